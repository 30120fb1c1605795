// Two integrators agree, or not: batches with known means and noise.

#include "report/agreement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace ajar {
namespace {

using Noise = std::function<double(std::mt19937_64&)>;

/// Batches whose pixels are signal(x, y) times noise of mean 1.
Batches batches(int count, uint64_t seed, const std::function<double(int, int)>& signal, const Noise& noise,
                int width = 64, int height = 64) {
  std::mt19937_64 random(seed);
  Batches list;
  for (int k = 0; k < count; ++k) {
    Picture image{width, height, {"R", "G", "B"}, {}};
    for (int i = 0; i < width * height; ++i)
      for (int c = 0; c < 3; ++c) image.pixels.push_back(float(signal(i % width, i / width) * noise(random)));
    list.push_back({std::move(image), 1});
  }
  return list;
}

double one(int, int) { return 1; }
double gauss(std::mt19937_64& r) { return 1 + std::normal_distribution<double>(0, 0.3)(r); }
/// Once in so many samples all the energy: a pixel sees it rarely, a small block may not see it at all.
Noise rare(double every) {
  return
      [every](std::mt19937_64& r) { return std::uniform_real_distribution<double>(0, 1)(r) * every < 1 ? every : 0.0; };
}

TEST(Agree, EqualMeansOfDifferentNoise) {
  int refused = 0;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const Agreement a = agree(batches(16, 2 * seed, one, gauss),
                              batches(16, 2 * seed + 1, one, [](auto& r) { return 0.5 * gauss(r) + 0.5; }));
    refused += a.p < 0.01;
    EXPECT_GE(a.p, least_agreement) << seed;
  }
  EXPECT_LE(refused, 3) << "of 20 at a level of 1 %";
}

TEST(Agree, HeavyTailsAreNoDisagreement) {
  // 16 batches of 4096 pixels: the whole image sees 131, 33 and 13 events, most of the 64 blocks none or one or two.
  for (const double every : {500, 2000, 5000})
    for (uint64_t seed = 0; seed < 8; ++seed)
      EXPECT_GE(agree(batches(16, seed, one, gauss), batches(16, seed + 100, one, rare(every))).p, least_agreement)
          << every << " " << seed;
}

TEST(Agree, FindsALittleTooMuchEverywhere) {
  // Whole-image deviation: 0.3 / sqrt(16 * 4096) = 0.0012 each; 2 % is 12 deviations of the difference.
  const Agreement a = agree(batches(16, 1, one, gauss), batches(
                                                            16, 2, [](int, int) { return 1.02; }, gauss));
  EXPECT_LT(a.p, least_agreement);
  EXPECT_EQ(a.worst.width, 64);
  EXPECT_LT(a.worst.t, -6);
  EXPECT_NEAR(a.whole.first.mean, 1, 0.01);
  EXPECT_NEAR(a.whole.second.mean, 1.02, 0.01);
  EXPECT_NEAR(std::sqrt(a.whole.first.variance), 0.3 / 256, 0.3 / 256 * 0.5);
}

TEST(Agree, FindsABlockThatIsDark) {
  const auto shadow = [](int x, int y) { return x >= 48 && y < 16 ? 0.7 : 1.0; };
  const Agreement a = agree(batches(16, 1, one, gauss), batches(16, 2, shadow, gauss));
  EXPECT_LT(a.p, least_agreement);
  EXPECT_GE(a.worst.x, 48);
  EXPECT_LT(a.worst.y, 16);
  EXPECT_GT(a.worst.t, 0);
}

TEST(Agree, NoiselessImagesDifferOrNot) {
  const auto still = [](auto&) { return 1.0; };
  EXPECT_EQ(agree(batches(2, 1, one, still), batches(2, 2, one, still)).p, 1);
  EXPECT_EQ(agree(batches(2, 1, one, still), batches(
                                                 2, 2, [](int, int) { return 1.001; }, still))
                .p,
            0);
  EXPECT_EQ(agree(batches(2, 1, one, still, 3, 2), batches(2, 2, one, still, 3, 2)).p, 1) << "smaller than a block";
}

TEST(Combine, WeighsByInverseErrors) {
  // Relative variances of single batches 0.09 and 0.0225 over 1.01: weights 1 : 4; the mean of 16 batches each.
  const Combined c =
      combine(batches(16, 1, one, gauss), batches(16, 2, one, [](auto& r) { return 0.5 * gauss(r) + 0.5; }));
  EXPECT_NEAR(c.weight[0], 0.2, 0.01);
  EXPECT_NEAR(c.weight[1], 0.8, 0.01);
  EXPECT_NEAR(c.relmse[0], 0.09 / 16 / 1.01, 0.02 * 0.09 / 16);
  EXPECT_NEAR(c.relmse[1], 0.0225 / 16 / 1.01, 0.02 * 0.0225 / 16);
  EXPECT_NEAR(c.relmse_both, 0.018 / 16 / 1.01, 0.02 * 0.018 / 16);
  double error = 0;
  for (const float v : c.image.pixels) error += (double(v) - 1) * (double(v) - 1) / 1.01;
  EXPECT_NEAR(error / double(c.image.pixels.size()), c.relmse_both, 0.05 * c.relmse_both) << "what it says it has";
}

TEST(Combine, BatchesCountBySamples) {
  Batches a = batches(
              2, 1, one, [](auto&) { return 1.0; }, 1, 1),
          b = a;
  a[1].image.pixels = {4, 4, 4};
  a[0].spp = 3;  // 3 of 1, 1 of 4: mean 1.75, variance (3 * 0.75^2 + 2.25^2) / (4 * 1)
  b[1].image.pixels = {4, 4, 4};
  b[0].spp = 3;
  const Combined c = combine(a, b);
  EXPECT_FLOAT_EQ(c.image.pixels[0], 1.75f);
  EXPECT_NEAR(c.relmse[0], (3 * 0.5625 + 5.0625) / 4 / (1.75 * 1.75 + 0.01), 1e-9);
}

}  // namespace
}  // namespace ajar
