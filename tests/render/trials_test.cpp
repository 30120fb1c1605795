// What a pilot's images are taken to say: noise, its deviation, fireflies and what is missed.
#include "ajar/render/trials.h"

#include <gtest/gtest.h>

#include "ajar/core/sampler.h"

namespace ajar {
namespace {

constexpr int size = 48, passes = 12;

float uniform(uint64_t key) { return float(double(hash(key, 0) >> 11) * 0x1p-53); }

// Of mean 1 everywhere: a sample is 1 / chance, with that chance, else 0; numbers that another key makes others.
Sight flicker(float chance, uint64_t key, double scale = 1) {
  Sight s;
  s.width = s.height = size;
  s.sum.resize(size * size);
  for (int pass = 0; pass < passes; ++pass) {
    std::vector<float>& out = s.passes.emplace_back();
    for (size_t i = 0; i < size * size; ++i) {
      out.push_back(uniform((key * passes + uint64_t(pass)) * size * size + i) < chance ? float(scale) / chance : 0);
      s.sum[i] += double(out.back());
    }
  }
  return s;
}

void add(Sight& s, int pass, size_t i, float value) {
  s.passes[size_t(pass)][i] += value;
  s.sum[i] += double(value);
}

// Takes the share of the light of a corner of 16 x 16 away.
Sight dimmed(Sight s, double share) {
  for (size_t i = 0; i < size * size; ++i)
    if (i % size < 16 && i / size < 16) {
      for (std::vector<float>& pass : s.passes) pass[i] *= float(1 - share);
      s.sum[i] *= 1 - share;
    }
  return s;
}

TEST(Trials, ErrorIsTheVarianceOfASample) {
  const auto j = judge({flicker(0.5f, 1), flicker(0.8f, 2)});
  // Variance is 1 / chance - 1; what all saw of a pixel is itself noisy, and 0.01 counts at a mean of a fifth.
  EXPECT_NEAR(j[0].error, 1 / 1.25, 0.15);
  EXPECT_NEAR(j[1].error, 0.25 / 1.25, 0.05);
  EXPECT_LT(j[0].deviation, 0.05 * j[0].error);
  EXPECT_EQ(j[0].unseen, 0);
  EXPECT_EQ(j[1].unseen, 0);
}

TEST(Trials, ExposureDoesNotMatter) {
  const auto a = judge({flicker(0.5f, 1), flicker(0.8f, 2)}),
             b = judge({flicker(0.5f, 1, 0x1p-30), flicker(0.8f, 2, 0x1p-30)});
  for (size_t k = 0; k < 2; ++k) EXPECT_NEAR(a[k].error, b[k].error, 1e-6 * a[k].error);
}

TEST(Trials, AFireflyMoreOrLessDoesNotDecide) {
  Sight hit = flicker(0.5f, 1);
  for (const size_t i : {100u, 1000u}) add(hit, 3, i, 1e6f);
  const auto j = judge({hit, flicker(0.5f, 2)}), without = judge({flicker(0.5f, 1), flicker(0.5f, 2)});
  EXPECT_LT(j[0].error, 0.15 + 1.3 * j[1].error);
  EXPECT_LT(j[1].unseen, 0.05) << "that one saw a firefly does not tell that the other missed light";
  EXPECT_LT(without[0].unseen, 0.01);
}

TEST(Trials, LightThatIsMissedCounts) {
  const auto j = judge({dimmed(flicker(0.8f, 1), 0.3), flicker(0.8f, 2)});
  EXPECT_EQ(j[1].unseen, 0);
  // At most one of a block's 64 x 12 samples would have brought the rest: 0.3^2 x 768 in a ninth of the image.
  EXPECT_NEAR(j[0].unseen, 0.09 / 1.25 * 768 / 9, 3);
}

// Whether the light that comes in fireflies happened to come, the verdict is about the same.
TEST(Trials, FirefliesAreNotTakenForTheLightThatTheyStandFor) {
  Sight lucky = dimmed(flicker(0.8f, 1), 0.3);
  for (const size_t i : {5u, 12u * size + 3}) add(lucky, 5, i, float(0.3 * 64 * passes));
  const auto j = judge({lucky, flicker(0.8f, 2)});
  EXPECT_GT(j[0].unseen, 3);
  EXPECT_LT(j[1].unseen, 0.01);
}

TEST(Trials, BlackIsNotQuiet) {
  Sight black = flicker(0.5f, 1, 0);
  const auto alone = judge({black});
  EXPECT_EQ(alone[0].error, infinity);
  const auto both = judge({black, flicker(0.5f, 2)});
  EXPECT_EQ(both[0].error, infinity);
  EXPECT_LT(both[1].error, infinity);
  add(black, 3, 100, 1e3f);
  EXPECT_EQ(judge({black, flicker(0.5f, 2)})[0].error, infinity) << "nor with one firefly";
}

}  // namespace
}  // namespace ajar
