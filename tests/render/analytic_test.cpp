// Images whose value is known by formula.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "ajar/scene/bsdf/fresnel.h"
#include "kit/stage.h"
#include "measure.h"

namespace ajar {
namespace {

using namespace kit;

Picture filled(const Scene& scene, const Rgb& value) {
  Picture p{scene.camera.crop_width, scene.camera.crop_height, {"R", "G", "B"}, {}};
  for (int i = 0; i < p.width * p.height; ++i) p.pixels.insert(p.pixels.end(), {value.x, value.y, value.z});
  return p;
}

void expect_everywhere(const Scene& scene, const std::string& integrator, int max_depth, const Rgb& value,
                       const Repeats& plan = {}) {
  expect_same(measure(scene, statistical(integrator, max_depth), plan), exact(filled(scene, value)),
              integrator + " against the formula");
}

// A closed room of which every surface emits and reflects: radiance is Le (1 + a + a^2 ..) in every direction.
enum class Oven { cube, sphere, mesh };
Scene furnace(Oven oven, const Rgb& radiance, const Rgb& reflectance) {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  set_camera(scene, {0.2f, 0.1f, 0.3f}, {0.4f, -0.2f, -0.5f}, 60, 12, 12);
  const uint32_t wall = add_diffuse(scene, reflectance);
  const Mat4 to_world = glm::rotate(glm::scale(Mat4(1), Vec3(1.5f)), 0.5f, Vec3(1, 2, 3));
  if (oven == Oven::sphere) scene.shapes[add_quadric(scene, ShapeKind::sphere, to_world, wall)].flip = true;
  if (oven == Oven::mesh) {
    Mesh mesh = globe(Vec3(0), 1.5f, 6);
    mesh.normals.clear();
    for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
    add_mesh(scene, std::move(mesh), wall);
  }
  if (oven == Oven::cube)
    for (int axis = 0; axis < 3; ++axis)
      for (const float side : {-1.0f, 1.0f}) {
        Vec3 corner(-1), u(0), v(0);
        u[(axis + 1) % 3] = 2, v[(axis + 2) % 3] = 2;
        corner[axis] = side;
        side < 0 ? add_quad(scene, corner, u, v, wall) : add_quad(scene, corner, v, u, wall);
      }
  for (uint32_t i = 0; i < scene.shapes.size(); ++i) add_area_light(scene, i, radiance);
  finish(scene);
  return scene;
}

Rgb series(const Rgb& radiance, const Rgb& a, int terms) {
  Rgb sum(0), power(1);
  for (int i = 0; i < terms; ++i, power *= a) sum += radiance * power;
  return sum;
}

TEST(Furnace, Unlimited) {
  const Rgb radiance(1, 2, 0.5f), a(0.5f, 0.3f, 0.75f);
  for (const Oven oven : {Oven::cube, Oven::sphere, Oven::mesh})
    for (const char* integrator : {"path", "bdpt", "light"})
      expect_everywhere(furnace(oven, radiance, a), integrator, -1, radiance / (Rgb(1) - a), {.passes = 24});
}

// Each edge more adds one power of the reflectance: this fixes how depth is counted.
TEST(Furnace, EachDepth) {
  const Rgb radiance(1, 2, 0.5f), a(0.5f, 0.3f, 0.8f);
  for (int depth = 1; depth <= 4; ++depth)
    for (const char* integrator : {"path", "bdpt", "light"})
      expect_everywhere(furnace(Oven::cube, radiance, a), integrator, depth, series(radiance, a, depth));
}

TEST(Furnace, InsideOfABlackEmissiveSphere) {
  for (const char* integrator : {"path", "bdpt", "light"})
    expect_everywhere(furnace(Oven::sphere, Rgb(3), Rgb(0)), integrator, -1, Rgb(3));
}

// What absorbs nothing cannot be seen in front of an even sky. Lossless glass, mirror, pane, white matter, null
// and a blend of it.
TEST(Furnace, LosslessObjectsVanish) {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  set_camera(scene, {0, 0, 5}, {0, 0, 0}, 40, 24, 24);
  Material glass, mirror, pane, nothing;
  glass.kind = MaterialKind::dielectric, mirror.kind = MaterialKind::conductor;
  pane.kind = MaterialKind::thindielectric, nothing.kind = MaterialKind::null;
  mirror.eta = Rgb(0), mirror.k = Rgb(1);
  add_sphere(scene, {-0.6f, 0.6f, 0}, 0.5f, add_material(scene, glass));
  add_mesh(scene, globe({0.6f, 0.6f, 0}, 0.5f, 6), add_diffuse(scene, Rgb(1)));
  add_sphere(scene, {-0.6f, -0.6f, 0}, 0.5f, add_material(scene, mirror));
  add_sphere(scene, {0.6f, -0.6f, 0}, 0.5f, add_material(scene, pane));
  add_sphere(scene, {0, 0, 0.3f}, 0.3f, add_material(scene, nothing));
  Material blend;
  blend.kind = MaterialKind::blend, blend.weight = 0.6f;
  blend.nested = {add_material(scene, nothing), add_material(scene, pane), none, none};
  add_sphere(scene, {0, 0, 1}, 0.3f, add_material(scene, blend));
  scene.meshes[0].normals.clear();
  add_light(scene, LightKind::constant, Rgb(1, 2, 3));
  finish(scene);
  for (const char* integrator : {"path", "bdpt"}) expect_everywhere(scene, integrator, -1, Rgb(1, 2, 3));
}

// Irradiance of a polygon of even radiance 1 at a point with normal n (Lambert 1760; Arvo 1995, equation 1).
double lambert(const std::vector<glm::dvec3>& polygon, const glm::dvec3& x, const glm::dvec3& n) {
  double sum = 0;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3 a = glm::normalize(polygon[i] - x), b = glm::normalize(polygon[(i + 1) % polygon.size()] - x);
    sum += std::acos(glm::dot(a, b)) * glm::dot(glm::normalize(glm::cross(a, b)), n);
  }
  return std::abs(sum) / 2;
}

TEST(Lambert, TriangleOverAPlane) {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  set_camera(scene, {0, 2, 3}, {0, 0, 0.2f}, 30, 24, 24);
  add_quad(scene, {-9, 0, 9}, {18, 0, 0}, {0, 0, -18}, add_diffuse(scene, {0.8f, 0.4f, 0.2f}));
  Mesh mesh;
  mesh.positions = {{-0.5f, 1.1f, -2.0f}, {0.7f, 1.5f, -1.9f}, {0.1f, 1.0f, -0.4f}};
  mesh.triangles = {{0, 1, 2}};
  add_area_light(scene, add_mesh(scene, mesh, add_diffuse(scene, Rgb(0))), Rgb(5));
  finish(scene);
  Picture expected = filled(scene, Rgb(0));
  std::vector<glm::dvec3> polygon(mesh.positions.begin(), mesh.positions.end());
  for (int i = 0; i < 24 * 24 * 16; ++i) {  // 4 x 4 points of each pixel
    const Vec2 raster(float(i / 16 % 24) + (float(i % 4) + 0.5f) / 4,
                      float(i / 16 / 24) + (float(i / 4 % 4) + 0.5f) / 4);
    const CameraRay ray = generate(scene.camera, raster, Vec2(0.5f));
    const Vec3 x = ray.o - ray.d * (ray.o.y / ray.d.y);
    const double e = 5 * lambert(polygon, x, {0, 1, 0}) / std::numbers::pi / 16;
    for (int c = 0; c < 3; ++c) expected.pixels[size_t(i / 16 * 3 + c)] += float(e) * Rgb(0.8f, 0.4f, 0.2f)[c];
  }
  for (const char* integrator : {"path", "bdpt", "light"})
    expect_same(measure(scene, statistical(integrator, 2)), exact(expected), integrator);
}

Material glass_of(float ior) {
  Material m;
  m.kind = MaterialKind::dielectric;
  m.ior = ior;
  return m;
}

// Radiance that leaves glass is divided by the squared index; the ball's centre shines, seen straight on.
TEST(Refraction, RadianceOutOfGlass) {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  set_camera(scene, {0, 0, 5}, {0, 0, 0}, 0.2f, 6, 6);
  add_sphere(scene, Vec3(0), 1, add_material(scene, glass_of(1.5f)));
  add_area_light(scene, add_sphere(scene, Vec3(0), 0.5f, add_diffuse(scene, Rgb(0))), Rgb(9));
  finish(scene);
  const float value = 9 * (1 - fresnel_dielectric(1, 1.5f)) / (1.5f * 1.5f);
  for (const char* integrator : {"path", "bdpt"}) expect_everywhere(scene, integrator, -1, Rgb(value));
}

// Power passes without that factor: a point light within a glass ball lights the wall around it as if through air, but
// for what the boundary reflects.
TEST(Refraction, PowerOutOfGlass) {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  set_camera(scene, {0, 0, 1.2f}, {0, 0, 2}, 120, 12, 12);  // the ball is behind
  add_sphere(scene, Vec3(0), 1, add_material(scene, glass_of(1.5f)));
  scene.shapes[add_sphere(scene, Vec3(0), 2, add_diffuse(scene, Rgb(0.7f)))].flip = true;
  add_light(scene, LightKind::point, Rgb(11));
  finish(scene);
  const float once = fresnel_dielectric(1, 1.5f), irradiance = 11.0f / 4 * (1 - once);
  const Repeats plan{.batches = 16, .passes = 400};
  for (const char* integrator : {"bdpt", "light"})
    expect_everywhere(scene, integrator, 3, Rgb(0.7f * irradiance * inv_pi), plan);
}

// A scene and its mirror image; what is mirrored by instances' transforms must have the mirrored picture.
Scene handed(bool mirror, const Material& material) {
  Scene scene = stage();
  if (mirror) std::swap(scene.shapes[2].material, scene.shapes[3].material);
  scene.groups = 1;
  scene.shapes[add_mesh(scene, globe({0.2f, -0.3f, 0.1f}, 0.5f, 8, 0.3f), add_material(scene, material))].group = 0;
  Instance instance;
  if (mirror) instance.to_world = instance.to_object = glm::scale(Mat4(1), Vec3(-1, 1, 1));
  scene.instances = {instance};
  finish(scene);
  return scene;
}

kit::Estimate mirrored(const kit::Estimate& e) {
  const auto flip = [&](std::vector<double>& v) {
    for (int y = 0; y < e.height; ++y)
      for (int x = 0; x < e.width / 2; ++x)
        for (int c = 0; c < 3; ++c)
          std::swap(v[size_t((y * e.width + x) * 3 + c)], v[size_t((y * e.width + e.width - 1 - x) * 3 + c)]);
  };
  kit::Estimate out = e;
  flip(out.mean), flip(out.variance);
  for (auto& run : out.runs) flip(run);
  return out;
}

TEST(Mirrored, SceneGivesTheMirroredImage) {
  Material rough = glass_of(1.5f);
  rough.kind = MaterialKind::roughdielectric;
  rough.distribution = Microfacet::ggx;
  rough.alpha_u = 0.2f, rough.alpha_v = 0.5f;
  for (const Material& material : {Material{}, rough})
    for (const char* integrator : {"path", "light"}) {
      const RenderOptions options = statistical(integrator);
      const auto image = [&](bool mirror) { return measure(handed(mirror, material), options, {.passes = 24}); };
      expect_same(image(false), mirrored(image(true)), integrator);
    }
}

}  // namespace
}  // namespace ajar
