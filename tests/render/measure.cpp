#include "measure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "kit/walls.h"

namespace ajar {
namespace {

// Sanitizers are asked what they report, and take ten times as long: verdicts are left to builds without them.
int batches_of(const Repeats& plan) {
#ifdef AJAR_SANITIZED
  return std::min(plan.batches, 2);
#else
  return plan.batches;
#endif
}

}  // namespace

RenderOptions statistical(const std::string& integrator, int max_depth) {
  RenderOptions o;
  o.integrator = integrator;
  o.max_depth = max_depth;
  o.sampler = SamplerKind::independent;
  o.learn.least_contrast = 2;
  return o;
}

RenderState rendered(const Scene& scene, const Accel& accel, const RenderOptions& options, const CellTable* walls) {
  RenderState state = start_render(scene, options);
  if (walls) kit::copy_walls(*walls, state.learning.fields.table);
  render(scene, accel, options, state, [](const RenderState&) { return true; });
  EXPECT_EQ(state.stats.rejected, 0u) << (state.stats.replay.empty() ? "" : state.stats.replay[0]);
  return state;
}

Fields learned(const Scene& scene) {
  const Accel accel(scene);
  RenderOptions options = statistical("guided-bdpt");
  options.spp = 6;
  return rendered(scene, accel, options).learning.fields;
}

kit::Estimate measure(const Scene& scene, const RenderOptions& options, const Repeats& plan) {
  const Accel accel(scene);
  RenderOptions o = options;
  o.spp = plan.passes;
  std::vector<std::vector<double>> runs;
  CellTable walls;
  for (int i = 0; i < batches_of(plan); ++i) {
    o.seed = plan.seed + uint64_t(i);
    RenderState state = rendered(scene, accel, o, &walls);
    const Picture p = develop(state.film);
    runs.emplace_back(p.pixels.begin(), p.pixels.end());
    walls = std::move(state.learning.fields.table);
  }
  return kit::estimate(scene.camera.crop_width, scene.camera.crop_height, std::move(runs));
}

std::map<std::pair<int, int>, kit::Estimate> measure_techniques(const Scene& scene, RenderOptions o,
                                                                const Repeats& plan) {
  const Accel accel(scene);
  o.spp = plan.passes;
  o.techniques = true;
  const size_t pixels = size_t(scene.camera.crop_width) * size_t(scene.camera.crop_height);
  std::map<std::pair<int, int>, std::vector<std::vector<double>>> runs;
  const int batches = batches_of(plan);
  CellTable walls;
  for (int i = 0; i < batches; ++i) {
    o.seed = plan.seed + uint64_t(i);
    RenderState state = rendered(scene, accel, o, &walls);
    walls = std::move(state.learning.fields.table);
    for (const auto& [st, layer] : state.pyramid.layers) {
      auto& all = runs[st];
      all.resize(size_t(batches), std::vector<double>(3 * pixels, 0.0));
      for (size_t k = 0; k < 3 * pixels; ++k)
        all[size_t(i)][k] = layer.raw[k / 3][glm::length_t(k % 3)] / state.film.passes;
    }
  }
  std::map<std::pair<int, int>, kit::Estimate> out;
  for (auto& [st, all] : runs)
    out[st] = kit::estimate(scene.camera.crop_width, scene.camera.crop_height, std::move(all));
  return out;
}

kit::Estimate exact(const Picture& p) {
  kit::Estimate e;
  e.width = p.width, e.height = p.height;
  e.mean.assign(p.pixels.begin(), p.pixels.end());
  e.variance.assign(p.pixels.size(), 0.0);
  return e;
}

double mean(const kit::Estimate& e) {
  return std::accumulate(e.mean.begin(), e.mean.end(), 0.0) / double(e.mean.size());
}

void expect_same(const kit::Estimate& a, const kit::Estimate& b, const std::string& what) {
  const kit::ZTest z = kit::z_test(a, b, 1e-6, 3);
  EXPECT_TRUE(z.ok) << what << ": means " << mean(a) << " and " << mean(b) << "; " << z.message;
  EXPECT_GT(mean(a), 0) << what << ": nothing was seen";
}

}  // namespace ajar
