#include "ajar/scene/build.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "ajar/core/error.h"
#include "bounds.h"
#include "load/mesh.h"

namespace ajar {
namespace {

// Adds to a list of the scene, which is to be finished anew then.
template <class T>
uint32_t append(Scene& scene, std::vector<T> Scene::*list, T value) {
  scene.finished = false;
  (scene.*list).push_back(std::move(value));
  return uint32_t((scene.*list).size() - 1);
}

Slot slot_of(uint32_t texture) {
  Slot slot;
  slot.texture = texture;
  return slot;
}

constexpr int waves_size = 64;

float wave_phase(int i) { return 2 * pi * 4 * (float(i) + 0.5f) / waves_size; }

// Grey heights in [0, 1], four waves each way.
Slot add_waves(Scene& scene) {
  std::vector<float> rgb;
  for (int y = 0; y < waves_size; ++y)
    for (int x = 0; x < waves_size; ++x)
      rgb.insert(rgb.end(), 3, 0.5f + 0.25f * (std::sin(wave_phase(x)) + std::sin(wave_phase(y))));
  return add_image(scene, waves_size, waves_size, std::move(rgb));
}

// The same waves as a map of unit normals, n/2 + 1/2.
Slot add_wave_normals(Scene& scene) {
  std::vector<float> rgb;
  for (int y = 0; y < waves_size; ++y)
    for (int x = 0; x < waves_size; ++x) {
      const Vec3 n = glm::normalize(Vec3(-0.25f * std::cos(wave_phase(x)), 0.25f * std::cos(wave_phase(y)), 1));
      for (int k = 0; k < 3; ++k) rgb.push_back(0.5f * n[k] + 0.5f);
    }
  return add_image(scene, waves_size, waves_size, std::move(rgb));
}

}  // namespace

bool add_camera(Scene& scene) {
  const Box box = boxes_of(scene).all;
  const Vec3 middle = box.lo * 0.5f + box.hi * 0.5f;
  const float distance = max_component(box.hi - box.lo) / (2 * std::tan(pi / 8));
  if (!(distance > 0)) return false;
  Mat4 to_world(1);
  to_world[3] = Vec4(middle.x, middle.y, box.lo.z - distance, 1);
  scene.filter = make_filter(FilterKind::gaussian, 0, 0.5f);
  set_perspective(scene.camera, 45, to_world);
  return true;
}

uint32_t add_material(Scene& scene, const Material& material) { return append(scene, &Scene::materials, material); }

uint32_t add_diffuse(Scene& scene, const Rgb& reflectance) {
  Material m;
  m.reflectance = reflectance;
  return add_material(scene, m);
}

uint32_t add_example(Scene& scene, MaterialKind kind, float alpha) {
  Material m;
  m.kind = kind;
  m.distribution = Microfacet::ggx;
  m.alpha_u = m.alpha_v = alpha;
  m.ior = 1.5f;
  m.reflectance = Rgb(0.6f, 0.4f, 0.2f);
  if (kind == MaterialKind::conductor || kind == MaterialKind::roughconductor)
    m.eta = {0.143f, 0.375f, 1.442f}, m.k = {3.983f, 2.386f, 1.603f};  // gold (Johnson and Christy 1972)
  if (kind == MaterialKind::principled) m.roughness = std::sqrt(alpha), m.metallic = 0.3f, m.clearcoat = 0.5f;
  const auto nest = [&](MaterialKind inner) { return add_example(scene, inner, alpha); };
  switch (kind) {
    case MaterialKind::twosided:
      m.nested = {nest(MaterialKind::roughplastic), nest(MaterialKind::diffuse), none, none};
      break;
    case MaterialKind::mask:
      m.nested[0] = nest(MaterialKind::diffuse), m.weight = add_checkerboard(scene, Rgb(1), Rgb(0.25f));
      break;
    case MaterialKind::blend:
      m.nested = {nest(MaterialKind::diffuse), nest(MaterialKind::roughconductor), none, none};
      m.weight = add_checkerboard(scene, Rgb(0.8f), Rgb(0.2f));
      break;
    case MaterialKind::mixture:
      m.nested = {nest(MaterialKind::diffuse), nest(MaterialKind::roughconductor), none, none};
      m.weights = {0.6f, 0.3f, 0, 0};
      break;
    case MaterialKind::bumpmap:
      m.nested[0] = nest(MaterialKind::diffuse), m.map = add_waves(scene), m.map_scale = 0.08f;
      break;
    case MaterialKind::normalmap:
      m.nested[0] = nest(MaterialKind::diffuse), m.map = add_wave_normals(scene);
      break;
    default:
      break;
  }
  return add_material(scene, m);
}

Slot add_checkerboard(Scene& scene, const Rgb& a, const Rgb& b) {
  Texture t;
  t.kind = TextureKind::checkerboard;
  t.to_uv[0][0] = t.to_uv[1][1] = 4;
  t.color0 = a, t.color1 = b;
  return slot_of(append(scene, &Scene::textures, t));
}

Slot add_image(Scene& scene, int width, int height, std::vector<float> rgb) {
  if (width < 1 || height < 1 || rgb.size() != 3 * size_t(width) * size_t(height))
    throw Error(fmt::format("add_image: {} numbers are no image of {}x{} pixels; give it 3 for each", rgb.size(), width,
                            height));
  if (!std::all_of(rgb.begin(), rgb.end(), [](float x) { return std::isfinite(x); }))
    throw Error("add_image: some of its numbers are not finite; leave them out");
  Image image;
  image.width = width, image.height = height, image.channels = 3;
  image.floats = std::move(rgb);
  image.name = "image " + std::to_string(scene.images.size());
  Texture t;
  t.image = append(scene, &Scene::images, std::move(image));
  return slot_of(append(scene, &Scene::textures, t));
}

uint32_t add_mesh(Scene& scene, Mesh mesh, uint32_t material) {
  Shape shape;
  shape.mesh = append(scene, &Scene::meshes, std::move(mesh));
  shape.material = material;
  return append(scene, &Scene::shapes, shape);
}

uint32_t add_quad(Scene& scene, const Vec3& corner, const Vec3& u, const Vec3& v, uint32_t material) {
  Mesh mesh = make_rectangle();
  mesh.positions = {corner, corner + u, corner + u + v, corner + v};
  return add_mesh(scene, std::move(mesh), material);
}

uint32_t add_box(Scene& scene, const Mat4& to_world, uint32_t material, bool inward) {
  Mesh mesh = make_cube();
  transform(mesh, to_world);
  if (inward)
    for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  return add_mesh(scene, std::move(mesh), material);
}

uint32_t add_box(Scene& scene, const Vec3& low, const Vec3& high, uint32_t material, bool inward) {
  return add_box(scene, glm::scale(glm::translate(Mat4(1), (low + high) * 0.5f), (high - low) * 0.5f), material,
                 inward);
}

uint32_t add_quadric(Scene& scene, ShapeKind kind, const Mat4& to_world, uint32_t material) {
  Shape shape;
  shape.kind = kind;
  shape.material = material;
  shape.to_world = to_world;
  return append(scene, &Scene::shapes, shape);
}

uint32_t add_instance(Scene& scene, uint32_t group, const Mat4& to_world) {
  return append(scene, &Scene::instances, Instance{group, to_world});
}

uint32_t add_sphere(Scene& scene, const Vec3& center, float radius, uint32_t material) {
  return add_quadric(scene, ShapeKind::sphere, glm::scale(glm::translate(Mat4(1), center), Vec3(radius)), material);
}

uint32_t add_globe(Scene& scene, const Vec3& center, float radius, uint32_t material, int rings) {
  Mesh mesh = make_sphere(rings, 2 * rings);
  transform(mesh, glm::scale(glm::translate(Mat4(1), center), Vec3(radius)));
  return add_mesh(scene, std::move(mesh), material);
}

uint32_t add_area_light(Scene& scene, uint32_t shape, const Slot& radiance) {
  if (shape >= scene.shapes.size())
    throw Error(fmt::format("add_area_light: there is no shape {}; the scene has {}", shape, scene.shapes.size()));
  Light light;
  light.radiance = radiance;
  light.shape = shape;
  return scene.shapes[shape].light = append(scene, &Scene::lights, light);
}

uint32_t add_light(Scene& scene, LightKind kind, const Slot& radiance) {
  Light light;
  light.kind = kind;
  light.radiance = radiance;
  light.direction = {0, -1, 0};
  light.to_world = kind == LightKind::spot || kind == LightKind::projector ? look_at({0, 0, 0}, {0, -1, 0}) : Mat4(1);
  light.cutoff = 40 * pi / 180, light.beam = 30 * pi / 180;
  if (kind == LightKind::sun) light.cone = 2 * sqr(std::sin(0.5358f / 4 * pi / 180));
  return append(scene, &Scene::lights, light);
}

uint32_t add_envmap(Scene& scene, const Slot& image, float scale) {
  if (image.texture >= scene.textures.size() || scene.textures[image.texture].image >= scene.images.size())
    throw Error("add_envmap: the slot has no image; take one that add_image made");
  const uint32_t id = add_light(scene, LightKind::envmap, image);
  scene.lights[id].environment =
      append(scene, &Scene::environments, make_environment(scene, scene.textures[image.texture].image, scale));
  return id;
}

Mat4 look_at(const Vec3& eye, const Vec3& target) {
  const Vec3 z = glm::normalize(target - eye), up = std::abs(z.y) > 0.999f ? Vec3(0, 0, 1) : Vec3(0, 1, 0);
  const Vec3 x = glm::normalize(glm::cross(up, z));
  return {Vec4(x, 0), Vec4(glm::cross(z, x), 0), Vec4(z, 0), Vec4(eye, 1)};
}

void set_camera(Scene& scene, const Vec3& eye, const Vec3& target, float fov, int width, int height) {
  Camera& c = scene.camera;
  c.width = c.crop_width = width;
  c.height = c.crop_height = height;
  c.crop_x = c.crop_y = 0;
  set_perspective(c, fov, look_at(eye, target));
}

}  // namespace ajar
