#include "kit/stage.h"

namespace ajar::kit {

Mesh globe(const Vec3& centre, float radius, int n, float bend) {
  Mesh mesh;
  const auto columns = uint32_t(2 * n);
  for (int i = 0; i <= n; ++i)
    for (uint32_t j = 0; j <= columns; ++j) {
      const float theta = pi * float(i) / float(n), phi = 2 * pi * float(j % columns) / float(columns);
      const Vec3 d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
      mesh.positions.push_back(centre + radius * d);
      mesh.normals.push_back(glm::normalize(d + bend * Vec3(std::sin(9 * phi), std::cos(7 * theta), 0)));
      mesh.uvs.push_back({float(j) / float(columns), float(i) / float(n)});
    }
  for (uint32_t i = 0; i < uint32_t(n); ++i)
    for (uint32_t j = 0; j < columns; ++j) {
      const uint32_t a = i * (columns + 1) + j, b = a + columns + 1;
      if (i + 1 < uint32_t(n)) mesh.triangles.push_back({a, b + 1, b});
      if (i > 0) mesh.triangles.push_back({a, a + 1, b + 1});
    }
  return mesh;
}

void add_open_room(Scene& scene, uint32_t floor_material) {
  const uint32_t grey = add_diffuse(scene, Rgb(0.6f)), red = add_diffuse(scene, {0.6f, 0.1f, 0.1f});
  const uint32_t green = add_diffuse(scene, {0.1f, 0.6f, 0.1f});
  add_quad(scene, {-1, -1, 1}, {2, 0, 0}, {0, 0, -2}, floor_material == none ? grey : floor_material);
  add_quad(scene, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, grey);
  add_quad(scene, {-1, -1, 1}, {0, 0, -2}, {0, 2, 0}, red);
  add_quad(scene, {1, -1, -1}, {0, 0, 2}, {0, 2, 0}, green);
}

void add_ceiling(Scene& scene) { add_quad(scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, add_diffuse(scene, Rgb(0.6f))); }

uint32_t add_paper(Scene& scene, const Rgb& reflectance) {
  Material front, through, paper;
  front.kind = MaterialKind::twosided, front.nested[0] = add_diffuse(scene, reflectance);
  through.kind = MaterialKind::difftrans, through.transmittance = Slot(0.8f);
  paper.kind = MaterialKind::blend, paper.weight = Slot(0.6f);
  paper.nested[0] = add_material(scene, front), paper.nested[1] = add_material(scene, through);
  return add_material(scene, paper);
}

uint32_t add_lamp(Scene& scene, float half, const Slot& radiance) {
  const uint32_t black = add_diffuse(scene, Rgb(0));
  return add_area_light(scene, add_quad(scene, {-half, 0.98f, -half}, {2 * half, 0, 0}, {0, 0, 2 * half}, black),
                        radiance);
}

Scene stage(int size) {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  set_camera(scene, {0, 0, 4.2f}, {0, 0, 0}, 36, size, size);
  add_open_room(scene);
  add_ceiling(scene);
  add_lamp(scene, 0.4f, Rgb(12, 10, 8));
  return scene;
}

Scene lit_through_paper() {
  Scene scene;
  const uint32_t grey = add_diffuse(scene, Rgb(0.5f));
  add_box(scene, Vec3(-1), Vec3(1), grey, true);
  add_quad(scene, {0, -1, -1}, {0, 2, 0}, {0, 0, 2}, add_paper(scene, Rgb(0.5f)));
  add_area_light(scene, add_quad(scene, {-0.9f, 0.9f, -0.5f}, {0.8f, 0, 0}, {0, 0, 1}, add_diffuse(scene, Rgb(0))),
                 Rgb(1));
  set_camera(scene, {0.5f, 0.5f, 0.9f}, {0.5f, -1, 0}, 90, 24, 24);
  finish(scene);
  return scene;
}

Scene under_a_lid(LightKind kind, float ground, int size) {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  set_camera(scene, {0, 0.8f, 1.9f}, {0, 0.5f, 0}, 60, size, size);
  const uint32_t white = add_diffuse(scene, Rgb(0.7f));
  add_quad(scene, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, white);
  for (const float x : {-2.0f, 2.0f}) add_quad(scene, {x, 0, -2}, {0, 0, 4}, {0, 2, 0}, white);
  for (const float z : {-2.0f, 2.0f}) add_quad(scene, {-2, 0, z}, {4, 0, 0}, {0, 2, 0}, white);
  for (const float z : {-2.0f, 0.4f}) add_quad(scene, {-2, 2, z}, {4, 0, 0}, {0, 0, 1.6f}, white);
  for (const float x : {-2.0f, 0.4f}) add_quad(scene, {x, 2, -0.4f}, {1.6f, 0, 0}, {0, 0, 0.8f}, white);
  add_quad(scene, {-ground, -0.1f, ground}, {2 * ground, 0, 0}, {0, 0, -2 * ground}, add_diffuse(scene, Rgb(0)));
  scene.lights[add_light(scene, kind, Rgb(1))].direction = glm::normalize(Vec3(0.1f, -1, 0.05f));
  finish(scene);
  return scene;
}

}  // namespace ajar::kit
