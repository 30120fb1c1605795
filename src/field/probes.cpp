#include "ajar/field/probes.h"

#include "ajar/core/sampler.h"
#include "ajar/core/warp.h"
#include "ajar/scene/geometry.h"

namespace ajar {
namespace {

// A shape where it is placed: itself, or as one of a group's in an instance.
struct Placed {
  uint32_t shape = none, instance = none;
};

std::vector<Placed> all_placed(const Scene& scene) {
  std::vector<Placed> out;
  for (uint32_t s = 0; s < scene.shapes.size(); ++s)
    if (scene.shapes[s].group == none) out.push_back({s, none});
  for (uint32_t i = 0; i < scene.instances.size(); ++i)
    for (uint32_t s = 0; s < scene.shapes.size(); ++s)
      if (scene.shapes[s].group == scene.instances[i].group) out.push_back({s, i});
  return out;
}

// What the instance makes of areas, taken as the same for all directions.
double scale_of(const Scene& scene, const Placed& at) {
  return at.instance == none
             ? 1
             : std::cbrt(sqr(double(std::abs(glm::determinant(glm::mat3(scene.instances[at.instance].to_world))))));
}

Probe to_world(const Scene& scene, const Placed& at, const Vec3& p, const Vec3& n) {
  if (at.instance == none) return {p, n};
  const Instance& i = scene.instances[at.instance];
  return {Vec3(i.to_world * Vec4(p, 1)), glm::normalize(glm::transpose(glm::mat3(i.to_object)) * n)};
}

Probe probe_at(const Scene& scene, const Placed& at, Vec2 u, const Distribution& triangles) {
  const Shape& shape = scene.shapes[at.shape];
  if (shape.kind != ShapeKind::mesh) {
    float pdf;
    const Surface s = sample_area(scene, at.shape, u, pdf);
    return to_world(scene, at, s.p, s.ng);
  }
  const Mesh& mesh = scene.meshes[shape.mesh];
  const uint32_t t = triangles.sample(u.x);
  const Vec2 b = to_triangle(u);
  const Vec3 corner = mesh.positions[mesh.triangles[t].x], e1 = mesh.positions[mesh.triangles[t].y] - corner,
             e2 = mesh.positions[mesh.triangles[t].z] - corner;
  return to_world(scene, at, corner + e1 * b.x + e2 * b.y, mesh.faces[t].ng);
}

Distribution triangles_of(const Scene& scene, const Shape& shape) {
  if (shape.kind != ShapeKind::mesh) return {};
  std::vector<float> areas;
  const Mesh& mesh = scene.meshes[shape.mesh];
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) areas.push_back(triangle_area(mesh, t));
  return Distribution(areas);
}

}  // namespace

double area(const Scene& scene) {
  double sum = 0;
  for (const Placed& at : all_placed(scene)) sum += area(scene, at.shape) * scale_of(scene, at);
  return sum;
}

std::vector<Probe> place_probes(const Scene& scene, uint32_t count, double& total) {
  total = area(scene);
  std::vector<Probe> out;
  double before = 0;  // area of the shapes so far
  uint32_t next = 0;
  for (const Placed& at : all_placed(scene)) {
    const double mine = area(scene, at.shape) * scale_of(scene, at);
    const Distribution triangles = triangles_of(scene, scene.shapes[at.shape]);
    for (; next < count; ++next) {
      const double u = ((next + 0.5) / count * total - before) / mine;
      if (!(u < 1)) break;
      const Probe probe =
          probe_at(scene, at, {std::clamp(float(u), 0.0f, one_minus_epsilon), to_unit(reverse_bits(next))}, triangles);
      if (is_finite(probe.p) && is_finite(probe.n)) out.push_back(probe);
    }
    before += mine;
  }
  return out;
}

}  // namespace ajar
