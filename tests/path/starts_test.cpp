// Where light subpaths start on the disk across the scene: next-event rays of camera vertices teach it what light
// subpaths would, and find what they hardly come by.
#include <gtest/gtest.h>

#include <numeric>

#include "kit/stage.h"
#include "train.h"

namespace ajar {
namespace {

int64_t sum(const std::vector<int64_t>& all) { return std::accumulate(all.begin(), all.end(), int64_t(0)); }

// What light subpaths alone teach the disk: first vertices are told, or kept back.
void teach_by_light(const Scene& scene, const Accel& accel, const Fields& fields, int paths, bool told, Training& out) {
  WalkOptions options;
  options.fields = &fields;
  for (int i = 0; i < paths; ++i) {
    Sampler sampler = make_sampler(SamplerKind::independent, 7, Side::light, uint64_t(i), 0);
    Subpath path;
    Walk walk;
    Surface surface;
    if (!start_light(scene, options, sampler, path, walk)) continue;
    const bool hit = step(scene, accel, options, path, walk, surface);
    const float per_watt = hit ? promise(path[1].guide, Rgb(1)).all : 0;
    WayBack way;
    if (hit && told)
      way = {&path[1].guide, pdf_next_event(scene, path[1].guide, walk.start.point, -walk.start.direction)};
    record_start(scene, fields, out, walk.start, 0, per_watt, way);
  }
}

// What next-event rays of camera vertices add. Each vertex sends so many, which is no more evidence than one.
void teach_by_camera(const Scene& scene, const Accel& accel, const Fields& fields, int paths, int rays, Training& out) {
  WalkOptions options;
  options.fields = &fields;
  Subpath path;
  for (int i = 0; i < paths; ++i) {
    trace_subpath(scene, accel, options, Side::camera, uint64_t(i), 77, 6, path);
    for (int t = 2; t <= path.n; ++t) {
      const Vertex& v = path[t - 1];
      if (!connectable(v.guide)) continue;
      for (int k = 0; k < rays; ++k) {
        Sampler s = make_sampler(SamplerKind::independent, 11, Side::camera, uint64_t(i), uint32_t(t * rays + k));
        LightChances chances;
        LightNumbers u;
        Candidate c;
        if (draw_light(scene, v.guide, s, u) && join_light(scene, &fields, path, t, chances, u, c) &&
            visible(accel, c.segment))
          record_start(scene, fields, out, c.point, c.light_found.w, {&v.guide, c.light.own * c.nee.ratio}, 1, rays);
      }
    }
  }
}

// Both sides' records, weighed by both sides' densities, are light subpaths' in the mean: as much evidence, and as much
// importance.
TEST(Starts, BothSidesTeachTheSame) {
  for (const LightKind kind : {LightKind::constant, LightKind::directional})
    for (const int rays : {1, 4}) {
      const Scene scene = kit::under_a_lid(kind, 5, 24);
      const Accel accel(scene);
      const Fields fields = train(scene, accel, 6, 8000);
      constexpr int paths = 200'000;
      Training alone = start_training(fields), both = start_training(fields), light = start_training(fields);
      teach_by_light(scene, accel, fields, paths, false, alone);
      teach_by_light(scene, accel, fields, paths, true, both);
      const double of_light = double(sum(both.disk.value));
      teach_by_camera(scene, accel, fields, paths, rays, both);
      const double value = double(sum(both.disk.value)), as_it_was = double(sum(alone.disk.value));
      EXPECT_GT(value - of_light, 0.1 * value) << "cameras hardly teach: the test means little";
      EXPECT_NEAR(value / as_it_was, 1, 0.06) << int(kind) << ' ' << rays;
      EXPECT_NEAR(double(sum(both.disk.weight)) / double(sum(alone.disk.weight)), 1, 0.04) << int(kind) << ' ' << rays;
    }
}

}  // namespace
}  // namespace ajar
