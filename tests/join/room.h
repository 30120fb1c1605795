// A lit room, its light vertices in a store, and camera subpaths to join them to.
#pragma once

#include <algorithm>

#include "ajar/join/store.h"
#include "kit/stage.h"
#include "path/train.h"

namespace ajar::room {
inline constexpr int most_edges = 6;

inline Scene scaled_stage(float scale) {
  Scene scene = kit::stage(8);
  Material glossy;
  glossy.kind = MaterialKind::roughplastic;
  add_mesh(scene, kit::globe({0.3f, -0.5f, 0.1f}, 0.4f, 8), add_material(scene, glossy));
  for (Mesh& mesh : scene.meshes)
    for (Vec3& p : mesh.positions) p *= scale;
  // Next-event estimation finds a ball's points by another density than emission does.
  add_area_light(scene, add_sphere(scene, Vec3(-0.5f, 0.2f, 0.1f) * scale, 0.2f * scale, add_diffuse(scene, Rgb(0.5f))),
                 Rgb(30));
  set_camera(scene, Vec3(0, 0, 4.2f) * scale, Vec3(0), 36, 8, 8);
  finish(scene);
  return scene;
}

// Each region sees some of the others always, some rarely, some never.
inline Views made_up_views(const Fields& fields) {
  Views views = fields.views;
  ViewTallies tallies = start_tallies(views);
  for (uint32_t a = 0; a < views.regions; ++a)
    for (uint32_t b = a; b < views.regions; ++b)
      for (uint32_t i = 0; i < 60; ++i) record_join(views, tallies, a, b, hash(a * 7919 + b, i) % 3 < hash(a, b) % 4);
  return learn_views(views, tallies, fields.regions, 1);
}

struct Room {
  Scene scene;
  Accel accel;
  Fields fields;
  WalkOptions options;

  explicit Room(float scale = 1, bool guided = false) : scene(scaled_stage(scale)), accel(scene) {
    options.counts.light_paths = 64;
    if (!guided) return;
    fields = train(scene, accel, 3, 1000);
    fields.views = made_up_views(fields);
    options.fields = &fields;
  }
  Room(const Room&) = delete;
  Room& operator=(const Room&) = delete;

  // So many light subpaths, and of their vertices so many at most; shares are those that light walks end with.
  LightStore store(uint32_t paths, size_t most_entries = ~size_t(0)) const {
    LightStore out;
    Subpath light;
    Surface surface;
    for (uint32_t i = 0; i < paths; ++i) {
      Sampler sampler = make_sampler(SamplerKind::independent, 5, Side::light, i, 0);
      Walk walk;
      light.n = 0;
      if (start_light(scene, options, sampler, light, walk))
        while (light.n < most_edges && step(scene, accel, options, light, walk, surface) &&
               scatter(options, sampler, light, walk)) {
        }
      add(out, light);
    }
    out.entries.resize(std::min(out.entries.size(), most_entries));
    deal_blocks(out);
    return out;
  }

  // Camera subpaths that end at a vertex that can be joined.
  std::vector<Subpath> cameras(size_t n) const {
    std::vector<Subpath> out;
    for (uint64_t i = 0; out.size() < n && i < 1000; ++i) {
      Subpath camera;
      trace_subpath(scene, accel, options, Side::camera, i, 77, 2 + int(i % 3), camera);
      if (camera.n > 1 && connectable(camera[camera.n - 1].guide)) out.push_back(camera);
    }
    return out;
  }
};

inline const Vertex& end_of(const Subpath& path) { return path[path.n - 1]; }
inline const LightStore::Entry& entry_of(const LightStore& store, const StoreChoice& choice) {
  return store.entries[choice.entry];
}
inline Sampler draws(uint64_t path) { return make_sampler(SamplerKind::independent, 9, Side::camera, path, 0); }

// What an entry brings to a camera subpath, but for visibility, times a factor of no meaning. Entries of subpaths that
// would be too long bring nothing.
inline std::vector<double> brought(const LightStore& store, const Subpath& camera, int most) {
  std::vector<double> out;
  for (const LightStore::Entry& at : store.entries) {
    Candidate c;
    const bool joined = at.s <= most && join_vertices(store.end(at), camera.first(camera.n), c);
    out.push_back(joined ? double(luminance(c.value)) * (0.5 + double(hash(out.size(), 3) % 1000) / 1000) : 0);
  }
  return out;
}

}  // namespace ajar::room
