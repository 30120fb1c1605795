// Enters: scenes and renders.
// Leaves: whether two renders are the same to the byte, and how bright one is.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>

#include "kit/stage.h"
#include "measure.h"

namespace ajar {

// All kinds of strategies, and more tiles than are traced at once: 4112 x 2 pixels are 257 tiles, and so many pixels
// that passes which are dropped trace a part of them.
inline Scene strip(bool wide) {
  using namespace kit;
  Scene scene = stage(40);
  Material glass;
  glass.kind = MaterialKind::dielectric;
  add_sphere(scene, {0.3f, -0.5f, 0.3f}, 0.4f, add_material(scene, glass));
  scene.filter = make_filter(FilterKind::mitchell);
  if (wide) {
    Camera& c = scene.camera;
    c.width = 4112, c.height = 2, c.crop_width = 4112, c.crop_height = 2;
  }
  finish(scene);
  return scene;
}

/// Of a pixel, its channels together.
inline double mean_of(const Film& film) {
  double sum = 0;
  for (const float x : develop(film).pixels) sum += double(x);
  return sum / double(film.pixels());
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

inline void expect_same_field(const Field& a, const Field& b) {
  EXPECT_EQ(a.unit, b.unit);
  EXPECT_TRUE(same_bytes(a.cells, b.cells));
  EXPECT_TRUE(a.nodes == b.nodes);
  EXPECT_TRUE(same_bytes(a.mean, b.mean));
  EXPECT_TRUE(same_bytes(a.weight, b.weight));
}

inline void expect_same_tallies(const Tallies& a, const Tallies& b) {
  EXPECT_EQ(a.value, b.value);
  EXPECT_EQ(a.weight, b.weight);
  EXPECT_EQ(a.direct, b.direct);
  EXPECT_EQ(a.directs, b.directs);
  EXPECT_EQ(a.visits, b.visits);
}

inline void expect_same_views(const Fields& a, const Fields& b) {
  ASSERT_EQ(a.cells.size(), b.cells.size());
  for (size_t i = 0; i < a.cells.size(); ++i) EXPECT_EQ(a.cells[i].region, b.cells[i].region);
  EXPECT_EQ(a.regions, b.regions);
  EXPECT_EQ(a.views.regions, b.views.regions);
  EXPECT_EQ(a.views.tried, b.views.tried);
  EXPECT_EQ(a.views.seen, b.views.seen);
  EXPECT_EQ(a.views.chance, b.views.chance);
}

inline void expect_same_learning(const Learning& a, const Learning& b) {
  EXPECT_EQ(a.passes, b.passes);
  EXPECT_EQ(a.first, b.first);
  EXPECT_EQ(a.fields.generation, b.fields.generation);
  ASSERT_EQ(a.fields.cells.size(), b.fields.cells.size());
  for (size_t i = 0; i < a.fields.cells.size(); ++i) EXPECT_EQ(a.fields.cells[i].key, b.fields.cells[i].key);
  expect_same_field(a.fields.q, b.fields.q);
  expect_same_field(a.fields.w, b.fields.w);
  expect_same_views(a.fields, b.fields);
  expect_same_tallies(a.training.q, b.training.q);
  expect_same_tallies(a.training.w, b.training.w);
  EXPECT_EQ(a.training.views.counts, b.training.views.counts);
  ASSERT_EQ(a.sightings.size(), b.sightings.size());
  for (const auto& [key, seen] : a.sightings) {
    ASSERT_TRUE(b.sightings.contains(key));
    EXPECT_EQ(seen.count, b.sightings.at(key).count);
    EXPECT_EQ(seen.normal, b.sightings.at(key).normal);
  }
}

inline void expect_same_bytes(const RenderState& a, const RenderState& b) {
  EXPECT_EQ(a.film.passes, b.film.passes);
  EXPECT_EQ(a.film.chunks, b.film.chunks);
  EXPECT_TRUE(same_bytes(a.film.camera_sum, b.film.camera_sum));
  EXPECT_TRUE(same_bytes(a.film.splat_sum, b.film.splat_sum));
  EXPECT_TRUE(same_bytes(a.film.half_sum, b.film.half_sum));
  EXPECT_TRUE(same_bytes(a.film.square_sum, b.film.square_sum));
  EXPECT_EQ(a.film.weight, b.film.weight);
  EXPECT_EQ(a.film.half_weight, b.film.half_weight);
  EXPECT_TRUE(same_bytes(a.film.camera, b.film.camera));
  EXPECT_TRUE(same_bytes(a.film.splat, b.film.splat));
  EXPECT_TRUE(same_bytes(develop(a.film).pixels, develop(b.film).pixels));
  ASSERT_EQ(a.pyramid.layers.size(), b.pyramid.layers.size());
  for (const auto& [st, layer] : a.pyramid.layers) {
    ASSERT_TRUE(b.pyramid.layers.contains(st));
    EXPECT_TRUE(same_bytes(layer.raw, b.pyramid.layers.at(st).raw));
    EXPECT_TRUE(same_bytes(layer.weighted, b.pyramid.layers.at(st).weighted));
  }
  EXPECT_EQ(a.stats.counters.camera_rays, b.stats.counters.camera_rays);
  EXPECT_EQ(a.stats.counters.light_rays, b.stats.counters.light_rays);
  EXPECT_EQ(a.stats.counters.shadow_rays, b.stats.counters.shadow_rays);
  for (int s = 0; s <= Ledger::most; ++s)
    for (int t = 0; t <= Ledger::most; ++t) {
      const StrategyCost &x = a.stats.ledger.strategies[s][t], &y = b.stats.ledger.strategies[s][t];
      EXPECT_EQ(x.joins, y.joins);
      EXPECT_EQ(x.rays, y.rays);
      EXPECT_EQ(x.visible, y.visible);
      EXPECT_EQ(x.energy, y.energy);
      EXPECT_EQ(a.stats.ledger.merges[s][t].joins, b.stats.ledger.merges[s][t].joins);
      EXPECT_EQ(a.stats.ledger.merges[s][t].energy, b.stats.ledger.merges[s][t].energy);
    }
  EXPECT_EQ(a.film.dropped, b.film.dropped);
  EXPECT_EQ(a.balance.goes_on, b.balance.goes_on);
  EXPECT_EQ(a.balance.work.beyond, b.balance.work.beyond);
  EXPECT_TRUE(same_bytes(a.balance.found, b.balance.found));
  expect_same_learning(a.learning, b.learning);
}

// Sanitizers take their time: those that have all that the others have.
inline std::vector<std::string> tried_integrators() {
#ifdef AJAR_SANITIZED
  return {"bdpt", "guided-vcm", "vpl"};
#else
  return integrator_names();
#endif
}

inline RenderOptions options_of(const std::string& integrator, uint32_t spp, uint64_t seed = 5) {
  RenderOptions o;
  o.integrator = integrator;
  o.spp = spp;
  o.seed = seed;
  o.learn.least_contrast = 2;  // small scenes are even, and guiding is to be tested
  return o;
}

inline bool always(const RenderState&) { return true; }

struct File {
  std::string path;
  explicit File(const std::string& name)
      : path((std::filesystem::temp_directory_path() / (name + std::to_string(getpid()))).string()) {}
  ~File() { std::filesystem::remove(path); }
};

}  // namespace ajar
