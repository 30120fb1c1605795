#include "solid.h"

#include "ajar/core/frame.h"
#include "ajar/core/warp.h"

namespace ajar {
namespace {

// The cone that a sphere fills, for a point outside.
struct Cone {
  Vec3 axis{0, 0, 1};  // from x to the centre
  float sin2 = 1;      // of half the angle
  float height = 1;    // 1 - cos of it
};

// False inside (or on the surface), and for spheres that shine inwards: then area is sampled.
bool cone_of(const Shape& sphere, const Vec3& x, Cone& cone) {
  if (sphere.flip) return false;
  const glm::dvec3 to_center = glm::dvec3(Vec3(sphere.to_world[3])) - glm::dvec3(x);
  const double d2 = glm::dot(to_center, to_center), r2 = double(length2(Vec3(sphere.to_world[0])));
  if (!(d2 > r2 * (1 + 1e-6))) return false;
  const double sin2 = r2 / d2;
  cone.axis = Vec3(to_center / std::sqrt(d2));
  cone.sin2 = float(sin2);
  cone.height = float(sin2 / (1 + std::sqrt(1 - sin2)));
  return cone.height > 0;
}

// Uniform in the cone; the point follows from the angle alpha at the centre between axis and point (Pharr et al. 2016,
// section 14.2.2), which does not cancel however far or near the sphere is.
void sample_cone(const Scene& scene, uint32_t id, bool uv, const Cone& cone, const Vec2& u, Surface& at) {
  const Shape& shape = scene.shapes[id];
  const Vec3 w = to_cone(u, cone.height);
  const float sin2 = w.x * w.x + w.y * w.y;
  const float in_cone = sin2 / std::sqrt(cone.sin2);
  const float cos_alpha = std::clamp(in_cone + w.z * safe_sqrt(1 - sin2 / cone.sin2), -1.0f, 1.0f);
  const float sin_alpha = safe_sqrt(1 - cos_alpha * cos_alpha), across = sin2 > 0 ? sin_alpha / std::sqrt(sin2) : 0;
  const Frame frame = make_frame(cone.axis);
  at.ng = frame.s * (w.x * across) + frame.t * (w.y * across) - cone.axis * cos_alpha;
  at.p = Vec3(shape.to_world[3]) + at.ng * std::sqrt(length2(Vec3(shape.to_world[0])));
  at.shape = id;
  at.error = position_error(shape, at.p);
  if (uv) at.uv = sphere_uv(shape, at.p);
}

}  // namespace

bool sample_shape(const Scene& scene, uint32_t id, bool uv, const Vec3& x, const Vec2& u, Surface& at, Vec3& wi,
                  float& distance, float& pdf) {
  const Shape& shape = scene.shapes[id];
  Cone cone;
  const bool by_cone = shape.kind == ShapeKind::sphere && cone_of(shape, x, cone);
  if (by_cone)
    sample_cone(scene, id, uv, cone, u, at);
  else
    at = sample_area(scene, id, u, pdf);
  const Vec3 between = at.p - x;
  const float d2 = length2(between);
  if (!(d2 > 0)) return false;
  distance = std::sqrt(d2);
  wi = between / distance;
  const float cosine = -glm::dot(at.ng, wi);
  if (!(cosine > 0)) return false;
  pdf = by_cone ? cone_pdf(cone.height) : pdf * d2 / cosine;
  return pdf > 0 && pdf < infinity;
}

float shape_pdf(const Scene& scene, uint32_t id, const LightPoint& point, const Vec3& x, const Vec3& wi) {
  const Shape& shape = scene.shapes[id];
  const float cosine = -glm::dot(point.n, wi);
  if (!(cosine > 0)) return 0;
  Cone cone;
  if (shape.kind == ShapeKind::sphere && cone_of(shape, x, cone)) return cone_pdf(cone.height);
  const float pdf = area_pdf(scene, id, point.prim, point.uv) * length2(point.p - x) / cosine;
  return pdf < infinity ? pdf : 0;
}

}  // namespace ajar
