// Lights that the camera itself does not see: against images of the same scene that show, by other means, what is left.
#include <gtest/gtest.h>

#include "ajar/accel/sight.h"
#include "kit/stage.h"
#include "measure.h"

namespace ajar {
namespace {

constexpr int size = 12;

// The room under a sky, seen past two lamps that scatter too, one before the other.
Scene with_lamps_before_it() {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  set_camera(scene, {0, 0.3f, 4}, {0, 0.2f, 0}, 50, size, size);
  kit::add_open_room(scene);
  const uint32_t grey = add_diffuse(scene, Rgb(0.4f));
  add_sphere(scene, {0.2f, -0.6f, 0}, 0.4f, grey);
  add_area_light(scene, add_mesh(scene, kit::globe({0.1f, 0.3f, 2.6f}, 0.3f, 6), grey), Rgb(6, 5, 4));
  add_area_light(scene, add_sphere(scene, {-0.2f, 0.2f, 2}, 0.25f, grey), Rgb(1, 2, 3));
  add_light(scene, LightKind::constant, Rgb(0.5f));
  finish(scene);
  return scene;
}

std::vector<double> image(const Scene& scene, const std::string& integrator, int max_depth = -1) {
  RenderOptions options = statistical(integrator, max_depth);
  options.spp = 4, options.seed = 5;
  const Picture p = develop(rendered(scene, Accel(scene), options).film);
  return {p.pixels.begin(), p.pixels.end()};
}

constexpr const char* unguided[] = {"path", "bdpt", "light", "vcm", "photon", "plain-vpl"};

TEST(Sight, DarkLampsShowAllButWhatTheyEmit) {
  Scene scene = with_lamps_before_it();
  for (const std::string integrator : unguided) {
    scene.camera.lamps = Lamps::seen;
    const std::vector<double> all = image(scene, integrator), direct = image(scene, integrator, 1);
    scene.camera.lamps = Lamps::dark;
    const std::vector<double> dark = image(scene, integrator), nothing = image(scene, integrator, 1);
    double sum = 0;
    for (size_t i = 0; i < all.size(); ++i) {
      EXPECT_NEAR(dark[i], all[i] - direct[i], 1e-5 * (1 + all[i])) << integrator << ", number " << i;
      EXPECT_EQ(nothing[i], 0) << integrator << ", number " << i;
      sum += direct[i];
    }
    EXPECT_GT(sum, 0) << integrator;
  }
}

// A near plane behind the lamps shows the room alone; and the sky that is seen beside it is taken away.
TEST(Sight, LampsThatAreGoneHideNothing) {
  Scene scene = with_lamps_before_it();
  for (const std::string integrator : unguided) {
    scene.camera.lamps = Lamps::gone, scene.camera.near_clip = 0;
    const std::vector<double> gone = image(scene, integrator);
    scene.camera.lamps = Lamps::dark;
    EXPECT_NE(image(scene, integrator), gone) << integrator;
    scene.camera.near_clip = 2.5f;
    const std::vector<double> beyond = image(scene, integrator);
    for (size_t i = 0; i < gone.size(); ++i)
      EXPECT_NEAR(gone[i], beyond[i], 1e-4 * (1 + beyond[i])) << integrator << ", number " << i;
  }
}

TEST(Sight, OneRayPassesSeveralLamps) {
  Scene scene = with_lamps_before_it();
  const Accel accel(scene);
  const CameraRay ray{{0, 0.25f, 4}, {0, 0, -1}, 0, infinity};
  Hit hit;
  ASSERT_TRUE(first_seen(scene, accel, ray, hit));
  EXPECT_FALSE(is_passed(scene, hit.shape));
  EXPECT_NEAR(hit.t, 1.1f, 0.05f);
  EXPECT_FALSE(camera_sees(scene, accel, ray.o, ray.d, 4.9f));
  scene.camera.lamps = Lamps::gone;
  ASSERT_TRUE(first_seen(scene, accel, ray, hit));
  EXPECT_NEAR(hit.t, 5, 1e-4f);
  EXPECT_TRUE(camera_sees(scene, accel, ray.o, ray.d, 4.9f));
  EXPECT_FALSE(camera_sees(scene, accel, ray.o, ray.d, 5.1f));
}

// What --aov tells is of what is seen, too.
TEST(Sight, FeaturesAreOfWhatIsSeen) {
  Scene scene = with_lamps_before_it();
  const Accel accel(scene);
  scene.camera.near_clip = 2.5f;
  const Picture beyond = render_features(scene, accel, 1, 4);
  scene.camera.near_clip = 0;
  EXPECT_NE(render_features(scene, accel, 1, 4).pixels, beyond.pixels);
  scene.camera.lamps = Lamps::gone;
  const Picture gone = render_features(scene, accel, 1, 4);
  for (size_t i = 0; i < gone.pixels.size(); ++i) EXPECT_NEAR(gone.pixels[i], beyond.pixels[i], 1e-4f) << i;
}

}  // namespace
}  // namespace ajar
