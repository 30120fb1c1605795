// The plan: what it leaves out, and that it does not depend on the clock.
#include "ajar/render/plan.h"

#include <gtest/gtest.h>

#include "ajar/core/error.h"
#include "ajar/scene/build.h"

namespace ajar {
namespace {

Plan plan_for(Scene scene, double cpu_seconds, uint64_t seed = 1, int threads = 2) {
  const Accel accel(scene);
  RenderOptions options;
  options.cpu_seconds = cpu_seconds, options.seed = seed, options.threads = threads;
  const int width = scene.camera.width;
  Plan plan = make_plan(scene, accel, options, {});
  EXPECT_EQ(scene.camera.width, width);
  return plan;
}

const Trial& trial(const Plan& plan, const std::string& integrator) {
  for (const Trial& t : plan.trials)
    if (t.integrator == integrator) return t;
  throw Error("no trial of " + integrator);
}

bool is_on(const Plan& plan, const std::string& part) {
  for (const Part& p : plan.parts)
    if (p.name == part) return p.on;
  throw Error("no part " + part);
}

TEST(Plan, LeavesOutWhatAnEasySceneDoesNotNeed) {
  const Plan plan = plan_for(cornell(128), 30);
  ASSERT_EQ(plan.trials.size(), 4u);
  EXPECT_FALSE(is_on(plan, "camera-guiding"));
  EXPECT_FALSE(is_on(plan, "light-guiding"));
  EXPECT_FALSE(is_on(plan, "environment"));
  EXPECT_FALSE(is_on(plan, "light-choice"));
  EXPECT_TRUE(is_on(plan, "next-event"));
}

TEST(Plan, KeepsGuidingBehindADoor) {
  const Plan plan = plan_for(two_rooms(10, 144), 30);
  EXPECT_EQ(plan.integrator, "guided-bdpt");
  EXPECT_TRUE(is_on(plan, "light-guiding"));
  EXPECT_LT(2 * trial(plan, "guided-bdpt").price(), trial(plan, "path").price());
}

TEST(Plan, IsTheSameForTheSameSeedWhateverTheThreads) {
  const Plan a = plan_for(two_rooms(20, 72), 20, 3, 1), b = plan_for(two_rooms(20, 72), 20, 3, 2);
  ASSERT_EQ(a.trials.size(), 4u);
  ASSERT_EQ(b.trials.size(), 4u);
  for (size_t i = 0; i < a.trials.size(); ++i) {
    EXPECT_EQ(a.trials[i].error, b.trials[i].error);
    EXPECT_EQ(a.trials[i].cost, b.trials[i].cost);
    EXPECT_EQ(a.trials[i].unseen, b.trials[i].unseen);
  }
  EXPECT_NE(a.trials[0].error, plan_for(two_rooms(20, 72), 20, 4, 2).trials[0].error);
}

// By a power of two: other factors round otherwise, fields divide otherwise, and a pilot of a thousand pixels is noisy.
TEST(Plan, DoesNotDependOnExposure) {
  Scene dark = two_rooms(20, 72);
  for (Light& light : dark.lights) light.radiance.value *= 0x1p-20f;
  finish(dark);
  const Plan a = plan_for(two_rooms(20, 72), 20), b = plan_for(dark, 20);
  for (size_t i = 0; i < a.trials.size(); ++i) EXPECT_NEAR(b.trials[i].price() / a.trials[i].price(), 1, 1e-4);
}

// A point of light in glass: a path that starts at the camera cannot hit it, nor a shadow ray pass the glass.
TEST(Plan, DoesNotTakeWhatSeesNothing) {
  Scene scene = glass_ball();
  scene.lights.clear();
  for (Shape& s : scene.shapes) s.light = none;
  scene.lights[add_light(scene, LightKind::point, Slot(Rgb(5)))].position = {0, -0.4f, 0};
  finish(scene);
  const Plan plan = plan_for(scene, 20);
  EXPECT_NE(plan.integrator, "path");
  EXPECT_NE(plan.integrator, "guided-path");
}

TEST(Plan, WithoutLightsOrTimeThereIsNoPilot) {
  Scene unlit = cornell(32);
  for (Shape& s : unlit.shapes) s.light = none;
  unlit.lights.clear();
  finish(unlit);
  const Plan dark = plan_for(unlit, 60);
  EXPECT_EQ(dark.integrator, "path");
  EXPECT_TRUE(dark.trials.empty());
  EXPECT_FALSE(is_on(dark, "next-event"));
  const Plan hasty = plan_for(cornell(256), 0.5);
  EXPECT_EQ(hasty.integrator, "bdpt");
  EXPECT_TRUE(hasty.trials.empty());
}

// Where nothing but a target for the noise ends the render, the pilot is as small as the time to it allows: it grows
// with the target's demands and never takes the image for its size.
TEST(Plan, NoiseAloneMakesASmallPilot) {
  Scene scene = two_rooms(20, 288);
  const Accel accel(scene);
  RenderOptions options;
  options.spp = 0, options.noise = 0.1;
  const Plan loose = make_plan(scene, accel, options, {});
  ASSERT_EQ(loose.trials.size(), 4u);
  EXPECT_LT(loose.width * loose.height, scene.camera.width * scene.camera.height / 8);
  options.noise = 0.005;
  const Plan strict = make_plan(scene, accel, options, {});
  EXPECT_GT(strict.width, loose.width);
  EXPECT_LT(strict.width, scene.camera.width);
}

TEST(Plan, StopsWhenAsked) {
  Scene scene = cornell(128);
  const Accel accel(scene);
  RenderOptions options;
  options.cpu_seconds = 600;
  int asked = 0;
  const Plan plan = make_plan(scene, accel, options, [&](const RenderState&) { return ++asked < 3; });
  EXPECT_LT(plan.trials.size(), 4u);
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
