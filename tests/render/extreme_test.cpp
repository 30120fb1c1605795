// Sizes, brightnesses and scenes at the limits: the same image, or black, and never a rejected value.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "kit/stage.h"
#include "measure.h"

namespace ajar {
namespace {

using namespace kit;

constexpr const char* all[] = {"path", "bdpt", "light", "guided-bdpt"};

Scene furnished() {
  Scene scene = stage();
  Material glossy, glass;
  glossy.kind = MaterialKind::roughconductor, glass.kind = MaterialKind::dielectric;
  add_sphere(scene, {0.4f, -0.6f, 0.2f}, 0.4f, add_material(scene, glossy));
  add_sphere(scene, {-0.4f, -0.6f, 0.3f}, 0.35f, add_material(scene, glass));
  add_mesh(scene, globe({-0.3f, 0.2f, -0.4f}, 0.3f, 8, 0.2f), add_diffuse(scene, Rgb(0.7f)));
  return scene;
}

Scene scaled(float size, const Vec3& shift = Vec3(0)) {
  Scene scene = furnished();
  const Mat4 m = glm::scale(glm::translate(Mat4(1), shift), Vec3(size));
  for (Mesh& mesh : scene.meshes)
    for (Vec3& p : mesh.positions) p = Vec3(m * Vec4(p, 1));
  for (Shape& shape : scene.shapes) shape.to_world = m * shape.to_world, shape.to_object = glm::inverse(shape.to_world);
  set_camera(scene, Vec3(m * Vec4(0, 0, 4.2f, 1)), shift, 36, 24, 24);
  finish(scene);
  return scene;
}

Picture image_of(const Scene& scene, const std::string& integrator, uint32_t spp = 16, int max_depth = -1) {
  const Accel accel(scene);
  RenderOptions o = statistical(integrator, max_depth);
  o.spp = spp;
  return develop(rendered(scene, accel, o).film);
}

double sum_of(const Picture& p) {
  double sum = 0;
  for (const float v : p.pixels) sum += v;
  return sum;
}

class Size : public testing::TestWithParam<float> {};
TEST_P(Size, DoesNotMatter) {
  for (const char* integrator : {"path", "bdpt", "guided-bdpt"}) {
    const Repeats plan{.batches = 16, .passes = 15};
    const RenderOptions options = statistical(integrator);
    expect_same(measure(scaled(1), options, plan), measure(scaled(GetParam()), options, plan), integrator);
  }
}
INSTANTIATE_TEST_SUITE_P(Extreme, Size, testing::Values(1e-3f, 1e4f),
                         [](const auto& test) { return test.param < 1 ? "Thousandth" : "TenThousand"; });

TEST(Extreme, FarFromTheOrigin) {
  const Repeats plan{.batches = 16, .passes = 30};
  const RenderOptions options = statistical("bdpt");
  expect_same(measure(scaled(1), options, plan), measure(scaled(1, {300, -200, 500}), options, plan), "moved");
}

TEST(Extreme, BrightnessIsAFactor) {
  for (const char* integrator : all) {
    double expected = 0;
    for (const float factor : {1.0f, 0x1p27f, 0x1p-20f}) {  // without rounding, so that no choice turns over
      Scene scene = furnished();
      scene.lights[0].radiance.value *= factor;
      finish(scene);
      const double sum = sum_of(image_of(scene, integrator)) / factor;
      if (factor == 1) expected = sum;
      EXPECT_NEAR(sum, expected, 1e-6 * expected) << integrator << ' ' << factor;
      EXPECT_GT(sum, 0);
    }
  }
}

// Squares of such radiance have no place in a float.
TEST(Extreme, BrighterAndDarkerThanSquaresGo) {
  for (const char* integrator : {"path", "guided-path", "guided-bdpt"}) {
    double expected = 0;
    for (const float factor : {1.0f, 0x1p70f, 0x1p-90f}) {
      Scene scene = furnished();
      scene.lights[0].radiance.value *= factor;
      finish(scene);
      const double sum = sum_of(image_of(scene, integrator, 64)) / factor;
      if (factor == 1) expected = sum;
      EXPECT_NEAR(sum, expected, 0.05 * expected) << integrator << ' ' << factor;
    }
  }
}

TEST(Extreme, SharpGlossAndTinyLights) {
  for (const float alpha : {1e-4f, 1e-3f, 1.0f}) {
    Scene scene = stage();
    Material m;
    m.kind = MaterialKind::roughconductor;
    m.distribution = Microfacet::ggx;
    m.alpha_u = m.alpha_v = alpha;
    const uint32_t gloss = add_material(scene, m);
    m.kind = MaterialKind::roughdielectric;
    const uint32_t frosted = add_material(scene, m);
    add_quad(scene, {-0.9f, -0.9f, 0.5f}, {1.8f, 0, 0}, {0, 0.3f, -1.4f}, gloss);
    add_sphere(scene, {-0.4f, 0, 0.2f}, 0.3f, frosted);
    add_sphere(scene, {0.4f, 0, 0.2f}, 0.3f, gloss);
    const uint32_t spark = add_sphere(scene, {0.1f, 0.3f, 0.3f}, 1e-4f, scene.shapes[0].material);
    add_area_light(scene, spark, Rgb(1e7f));
    finish(scene);
    for (const char* integrator : all) EXPECT_GT(sum_of(image_of(scene, integrator, 64)), 0) << integrator << alpha;
  }
}

TEST(Extreme, GrazingAndTouchingSurfaces) {
  Scene scene = furnished();
  const uint32_t grey = scene.shapes[0].material;
  for (int i = 0; i < 8; ++i)  // sheets upon the floor, ever closer, and through the spheres
    add_quad(scene, {-1, -1 + std::pow(0.1f, float(i)), 1}, {2, 0, 0}, {0, std::pow(0.1f, float(7 - i)), -2}, grey);
  add_area_light(scene, add_quad(scene, {-1, -0.99999f, 0.9f}, {2, 0, 0}, {0, 0, -0.01f}, grey), Rgb(50));
  finish(scene);
  for (const char* integrator : all) EXPECT_GT(sum_of(image_of(scene, integrator, 64)), 0) << integrator;
}

TEST(Extreme, LightsWithoutAreaGiveNothing) {
  for (const bool lamp : {false, true}) {
    Scene scene = furnished(), plain = furnished();
    if (!lamp) {
      for (Scene* s : {&scene, &plain}) s->lights.clear(), s->shapes[5].light = none;
    }
    Mesh flat;
    flat.positions = {{0, 0, 0}, {0.1f, 0.1f, 0}, {0.2f, 0.2f, 0}, {0, 0, 0}};
    flat.triangles = {{0, 1, 2}, {0, 3, 0}, {1, 1, 1}};
    add_area_light(scene, add_mesh(scene, flat, add_diffuse(scene, Rgb(0.5f))), Rgb(100));
    finish(scene), finish(plain);
    for (const char* integrator : all) {
      const double sum = sum_of(image_of(scene, integrator, 32)), expected = sum_of(image_of(plain, integrator, 32));
      EXPECT_NEAR(sum, expected, 0.1 * expected) << integrator;
      EXPECT_EQ(sum > 0, lamp) << integrator;
    }
  }
}

// A closed room with a small lamp, and the camera in it.
Scene closed_room(const Vec3& middle, float watts) {
  Scene scene;
  add_box(scene, middle - 1.0f, middle + 1.0f, add_diffuse(scene, Rgb(0.5f)), true);
  scene.lights[add_light(scene, LightKind::point, Rgb(watts))].position = middle + Vec3(0.1f, 0.6f, 0);
  scene.filter = make_filter(FilterKind::box, 0.5f);
  set_camera(scene, middle + Vec3(0, 0, 0.9f), middle, 70, 16, 16);
  return scene;
}

// A sun that no ray in the room finds promises ten thousand times what its lamp does.
TEST(Extreme, SunsOutsideDoNotDrawRaysFromTheLampInside) {
  Scene dark = closed_room(Vec3(0), 0.4f), sunny = closed_room(Vec3(0), 0.4f);
  sunny.lights[add_light(sunny, LightKind::directional, Rgb(1000))].direction = {0.4f, -1, -0.3f};
  for (Scene* s : {&dark, &sunny}) set_camera(*s, {0, 0, 0.9f}, Vec3(0), 70, 40, 40), finish(*s);
  const Picture right = image_of(dark, "path", 1024);
  const auto error_of = [&](const Scene& scene) {
    RenderOptions o = statistical("guided-bdpt");
    o.spp = 96, o.leaves_out = false;
    const Picture image = develop(rendered(scene, Accel(scene), o).film);
    double sum = 0;
    for (size_t i = 0; i < right.pixels.size(); ++i) sum += sqr(double(image.pixels[i] / right.pixels[i]) - 1);
    return sum / double(right.pixels.size());
  };
  EXPECT_LT(error_of(sunny), 0.008);  // without the sun 0.0008, most of it the reference's own
}

// Its share of all light is lost in the sum; its room is lit all the same.
TEST(Extreme, FaintLampsOutlastBrightOnes) {
  Scene scene = closed_room({5, 0, 0}, 1e-9f);
  add_box(scene, {-6, -1, -1}, {-4, 1, 1}, 0, true);
  scene.lights[add_light(scene, LightKind::point, Rgb(1e9f))].position = {-5, 0, 0};
  finish(scene);
  const double expected = sum_of(image_of(scene, "path", 256));
  EXPECT_GT(expected, 0);
  for (const char* integrator : {"bdpt", "vcm", "guided-path", "guided-bdpt"})
    EXPECT_NEAR(sum_of(image_of(scene, integrator, 256)) / expected, 1, 0.1) << integrator;
}

// What next-event estimation is not to ask for shines all the same, for all who send light from it.
TEST(Extreme, LampsThatAreNotAskedForShine) {
  Scene scene = stage(12);
  const uint32_t ball = add_sphere(scene, {-0.5f, -0.2f, 0.2f}, 0.3f, add_diffuse(scene, Rgb(0.3f)));
  scene.lights[add_area_light(scene, ball, Rgb(1, 6, 1))].sampling_weight = 0;
  scene.lights[add_light(scene, LightKind::constant, Rgb(0.5f))].sampling_weight = 0;
  finish(scene);
  const Estimate right = measure(scene, statistical("path"), {8, 128, 1});
  for (const char* integrator : {"bdpt", "guided-bdpt", "vpl", "plain-vpl"})
    expect_same(measure(scene, statistical(integrator), {8, 32, 100}), right, integrator);
  scene.lights.pop_back();  // which light alone does not see
  finish(scene);
  expect_same(measure(scene, statistical("light"), {8, 128, 200}), measure(scene, statistical("path"), {8, 128, 1}),
              "light");
}

TEST(Extreme, NoLightNoShape) {
  Scene dark = furnished();
  dark.lights.clear();
  dark.shapes[5].light = none;
  finish(dark);
  Scene unlit = furnished();
  unlit.lights[0].radiance = Rgb(0);
  finish(unlit);
  Scene empty;
  set_camera(empty, Vec3(0), Vec3(0, 0, 1), 40, 8, 8);
  finish(empty);
  Scene sky = empty;
  add_light(sky, LightKind::constant, Rgb(2));
  finish(sky);
  Scene lamp = empty;
  add_light(lamp, LightKind::point, Rgb(2));
  add_light(lamp, LightKind::directional, Rgb(2));
  finish(lamp);
  for (const char* integrator : all) {
    for (const Scene* scene : {&dark, &unlit, &empty, &lamp})
      EXPECT_EQ(sum_of(image_of(*scene, integrator, 2)), 0) << integrator;
    if (integrator == all[2]) continue;
    EXPECT_NEAR(sum_of(image_of(sky, integrator, 2)), 2 * 3 * 64, 1e-3) << integrator;
  }
}

TEST(Extreme, MirrorCorridor) {
  Scene scene = stage();
  Material mirror;
  mirror.kind = MaterialKind::conductor;
  mirror.eta = Rgb(0), mirror.k = Rgb(1);
  const uint32_t id = add_material(scene, mirror);
  scene.shapes[2].material = scene.shapes[3].material = id;
  add_quad(scene, {-1, -1, 4.5f}, {0, 2, 0}, {2, 0, 0}, id);  // behind the camera
  scene.shapes[1].material = id;
  set_camera(scene, {0.1f, -0.2f, 0.5f}, {1, 0, -0.1f}, 70, 24, 24);
  finish(scene);
  for (const char* integrator : {"path", "bdpt", "guided-bdpt"}) {
    const Picture p = image_of(scene, integrator, 16);
    EXPECT_GT(sum_of(p), 0) << integrator;
  }
}

TEST(Extreme, DepthOneSeesLightsAlone) {
  Scene scene = furnished();
  finish(scene);
  for (const char* integrator : all) {
    const Picture one = image_of(scene, integrator, 64, 1);
    for (size_t i = 24 * 24 * 3 / 2; i < one.pixels.size(); ++i) ASSERT_EQ(one.pixels[i], 0) << integrator;
  }
}

}  // namespace
}  // namespace ajar
