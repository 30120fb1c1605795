// The scenes of build.h.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <glm/gtc/matrix_transform.hpp>

#include "ajar/core/error.h"
#include "ajar/core/sampler.h"
#include "ajar/scene/build.h"

namespace ajar {
namespace {

void require_count(const char* scene, const char* parts, int n, int least, int most) {
  if (n < least || n > most) throw Error(fmt::format("{}: {} {}; give it {} to {}", scene, n, parts, least, most));
}

Scene begin() {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  return scene;
}

Scene finished(Scene scene) {
  finish(scene);
  return scene;
}

// The room [-1,1]^3, seen from z = 4.2 through its open front.
Scene room(int size, bool ceiling, const Rgb& left = {0.6f, 0.1f, 0.1f}, const Rgb& right = {0.1f, 0.6f, 0.1f}) {
  Scene scene = begin();
  set_camera(scene, {0, 0, 4.2f}, {0, 0, 0}, 36, size, size);
  const uint32_t grey = add_diffuse(scene, Rgb(0.6f));
  add_quad(scene, {-1, -1, 1}, {2, 0, 0}, {0, 0, -2}, grey);
  add_quad(scene, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, grey);
  add_quad(scene, {-1, -1, 1}, {0, 0, -2}, {0, 2, 0}, add_diffuse(scene, left));
  add_quad(scene, {1, -1, -1}, {0, 0, 2}, {0, 2, 0}, add_diffuse(scene, right));
  if (ceiling) add_quad(scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, grey);
  return scene;
}

// A square that shines down from y, in black so that it does nothing else.
uint32_t add_lamp(Scene& scene, float x, float y, float z, float half, const Slot& radiance) {
  const uint32_t black = add_diffuse(scene, Rgb(0));
  return add_area_light(scene, add_quad(scene, {x - half, y, z - half}, {2 * half, 0, 0}, {0, 0, 2 * half}, black),
                        radiance);
}

Scene lit_room(int size) {
  Scene scene = room(size, true);
  add_lamp(scene, 0, 0.98f, 0, 0.4f, Rgb(12, 10, 8));
  return scene;
}

Mat4 turned_box(const Vec3& center, const Vec3& half, float degrees) {
  const Mat4 there = glm::translate(Mat4(1), center);
  return glm::scale(glm::rotate(there, degrees * pi / 180, Vec3(0, 1, 0)), half);
}

void add_two_boxes(Scene& scene) {
  const uint32_t grey = add_diffuse(scene, Rgb(0.6f));
  add_box(scene, turned_box({-0.4f, -0.4f, -0.3f}, {0.28f, 0.6f, 0.28f}, 18), grey);
  add_box(scene, turned_box({0.4f, -0.7f, 0.3f}, {0.3f, 0.3f, 0.3f}, -18), grey);
}

// A gradient and a small sun, 20 times as bright.
Slot add_sky(Scene& scene) {
  constexpr int width = 32, height = 16;
  std::vector<float> rgb;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float up = 1 - (float(y) + 0.5f) / height;
      const bool sun = (y == 3 || y == 4) && (x == 10 || x == 11);
      for (const float c : {0.4f, 0.6f, 1.0f}) rgb.push_back(sun ? 20 : 0.2f + up * c);
    }
  return add_image(scene, width, height, std::move(rgb));
}

void add_light_of(Scene& scene, LightKind kind) {
  switch (kind) {
    case LightKind::area:
      add_lamp(scene, 0, 0.98f, 0, 0.4f, Rgb(12, 10, 8));
      break;
    case LightKind::envmap:
      add_envmap(scene, add_sky(scene));
      break;
    case LightKind::constant:
      add_light(scene, kind, Rgb(0.8f, 0.9f, 1));
      break;
    case LightKind::sun: {
      Light& light = scene.lights[add_light(scene, kind, Rgb(300, 250, 200))];
      light.direction = glm::normalize(Vec3(0.3f, -1, -0.4f));
      light.cone = 0.003f;
      break;
    }
    case LightKind::directional:
      scene.lights[add_light(scene, kind, Rgb(3, 2.5f, 2))].direction = glm::normalize(Vec3(0.3f, -1, -0.4f));
      break;
    case LightKind::point:
      scene.lights[add_light(scene, kind, Rgb(2, 1.8f, 1.5f))].position = {0.2f, 0.5f, 0.3f};
      break;
    case LightKind::spot: {
      Light& light = scene.lights[add_light(scene, kind, Rgb(6, 5, 4))];
      light.position = {0.3f, 0.9f, 0.2f};
      light.to_world = look_at(light.position, {-0.2f, -1, -0.3f});
      light.direction = Vec3(light.to_world[2]);
      break;
    }
    case LightKind::projector: {
      Light& light = scene.lights[add_light(scene, kind, add_checkerboard(scene, Rgb(6, 5, 4), Rgb(0.5f)))];
      light.position = {0.3f, 0.9f, 0.2f};
      light.to_world = look_at(light.position, {-0.2f, -1, -0.3f});
      light.direction = Vec3(light.to_world[2]);
      light.plane = {0.8f, 0.6f};
      break;
    }
  }
}

}  // namespace

Scene furnace(Oven oven, const Material& wall, const Rgb& radiance, int size) {
  Scene scene = begin();
  set_camera(scene, {0.3f, -0.2f, 0.5f}, {-0.1f, 0.1f, 0}, 70, size, size);
  const uint32_t material = add_material(scene, wall);
  if (oven == Oven::box) {
    add_box(scene, Mat4(1), material, true);
  } else if (oven == Oven::sphere) {
    scene.shapes[add_sphere(scene, Vec3(0), 1, material)].flip = true;
  } else {
    add_globe(scene, Vec3(0), 1, material);
    Mesh& mesh = scene.meshes[0];
    for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
    for (Vec3& n : mesh.normals) n = -n;
  }
  add_area_light(scene, 0, radiance);
  return finished(std::move(scene));
}

Scene polygon_over_plane(int corners, float height, float radius, const Rgb& radiance, float reflectance, int size) {
  Scene scene = begin();
  set_camera(scene, {0, 0.8f * height, 3 * height}, {0, 0, 0.4f * height}, 25, size, size);
  add_quad(scene, {-50, 0, 50}, {100, 0, 0}, {0, 0, -100}, add_diffuse(scene, Rgb(reflectance)));
  Mesh mesh;
  require_count("polygon_over_plane", "corners", corners, 3, 10'000'000);
  for (int i = 0; i < corners; ++i) {
    const float angle = 2 * pi * float(i) / float(corners);
    mesh.positions.push_back({radius * std::sin(angle), height, radius * std::cos(angle)});
    mesh.uvs.push_back({std::sin(angle), std::cos(angle)});
    if (i >= 2) mesh.triangles.push_back({0, i, i - 1});
  }
  add_area_light(scene, add_mesh(scene, std::move(mesh), add_diffuse(scene, Rgb(0))), radiance);
  return finished(std::move(scene));
}

Scene inside_sphere(const Rgb& radiance, int size) {
  Material black;
  black.reflectance = Rgb(0);
  return furnace(Oven::sphere, black, radiance, size);
}

Scene two_rooms(float door_degrees, int height) {
  if (!(door_degrees >= 0 && door_degrees <= 120))
    throw Error(fmt::format("two_rooms: the door at {} degrees; it opens from 0 to 120", door_degrees));
  Scene scene = begin();
  set_camera(scene, {1, 1.4f, 3.7f}, {2.3f, 1, 0}, 60, height * 16 / 9, height);
  const uint32_t near_wall = add_diffuse(scene, {0.75f, 0.72f, 0.68f}),
                 far_wall = add_diffuse(scene, {0.7f, 0.6f, 0.4f});
  const uint32_t dividing = add_diffuse(scene, Rgb(0.7f)), leaf = add_diffuse(scene, {0.45f, 0.3f, 0.2f});
  add_box(scene, {0, 0, 0}, {4, 2.5f, 4}, near_wall, true);
  add_box(scene, {0, 0, -4}, {4, 2.5f, 0}, far_wall, true);
  // Both boxes lack the wall between them: a slab with an opening stands there, and reaches past them so that no
  // corner leaks.
  for (const size_t i : {0, 1})
    std::erase_if(scene.meshes[i].triangles, [&](const glm::uvec3& t) {
      const auto at_middle = [&](uint32_t v) { return scene.meshes[i].positions[v].z == 0; };
      return at_middle(t.x) && at_middle(t.y) && at_middle(t.z);
    });
  constexpr float left = 2.6f, right = 3.5f, top = 2, half = 0.05f, gap = 0.005f;
  add_box(scene, {-0.1f, -0.1f, -half}, {left, 2.6f, half}, dividing);
  add_box(scene, {right, -0.1f, -half}, {4.1f, 2.6f, half}, dividing);
  add_box(scene, {left - 0.05f, top, -half}, {right + 0.05f, 2.6f, half}, dividing);
  const Mat4 hinge =
      glm::rotate(glm::translate(Mat4(1), Vec3(right - gap, 0, 0)), door_degrees * pi / 180, Vec3(0, 1, 0));
  const Vec3 leaf_half((right - left) / 2 - gap, top / 2 - gap, 0.02f);
  add_box(scene, glm::scale(glm::translate(hinge, Vec3(-leaf_half.x, top / 2, 0)), leaf_half), leaf);
  add_lamp(scene, 1, 2.49f, -2.6f, 0.4f, Rgb(30, 27, 22));
  return finished(std::move(scene));
}

Scene cornell(int size) {
  Scene scene = lit_room(size);
  add_two_boxes(scene);
  return finished(std::move(scene));
}

Scene glass_ball(float ior, int size) {
  Scene scene = lit_room(size);
  const uint32_t glass = add_example(scene, MaterialKind::dielectric);
  scene.materials[glass].ior = ior;
  add_sphere(scene, {0.1f, -0.45f, 0.1f}, 0.5f, glass);
  return finished(std::move(scene));
}

Scene mirror_chain(int mirrors, int size) {
  require_count("mirror_chain", "mirrors", mirrors, 0, 64);
  Scene scene = begin();
  Material mirror;
  mirror.kind = MaterialKind::conductor;  // eta 0, k 1: reflects everything
  const uint32_t silver = add_material(scene, mirror);
  // A ray at 45 degrees hops between y = 0 and y = 1, one mirror a metre, and half a metre on it meets the screen.
  for (int i = 1; i <= mirrors; ++i) {
    const Vec3 along(0.9f, 0, 0), across(0, 0, 0.9f);
    const bool above = i % 2 == 1;
    add_quad(scene, {float(i) - 0.45f, above ? 1 : 0, -0.45f}, above ? along : across, above ? across : along, silver);
  }
  const float x = float(mirrors) + 0.5f;
  add_quad(scene, {x, 0.05f, -0.45f}, {0, 0, 0.9f}, {0, 0.9f, 0}, add_diffuse(scene, {0.8f, 0.7f, 0.6f}));
  const Vec3 beside(x - 0.35f, 0.5f, 0.7f), n = glm::normalize(Vec3(x, 0.5f, 0) - beside), up(0, 0.6f, 0);
  const Vec3 u = 0.6f * glm::normalize(glm::cross(up, n));
  add_area_light(scene, add_quad(scene, beside - u * 0.5f - up * 0.5f, u, up, add_diffuse(scene, Rgb(0))), Rgb(6));
  const float fov = 2 * std::atan(0.3f / (x * std::sqrt(2.0f))) * 180 / pi;
  set_camera(scene, Vec3(0), {1, 1, 0}, fov, size, size);
  return finished(std::move(scene));
}

Scene many_lights(int lights, uint64_t seed, int size) {
  require_count("many_lights", "lights", lights, 0, 10'000'000);
  Scene scene = room(size, true);
  add_two_boxes(scene);
  const int columns = std::max(1, int(std::ceil(std::sqrt(double(lights)))));
  const float cell = 1.8f / float(columns);
  for (int i = 0; i < lights; ++i) {
    const auto random = [&](uint64_t what) { return to_unit(uint32_t(hash(hash(seed, uint64_t(i)), what) >> 32)); };
    const float half = cell * 0.15f, x = -0.9f + cell * (float(i % columns) + 0.2f + 0.6f * random(0)),
                z = -0.9f + cell * (float(i / columns) + 0.2f + 0.6f * random(1));
    // Powers over two decades that add up to about that of one lamp.
    const float power = 8 * std::pow(0.01f, random(2)) / float(lights);
    add_lamp(scene, x, 0.98f, z, half, Rgb(random(3), random(4), random(5)) * (power / (4 * half * half)));
  }
  return finished(std::move(scene));
}

Scene under_sky(LightKind kind, int size) {
  Scene scene = begin();
  set_camera(scene, {0, 0.4f, 4}, {0, 0, 0}, 40, size, size);
  add_quad(scene, {-3, -0.6f, 3}, {6, 0, 0}, {0, 0, -6}, add_diffuse(scene, Rgb(0.5f)));
  add_sphere(scene, {0, 0, 0}, 0.6f, add_diffuse(scene, {0.7f, 0.5f, 0.3f}));
  add_light_of(scene, kind);
  return finished(std::move(scene));
}

Scene instanced(bool mirrored, int size) {
  Scene scene = room(size, true, Rgb(0.6f), Rgb(0.6f));
  add_lamp(scene, 0, 0.98f, 0, 0.4f, Rgb(12, 10, 8));
  scene.groups = 1;
  const uint32_t metal = add_example(scene, MaterialKind::roughconductor, 0.3f);
  scene.materials[metal].alpha_v = 0.1f;
  const uint32_t parts[] = {
      add_globe(scene, {-0.1f, 0.15f, 0.1f}, 0.25f, metal, 12),
      add_box(scene, turned_box({0, -0.28f, 0}, {0.25f, 0.15f, 0.15f}, 30), add_diffuse(scene, {0.2f, 0.4f, 0.7f}))};
  for (const uint32_t shape : parts) scene.shapes[shape].group = 0;
  const Mat4 left = glm::rotate(glm::translate(Mat4(1), Vec3(-0.5f, -0.45f, 0.1f)), 0.3f, Vec3(0, 0, 1));
  const Mat4 right =
      mirrored ? glm::scale(Mat4(1), Vec3(-1, 1, 1)) * left : glm::translate(Mat4(1), Vec3(1, 0, 0)) * left;
  for (const Mat4& m : {left, right}) add_instance(scene, 0, m);
  return finished(std::move(scene));
}

Scene bump_plane(bool normal_map, int size) {
  Scene scene = lit_room(size);
  const uint32_t bent = add_example(scene, normal_map ? MaterialKind::normalmap : MaterialKind::bumpmap);
  for (Shape& shape : std::span(scene.shapes).first(2)) shape.material = bent;
  return finished(std::move(scene));
}

Scene lit_by(LightKind kind, int size) {
  Scene scene = room(size, false);
  // From above, so that no pixel looks past the walls: a sky that the camera sees is out of reach of paths from it.
  set_camera(scene, {0, 1.2f, 4.2f}, {0, -0.4f, -0.2f}, 24, size, size);
  add_light_of(scene, kind);
  return finished(std::move(scene));
}

Scene lit_by(ShapeKind kind, int size) {
  Scene scene = room(size, true);
  const uint32_t black = add_diffuse(scene, Rgb(0));
  const Vec3 middle(0, 0.4f, 0);
  const Mat4 there = glm::scale(glm::translate(Mat4(1), middle), Vec3(0.3f));
  const uint32_t lamp = kind == ShapeKind::mesh ? add_globe(scene, middle, 0.3f, black, 8)
                        : kind == ShapeKind::sphere
                            ? add_quadric(scene, kind, there, black)
                            : add_quadric(scene, kind, glm::rotate(there, pi / 2, Vec3(1, 0, 0)), black);
  add_area_light(scene, lamp, Rgb(6, 5, 4));
  return finished(std::move(scene));
}

Scene with_material(MaterialKind kind, float alpha, int size) {
  Scene scene = lit_room(size);
  add_sphere(scene, {0.1f, -0.5f, 0.1f}, 0.45f, add_example(scene, kind, alpha));
  return finished(std::move(scene));
}

// Two normal maps under one blend: a floor and a wall whose parts have normals of their own.
Scene bent_blend(int size) {
  Scene scene = lit_room(size);
  Material blend;
  blend.kind = MaterialKind::blend;
  blend.nested = {add_example(scene, MaterialKind::normalmap), add_example(scene, MaterialKind::bumpmap), none, none};
  const uint32_t id = add_material(scene, blend);
  for (Shape& shape : std::span(scene.shapes).first(2)) shape.material = id;
  return finished(std::move(scene));
}

std::span<const FeatureScene> feature_scenes() {
  using enum MaterialKind;
  static const std::array all{
      FeatureScene{"cornell", [] { return cornell(24); }},
      FeatureScene{"area", [] { return lit_by(LightKind::area); }},
      FeatureScene{"point", [] { return lit_by(LightKind::point); }},
      FeatureScene{"spot", [] { return lit_by(LightKind::spot); }},
      FeatureScene{"projector", [] { return lit_by(LightKind::projector); }},
      FeatureScene{"directional", [] { return lit_by(LightKind::directional); }},
      FeatureScene{"constant", [] { return lit_by(LightKind::constant); }},
      FeatureScene{"envmap", [] { return lit_by(LightKind::envmap); }},
      FeatureScene{"sun", [] { return lit_by(LightKind::sun); }},
      FeatureScene{"open directional", [] { return under_sky(LightKind::directional); }},
      FeatureScene{"mesh lamp", [] { return lit_by(ShapeKind::mesh); }},
      FeatureScene{"sphere lamp", [] { return lit_by(ShapeKind::sphere); }},
      FeatureScene{"disk lamp", [] { return lit_by(ShapeKind::disk); }},
      FeatureScene{"cylinder lamp", [] { return lit_by(ShapeKind::cylinder); }},
      FeatureScene{"roughconductor", [] { return with_material(roughconductor); }},
      FeatureScene{"roughdielectric", [] { return with_material(roughdielectric, 0.4f); }},
      FeatureScene{"roughplastic", [] { return with_material(roughplastic); }},
      FeatureScene{"phong", [] { return with_material(phong); }},
      FeatureScene{"principled", [] { return with_material(principled); }},
      FeatureScene{"twosided", [] { return with_material(twosided); }},
      FeatureScene{"blend", [] { return with_material(blend); }},
      FeatureScene{"mixture", [] { return with_material(mixture); }},
      FeatureScene{"bumpmap", [] { return bump_plane(false, 24); }},
      FeatureScene{"normalmap", [] { return bump_plane(true, 24); }},
      FeatureScene{"bent blend", [] { return bent_blend(24); }},
      FeatureScene{"roughdiffuse", [] { return with_material(roughdiffuse, 0.6f); }},
      FeatureScene{"difftrans", [] { return with_material(difftrans); }},
      FeatureScene{"ward", [] { return with_material(ward, 0.3f); }},
      FeatureScene{"instances", [] { return instanced(false, 24); }},
      FeatureScene{"mirrored instance", [] { return instanced(true, 24); }},
      FeatureScene{"many lights", [] { return many_lights(16, 1, 24); }},
      FeatureScene{"two rooms", [] { return two_rooms(40, 18); }},
      // The camera sees sky, or a mirror or glass first: nothing from the lights can be joined to it there.
      FeatureScene{"open constant", [] { return under_sky(LightKind::constant); }, true, false},
      FeatureScene{"open envmap", [] { return under_sky(LightKind::envmap); }, true, false},
      FeatureScene{"conductor", [] { return with_material(conductor); }, true, false},
      FeatureScene{"dielectric", [] { return with_material(dielectric); }, true, false},
      FeatureScene{"thindielectric", [] { return with_material(thindielectric); }, true, false},
      FeatureScene{"plastic", [] { return with_material(plastic); }, true, false},
      FeatureScene{"mask", [] { return with_material(mask); }, true, false},
      FeatureScene{"null", [] { return with_material(null); }, true, false},
      FeatureScene{"mirror chain", [] { return mirror_chain(3); }, true, false},
  };
  return all;
}

}  // namespace ajar
