// Where subpaths leave the scene, fields learn what is there: infinite lights, or nothing.
#include <gtest/gtest.h>

#include <numbers>

#include "ajar/scene/build.h"
#include "ajar/scene/light.h"
#include "measure.h"

namespace ajar {
namespace {

struct Sums {
  double total = 0, direct = 0, near = 0, visits = 0;
};

// Of a field's cells whose normals point up.
Sums upwards(const Fields& fields, const Field& field) {
  Sums s;
  for (size_t i = 0; i < field.cells.size(); ++i) {
    const FieldCell& c = field.cells[i];
    if (fields.cells[i].frame.n.y < 0.99f) continue;
    const double visits = double(c.visits);
    s.total += visits * double(c.total), s.direct += visits * double(c.direct), s.near += visits * double(c.near);
    s.visits += visits;
  }
  return s;
}

// What next-event estimation leaves to rays that hit the sky is most of the light here.
TEST(Escapes, TeachTheSky) {
  const Scene scene = under_sky(LightKind::constant);
  const Fields fields = learned(scene);
  const Sums q = upwards(fields, fields.q);
  const double sky = pi * double(luminance(environment(scene, 0, {0, 1, 0})));
  EXPECT_GT(q.total / q.visits, 0.8 * sky);  // a ball stands on the floor
  EXPECT_LT(q.total / q.visits, 1.05 * sky);
  EXPECT_LT(q.direct / q.visits, 0.6 * sky);
}

TEST(Escapes, TeachThatNoImportanceComesFromThere) {
  const Scene scene = under_sky(LightKind::constant);
  const Fields fields = learned(scene);
  float up = 0, level = 0;  // the ball is beside most of the floor, and nothing above it
  int cells = 0;
  for (size_t i = 0; i < fields.cells.size(); ++i) {
    const Cell& cell = fields.cells[i];
    if (cell.frame.n.y < 0.99f || !(fields.w.cells[i].mix > 0.3f)) continue;
    const Vec3 p = cell.center, to_ball = glm::normalize(Vec3(0) - p);
    if (glm::length(Vec2(p.x, p.z)) < 1.2f) continue;
    ++cells;
    up += pdf(fields, fields.w, uint32_t(i), p, {0, 1, 0});
    level += pdf(fields, fields.w, uint32_t(i), p, to_ball);
  }
  ASSERT_GT(cells, 0);
  EXPECT_GT(level, 5 * up);
}

// Behind a pane the sky is as far away as without.
TEST(Escapes, GoStraightThroughPanes) {
  Scene scene = under_sky(LightKind::constant);
  Material pane;
  pane.kind = MaterialKind::thindielectric;
  const float radius = 2 * scene.radius;
  add_sphere(scene, scene.center, radius, add_material(scene, pane));
  finish(scene);
  const Fields fields = learned(scene);
  const Sums q = upwards(fields, fields.q);
  ASSERT_GT(q.total, 0);
  EXPECT_LT(q.near / q.visits, 0.6 / double(radius));  // the pane mirrors, too, and the ball is near
}

// What hits and next-event estimation bring adds up: a closed box that shines knows its irradiance.
TEST(Escapes, LampsAreLearnedOnce) {
  Material wall;
  wall.reflectance.value = Rgb(0.5f);
  const Scene scene = furnace(Oven::box, wall, Rgb(1), 40);
  const Accel accel(scene);
  RenderOptions o = statistical("guided-path");
  o.spp = 128;
  const Fields fields = rendered(scene, accel, o).learning.fields;
  double sum = 0, visits = 0;
  for (const FieldCell& c : fields.q.cells) sum += double(c.visits * c.total), visits += double(c.visits);
  EXPECT_NEAR(sum / visits / (2 * std::numbers::pi), 1, 0.15);
}

}  // namespace
}  // namespace ajar
