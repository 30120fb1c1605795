// The square of directions and the trees of strata over it: maps, densities, samples.
#include "ajar/field/strata.h"

#include <gtest/gtest.h>

#include <cfloat>

#include "ajar/core/sampler.h"
#include "kit/chisquare.h"

namespace ajar {
namespace {

Vec3 direction(double cosine, double phi) {
  const double s = std::sqrt(1 - cosine * cosine);
  return {float(s * std::cos(phi)), float(s * std::sin(phi)), float(cosine)};
}

// Shares in steps of 2^-16, of all sixteen strata; they must add up to 65536.
StrataNode node_of(const std::vector<uint32_t>& steps) {
  StrataNode node;
  uint32_t sum = 0;
  for (size_t i = 0; i < 16; ++i) node.before[i] = uint16_t(sum), sum += steps[i];
  EXPECT_EQ(sum, 65536u);
  return node;
}

StrataNode even() { return node_of(std::vector<uint32_t>(16, 4096)); }

// Fifteen strata of one step, one takes the rest.
StrataNode lone(size_t heavy) {
  std::vector<uint32_t> steps(16, 1);
  steps[heavy] = 65536 - 15;
  return node_of(steps);
}

StrataNode slope() {
  std::vector<uint32_t> steps(16);
  uint32_t sum = 0;
  for (size_t i = 0; i < 15; ++i) sum += steps[i] = 1000 + 400 * uint32_t(i);
  steps[15] = 65536 - sum;
  return node_of(steps);
}

// A root with two divided strata, one of which is divided again.
std::vector<StrataNode> nested() {
  std::vector<StrataNode> nodes = {slope(), lone(6), slope(), even()};
  nodes[0].divided = (1u << 3) | (1u << 12), nodes[0].children = 1;
  nodes[1].divided = 1u << 6, nodes[1].children = 3;
  nodes[3] = slope();
  return nodes;
}

void expect_same_square(const Vec3& w) {
  float density;
  const Vec2 at = to_square(w, density);
  EXPECT_NEAR(density, square_density(w), 1e-6f);
  ASSERT_TRUE(at.x >= 0 && at.x < 1 && at.y >= 0 && at.y < 1) << at.x << ' ' << at.y;
  const Vec3 back = from_square(at);
  EXPECT_NEAR(back.x, w.x, 4e-7f);
  EXPECT_NEAR(back.y, w.y, 4e-7f);
  // At grazing angles z = sqrt(1 - r^2) is the difference of numbers near 1; its square is as exact as they are.
  EXPECT_NEAR(back.z * back.z, w.z * w.z, 8e-7f);
  EXPECT_GE(back.z, 0);
}

TEST(UFloat16, ErrsByOnePartIn512AtMost) {
  for (float x = 1e-37f; x < 1e38f; x *= 1.0137f) EXPECT_NEAR(UFloat16(x) / x, 1, 1.0 / 512) << x;
  for (const float x : {0.0f, 0.25f, 1.0f, 3.0f, 9.0f, 255.0f}) EXPECT_EQ(UFloat16(x), x);
  EXPECT_EQ(UFloat16(-1), 0.0f);
  EXPECT_LT(UFloat16(infinity), infinity);
  EXPECT_GT(UFloat16(infinity), 3e38f);
}

TEST(Square, ThereAndBackOverTheHemisphere) {
  for (int i = 0; i <= 200; ++i)
    for (int j = 0; j < 360; ++j) expect_same_square(direction(i / 200.0, j * std::numbers::pi / 180));
}

TEST(Square, ThereAndBackAtGrazingAndAxisDirections) {
  for (const double z : {0.0, 1e-20, 1e-7, 1e-4, 1 - 1e-7, 1.0})
    for (int j = 0; j < 16; ++j) expect_same_square(direction(z, j * std::numbers::pi / 8));
  for (const float tiny : {FLT_MIN, 1e-30f, 1e-10f})
    for (const Vec3 w : {Vec3(tiny, 0, 1), Vec3(0, -tiny, 1), Vec3(-tiny, tiny, 1)}) expect_same_square(w);
  for (const Vec3 w : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1)})
    expect_same_square(w);
}

TEST(Square, BackAndThere) {
  for (int i = 0; i < 512; ++i)
    for (int j = 0; j < 512; ++j) {
      const Vec2 at((float(i) + 0.5f) / 512, (float(j) + 0.5f) / 512), again = to_square(from_square(at));
      ASSERT_NEAR(at.x, again.x, 2e-7f) << i << ' ' << j;
      ASSERT_NEAR(at.y, again.y, 2e-7f) << i << ' ' << j;
    }
  for (const float x : {0.0f, 0.5f, one_minus_epsilon})
    for (const float y : {0.0f, 0.5f, one_minus_epsilon}) {
      const Vec2 again = to_square(from_square({x, y}));
      EXPECT_NEAR(again.x, x, 2e-7f);
      EXPECT_NEAR(again.y, y, 2e-7f);
    }
}

TEST(Square, DensityIntegratesToOneAndIsTheMapsJacobian) {
  // Uniform in cosine and angle, so that a solid angle is their product; a midpoint rule.
  const int n = 400;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 4 * n; ++j)
      sum += double(square_density(direction((i + 0.5) / n, (j + 0.5) / (4.0 * n) * 2 * std::numbers::pi)));
  EXPECT_NEAR(sum * 2 * std::numbers::pi / (4.0 * n * n), 1, 1e-5);
  // Solid angle of a small quadrilateral of the square against its area.
  const float h = 1.0f / 256;
  for (int i = 1; i < 40; ++i)
    for (int j = 1; j < 40; ++j) {
      const Vec2 at((float(i) + 0.37f) / 41, (float(j) + 0.21f) / 41);
      const Vec2 from_centre = glm::abs(at - 0.5f);
      if (std::abs(from_centre.x - from_centre.y) < 2 * h || glm::dot(from_centre, from_centre) < 0.01f)
        continue;  // kinks
      const Vec3 a = from_square(at - Vec2(h, 0)), b = from_square(at + Vec2(h, 0)), c = from_square(at - Vec2(0, h)),
                 d = from_square(at + Vec2(0, h)), w = from_square(at);
      if (w.z < 0.3f) continue;
      const double solid = 0.5 * double(glm::length(glm::cross(b - a, d - c))), area = 2.0 * h * h;
      EXPECT_NEAR(area / solid / double(square_density(w)), 1, 5e-3) << at.x << ' ' << at.y;
    }
}

// The integral of a density over the square, by the midpoints of the finest strata.
double integral(const std::vector<StrataNode>& nodes, uint32_t root) {
  const int n = 1 << (2 * most_levels);
  double sum = 0;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) sum += double(density(nodes, root, {(float(x) + 0.5f) / n, (float(y) + 0.5f) / n}));
  return sum / (double(n) * n);
}

void expect_sampled(const std::vector<StrataNode>& nodes, uint32_t root, int cells) {
  const auto r = kit::chi_square_square(
      [&](const Vec2& u) {
        float d;
        const Vec2 at = sample(nodes, root, u, d);
        return std::optional<Vec2>(at);
      },
      [&](const Vec2& at) { return double(density(nodes, root, at)); },
      {.rows = cells, .columns = cells, .samples = 400'000, .quadrature = 4});
  EXPECT_TRUE(r.ok) << r.message;
}

TEST(Strata, OneNode) {
  for (const StrataNode& node : {even(), slope(), lone(0), lone(7), lone(15)}) {
    const std::vector<StrataNode> nodes = {node};
    EXPECT_NEAR(integral(nodes, 0), 1, 1e-6);
    expect_sampled(nodes, 0, 16);
  }
}

TEST(Strata, NestedNodes) {
  EXPECT_NEAR(integral(nested(), 0), 1, 1e-6);
  expect_sampled(nested(), 0, 64);
  expect_sampled(nested(), 1, 64);  // a root need not be the first node
}

// Hand-computed: the share of stratum 3 is 2200 steps, that of its part 6 65521, of whose part 5 3000.
TEST(Strata, DensityIsTheProductOfShares) {
  const auto nodes = nested();
  const Vec2 in_3(0.75f, 0), in_36 = in_3 + Vec2(0.125f, 0.0625f), in_365 = in_36 + Vec2(0.015625f, 0.015625f);
  const float part = 1 / 1024.0f;
  const double d = 2200.0 / 4096 * 65521 / 4096 * 3000 / 4096;
  EXPECT_NEAR(density(nodes, 0, in_365 + part), d, 1e-5 * d);
  EXPECT_NEAR(density(nodes, 0, in_3 + part), 2200.0 / 4096 / 4096, 1e-7);
  EXPECT_NEAR(density(nodes, 0, Vec2(0.26f, 0.01f)), 1400.0 / 4096, 1e-6);
}

// Level by level, up to the leaf.
float slow_density(const std::vector<StrataNode>& nodes, uint32_t node, const Vec2& at) {
  Descent down(at);
  int i = down.next();
  float product = float(nodes[node].steps(i)) / 4096;
  while (nodes[node].is_divided(i)) {
    node = nodes[node].child(i);
    i = down.next();
    product *= float(nodes[node].steps(i)) / 4096;
  }
  return product;
}

// A chain down to the last level, below its last stratum each time.
std::vector<StrataNode> deepest() {
  std::vector<StrataNode> nodes(most_levels, slope());
  for (uint32_t i = 0; i + 1 < nodes.size(); ++i) nodes[i].divided = 1u << 15, nodes[i].children = i + 1;
  return nodes;
}

TEST(Strata, ThereIsNothingBelowALeaf) {
  Sampler sampler = make_sampler(SamplerKind::independent, 2, Side::camera, 0, 0);
  for (const auto& nodes : {nested(), deepest()})
    for (uint32_t root = 0; root < nodes.size(); ++root)
      for (int i = 0; i < 4000; ++i) {
        const Vec2 u = sampler.next2(), at = i % 4 == 0 ? u : Vec2(1) - u * std::ldexp(1.0f, -(i % 12));
        const Vec2 in = glm::clamp(at, Vec2(0), Vec2(one_minus_epsilon));
        ASSERT_EQ(density(nodes, root, in), slow_density(nodes, root, in)) << root << ' ' << in.x << ' ' << in.y;
        // A tree that ends before another, which is walked beside it, stays what it is.
        Way way(nodes.data(), root, in), once(nodes.data(), root, in);
        for (int pair = 0; pair < 3; ++pair) way.go_on();
        while (once.goes_on()) once.go_on();
        ASSERT_EQ(way.density(), once.density());
      }
}

// Density that comes with a sample is that of its place, at both ends of u too; strata of one step are found.
TEST(Strata, SamplesKnowTheirDensity) {
  for (const auto& nodes : {nested(), std::vector<StrataNode>{lone(0)}, std::vector<StrataNode>{lone(15)},
                            std::vector<StrataNode>{even()}}) {
    Sampler sampler = make_sampler(SamplerKind::independent, 1, Side::camera, 0, 0);
    std::vector<Vec2> us;
    for (const float x : {0.0f, 0x1p-24f, 0x1p-16f, 0.25f, 0.5f, 1 - 0x1p-16f, one_minus_epsilon})
      for (const float y : {0.0f, 0x1p-24f, 0.5f, one_minus_epsilon}) us.emplace_back(x, y);
    for (int i = 0; i < 65536; ++i) us.emplace_back((float(i) + 0.5f) / 65536, sampler.next1());
    for (const Vec2& u : us) {
      float d;
      const Vec2 at = sample(nodes, 0, u, d);
      ASSERT_TRUE(at.x >= 0 && at.x < 1 && at.y >= 0 && at.y < 1) << u.x << ' ' << u.y;
      ASSERT_GT(d, 0);
      ASSERT_EQ(d, density(nodes, 0, at)) << u.x << ' ' << u.y << " gave " << at.x << ' ' << at.y;
    }
  }
}

TEST(Strata, EveryStepIsReached) {
  const std::vector<StrataNode> nodes = {lone(9)};
  int found[16] = {};
  for (int i = 0; i < 65536; ++i) {
    float d;
    const Vec2 at = sample(nodes, 0, {(float(i) + 0.5f) / 65536, 0.5f}, d);
    ++found[Descent(at).next()];
  }
  for (int i = 0; i < 16; ++i) EXPECT_EQ(found[i], i == 9 ? 65521 : 1) << i;
}

}  // namespace
}  // namespace ajar
