#include "quadric.h"

#include "ajar/core/angle.h"

namespace ajar {
namespace {

float turn(float y, float x) {
  const float phi = fast_atan2(y, x) / (2 * pi);
  return phi < 0 ? phi + 1 : phi;
}

// Roots of |f + (t - tc) d|^2 = 1 with f the point of the ray nearest to the centre: no cancellation for far rays
// (Haines et al. 2019, Ray Tracing Gems, chapter 7).
bool roots(const glm::dvec3& o, const glm::dvec3& d, double& t0, double& t1) {
  const double a = glm::dot(d, d);
  if (!(a > 0)) return false;
  const double tc = -glm::dot(o, d) / a;
  const glm::dvec3 f = o + d * tc;
  const double rest = 1 - glm::dot(f, f);
  if (!(rest >= 0)) return false;
  const double h = std::sqrt(rest / a);
  t0 = tc - h;
  t1 = tc + h;
  return true;
}

}  // namespace

bool intersect_quadric(ShapeKind kind, const glm::dvec3& o, const glm::dvec3& d, double t_min, double t_max, double& t,
                       glm::dvec3& p) {
  const auto inside = [&](double x) { return x > t_min && x < t_max; };
  if (kind == ShapeKind::disk) {
    if (d.z == 0) return false;
    t = -o.z / d.z;
    if (!inside(t)) return false;
    p = o + d * t;
    return p.x * p.x + p.y * p.y <= 1;
  }
  double t0, t1;
  const bool cylinder = kind == ShapeKind::cylinder;
  if (!roots(cylinder ? glm::dvec3(o.x, o.y, 0) : o, cylinder ? glm::dvec3(d.x, d.y, 0) : d, t0, t1)) return false;
  for (const double root : {t0, t1}) {
    if (!inside(root)) continue;
    p = o + d * root;
    if (cylinder && (p.z < 0 || p.z > 1)) continue;
    t = root;
    return true;
  }
  return false;
}

Vec2 quadric_uv(ShapeKind kind, const glm::dvec3& p) {
  const float around = turn(float(p.y), float(p.x)), from_axis = float(std::sqrt(p.x * p.x + p.y * p.y));
  if (kind == ShapeKind::disk) return {from_axis, around};
  if (kind == ShapeKind::cylinder) return {around, float(p.z)};
  return {around, fast_atan2(from_axis, float(p.z)) * inv_pi};
}

}  // namespace ajar
