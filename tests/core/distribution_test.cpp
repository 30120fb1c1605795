// Discrete and piecewise-constant distributions: sample and pdf are inverses of each other, whatever the weights.
#include "ajar/core/distribution.h"

#include <gtest/gtest.h>

#include <numeric>

#include "ajar/core/sampler.h"

namespace ajar {
namespace {

std::vector<float> random_weights(size_t n, uint64_t seed, bool wild) {
  std::vector<float> w(n);
  for (size_t i = 0; i < n; ++i) {
    const uint64_t h = hash(seed, i);
    w[i] = to_unit(uint32_t(h));
    if (wild) w[i] = i > 0 && (h >> 32) % 4 == 0 ? 0.0f : std::pow(10.0f, 40 * w[i] - 20);
  }
  return w;
}

void expect_consistent(const std::vector<float>& weights) {
  const Distribution d(weights);
  ASSERT_EQ(d.size(), weights.size());
  EXPECT_EQ(d.cdf.front(), 0);
  EXPECT_EQ(d.cdf.back(), 1);
  double sum = 0;
  for (uint32_t i = 0; i < d.size(); ++i) {
    ASSERT_GE(d.pdf(i), 0);
    ASSERT_EQ(d.pdf(i) > 0, weights[i] > 0) << i;
    sum += d.pdf(i);
    if (weights[i] == 0) continue;
    // The ends of every entry belong to it, and the position inside comes back.
    float first = d.cdf[i], last = std::nextafter(d.cdf[i + 1], 0.0f);
    ASSERT_EQ(d.sample(first), i);
    ASSERT_EQ(first, 0);
    ASSERT_EQ(d.sample(last), i);
    ASSERT_LT(last, 1);
    float middle = 0.5f * (d.cdf[i] + d.cdf[i + 1]);
    if (d.pdf(i) < 1e-4f) continue;
    ASSERT_EQ(d.sample(middle), i);
    ASSERT_NEAR(middle, 0.5f, 1e-2f);
  }
  EXPECT_NEAR(sum, 1, 1e-6);
}

TEST(Distribution, EveryEntryIsFoundAndOnlyByItsShare) {
  for (const size_t n : {1u, 2u, 3u, 7u, 64u, 1000u, 20000u}) {
    expect_consistent(random_weights(n, n, false));
    expect_consistent(random_weights(n, n + 1, true));
  }
}

TEST(Distribution, SharesAreTheWeights) {
  const std::vector<float> w{1, 0, 3, 4};
  const Distribution d(w);
  EXPECT_EQ(d.sum, 8);
  EXPECT_EQ(d.pdf(0), 0.125f);
  EXPECT_EQ(d.pdf(1), 0);
  EXPECT_EQ(d.pdf(2), 0.375f);
  EXPECT_EQ(d.pdf(3), 0.5f);
}

TEST(Distribution, ATinyShareKeepsAChance) {
  const Distribution d(std::vector<float>{1e-30f, 1e30f, 1e-30f, 0, 1e-30f, 0});
  for (const uint32_t i : {0u, 2u, 4u}) EXPECT_EQ(d.pdf(i), 0x1p-24f) << i;
  EXPECT_EQ(d.pdf(3), 0);
  EXPECT_EQ(d.pdf(5), 0);
}

TEST(Distribution, NothingToChooseFromIsUniform) {
  const Distribution d(std::vector<float>(10, 0.0f));
  EXPECT_EQ(d.sum, 0);
  for (uint32_t i = 0; i < 10; ++i) EXPECT_NEAR(d.pdf(i), 0.1f, 1e-6f);
  EXPECT_EQ(Distribution(std::span<const float>{}).size(), 0u);
}

TEST(Distribution, NonsenseCountsAsZero) {
  const Distribution d(std::vector<float>{-1, std::nanf(""), 2, infinity});
  EXPECT_EQ(d.pdf(2), 1);
  EXPECT_EQ(d.sum, 2);
  float u = one_minus_epsilon;
  EXPECT_EQ(d.sample(u), 2u);
}

TEST(Distribution2D, SampleHasThePdfThatItClaims) {
  for (const auto& [w, h] : {std::pair{1, 1}, {5, 3}, {64, 32}}) {
    const std::vector<float> weights = random_weights(size_t(w * h), 9, w == 64);
    const Distribution2D d(weights, w, h);
    double mass = 0;
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) {
        mass += d.mass({x, y});
        EXPECT_EQ(d.pdf(Vec2((float(x) + 0.5f) / float(w), (float(y) + 0.5f) / float(h))),
                  d.mass({x, y}) * float(w) * float(h));
        EXPECT_EQ(d.mass({x, y}) > 0, weights[size_t(y * w + x)] > 0);
      }
    EXPECT_NEAR(mass, 1, 1e-6);
    for (uint32_t i = 0; i < 1000; ++i) {
      const uint64_t r = hash(i, 1);
      float pdf;
      const Vec2 at = d.sample({to_unit(uint32_t(r)), to_unit(uint32_t(r >> 32))}, pdf);
      ASSERT_TRUE(at.x >= 0 && at.x < 1 && at.y >= 0 && at.y < 1);
      ASSERT_GT(pdf, 0);
      // A point on the edge of a cell may round into its neighbour.
      const float fx = at.x * float(w), fy = at.y * float(h);
      if (std::abs(fx - std::round(fx)) > 1e-3f && std::abs(fy - std::round(fy)) > 1e-3f) {
        ASSERT_EQ(pdf, d.pdf(at));
      }
    }
  }
}

TEST(Distribution2D, FrequenciesFollowTheWeights) {
  const std::vector<float> weights{1, 2, 3, 0, 5, 1};
  const Distribution2D d(weights, 3, 2);
  std::vector<double> counts(6);
  const int n = 60000;
  Sampler s = make_sampler(SamplerKind::independent, 3, Side::camera, 0, 0);
  for (int i = 0; i < n; ++i) {
    Vec2 u = s.next2();
    const auto c = d.sample_cell(u);
    counts[size_t(c.y * 3 + c.x)] += 1.0 / n;
  }
  for (size_t i = 0; i < 6; ++i) EXPECT_NEAR(counts[i], weights[i] / 12, 0.01) << i;
}

}  // namespace
}  // namespace ajar
