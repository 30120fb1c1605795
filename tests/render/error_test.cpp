// The estimate of the error against the error, over many seeds of a small scene.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kit/stage.h"
#include "measure.h"

namespace ajar {
namespace {

using namespace kit;

struct Compared {
  double estimate = 0, truth = 0, spread = 0;  // means over seeds of relMSE; spread is what the passes' variance says
  double deviation = 0;                        // standard deviation of estimate - truth over seeds
};

// The truth of a seed is the mean of the others, whose own error is 1 / (seeds - 1) of what is measured.
Compared compared(const Scene& scene, const RenderOptions& options, int seeds) {
  const Accel accel(scene);
  RenderOptions o = options;
  std::vector<Picture> images, variances;
  std::vector<double> estimates, sum;
  for (int k = 0; k < seeds; ++k) {
    o.seed = 100 + uint64_t(k);
    const RenderState state = rendered(scene, accel, o);
    estimates.push_back(estimated_error(state.film));
    images.push_back(develop(state.film));
    variances.push_back(variance(state.film));
    sum.resize(images[0].pixels.size());
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += images.back().pixels[i];
  }
  std::vector<double> differences;
  Compared c;
  for (size_t k = 0; k < images.size(); ++k) {
    double truth = 0, spread = 0;
    for (size_t i = 0; i < sum.size(); ++i) {
      const double r = (sum[i] - images[k].pixels[i]) / (seeds - 1), scale = 1 / (r * r + 0.01) / double(sum.size());
      truth += sqr(images[k].pixels[i] - r) * scale * (seeds - 1) / seeds;
      spread += variances[k].pixels[i] * scale;
    }
    c.estimate += estimates[k] / seeds, c.truth += truth / seeds, c.spread += spread / seeds;
    differences.push_back(estimates[k] - truth);
  }
  for (const double d : differences) c.deviation += sqr(d - c.estimate + c.truth) / (seeds - 1);
  c.deviation = std::sqrt(c.deviation);
  return c;
}

// Halves are independent with the same expectation, so the square of their half difference has the expectation of the
// square of their mean's error, whatever the sampler and the number of passes. What is left is chance, four deviations
// of it, and that pixels and neighbours stand for the true values.
TEST(ErrorEstimate, IsTheErrorWhateverTheSampler) {
  Scene scene = stage();
  set_camera(scene, {0, 0, 3.5f}, {0, -0.4f, 0}, 30, 24,
             24);  // the lamp, whose outline would be most of the error, is out of view
  finish(scene);
  struct Case {
    const char* integrator;
    SamplerKind kind;
    uint32_t spp;
  };
  constexpr int seeds = 16;
  for (const auto& [integrator, kind, spp] : {Case{"path", SamplerKind::sobol, 16},
                                              {"path", SamplerKind::sobol, 23},
                                              {"path", SamplerKind::independent, 16},
                                              {"bdpt", SamplerKind::sobol, 16},
                                              {"bdpt", SamplerKind::sobol, 23},
                                              {"bdpt", SamplerKind::independent, 16},
                                              {"light", SamplerKind::sobol, 23}}) {
    RenderOptions o;
    o.integrator = integrator, o.sampler = kind, o.spp = spp, o.max_depth = 5;
    const Compared c = compared(scene, o, seeds);
    const double chance = 4 * c.deviation / std::sqrt(seeds);
    const std::string name = fmt::format("{} {} {}", integrator, int(kind), spp);
    // For n equal pixels, estimate and truth would be independent sums of n squares of one normal variable each.
    EXPECT_LT(c.deviation, 2 * std::sqrt(4.0 / (24 * 24)) * c.truth) << name;
    EXPECT_NEAR(c.estimate, c.truth, chance + 0.06 * c.truth) << name << ": " << c.estimate / c.truth;
    // The spread of passes is no estimate for points that belong together: that is why there are halves.
    if (kind == SamplerKind::sobol && o.integrator != "light")
      EXPECT_GT(c.spread, 1.2 * c.truth) << name;
    else
      EXPECT_NEAR(c.spread, c.truth, chance + 0.06 * c.truth) << name;
  }
}

}  // namespace
}  // namespace ajar
