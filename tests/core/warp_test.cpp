// Every warp against the density that stands beside it.
#include "ajar/core/warp.h"

#include <gtest/gtest.h>

#include "kit/chisquare.h"

namespace ajar {
namespace {

using kit::ChiOptions;

ChiOptions options(uint64_t seed) {
  ChiOptions o;
  o.samples = 200'000;
  o.seed = seed;
  return o;
}

TEST(Warp, DiskIsUniform) {
  const auto draw = [](const Vec2& u) { return std::optional<Vec2>(to_disk(u) * 0.5f + 0.5f); };
  const auto pdf = [](const Vec2& p) { return length2(Vec3(p - 0.5f, 0)) < 0.25f ? 4.0 / pi : 0.0; };
  const auto r = kit::chi_square_square(draw, pdf, options(1));
  EXPECT_TRUE(r.ok) << r.message;
  EXPECT_EQ(to_disk({0.5f, 0.5f}), Vec2(0));
  for (const Vec2& u : {Vec2(0, 0), Vec2(0, one_minus_epsilon), Vec2(one_minus_epsilon, 0)})
    EXPECT_LE(length2(Vec3(to_disk(u), 0)), 1 + 1e-6f);
}

TEST(Warp, CosineHemisphere) {
  const auto r =
      kit::chi_square_sphere([](const Vec2& u, float) { return std::optional<Vec3>(to_cosine_hemisphere(u)); },
                             [](const Vec3& w) { return cosine_hemisphere_pdf(w); }, options(2));
  EXPECT_TRUE(r.ok) << r.message;
}

TEST(Warp, Sphere) {
  const auto r = kit::chi_square_sphere([](const Vec2& u, float) { return std::optional<Vec3>(to_sphere(u)); },
                                        [](const Vec3&) { return sphere_pdf; }, options(3));
  EXPECT_TRUE(r.ok) << r.message;
}

TEST(Warp, Cone) {
  for (const float height : {0.01f, 0.5f, 1.0f, 1.7f, 2.0f}) {
    const auto r =
        kit::chi_square_sphere([=](const Vec2& u, float) { return std::optional<Vec3>(to_cone(u, height)); },
                               [=](const Vec3& w) { return w.z > 1 - height ? cone_pdf(height) : 0.0f; }, options(4));
    EXPECT_TRUE(r.ok) << height << ": " << r.message;
  }
}

TEST(Warp, TinyConesKeepTheirAngle) {
  for (const float height : {1e-6f, 1e-10f, 1e-20f}) {
    double mean = 0;
    for (int i = 0; i < 1000; ++i) {
      const Vec3 w = to_cone({(float(i) + 0.5f) / 1000, 0.3f}, height);
      mean += double(w.x * w.x + w.y * w.y) / 1000;
    }
    EXPECT_NEAR(mean / height, 1, 1e-3);  // sin^2 = 2 h, uniform in [0, 2 height)
  }
}

TEST(Warp, TriangleIsUniform) {
  const auto draw = [](const Vec2& u) { return std::optional<Vec2>(to_triangle(u)); };
  const auto pdf = [](const Vec2& p) { return p.x + p.y < 1 ? 2.0 : 0.0; };
  ChiOptions o = options(5);
  o.rows = o.columns = 20;  // the diagonal halves cells
  const auto r = kit::chi_square_square(draw, pdf, o);
  EXPECT_TRUE(r.ok) << r.message;
  for (const Vec2& u : {Vec2(0, 0), Vec2(one_minus_epsilon), Vec2(1e-8f, 0.5f)}) {
    const Vec2 b = to_triangle(u);
    EXPECT_TRUE(b.x >= 0 && b.y >= 0 && b.x + b.y <= 1 + 1e-6f);
  }
}

}  // namespace
}  // namespace ajar
