// Enters: kinds of shapes, transforms.
// Leaves: small finished scenes for the tests of this folder, and random numbers for them.
#pragma once

#include <glm/gtc/matrix_transform.hpp>

#include "ajar/core/sampler.h"
#include "ajar/scene/geometry.h"

namespace ajar::kit {

inline Vec2 random2(uint64_t i, uint64_t salt) {
  const uint64_t h = hash(i, salt);
  return {to_unit(uint32_t(h)), to_unit(uint32_t(h >> 32))};
}

/// Rotation about an odd axis, size and translation.
inline Mat4 placed(float angle, const Vec3& scale, const Vec3& at) {
  return glm::translate(Mat4(1), at) * glm::rotate(Mat4(1), angle, glm::normalize(Vec3(1, 2, -0.5f))) *
         glm::scale(Mat4(1), scale);
}

inline Mesh rectangle(const Mat4& m) {
  Mesh mesh;
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (const Vec2& uv : mesh.uvs) mesh.positions.push_back(m * Vec4(2.0f * uv - 1.0f, 0, 1));
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/// Adds a shape with material 0, which is anisotropic: hits have tangents; a mesh where one is given.
inline uint32_t add_shape(Scene& scene, ShapeKind kind, const Mat4& m, const Mesh* mesh = nullptr) {
  if (scene.materials.empty()) {
    Material& material = scene.materials.emplace_back();
    material.kind = MaterialKind::roughconductor;
    material.alpha_v = Slot(0.2f);
  }
  Shape shape;
  shape.kind = kind;
  shape.to_world = m;
  shape.to_object = Mat4(glm::inverse(glm::dmat4(m)));
  if (mesh) {
    shape.mesh = uint32_t(scene.meshes.size());
    scene.meshes.push_back(*mesh);
  }
  scene.shapes.push_back(shape);
  return uint32_t(scene.shapes.size() - 1);
}

inline uint32_t add_mesh(Scene& scene, const Mesh& mesh) { return add_shape(scene, ShapeKind::mesh, Mat4(1), &mesh); }

inline uint32_t add_light(Scene& scene, const Light& light) {
  scene.lights.push_back(light);
  const uint32_t id = uint32_t(scene.lights.size() - 1);
  if (light.kind == LightKind::area) scene.shapes[light.shape].light = id;
  return id;
}

/// Makes a shape emit.
inline uint32_t light_up(Scene& scene, uint32_t shape, const Rgb& radiance) {
  Light light;
  light.shape = shape;
  light.radiance = Slot(radiance);
  return add_light(scene, light);
}

inline glm::dvec3 map(const Mat4& m, const glm::dvec3& p) { return glm::dmat4(m) * glm::dvec4(p, 1); }

/// Point, outward normal (not unit) and (u, v) of the unit object, for (u, v) in the unit square.
struct UnitPoint {
  glm::dvec3 p, n;
};
inline UnitPoint unit_object(ShapeKind kind, double u, double v) {
  const double two_pi = 2 * std::numbers::pi;
  if (kind == ShapeKind::disk) return {{u * std::cos(two_pi * v), u * std::sin(two_pi * v), 0}, {0, 0, 1}};
  const double c = std::cos(two_pi * u), s = std::sin(two_pi * u);
  if (kind == ShapeKind::cylinder) return {{c, s, v}, {c, s, 0}};
  const double theta = std::numbers::pi * v;
  const glm::dvec3 p(std::sin(theta) * c, std::sin(theta) * s, std::cos(theta));
  return {p, p};
}

/// The hit of a ray from o on a quadric at (u, v), as the ray tracer would report it.
inline Hit quadric_hit(const Scene& scene, uint32_t shape, double u, double v, const Vec3& o, Vec3& d,
                       uint32_t instance = none) {
  glm::dvec3 p = map(scene.shapes[shape].to_world, unit_object(scene.shapes[shape].kind, u, v).p);
  if (instance != none) p = map(scene.instances[instance].to_world, p);
  const glm::dvec3 between = p - glm::dvec3(o);
  d = Vec3(glm::normalize(between));
  Hit hit;
  hit.t = float(glm::dot(between, glm::dvec3(d)));
  hit.shape = shape;
  hit.instance = instance;
  hit.bary = {float(u), float(v)};
  return hit;
}

}  // namespace ajar::kit
