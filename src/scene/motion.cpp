#include "ajar/scene/motion.h"

#include "bounds.h"

namespace ajar {
namespace {

Box bounds_of(const Scene& scene, const Shape& shape) {
  return shape.kind == ShapeKind::mesh ? box_of(scene.meshes[shape.mesh].positions) : box_of(shape);
}

bool is_same(const Scene& a, const Shape& shape_a, const Scene& b, const Shape& shape_b) {
  if (shape_a.kind != shape_b.kind || shape_a.group != shape_b.group) return false;
  if (shape_a.kind != ShapeKind::mesh) return shape_a.to_world == shape_b.to_world;
  const Mesh &mesh_a = a.meshes[shape_a.mesh], &mesh_b = b.meshes[shape_b.mesh];
  return mesh_a.positions == mesh_b.positions && mesh_a.triangles == mesh_b.triangles;
}

std::vector<Box> boxes_of_groups(const Scene& scene) {
  std::vector<Box> groups(scene.groups);
  for (const Shape& s : scene.shapes)
    if (s.group != none) groups[s.group].add(bounds_of(scene, s));
  return groups;
}

}  // namespace

std::vector<Box> find_motion(const Scene& before, const Scene& after) {
  if (before.shapes.size() != after.shapes.size() || before.instances.size() != after.instances.size() ||
      before.groups != after.groups)
    return {{Vec3(-infinity), Vec3(infinity)}};
  std::vector<Box> moved;
  std::vector<bool> changed(after.groups);
  for (size_t i = 0; i < after.shapes.size(); ++i) {
    const Shape &a = before.shapes[i], &b = after.shapes[i];
    if (is_same(before, a, after, b)) continue;
    if (b.group != none && a.group == b.group) {
      changed[b.group] = true;
      continue;
    }
    moved.push_back(bounds_of(before, a));
    moved.back().add(bounds_of(after, b));
  }
  if (after.instances.empty()) return moved;
  const std::vector<Box> groups_before = boxes_of_groups(before), groups_after = boxes_of_groups(after);
  for (size_t i = 0; i < after.instances.size(); ++i) {
    const Instance &a = before.instances[i], &b = after.instances[i];
    if (a.group == b.group && a.to_world == b.to_world && !changed[b.group]) continue;
    moved.push_back(box_of(a.to_world, groups_before[a.group]));
    moved.back().add(box_of(b.to_world, groups_after[b.group]));
  }
  return moved;
}

}  // namespace ajar
