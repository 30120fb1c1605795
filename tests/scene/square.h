// Enters: a scene with one area light (shape 0).
// Leaves: its points as points of the unit square: by (u, v), or by triangle where a mesh has no texture coordinates.
#pragma once

#include <optional>

#include "shapes.h"

namespace ajar::kit {

struct OnSquare {
  Surface at;
  double area = 0;  // world area per area of the square
};

inline bool has_uvs(const Scene& scene) {
  const Shape& shape = scene.shapes[0];
  return shape.kind != ShapeKind::mesh || !scene.meshes[shape.mesh].uvs.empty();
}

/// The place on the square of a point of the light.
inline Vec2 to_square(const Scene& scene, const LightPoint& point) {
  const Shape& shape = scene.shapes[0];
  if (shape.kind == ShapeKind::sphere) return sphere_uv(shape, point.p);
  if (shape.kind != ShapeKind::mesh) return point.uv;
  const Mesh& mesh = scene.meshes[0];
  const glm::uvec3 t = mesh.triangles[point.prim];
  // By the position: solve it on the triangle.
  const glm::dvec3 p0(mesh.positions[t.x]), e1 = glm::dvec3(mesh.positions[t.y]) - p0,
                                            e2 = glm::dvec3(mesh.positions[t.z]) - p0, q = glm::dvec3(point.p) - p0;
  const double a = glm::dot(e1, e1), b = glm::dot(e1, e2), c = glm::dot(e2, e2), det = a * c - b * b;
  const Vec2 bary((c * glm::dot(q, e1) - b * glm::dot(q, e2)) / det, (a * glm::dot(q, e2) - b * glm::dot(q, e1)) / det);
  if (!has_uvs(scene)) return {(float(point.prim) + bary.x) / float(mesh.triangles.size()), bary.y};
  return mesh.uvs[t.x] * (1 - bary.x - bary.y) + mesh.uvs[t.y] * bary.x + mesh.uvs[t.z] * bary.y;
}

/// Barycentric weights of uv in a triangle.
inline Vec2 bary_of(const Mesh& mesh, uint32_t triangle, const Vec2& uv) {
  const glm::uvec3 t = mesh.triangles[triangle];
  const Vec2 a = mesh.uvs[t.y] - mesh.uvs[t.x], b = mesh.uvs[t.z] - mesh.uvs[t.x], c = uv - mesh.uvs[t.x];
  const float det = a.x * b.y - a.y * b.x;
  return {(c.x * b.y - c.y * b.x) / det, (a.x * c.y - a.y * c.x) / det};
}

/// The point of the light at a place; make_surface sees it from x.
inline std::optional<OnSquare> from_square(const Scene& scene, const Vec2& at, const Vec3& x) {
  const Shape& shape = scene.shapes[0];
  Vec3 d{0, 0, 1};
  if (shape.kind != ShapeKind::mesh) {
    const Hit hit = kit::quadric_hit(scene, 0, at.x, at.y, x, d);
    const Surface s = make_surface(scene, hit, x, d);
    return OnSquare{s, double(glm::length(glm::cross(s.dpdu, s.dpdv)))};
  }
  const Mesh& mesh = scene.meshes[0];
  const uint32_t n = uint32_t(mesh.triangles.size());
  Hit hit;
  hit.shape = 0;
  if (!has_uvs(scene)) {
    hit.prim = std::min(uint32_t(at.x * float(n)), n - 1);
    hit.bary = {at.x * float(n) - float(hit.prim), at.y};
    if (hit.bary.x + hit.bary.y > 1) return std::nullopt;
    return OnSquare{make_surface(scene, hit, x, d), 2.0 * n * triangle_area(mesh, hit.prim)};
  }
  for (hit.prim = 0; hit.prim < n; ++hit.prim) {
    hit.bary = bary_of(mesh, hit.prim, at);
    if (hit.bary.x < 0 || hit.bary.y < 0 || hit.bary.x + hit.bary.y > 1) continue;
    const Surface s = make_surface(scene, hit, x, d);
    return OnSquare{s, double(glm::length(glm::cross(s.dpdu, s.dpdv)))};
  }
  return std::nullopt;
}

}  // namespace ajar::kit
