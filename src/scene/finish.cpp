#include <fmt/format.h>

#include "ajar/core/error.h"
#include "ajar/core/parallel.h"
#include "ajar/scene/cutout.h"
#include "bounds.h"
#include "check.h"
#include "solid.h"

namespace ajar {
namespace {

float farthest2(const std::vector<Vec3>& points, const Vec3& center) {
  return reduce(
      points.size(), 0.0f,
      [&](size_t from, size_t to) {
        float most = 0;
        for (size_t i = from; i < to; ++i) most = std::max(most, length2(points[i] - center));
        return most;
      },
      [](float a, float b) { return std::max(a, b); });
}

float farthest2(const Box& box, const Vec3& center) {
  return box.empty() ? 0 : length2(glm::max(glm::abs(box.lo - center), glm::abs(box.hi - center)));
}

bool is_mesh(const Shape& s) { return s.kind == ShapeKind::mesh; }

// What reaches farthest, for a message.
std::string name_of_farthest(const Scene& scene, const Boxes& boxes) {
  float most = 0;
  std::string name = "it";
  const auto look = [&](const Box& box, const std::string& its_name) {
    const float reach = box.empty() ? 0 : std::max(max_abs(box.lo), max_abs(box.hi));
    if (reach <= most) return;
    most = reach;
    name = its_name;
  };
  for (size_t i = 0; i < boxes.shapes.size(); ++i)
    if (scene.shapes[i].group == none) look(boxes.shapes[i], fmt::format("the shape \"{}\"", scene.shapes[i].name));
  for (size_t i = 0; i < boxes.instances.size(); ++i) look(boxes.instances[i], fmt::format("instance {}", i));
  return name;
}

// Bounding sphere about the middle of the bounding box. Meshes by their vertices, the rest by their boxes.
void set_bounds(Scene& scene) {
  const Boxes boxes = boxes_of(scene);
  const auto& [shapes, instances, all] = boxes;
  scene.center = Vec3(0), scene.radius = 1;
  if (all.empty()) return;
  scene.center = all.lo * 0.5f + all.hi * 0.5f;
  float most = 0;
  for (size_t i = 0; i < shapes.size(); ++i) {
    if (scene.shapes[i].group != none) continue;
    most =
        std::max(most, is_mesh(scene.shapes[i]) ? farthest2(scene.meshes[scene.shapes[i].mesh].positions, scene.center)
                                                : farthest2(shapes[i], scene.center));
  }
  for (const Box& b : instances) most = std::max(most, farthest2(b, scene.center));
  const float radius = std::sqrt(most) * 1.0001f + 1e-5f * max_abs(scene.center);
  if (!(radius < farthest) || !is_finite(scene.center))
    throw Error(fmt::format("scene: {} reaches farther than {} units from the middle; check its transform",
                            name_of_farthest(scene, boxes), farthest));
  if (radius > 0) scene.radius = radius;
}

void set_packed(Mesh& mesh) {
  mesh.packed.clear();
  mesh.packed.shrink_to_fit();
  std::vector<PackedVertex> packed(mesh.positions.size());
  parallel_ranges(packed.size(), grain, [&](size_t from, size_t to) {
    for (size_t i = from; i < to; ++i) {
      const Vec2 uv = mesh.uvs.empty() ? Vec2(0) : mesh.uvs[i];
      packed[i] = {mesh.positions[i], uv.x, mesh.normals.empty() ? Vec3(0) : mesh.normals[i], uv.y};
    }
  });
  mesh.packed = std::move(packed);
  mesh.smooth = !mesh.normals.empty(), mesh.mapped = !mesh.uvs.empty();
  mesh.faces.resize(mesh.triangles.size());
  parallel_ranges(mesh.faces.size(), grain, [&](size_t from, size_t to) {
    for (size_t i = from; i < to; ++i) mesh.faces[i] = pack_triangle(mesh, uint32_t(i));
  });
}

void set_areas(Mesh& mesh) {
  std::vector<float> areas(mesh.triangles.size());
  parallel_ranges(areas.size(), grain / 4, [&](size_t from, size_t to) {
    for (size_t i = from; i < to; ++i) areas[i] = triangle_area(mesh, uint32_t(i));
  });
  mesh.area = Distribution(areas);
  mesh.total_area = mesh.area.sum;
}

// What is the other way round of to_world, so that parts may be moved by that alone. Checked afterwards.
void set_inverses(Scene& scene) {
  for (Shape& s : scene.shapes) s.to_object = is_mesh(s) ? Mat4(1) : inverse(s.to_world);
  for (Instance& i : scene.instances) i.to_object = inverse(i.to_world);
  scene.camera.to_camera = inverse(scene.camera.to_world);
}

void prepare_light(Scene& scene, uint32_t id) {
  Light& light = scene.lights[id];
  if (std::abs(length2(light.direction) - 1) > 1e-5f) light.direction = glm::normalize(light.direction);
  light.textured = light.radiance.texture != none;
  light.rectangle = {};
  if (light.kind == LightKind::area && is_mesh(scene.shapes[light.shape])) {
    Mesh& mesh = scene.meshes[scene.shapes[light.shape].mesh];
    set_areas(mesh);
    if (!light.textured) light.rectangle = rectangle_of(mesh);
  }
  if (is_infinite(light.kind) && light.kind != LightKind::directional) scene.infinite_lights.push_back(id);
  if (light.kind != LightKind::envmap && light.kind != LightKind::spot && light.kind != LightKind::projector) return;
  const glm::dmat3 linear(light.to_world);
  const double volume = std::abs(glm::determinant(linear));
  light.to_local = Mat3(glm::inverse(linear));
  if (!(volume > 0) || !is_finite(light.to_local[0] + light.to_local[1] + light.to_local[2]))
    throw Error(fmt::format("light {}: its to_world matrix cannot be inverted; repair the transform", id));
}

}  // namespace

void finish(Scene& scene) {
  scene.finished = false;
  set_inverses(scene);
  check_parts(scene);
  set_bounds(scene);
  for (Mesh& mesh : scene.meshes) set_packed(mesh);
  prepare_materials(scene);
  for (Shape& shape : scene.shapes) {
    cut_out(scene, shape);
    shape.tangents = wants_tangents(scene, shape.material);
  }
  scene.infinite_lights.clear();
  for (uint32_t i = 0; i < scene.lights.size(); ++i) prepare_light(scene, i);
  scene.light_tree = make_light_tree(scene, scene.light_tree.choice);
  scene.finished = true;
}

void require_finished(const Scene& scene) {
  const auto is_packed = [](const Mesh& m) {
    return m.packed.size() == m.positions.size() && m.faces.size() == m.triangles.size();
  };
  if (!scene.finished || scene.light_tree.tiling.size() != scene.lights.size() ||
      !std::all_of(scene.meshes.begin(), scene.meshes.end(), is_packed))
    throw Error("scene: it was built or changed, and not finished; call finish(scene) first");
  check_camera(scene.camera);
}

void set_light_choice(Scene& scene, LightChoice choice) {
  scene.light_tree.choice = choice;
  if (scene.finished) scene.light_tree = make_light_tree(scene, choice);
}

uint64_t count_triangles(const Scene& scene) {
  uint64_t n = 0;
  for (const Mesh& m : scene.meshes) n += m.triangles.size();
  return n;
}

}  // namespace ajar
