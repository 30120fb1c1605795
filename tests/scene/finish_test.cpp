// What finish derives: bounds, the choice of light, and refusals.
#include <gtest/gtest.h>

#include "ajar/core/error.h"
#include "ajar/scene/build.h"
#include "ajar/scene/motion.h"
#include "lights.h"

namespace ajar {
namespace {

using kit::placed;

TEST(Finish, EmptySceneIsFinite) {
  Scene scene;
  finish(scene);
  EXPECT_TRUE(is_finite(scene.center));
  EXPECT_EQ(scene.radius, 1);
  EXPECT_TRUE(scene.light_tree.nodes.empty());
}

TEST(Finish, BoundsHoldEverything) {
  Scene scene;
  kit::add_mesh(scene, kit::rectangle(placed(1, {2, 1, 1}, {5, 0, 0})));
  kit::add_shape(scene, ShapeKind::sphere, placed(2, Vec3(1.5f), {-4, 1, 0}));
  kit::add_shape(scene, ShapeKind::disk, placed(0.5f, {1, 3, 1}, {0, 6, 1}));
  kit::add_shape(scene, ShapeKind::cylinder, placed(2, {1, 0.5f, 4}, {0, -3, 2}));
  const Mesh solid = kit::icosphere_like();
  const uint32_t in_group = kit::add_mesh(scene, solid);
  scene.shapes[in_group].group = 0;
  scene.groups = 1;
  const Mat4 m = placed(1, {-1, 2, 1}, {3, 4, -7});
  add_instance(scene, 0, m);
  finish(scene);
  const auto inside = [&](const glm::dvec3& p) { return glm::distance(Vec3(p), scene.center) <= scene.radius; };
  for (uint32_t id = 1; id <= 3; ++id)
    for (uint32_t i = 0; i < 500; ++i) {
      const Vec2 uv = kit::random2(i, id);
      EXPECT_TRUE(inside(kit::map(scene.shapes[id].to_world, kit::unit_object(scene.shapes[id].kind, uv.x, uv.y).p)));
    }
  for (const Vec3& p : scene.meshes[0].positions) EXPECT_TRUE(inside(p));
  for (const Vec3& p : solid.positions) EXPECT_TRUE(inside(kit::map(m, p)));
  EXPECT_LT(scene.radius, 15);
}

TEST(Finish, BoundsAreTightForOneSphere) {
  Scene scene;
  kit::add_shape(scene, ShapeKind::disk, placed(0.3f, Vec3(2), {1e3f, 0, 0}));
  finish(scene);
  EXPECT_LT(scene.radius, 2.9f);
  EXPECT_NEAR(scene.center.x, 1e3f, 1e-3f);
}

TEST(Finish, LightsAreChosenByPowerTimesWeight) {
  Scene scene;
  const uint32_t a = kit::add_mesh(scene, kit::rectangle(placed(0, Vec3(1), {0, 0, 0})));
  const uint32_t b = kit::add_mesh(scene, kit::rectangle(placed(0, Vec3(2), {0, 0, 5})));
  Mesh flat = kit::rectangle(glm::scale(Mat4(1), Vec3(1, 0, 1)));
  const uint32_t c = kit::add_mesh(scene, flat), d = kit::add_mesh(scene, kit::rectangle(Mat4(1)));
  kit::light_up(scene, a, Rgb(6));
  kit::light_up(scene, b, Rgb(1));
  kit::light_up(scene, c, Rgb(1e9f));
  kit::light_up(scene, d, Rgb(0));
  scene.lights[1].sampling_weight = 3;
  finish(scene);
  const LightTree& t = scene.light_tree;
  ASSERT_EQ(t.pieces.size(), 2u);
  const uint32_t first = place_of(t, 0, none), second = place_of(t, 1, none);
  EXPECT_NEAR(power_of(t, second, second + 1) / power_of(t, first, first + 1), 2, 1e-5);
  EXPECT_EQ(place_of(t, 2, 0), none);  // no area
  EXPECT_EQ(place_of(t, 3, 0), none);  // black
}

TEST(Finish, DarkLightsAreNotChosen) {
  Scene scene;
  for (int i = 0; i < 2; ++i) kit::light_up(scene, kit::add_mesh(scene, kit::rectangle(Mat4(1))), Rgb(0));
  finish(scene);
  EXPECT_TRUE(scene.light_tree.nodes.empty());
}

// A dim light among bright ones keeps its chance.
TEST(Finish, DimLightsAreNotForgotten) {
  Scene scene;
  for (const float l : {1e8f, 1e-6f, 1e12f})
    kit::light_up(scene, kit::add_mesh(scene, kit::rectangle(Mat4(1))), Rgb(l));
  finish(scene);
  const uint32_t place = place_of(scene.light_tree, 1, none);
  ASSERT_NE(place, none);
  EXPECT_GT(power_of(scene.light_tree, place, place + 1), 0);
}

TEST(Finish, RefusesNonsense) {
  Scene scene;
  Light light;
  light.kind = LightKind::spot;
  light.to_world = glm::scale(Mat4(1), Vec3(1, 0, 1));
  kit::add_light(scene, light);
  EXPECT_THROW(finish(scene), Error);
  Scene far;
  kit::add_mesh(far, kit::rectangle(placed(0, Vec3(1e30f), {0, 0, 0})));
  EXPECT_THROW(finish(far), Error);
  Scene sky;
  sky.images.push_back(kit::float_image(4, 2, [](int x, int y) { return x == 2 && y == 1 ? -1.0f : 1.0f; }));
  try {
    make_environment(sky, 0, 1);
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("made: pixel (2, 1)"), std::string::npos) << e.what();
  }
}

// Motion is found where something was and where it is.
TEST(Motion, IsWhereShapesWereAndAre) {
  const auto scene_with = [](float x, float radius, float y) {
    Scene scene;
    kit::add_mesh(scene, kit::rectangle(placed(1, {2, 1, 1}, {x, 0, 0})));
    kit::add_shape(scene, ShapeKind::sphere, placed(radius, Vec3(1), {-4, 1, 0}));
    const uint32_t in_group = kit::add_mesh(scene, kit::icosphere_like());
    scene.shapes[in_group].group = 0;
    scene.groups = 1;
    const Mat4 m = placed(1, Vec3(1), {0, y, 0});
    add_instance(scene, 0, m);
    finish(scene);
    return scene;
  };
  const Scene rest = scene_with(0, 1, 9);
  EXPECT_TRUE(find_motion(rest, scene_with(0, 1, 9)).empty());
  const auto slid = find_motion(rest, scene_with(3, 1, 9));
  ASSERT_EQ(slid.size(), 1u);
  EXPECT_LT(slid[0].lo.x, -1.5f);
  EXPECT_GT(slid[0].hi.x, 4.5f);
  EXPECT_LT(slid[0].hi.y, 2);
  EXPECT_EQ(find_motion(rest, scene_with(0, 2, 9)).size(), 1u);
  const auto lifted = find_motion(rest, scene_with(0, 1, 12));
  ASSERT_EQ(lifted.size(), 1u);
  EXPECT_TRUE(lifted[0].lo.y < 9 && lifted[0].hi.y > 12 && lifted[0].lo.y > 5);
  Scene more = rest;
  more.shapes.push_back(more.shapes[0]);
  ASSERT_EQ(find_motion(rest, more).size(), 1u);
  EXPECT_TRUE(overlap(find_motion(rest, more)[0], {Vec3(1e6f), Vec3(1e6f)}));
}

}  // namespace
}  // namespace ajar
