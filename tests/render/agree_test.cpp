// path = bdpt = light tracing = guided path = guided bdpt = virtual point lights by z-test, one small scene for each
// feature. What an integrator cannot sample is left out: light tracing makes no light seen over mirrors and glass alone
// and no environment seen directly; path tracing finds no caustic of a light without
// extent, which VPLs (v, where there is no p) do.
#include <gtest/gtest.h>

#include "features.h"
#include "measure.h"

namespace ajar {
namespace {

class Agree : public testing::TestWithParam<Feature> {};

TEST_P(Agree, InEveryBlock) {
  const Feature& feature = GetParam();
  Scene scene = feature.make();
  if (Camera& c = scene.camera; c.crop_width == c.width) set_size(c, 16, 16);
  const std::string initials = feature.integrators;
  const auto measured = [&](const std::string& integrator, uint32_t passes, uint64_t seed) {
    RenderOptions options = statistical(integrator, feature.max_depth);
    options.heuristic = feature.heuristic;
    return measure(scene, options, {.batches = 16, .passes = passes * feature.effort, .seed = seed});
  };
  const kit::Estimate bdpt = measured("bdpt", 20, 1000);
  if (initials.find('p') != std::string::npos) {
    expect_same(measured("path", 60, 2000), bdpt, "path, bdpt");
    expect_same(measured("guided-path", 20, 5000), bdpt, "guided-path, bdpt");
  }
  if (initials.find_first_of("pv") != std::string::npos)
    for (const std::string vpls : {"plain-vpl", "vpl"}) expect_same(measured(vpls, 10, 6000), bdpt, vpls + ", bdpt");
  if (initials.find('l') != std::string::npos) expect_same(measured("light", 60, 3000), bdpt, "light, bdpt");
  // The young passes are dropped, so these are passes through fields that have learned, and went on learning.
  expect_same(measured("guided-bdpt", 20, 4000), bdpt, "guided-bdpt, bdpt");
}

// What light subpaths find of a caustic, and what camera subpaths leave to them, is weighed with the fields of the side
// that the light came from.
TEST(AgreeClosely, CausticsThroughPaper) {
  const auto is_it = [](const Feature& f) { return f.name == std::string("caustic_through_paper"); };
  const std::vector<Feature> all = features();
  Scene scene = std::find_if(all.begin(), all.end(), is_it)->make();
  set_size(scene.camera, 16, 16);
  const kit::Estimate path = measure(scene, statistical("path", 4), {.batches = 16, .passes = 400, .seed = 2000});
  expect_same(measure(scene, statistical("vpl", 4), {.batches = 16, .passes = 400, .seed = 6000}), path, "vpl, path");
}

INSTANTIATE_TEST_SUITE_P(Features, Agree, testing::ValuesIn(features()),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace ajar
