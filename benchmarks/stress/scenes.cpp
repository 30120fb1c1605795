#include "scenes.h"

#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "ajar/scene/build.h"

namespace ajar::stress {
namespace {

Scene finished(Scene scene) {
  finish(scene);
  return scene;
}

void apply(Scene& scene, const Mat4& m) {
  for (Mesh& mesh : scene.meshes)
    for (Vec3& p : mesh.positions) p = Vec3(m * Vec4(p, 1));
  for (Shape& shape : scene.shapes)
    shape.to_world = m * shape.to_world, shape.to_object = Mat4(glm::inverse(glm::dmat4(shape.to_world)));
}

// A lamp that reflects nothing.
void add_lamp(Scene& scene, const Vec3& corner, const Vec3& u, const Vec3& v, float radiance) {
  add_area_light(scene, add_quad(scene, corner, u, v, add_diffuse(scene, Rgb(0))), Rgb(radiance));
}

// A scene whose pixels share nothing.
Scene unfiltered() {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  return scene;
}

// A box of 2 x 2 x 2 without a front, about x, lit from its ceiling.
void add_alcove(Scene& scene, float x, float radiance) {
  const uint32_t grey = add_diffuse(scene, Rgb(0.6f));
  add_box(scene, {x - 1.05f, -1.05f, -1.05f}, {x + 1.05f, 1.05f, -1}, grey);
  add_box(scene, {x - 1.05f, -1.05f, -1}, {x + 1.05f, -1, 1}, grey);
  add_box(scene, {x - 1.05f, 1, -1}, {x + 1.05f, 1.05f, 1}, grey);
  add_box(scene, {x - 1.05f, -1, -1}, {x - 1, 1, 1}, grey);
  add_box(scene, {x + 1, -1, -1}, {x + 1.05f, 1, 1}, grey);
  add_lamp(scene, {x - 0.4f, 0.98f, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f}, radiance);
}

// Glass of an index, and no light.
Scene with_glass(float ior) {
  Scene scene = unfiltered();
  const uint32_t glass = add_example(scene, MaterialKind::dielectric);
  scene.materials[glass].ior = ior;
  return scene;
}

// Parallel rays from the eye to the target, of an image so wide and high.
void look_straight(Scene& scene, const Vec3& eye, const Vec3& target, float width) {
  set_size(scene.camera, image_side, image_side);
  set_orthographic(scene.camera, look_at(eye, target) * glm::scale(Mat4(1), Vec3(width / 2, width / 2, 1)));
}

// That of cornell(), without its lamp.
Scene unlit_room() {
  Scene scene = cornell(image_side);
  set_camera(scene, {0, 0, 4.2f}, Vec3(0), 36, image_side, image_side);
  for (Shape& shape : scene.shapes) shape.light = none;
  scene.lights.clear();
  return scene;
}

}  // namespace

Scene plain_room() { return cornell(image_side); }

Scene dark_room() { return finished(unlit_room()); }

Scene grey_furnace(float albedo) {
  Material wall;
  wall.reflectance = Rgb(albedo);
  return furnace(Oven::box, wall, Rgb(1), 16);
}

Scene moved_room(float scale, const Vec3& shift) {
  Scene scene = cornell(image_side);
  apply(scene, glm::scale(glm::translate(Mat4(1), shift), Vec3(scale)));
  set_camera(scene, shift + Vec3(0, 0, 4.2f * scale), shift, 36, image_side, image_side);
  return finished(std::move(scene));
}

Scene corridor(int rooms, bool in_line) {
  Scene scene = unfiltered();
  const uint32_t grey = add_diffuse(scene, Rgb(0.8f));
  const float length = 2 * float(rooms);
  add_box(scene, {0, 0, 0}, {length, 2, 2}, grey, true);
  for (int i = 1; i < rooms; ++i) {
    const float x = 2 * float(i), z = in_line ? 0.7f : i % 2 ? 0.2f : 1.2f;
    add_box(scene, {x - 0.02f, -0.1f, -0.1f}, {x + 0.02f, 2.1f, z}, grey);
    add_box(scene, {x - 0.02f, -0.1f, z + 0.6f}, {x + 0.02f, 2.1f, 2.1f}, grey);
  }
  add_lamp(scene, {length - 1.3f, 1.98f, 0.7f}, {0.6f, 0, 0}, {0, 0, 0.6f}, 20);
  if (in_line)
    set_camera(scene, {0.1f, 1, 1}, {length, 1, 1}, 140 / length, image_side, image_side);
  else
    set_camera(scene, {0.1f, 1, 0.5f}, {2, 0.9f, 1}, 70, image_side, image_side);
  return finished(std::move(scene));
}

Scene door(double degrees) {
  Scene scene = unfiltered();
  const uint32_t grey = add_diffuse(scene, Rgb(0.7f));
  add_box(scene, {0, 0, -2}, {2, 2, 2}, grey, true);
  const float gap = float(std::sin(degrees * std::numbers::pi / 180)), thick = gap > 0 ? std::min(gap, 0.02f) : 0.02f;
  add_box(scene, {-0.1f, -0.1f, -thick}, {0.7f, 2.1f, thick}, grey);
  add_box(scene, {gap > 0 ? 0.7f + gap : 0.6f, -0.1f, -thick}, {2.1f, 2.1f, thick}, grey);
  const float strength = gap > 0 ? 4 / gap : 20;  // so that all images are about as bright
  add_lamp(scene, {0.7f, 1.98f, -1.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, strength);
  set_camera(scene, {1.8f, 1, 1.8f}, {0.8f, 0.8f, 0}, 70, image_side, image_side);
  return finished(std::move(scene));
}

Scene false_floor(float gap) {
  Scene scene = cornell(image_side);
  add_quad(scene, {-1, -1 - gap, 1}, {2, 0, 0}, {0, 0, -2}, add_diffuse(scene, Rgb(0.1f, 0.9f, 0.1f)));
  return finished(std::move(scene));
}

Scene floor_lamp(float gap) {
  Scene scene = unlit_room();
  add_lamp(scene, {-0.9f, -1 + gap, 0.9f}, {0.6f, 0, 0}, {0, 0, -0.3f}, 10);
  return finished(std::move(scene));
}

Scene boxed_lamp(float gap) {
  Scene scene = unlit_room();
  const uint32_t grey = add_diffuse(scene, Rgb(0.8f));
  add_box(scene, Vec3(-0.3f), Vec3(0.3f), grey);
  const uint32_t lamp = add_box(scene, Vec3(-0.3f + gap), Vec3(0.3f - gap), grey);
  add_area_light(scene, lamp, Rgb(100));
  return finished(std::move(scene));
}

Scene strips(int count) {
  Scene scene = cornell(image_side);
  Mesh mesh;
  for (int i = 0; i <= count; ++i) {
    const float z = 1 - 2 * float(i) / float(count);
    mesh.positions.push_back({-1, -1, z}), mesh.positions.push_back({1, -1, z});
    if (i == 0) continue;
    const uint32_t k = 2 * uint32_t(i - 1);
    mesh.triangles.push_back({k, k + 1, k + 3}), mesh.triangles.push_back({k, k + 3, k + 2});
    mesh.triangles.push_back({k, k, k + 1}), mesh.triangles.push_back({k, k + 2, k});
  }
  mesh.triangles.push_back({0, 2, 4});
  scene.meshes[scene.shapes[0].mesh] = std::move(mesh);
  return finished(std::move(scene));
}

Scene fine_floor(uint32_t n) {
  Scene scene = cornell(image_side);
  Mesh mesh;
  for (uint32_t y = 0; y <= n; ++y)
    for (uint32_t x = 0; x <= n; ++x)
      mesh.positions.push_back({-1 + 2 * float(x) / float(n), -1, 1 - 2 * float(y) / float(n)});
  for (uint32_t y = 0; y < n; ++y)
    for (uint32_t x = 0; x < n; ++x) {
      const uint32_t k = y * (n + 1) + x;
      mesh.triangles.push_back({k, k + 1, k + n + 2}), mesh.triangles.push_back({k, k + n + 2, k + n + 1});
    }
  scene.meshes[scene.shapes[0].mesh] = std::move(mesh);
  return finished(std::move(scene));
}

Scene bright_room(float factor) {
  Scene scene = cornell(image_side);
  for (Light& light : scene.lights) light.radiance.value *= factor;
  return finished(std::move(scene));
}

Scene beside(float bright) {
  Scene scene = bright_room(1e-8f);
  if (bright > 0) {
    add_box(scene, {3, -1, -1}, {5, 1, 1}, add_diffuse(scene, Rgb(0.6f)), true);
    add_lamp(scene, {3.6f, 0.98f, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f}, bright);
  }
  return finished(std::move(scene));
}

Scene in_one_image(float faint, float bright) {
  Scene scene = unfiltered();
  add_alcove(scene, -1.1f, faint), add_alcove(scene, 1.1f, bright);
  set_camera(scene, {0, 0, 5}, Vec3(0), 56, 2 * image_side, image_side);
  return finished(std::move(scene));
}

Scene one_triangle() {
  Scene scene = unfiltered();
  Mesh mesh;
  mesh.positions = {{-1, 0, 1}, {1, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 1, 2}};
  add_mesh(scene, std::move(mesh), add_diffuse(scene, Rgb(0.7f)));
  scene.lights[add_light(scene, LightKind::point, Rgb(3))].position = {0.2f, 1, 0.1f};
  set_camera(scene, {0, 1.5f, 2.5f}, Vec3(0), 50, image_side, image_side);
  return finished(std::move(scene));
}

Scene spark(float radius) {
  Scene scene = unlit_room();
  const Vec3 place(0.1f, 1.2f, 1.8f);  // out of sight
  if (radius > 0) {
    const float radiance = 3 / (pi * radius * radius);
    add_area_light(scene, add_sphere(scene, place, radius, add_diffuse(scene, Rgb(0))), Rgb(radiance));
  } else {
    scene.lights[add_light(scene, LightKind::point, Rgb(3))].position = place;
  }
  return finished(std::move(scene));
}

Scene film(int width, int height) {
  Scene scene = cornell(image_side);
  const float half = std::tan(18 * pi / 180) * std::min(1.0f, float(width) / float(height));
  set_camera(scene, {0, 0, 4.2f}, Vec3(0), 2 * std::atan(half) * 180 / pi, width, height);
  return finished(std::move(scene));
}

Scene glass_in_sky(float ior, bool box) {
  Scene scene = with_glass(ior);
  if (box)
    add_box(scene, glm::rotate(Mat4(1), 0.5f, glm::normalize(Vec3(1, 2, 3))), 0);
  else
    add_sphere(scene, Vec3(0), 1, 0);
  add_light(scene, LightKind::constant, Rgb(1));
  set_camera(scene, {0, 0, 4}, Vec3(0), 45, image_side, image_side);
  return finished(std::move(scene));
}

Scene glass_pane(float ior) {
  Scene scene = with_glass(ior);
  add_box(scene, {-2, -2, -0.3f}, {2, 2, 0.3f}, 0);
  add_lamp(scene, {-2, -2, -1}, {4, 0, 0}, {0, 4, 0}, 1);
  look_straight(scene, {0, 0, 3}, Vec3(0), 1);
  return finished(std::move(scene));
}

Scene glass_bar(float ior, int hops) {
  Scene scene = with_glass(ior);
  const float end = 2 * float(hops) + 2;
  Mesh bar;
  for (const float z : {-1.0f, 1.0f})
    bar.positions.insert(bar.positions.end(), {{0, 0, z}, {end, 0, z}, {end - 1, 1, z}, {1, 1, z}});
  bar.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  for (const uint32_t a : {0u, 1u, 2u, 3u}) {
    const uint32_t b = (a + 1) % 4;
    bar.triangles.push_back({a, b, b + 4}), bar.triangles.push_back({a, b + 4, a + 4});
  }
  add_mesh(scene, std::move(bar), 0);
  add_lamp(scene, {end + 1, 0.5f, -1.5f}, {0, 0, 3}, {-1.5f, 1.5f, 0}, 1);
  look_straight(scene, {-1.5f, 2.5f, 0}, {0.5f, 0.5f, 0}, 0.8f);
  return finished(std::move(scene));
}

Scene deltas_in_sky() {
  Scene scene = glass_in_sky(1.5f, false);
  Material mirror;
  mirror.kind = MaterialKind::conductor;
  mirror.eta = Rgb(0), mirror.k = Rgb(1);
  const uint32_t silver = add_material(scene, mirror);
  add_quad(scene, {-1.5f, -3, 3}, {0, 0, -6}, {0, 6, 0}, silver);
  add_quad(scene, {1.5f, -3, -3}, {0, 0, 6}, {0, 6, 0}, silver);
  for (float y = -1.2f; y < 2; y += 2.4f) add_sphere(scene, {0.2f, y, 0.3f}, 0.5f, scene.shapes[0].material);
  return finished(std::move(scene));
}

Scene black_room() {
  Scene scene = cornell(image_side);
  for (Material& m : scene.materials) m.reflectance = Rgb(0);
  return finished(std::move(scene));
}

Scene grazing(float height, float bumps) {
  Scene scene = bumps > 0 ? bump_plane(false, image_side) : cornell(image_side);
  for (Material& m : scene.materials)
    if (m.kind == MaterialKind::bumpmap) m.map_scale = bumps;
  set_camera(scene, {0, -1 + height, 0.95f}, {0.1f, -1 + height * 0.7f, -1}, 40, image_side, image_side);
  return finished(std::move(scene));
}

}  // namespace ajar::stress
