// Directions of a cell's points as its centre has them: both ways, their density, and how far away things are learned
// to be.
#include <gtest/gtest.h>

#include "ajar/core/sampler.h"
#include "ajar/core/warp.h"
#include "ajar/field/learn.h"

namespace ajar {
namespace {

const Vec3 upwards(0, 1, 0);

struct Nearness : testing::Test {
  Fields fields;
  float edge = 0;

  void SetUp() override {
    fields.table = make_cell_table(Vec3(0), 9);
    Sightings seen;
    for (int i = 0; i < 4; ++i) record_missing(seen, find(fields.table, Vec3(0), upwards).missing, upwards);
    fields = learn(fields, start_training(fields), seen, 1, {});
    ASSERT_EQ(fields.cells.size(), 1u);
    edge = fields.table.width;
  }
  const Cell& cell() const { return fields.cells[0]; }
  Vec3 centred(const Vec3& p, const Vec3& w, float& density) const {
    return centered(fields, fields.q, 0, p, cell().frame.to_local(w), density);
  }
  // What paths record of a small bright ball, the only light, seen from all over the cell's tangent plane: half of them
  // are guided by what was learned before.
  void learn_from(const Vec3& light, int lessons) {
    constexpr float radius = 0.05f;
    for (int l = 0; l < lessons; ++l) {
      Training training = start_training(fields);
      Sampler sampler = make_sampler(SamplerKind::independent, 1, Side::camera, 0, uint32_t(l));
      for (int i = 0; i < 4000; ++i) {
        const Vec2 u = sampler.next2() - 0.5f, v = sampler.next2();
        const Vec3 p = cell().center + edge * (u.x * cell().frame.s + u.y * cell().frame.t), to = light - p;
        float guided = 0;
        const Vec3 w =
            i % 2 ? sample(fields, fields.q, 0, p, v, guided) : cell().frame.to_world(to_cosine_hemisphere(v));
        guided = pdf(fields, fields.q, 0, p, w);
        const float cosine = glm::dot(w, cell().frame.n) * inv_pi, off = glm::length(glm::cross(w, to));
        const bool hit = off < radius && glm::dot(w, to) > 0;
        record(fields, fields.q, training.q, 0,
               {p, w, hit ? glm::length(to) : 1, hit ? 5.0f : 0.0f, cosine / (0.5f * (guided + cosine))});
      }
      fields = learn(fields, training, {}, 1, {});
    }
  }
};

TEST_F(Nearness, OfNothingChangesNothing) {
  float density = 0;
  const Vec3 w = glm::normalize(Vec3(0.3f, 0.5f, -0.2f));
  EXPECT_EQ(centred(cell().center + Vec3(0.2f, 0, 0.1f), w, density), cell().frame.to_local(w));
  EXPECT_EQ(density, 1);
}

TEST_F(Nearness, APointAtThatDistanceIsInTheSameDirectionFromEverywhere) {
  const Vec3 light = cell().center + 2.5f * glm::normalize(Vec3(1, 2, 0.5f));
  fields.q.cells[0].near = 1 / 2.5f;
  for (const Vec2& u : {Vec2(0.4f, 0.4f), Vec2(-0.5f, 0.1f), Vec2(0)}) {
    const Vec3 p = cell().center + edge * (u.x * cell().frame.s + u.y * cell().frame.t);
    float density = 0;
    const Vec3 from_center = cell().frame.to_local(glm::normalize(light - cell().center));
    EXPECT_LT(glm::length(centred(p, glm::normalize(light - p), density) - from_center), 1e-5f);
  }
}

TEST_F(Nearness, DensitiesIntegrateToOne) {
  learn_from(cell().center + Vec3(0.8f, 1.2f, 0.3f), 6);
  ASSERT_GT(fields.q.cells[0].near, 0.3f);
  for (const float side : {0.0f, 0.45f, 3.0f}) {  // the last far outside: of a surface that bends away
    const Vec3 p = cell().center + edge * side * cell().frame.s;
    double sum = 0;
    constexpr int n = 1000;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const float z = (float(i) + 0.5f) / n, phi = 2 * pi * (float(j) + 0.5f) / n, r = safe_sqrt(1 - z * z);
        sum += pdf(fields, fields.q, 0, p, cell().frame.to_world({r * std::cos(phi), r * std::sin(phi), z}));
      }
    EXPECT_NEAR(sum * 2 * double(pi) / n / n, 1, 0.02) << side;
  }
}

TEST_F(Nearness, SamplesKnowTheirDensity) {
  learn_from(cell().center + Vec3(-0.5f, 1, 0.9f), 6);
  const Vec3 p = cell().center + edge * (0.4f * cell().frame.s - 0.3f * cell().frame.t);
  Sampler sampler = make_sampler(SamplerKind::independent, 4, Side::camera, 0, 0);
  for (int i = 0; i < 2000; ++i) {
    float density = 0;
    const Vec3 w = sample(fields, fields.q, 0, p, sampler.next2(), density);
    EXPECT_NEAR(glm::length(w), 1, 1e-5f);
    // At the border of two strata rounding may decide for the other one.
    const float again = pdf(fields, fields.q, 0, p, w);
    if (std::abs(again / density - 1) > 1e-3f) {
      const Vec3 beside = glm::normalize(w + 1e-4f * (w - cell().frame.n));
      EXPECT_GT(std::abs(pdf(fields, fields.q, 0, p, beside) / again - 1), 1e-4f) << i;
    }
  }
}

TEST_F(Nearness, IsLearnedFromWhereTheLightComesFrom) {
  const float distance = 2;
  learn_from(cell().center + distance * upwards, 6);
  EXPECT_NEAR(fields.q.cells[0].near, 1 / distance, 0.1f / distance);
  EXPECT_EQ(fields.w.cells[0].near, 0) << "nothing was recorded of it";
  learn_from(cell().center + 0.01f * upwards, 6);
  EXPECT_LE(fields.q.cells[0].near, 1 / edge) << "the cell must lie within the sphere";
}

// A record on the cell's own edge says no more than that its light is as near as a cell can tell.
TEST_F(Nearness, OneRecordThatIsAllButHereDoesNotDecide) {
  Training training = start_training(fields);
  const float distance = 4 * edge;
  for (int i = 0; i < 99; ++i) record(fields, fields.q, training.q, 0, {cell().center, upwards, distance, 5.0f, 1.0f});
  record(fields, fields.q, training.q, 0, {cell().center, upwards, 1e-6f * edge, 5.0f, 1.0f});
  fields = learn(fields, training, {}, 1, {});
  EXPECT_NEAR(fields.q.cells[0].near, (99 / distance + 1 / edge) / 100, 1e-3f / edge);
}

// What it is good for: more of what is sampled goes to a small light that is seen from all over a cell.
TEST_F(Nearness, MakesSmallLightsSharp) {
  const Vec3 light = cell().center + 2.0f * upwards;
  learn_from(light, 10);
  Fields flat = fields;
  flat.q.cells[0].near = 0;
  double with = 0, without = 0;
  for (const float side : {-0.4f, -0.2f, 0.2f, 0.4f}) {
    const Vec3 p = cell().center + edge * side * cell().frame.s, w = glm::normalize(light - p);
    with += pdf(fields, fields.q, 0, p, w), without += pdf(flat, flat.q, 0, p, w);
  }
  EXPECT_GT(with, 4 * without) << without;
}

}  // namespace
}  // namespace ajar
