// The plan: what it leaves out, and that it does not depend on the clock.
#include "ajar/render/plan.h"

#include <gtest/gtest.h>

#include "ajar/core/error.h"
#include "ajar/scene/build.h"
#include "ajar/scene/load.h"
#include "kit/files.h"

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
  for (const uint64_t seed : {1, 2}) {
    const Plan plan = plan_for(two_rooms(20, 144), 30, seed);
    EXPECT_EQ(plan.integrator, "guided-bdpt");
    EXPECT_TRUE(is_on(plan, "light-guiding"));
    EXPECT_LT(1.1 * trial(plan, "guided-bdpt").price(), trial(plan, "path").price());
  }
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

// Lamps in sight before black walls: all that is noisy is how much of a lamp a pixel holds, which camera rays alone
// decide. The pilot gives all integrators the same ones, so that none can be lucky.
TEST(Plan, EdgesOfLampsInSightAreTheSameNoiseToAll) {
  Scene scene = cornell(64);
  for (Material& m : scene.materials) m.reflectance = Rgb(0);
  add_area_light(scene, add_sphere(scene, {0.2f, 0, 0}, 0.1f, scene.shapes[0].material), Rgb(1000));
  finish(scene);
  for (const uint64_t seed : {1, 2}) {
    const Plan plan = plan_for(scene, 20, seed);
    ASSERT_EQ(plan.trials.size(), 4u);
    EXPECT_GT(plan.trials[0].error, 0.01);
    for (const Trial& t : plan.trials) EXPECT_NEAR(t.error / plan.trials[0].error, 1, 1e-4) << t.integrator;
    EXPECT_EQ(plan.integrator, "path");
  }
}

// A caustic lies on other light: what misses it sees the most of every pixel, and looks quiet. One pilot in twenty of
// this size sees next to nothing of it.
TEST(Plan, KnowsThatCausticsAreMissed) {
  Scene scene = load_scene(kit::source_path("scenes/glass/glass.xml"));
  set_size(scene.camera, 128, 128);
  int right = 0;
  for (uint64_t seed = 1; seed <= 12; ++seed) right += is_on(plan_for(scene, 20, seed), "light-subpaths");
  EXPECT_GE(right, 10);
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

// Where nothing but a target for the noise ends the render, a first small pilot tells how long that takes, and what
// takes longer gets a pilot of its share, not one of the image's size.
// Where nothing came from no comparison can be made: that is said, not made up.
TEST(Plan, BlackIsNoMeasurement) {
  Scene scene = two_rooms(20, 24);
  const Accel accel(scene);
  RenderOptions options;
  options.cpu_seconds = 1.01 * least_budget(scene.camera), options.max_depth = 1;
  const Plan lights = make_plan(scene, accel, options, {});
  EXPECT_EQ(lights.integrator, "path");
  EXPECT_TRUE(lights.trials.empty());
  EXPECT_EQ(lights.parts[0].why, "paths of one edge see lights alone");
  for (Light& light : scene.lights) light.radiance = {};
  options.max_depth = 2;
  const Plan black = make_plan(scene, accel, options, {});
  ASSERT_EQ(black.trials.size(), 4u);
  EXPECT_EQ(black.parts[0].why, "guided-bdpt and guided-path saw black alone");
  options.cpu_seconds = 0.99 * least_budget(scene.camera);
  EXPECT_TRUE(make_plan(scene, accel, options, {}).trials.empty());
}

TEST(Plan, NoiseAloneMakesASmallPilot) {
  Scene scene = two_rooms(20, 288);
  const Accel accel(scene);
  const double pixels = double(scene.camera.width) * scene.camera.height;
  RenderOptions options;
  options.spp = 0, options.noise = 1e6;
  const Plan loose = make_plan(scene, accel, options, {});
  ASSERT_EQ(loose.trials.size(), 4u);
  EXPECT_LT(loose.width * loose.height, 4000);
  double price = infinity;
  for (const Trial& t : loose.trials) price = std::min(price, t.price());
  options.noise = price * 1e-6 * pixels / 50;  // what takes 50 s
  const Plan strict = make_plan(scene, accel, options, {});
  EXPECT_NEAR(double(strict.width) * strict.height / (double(loose.width) * loose.height), 2.5, 0.1);
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
