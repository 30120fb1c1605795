#include "ajar/core/angle.h"

#include <gtest/gtest.h>

#include "ajar/core/sampler.h"

namespace ajar {
namespace {

void expect_same(float y, float x) {
  EXPECT_NEAR(fast_atan2(y, x), std::atan2(double(y), double(x)), 3e-7) << y << ' ' << x;
  EXPECT_EQ(std::signbit(fast_atan2(y, x)), std::signbit(y)) << y << ' ' << x;
}

TEST(Angle, IsThatOfTheStandardLibrary) {
  Sampler sampler = make_sampler(SamplerKind::independent, 1, Side::camera, 0, 0);
  for (int i = 0; i < 200'000; ++i) {
    const Vec2 u = 2.0f * sampler.next2() - 1.0f;
    expect_same(u.y, u.x);
    expect_same(u.y * std::exp(40 * u.x), u.x);
  }
  for (int i = 0; i <= 1'000'000; i += 7) expect_same(float(i) / 1'000'000, 1);  // where the series changes too
}

TEST(Angle, OfAxesAndExtremesToo) {
  for (const float y : {0.0f, -0.0f, 1e-45f, 1e-38f, 1.0f, 1.6e38f})
    for (const float x : {0.0f, -0.0f, 1e-45f, 1e-38f, 1.0f, 1.6e38f})
      for (const float sign : {1.0f, -1.0f}) expect_same(y, sign * x), expect_same(-y, sign * x);
}

}  // namespace
}  // namespace ajar
