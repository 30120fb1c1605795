// Directions drawn from every bsdf against the density that it claims.
#include <gtest/gtest.h>

#include "kit/chisquare.h"
#include "scene/bsdf/cases.h"

namespace ajar::test {
namespace {

class Draw : public testing::TestWithParam<Case> {};

// Smooth part only: a delta that was drawn counts as nothing drawn, and the density integrates to the rest.
kit::ChiSquare test_draws(const Bsdf& bsdf, const Vec3& wo, Mode mode) {
  kit::ChiOptions options;
  options.samples = 200'000;
  options.level = 2e-6;  // some 250 tests: one false alarm in 2000 suites
  const auto draw = [&](const Vec2& u, float u_lobe) -> std::optional<Vec3> {
    BsdfSample s;
    if (!sample(bsdf, wo, u_lobe, u, mode, s) || s.delta) return {};
    return s.wi;
  };
  return kit::chi_square_sphere(
      draw, [&](const Vec3& wi) { return eval(bsdf, wo, wi, mode).pdf; }, options);
}

TEST_P(Draw, FollowsItsDensity) {
  const Resolved r = resolved(GetParam().materials);
  for (const float theta : {0.02f, 0.7f, 1.2f, 1.5f, 2.0f, 2.8f}) {
    if (theta > pi / 2 && !GetParam().behind) continue;
    const kit::ChiSquare result =
        test_draws(r.bsdf, direction(theta, 0.4f + theta), theta > 1 ? Mode::importance : Mode::radiance);
    EXPECT_TRUE(result.ok) << "theta " << theta << ": " << result.message;
  }
}

INSTANTIATE_TEST_SUITE_P(Bsdf, Draw, testing::ValuesIn(smooth_cases()), [](const auto& i) { return i.param.name; });

}  // namespace
}  // namespace ajar::test
