// Russian roulette between surfaces of one albedo: what paths weigh, and whether they end.
#include <gtest/gtest.h>

#include <cmath>

#include "ajar/path/walk.h"

namespace ajar {
namespace {

struct Life {
  double chance = 1;  // of a path to live so long
  double weight = 1;  // of those that do
};

Life after(int edges, float albedo) {
  const WalkOptions options;
  const Guide guide{};
  Life life;
  float promised = 0;
  for (int n = 2; n < edges + 2; ++n) {
    const Rgb arrives(float(life.weight)), leaves(float(life.weight) * albedo);
    const double q = keep(options, guide, n, arrives, leaves, promised);
    life.weight *= double(albedo) / q;
    life.chance *= q;
  }
  return life;
}

TEST(Roulette, MeansAreKept) {
  for (const float albedo : {0.3f, 0.9f, 0.99f}) {
    const Life life = after(50, albedo);
    EXPECT_NEAR(life.chance * life.weight / std::pow(double(albedo), 50), 1, 1e-5);
  }
}

// The second moment of what 20 / (1 - albedo) edges bring must be next to nothing: else the sum over all lengths has
// none.
TEST(Roulette, SecondMomentsVanish) {
  for (const float albedo : {0.5f, 0.97f, 0.98f, 0.99f, 0.999f}) {
    const Life life = after(int(20 / (1 - albedo)), albedo);
    EXPECT_LT(life.chance * life.weight * life.weight, 1e-3) << albedo;
  }
}

TEST(Roulette, WhatLosesNothingEndsAllTheSame) {
  double edges = 0;
  for (int n = 0; n < 512; ++n) edges += after(n, 1).chance;
  EXPECT_LT(edges, 100);
  EXPECT_LT(after(1000, 1).chance, 0.011);
}

}  // namespace
}  // namespace ajar
