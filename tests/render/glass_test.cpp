// Fields learn of what glass alone connects: joins cannot pass it, so that the paths themselves have to tell.
#include <gtest/gtest.h>

#include "ajar/field/emission.h"
#include "kit/stage.h"
#include "measure.h"

namespace ajar {
namespace {

using namespace kit;

uint32_t add_pane_material(Scene& scene) {
  Material m;
  m.kind = MaterialKind::thindielectric;
  return add_material(scene, m);
}

// What a field's vertices receive at once, in the mean over its visits.
double direct(const Field& field) {
  double sum = 0, visits = 0;
  for (const FieldCell& c : field.cells) sum += double(c.direct) * double(c.visits), visits += double(c.visits);
  return sum / visits;
}

double total(const Field& field) {
  double sum = 0;
  for (const FieldCell& c : field.cells) sum += double(c.total);
  return sum;
}

TEST(BehindGlass, TheLensGivesImportanceToWhatItSees) {
  Scene bare = stage(24), glazed = stage(24);
  add_quad(glazed, {-3, -3, 2}, {6, 0, 0}, {0, 6, 0}, add_pane_material(glazed));
  finish(bare), finish(glazed);
  const double without = direct(learned(bare).w), with = direct(learned(glazed).w);
  EXPECT_GT(with, 0.1 * without);  // where light subpaths come, they find that the lens is hidden
  EXPECT_LT(with, 1.1 * without);
}

// Through a dome of glass the sky lights what is under it, and light subpaths start where they come through.
TEST(BehindGlass, TheSkyShines) {
  Scene scene = under_sky(LightKind::constant);
  add_sphere(scene, scene.center, 4 * scene.radius, add_pane_material(scene));
  finish(scene);
  const Fields fields = learned(scene);
  EXPECT_GT(total(fields.q), 0);
  EXPECT_TRUE(std::any_of(fields.disk.mean.begin(), fields.disk.mean.end(), [](float m) { return m > 0; }));
}

// Share of light subpaths that start where they come through the hole, or would but for the pane in it.
double share_through_the_hole(const Scene& scene, const Fields& fields) {
  constexpr int starts = 20'000;
  int through = 0;
  for (int i = 0; i < starts; ++i) {
    Sampler sampler = make_sampler(SamplerKind::independent, 5, Side::light, uint64_t(i), 0);
    const float choice = sampler.next1();
    const Vec2 position = sampler.next2(), direction = sampler.next2();
    EmissionSample start;
    if (!sample_emission(scene, &fields, choice, position, direction, start) || start.direction.y >= 0) continue;
    const Vec3 at = start.point.p + start.direction * ((2 - start.point.p.y) / start.direction.y);
    through += std::abs(at.x) < 0.4f && std::abs(at.z) < 0.4f;
  }
  return double(through) / starts;
}

// Camera subpaths come to the sky through a hole that light subpaths hardly find, and tell them: by next-event
// estimation, or straight through a pane.
TEST(BehindGlass, CameraSubpathsTeachWhereTheSkyComesIn) {
  for (const bool glazed : {false, true}) {
    Scene scene = under_a_lid(LightKind::constant, 30, 64);
    if (glazed) add_quad(scene, {-0.4f, 2, 0.4f}, {0.8f, 0, 0}, {0, 0, -0.8f}, add_pane_material(scene));
    finish(scene);
    EXPECT_GT(share_through_the_hole(scene, learned(scene)), 0.05) << glazed;
  }
}

// The stage with its lamp hung where no other surface shares its cell.
Scene hung() {
  Scene scene = stage(24);
  Mesh& lamp = scene.meshes[scene.shapes[scene.lights[0].shape].mesh];
  for (Vec3& p : lamp.positions) p.y = 0.2f;
  return scene;
}

// A lamp wholly in a ball of glass sends its light where importance lies beyond.
TEST(BehindGlass, LampsSendLightToWhatMatters) {
  const auto at_lamp = [](const Scene& scene) {
    const Fields fields = learned(scene);
    const Place at = find(fields.table, {0, 0.2f, 0}, {0, -1, 0});
    return at.cell == none ? 0 : fields.w.cells[at.cell].total;
  };
  Scene bare = hung(), covered = hung();
  add_sphere(covered, {0, 0.2f, 0}, 0.7f, add_pane_material(covered));
  finish(bare), finish(covered);
  const float without = at_lamp(bare), with = at_lamp(covered);
  EXPECT_GT(with, 0.5f * without);
  EXPECT_LT(with, 4 * without);
}

}  // namespace
}  // namespace ajar
