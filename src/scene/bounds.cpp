#include "bounds.h"

namespace ajar {

Box box_of(const std::vector<Vec3>& points) {
  return reduce(
      points.size(), Box{},
      [&](size_t from, size_t to) {
        Box b;
        for (size_t i = from; i < to; ++i) b.add(points[i]);
        return b;
      },
      [](Box a, const Box& b) {
        a.add(b);
        return a;
      });
}

// Box of the unit object under its transform; its extent along each world axis has a closed form.
Box box_of(const Shape& shape) {
  const Vec3 x(shape.to_world[0]), y(shape.to_world[1]), z(shape.to_world[2]), o(shape.to_world[3]);
  const Vec3 ring = glm::sqrt(x * x + y * y);
  Box b;
  if (shape.kind == ShapeKind::sphere) {
    const Vec3 r = glm::sqrt(x * x + y * y + z * z);
    b.add(o - r), b.add(o + r);
  } else {
    b.add(o - ring), b.add(o + ring);
    if (shape.kind == ShapeKind::cylinder) b.add(o + z - ring), b.add(o + z + ring);
  }
  return b;
}

Boxes boxes_of(const Scene& scene) {
  Boxes b;
  std::vector<Box> groups(scene.groups);
  for (const Shape& s : scene.shapes) {
    b.shapes.push_back(s.kind == ShapeKind::mesh ? box_of(scene.meshes[s.mesh].positions) : box_of(s));
    (s.group == none ? b.all : groups[s.group]).add(b.shapes.back());
  }
  for (const Instance& i : scene.instances) {
    b.instances.push_back(box_of(i.to_world, groups[i.group]));
    b.all.add(b.instances.back());
  }
  return b;
}

Box box_of(const Mat4& m, const Box& box) {
  Box b;
  if (box.empty()) return b;
  for (int i = 0; i < 8; ++i)
    b.add(Vec3(m * Vec4(i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y, i & 4 ? box.hi.z : box.lo.z, 1)));
  return b;
}

}  // namespace ajar
