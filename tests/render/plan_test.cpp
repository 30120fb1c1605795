// The plan: what it leaves out, and that it does not depend on the clock.
#include "ajar/render/plan.h"

#include <gtest/gtest.h>

#include "ajar/core/error.h"
#include "ajar/scene/build.h"
#include "ajar/scene/load.h"
#include "kit/files.h"
#include "kit/stage.h"

namespace ajar {
namespace {

RenderOptions budget(double cpu_seconds, uint64_t seed = 1, int threads = 2) {
  RenderOptions options;
  options.cpu_seconds = cpu_seconds, options.seed = seed, options.threads = threads;
  return options;
}

Plan piloted(Scene scene, const RenderOptions& options, const Monitor& monitor = {}) {
  const Accel accel(scene);
  Plan plan = make_plan(scene, options);
  const int width = scene.camera.width, crop = scene.camera.crop_width;
  run_pilot(scene, accel, options, monitor, plan);
  EXPECT_EQ(scene.camera.width, width);
  EXPECT_EQ(scene.camera.crop_width, crop);
  return plan;
}

bool is_on(const Plan& plan, const std::string& part) {
  for (const Part& p : plan.parts)
    if (p.name == part) return p.on;
  throw Error("no part " + part);
}

TEST(Plan, WhatThrowsInThePilotLeavesTheCameraAsItWas) {
  Scene scene = load_scene(kit::source_path("scenes/box/box.xml"), {});
  const Accel accel(scene);
  RenderOptions options;
  options.cpu_seconds = 60;
  Plan plan = make_plan(scene, options);
  const int width = scene.camera.width;
  const auto run = [&] {
    run_pilot(
        scene, accel, options, [](const RenderState&) -> bool { throw Error("no more"); }, plan);
  };
  EXPECT_THROW(run(), Error);
  EXPECT_EQ(scene.camera.width, width);
}

TEST(Plan, LeavesOutWhatAnEasySceneDoesNotNeed) {
  Scene scene = kit::stage(128);
  finish(scene);
  const Plan plan = piloted(scene, budget(30));
  EXPECT_EQ(plan.integrator, "guided-bdpt");
  ASSERT_TRUE(plan.pilot);
  EXPECT_TRUE(plan.pilot->plain);
  EXPECT_FALSE(is_on(plan, "light-subpaths"));
  EXPECT_FALSE(is_on(plan, "camera-guiding"));
  EXPECT_FALSE(is_on(plan, "light-guiding"));
  EXPECT_FALSE(is_on(plan, "environment"));
  EXPECT_TRUE(is_on(plan, "next-event"));
  EXPECT_GT(plan.pilot->saved_seconds(), 0);
}

TEST(Plan, KeepsGuidingBehindADoor) {
  for (const uint64_t seed : {1, 2}) {
    const Plan plan = piloted(two_rooms(20, 144), budget(30, seed));
    ASSERT_TRUE(plan.pilot);
    EXPECT_FALSE(plan.pilot->plain);
    EXPECT_TRUE(plan.pilot->settled);
    EXPECT_TRUE(is_on(plan, "light-guiding"));
    EXPECT_GT(plan.pilot->ratio, 2);
    EXPECT_NEAR(plan.pilot->saved_seconds(), 30 * (std::min(plan.pilot->ratio, 10.0) - 1), 1e-6);
  }
}

TEST(Plan, TrustsNoRatioBeyondTen) {
  Pilot p;
  p.budget = 1;
  for (const double ratio : {0.05, 0.2, 5.0, 20.0}) {
    p.ratio = ratio;
    const bool beyond = ratio < 0.1 || ratio > 10;
    EXPECT_EQ(p.saves_more(), beyond) << ratio;
    EXPECT_NEAR(p.saved_seconds(), beyond ? 9 : 4, 1e-9) << ratio;
  }
}

TEST(Plan, IsTheSameForTheSameSeedWhateverTheThreads) {
  const Plan a = piloted(two_rooms(20, 72), budget(20, 3, 1)), b = piloted(two_rooms(20, 72), budget(20, 3, 2));
  ASSERT_TRUE(a.pilot && b.pilot);
  EXPECT_EQ(a.pilot->ratio, b.pilot->ratio);
  EXPECT_EQ(a.pilot->guided, b.pilot->guided);
  EXPECT_EQ(a.pilot->path_for_one, b.pilot->path_for_one);
  EXPECT_NE(a.pilot->ratio, piloted(two_rooms(20, 72), budget(20, 4)).pilot->ratio);
}

// By a power of two: other factors round otherwise, fields divide otherwise, and a small pilot is noisy.
TEST(Plan, DoesNotDependOnExposure) {
  Scene dark = two_rooms(20, 72);
  for (Light& light : dark.lights) light.radiance.value *= 0x1p-20f;
  finish(dark);
  const Plan a = piloted(two_rooms(20, 72), budget(20)), b = piloted(dark, budget(20));
  EXPECT_NEAR(b.pilot->ratio / a.pilot->ratio, 1, 1e-4);
  EXPECT_NEAR(b.pilot->path / a.pilot->path, 1, 1e-4);
}

// A point of light in glass: a path that starts at the camera cannot hit it, nor a shadow ray pass the glass.
TEST(Plan, DoesNotTakeWhatSeesNothing) {
  Scene scene = glass_ball();
  scene.lights.clear();
  for (Shape& s : scene.shapes) s.light = none;
  scene.lights[add_light(scene, LightKind::point, Slot(Rgb(5)))].position = {0, -0.4f, 0};
  finish(scene);
  const Plan plan = piloted(scene, budget(20));
  ASSERT_TRUE(plan.pilot);
  EXPECT_FALSE(plan.pilot->plain);
}

TEST(Plan, WithoutLightsOrTimeThereIsNoPilot) {
  Scene unlit = cornell(32);
  for (Shape& s : unlit.shapes) s.light = none;
  unlit.lights.clear();
  finish(unlit);
  const Plan dark = piloted(unlit, budget(60));
  EXPECT_EQ(dark.integrator, "path");
  EXPECT_FALSE(dark.pilot);
  EXPECT_FALSE(is_on(dark, "next-event"));
  EXPECT_FALSE(is_on(dark, "light-subpaths"));
  const Plan hasty = piloted(cornell(256), budget(0.5));
  EXPECT_EQ(hasty.integrator, "bdpt");
  EXPECT_FALSE(hasty.pilot);
  EXPECT_TRUE(is_on(hasty, "light-subpaths"));
  EXPECT_FALSE(is_on(hasty, "light-guiding"));
}

TEST(Plan, TheBudgetDecidesWhetherThereIsTimeToLearn) {
  const Scene scene = cornell(64);
  const double least = least_budget(scene.camera);
  EXPECT_EQ(make_plan(scene, budget(0.99 * least)).integrator, "bdpt");
  EXPECT_EQ(make_plan(scene, budget(1.01 * least)).integrator, "guided-bdpt");
  RenderOptions wall;
  wall.seconds = 0.51 * least, wall.threads = 2;
  EXPECT_EQ(make_plan(scene, wall).integrator, "guided-bdpt");
  wall.threads = 1;
  EXPECT_EQ(make_plan(scene, wall).integrator, "bdpt");
  RenderOptions few;
  few.spp = 2;
  EXPECT_EQ(make_plan(scene, few).integrator, "bdpt");
  RenderOptions noise;
  noise.spp = 0, noise.noise = 0.01;
  EXPECT_EQ(make_plan(scene, noise).integrator, "guided-bdpt");
}

// A crop window is all that is rendered, and all that the pilot looks at.
TEST(Plan, IsOfTheCropWindow) {
  Scene scene = cornell(512);
  const double least = least_budget(scene.camera);
  Camera& c = scene.camera;
  c.crop_x = 320, c.crop_y = 256, c.crop_width = c.crop_height = 128;
  EXPECT_NEAR(least_budget(c) / least, 1. / 16, 1e-9);
  EXPECT_EQ(make_plan(scene, budget(least / 15)).integrator, "guided-bdpt");
  const Plan plan = piloted(scene, budget(10));
  ASSERT_TRUE(plan.pilot);
  EXPECT_LT(plan.pilot->width, 100);
  EXPECT_EQ(plan.pilot->width, plan.pilot->height);
  EXPECT_GT(plan.pilot->passes, 0u);
  set_camera(scene, {0, 0, 3}, {0, 0, -1}, 150, 512, 512);  // the room is the middle of the image
  c.crop_x = c.crop_y = 0, c.crop_width = c.crop_height = 64;
  const Plan beside = piloted(scene, budget(10));
  ASSERT_TRUE(beside.pilot);
  EXPECT_EQ(beside.pilot->passes, 0u) << "it looked at the room";
}

// Where nothing came from no comparison can be made: that is said, not made up.
TEST(Plan, BlackIsNoMeasurement) {
  Scene scene = two_rooms(20, 24);
  RenderOptions options = budget(60);
  options.max_depth = 1;
  const Plan lights = piloted(scene, options);
  EXPECT_EQ(lights.integrator, "path");
  EXPECT_FALSE(lights.pilot);
  EXPECT_EQ(lights.parts[0].why, "paths of one edge see lights alone");
  for (Light& light : scene.lights) light.radiance = {};
  options.max_depth = 2;
  const Plan black = piloted(scene, options);
  ASSERT_TRUE(black.pilot);
  EXPECT_EQ(black.pilot->passes, 0u);
  EXPECT_EQ(black.pilot->saved_seconds(), 0);
  EXPECT_EQ(black.parts[0].why, "the pilot saw nothing to compare");
}

TEST(Plan, StopsWhenAsked) {
  int asked = 0;
  const Plan plan = piloted(cornell(128), budget(600), [&](const RenderState&) { return ++asked < 3; });
  EXPECT_FALSE(plan.pilot);
  EXPECT_EQ(asked, 3);
}

TEST(Plan, PartsChooseTheIntegrator) {
  const auto of = [](std::vector<std::string> parts) {
    RenderOptions o;
    apply_parts(parts, o);
    return o;
  };
  EXPECT_EQ(of({"none"}).integrator, "path");
  EXPECT_EQ(of({"light-subpaths"}).integrator, "bdpt");
  EXPECT_EQ(of({"camera-guiding"}).integrator, "guided-path");
  EXPECT_EQ(of({"light-subpaths", "camera-guiding"}).learn.guided, Guided::camera);
  EXPECT_EQ(of({"light-subpaths", "light-guiding"}).learn.guided, Guided::light);
  EXPECT_EQ(of({"light-subpaths", "light-guiding", "camera-guiding"}).integrator, "guided-bdpt");
  EXPECT_THROW(of({"light-guiding"}), Error);
  EXPECT_THROW(of({"magic"}), Error);
}

}  // namespace
}  // namespace ajar
