// Russian roulette between surfaces of one albedo: what paths weigh, and whether they end.
#include <gtest/gtest.h>

#include <cmath>

#include "ajar/path/walk.h"
#include "ajar/scene/build.h"

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
    const double q = survival_probability(options, guide, n, arrives, leaves, promised);
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

// A vertex of a wall whose cell's fields expect so much.
Guide guide_by(Fields& fields, float total) {
  const Scene scene = cornell(8);
  const Accel accel(scene);
  Hit hit;
  EXPECT_TRUE(accel.intersect({0, 0, 3}, {0, 0, -1}, 0, infinity, hit));
  for (Field* f : {&fields.q, &fields.w}) f->cells.push_back({0, 0, total, 0.8f, 1});
  Guide guide;
  make_guide(scene, nullptr, Side::camera, make_surface(scene, hit, {0, 0, 3}, {0, 0, -1}), {0, 0, 1}, guide);
  guide.fields = &fields, guide.cell = 0;
  return guide;
}

// Fields that expect a millionth of what was promised, wherever the path comes: it lives on with few others, but does
// not weigh more than the window allows.
TEST(Roulette, FieldsThatLieDoNotMakeFireflies) {
  Fields fields;
  const Guide guide = guide_by(fields, 1e-6f);
  WalkOptions options;
  options.fields = &fields;
  float weight = 1, chance = 1, promised = 1;
  for (int n = 2; n < 12; ++n) {
    const float q = survival_probability(options, guide, n, Rgb(weight), Rgb(weight), promised);
    weight /= q, chance *= q;
    EXPECT_LE(weight, options.window * 1.001f) << n;
  }
  EXPECT_NEAR(weight * chance, 1, 1e-5);
  EXPECT_LT(chance, 0.21);
}

// Of camera subpaths alone: light subpaths keep theirs.
TEST(Roulette, MoreGoOnWhereThatPays) {
  Fields fields;
  Guide guide = guide_by(fields, 1);
  WalkOptions options;
  options.fields = &fields;
  float promised = 16 * promise(guide, Rgb(1)).beyond;
  const float q = survival_probability(options, guide, 2, Rgb(1), Rgb(1), promised);
  EXPECT_NEAR(q, options.window / 16, 1e-5);
  options.goes_on = 2;
  EXPECT_NEAR(survival_probability(options, guide, 2, Rgb(1), Rgb(1), promised), 2 * q, 1e-5);
  guide.side = Side::light;
  EXPECT_NEAR(survival_probability(options, guide, 2, Rgb(1), Rgb(1), promised), q, 1e-5);
}

}  // namespace
}  // namespace ajar
