// Frames are orthonormal and right-handed for every normal and tangent.
#include "ajar/core/frame.h"

#include <gtest/gtest.h>

#include "ajar/core/sampler.h"
#include "ajar/core/warp.h"

namespace ajar {
namespace {

void expect_orthonormal(const Frame& f, const Vec3& n) {
  EXPECT_EQ(f.n, n);
  const float most = std::max({std::abs(length2(f.s) - 1), std::abs(length2(f.t) - 1), std::abs(glm::dot(f.s, f.t)),
                               std::abs(glm::dot(f.s, f.n)), std::abs(glm::dot(f.t, f.n))});
  EXPECT_LT(most, 2e-6f);
  EXPECT_NEAR(glm::dot(glm::cross(f.s, f.t), f.n), 1, 2e-6f);
}

TEST(Frame, IsOrthonormalEverywhere) {
  std::vector<Vec3> normals{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, {0, 0, -1.0f}, {1e-8f, 0, -1}};
  for (uint32_t i = 0; i < 1000; ++i)
    normals.push_back(to_sphere({to_unit(uint32_t(hash(i, 1))), to_unit(uint32_t(hash(i, 2)))}));
  for (const Vec3& n : normals) {
    expect_orthonormal(make_frame(n), n);
    const Vec3 v(0.3f, -0.5f, 0.7f);
    const Vec3 back = make_frame(n).to_world(make_frame(n).to_local(v));
    EXPECT_LT(std::sqrt(length2(back - v)), 1e-6f);
  }
}

TEST(Frame, FollowsTheTangentOrDoesWithout) {
  const Vec3 n = glm::normalize(Vec3(1, 2, 3));
  const Frame f = make_frame(n, Vec3(5, 0, 0));
  expect_orthonormal(f, n);
  EXPECT_GT(f.s.x, 0);
  EXPECT_NEAR(glm::dot(f.t, Vec3(1, 0, 0)), 0, 1e-6f);
  for (const Vec3& useless : {Vec3(0), n, -2.0f * n, Vec3(infinity, 0, 0), Vec3(std::nanf("")), Vec3(1e30f)})
    expect_orthonormal(make_frame(n, useless), n);
  expect_orthonormal(make_frame(n, Vec3(1e-15f, 0, 0)), n);
}

}  // namespace
}  // namespace ajar
