// Enters: a unit normal, optionally a tangent.
// Leaves: an orthonormal frame and the transformations into it and out of it.
#pragma once

#include "ajar/core/vec.h"

namespace ajar {

/// Right-handed orthonormal frame; local z is n. Directions keep their length.
struct Frame {
  Vec3 s{1, 0, 0};
  Vec3 t{0, 1, 0};
  Vec3 n{0, 0, 1};

  Vec3 to_local(const Vec3& v) const { return {glm::dot(v, s), glm::dot(v, t), glm::dot(v, n)}; }
  Vec3 to_world(const Vec3& v) const { return s * v.x + t * v.y + n * v.z; }
};

/// n or -n, whichever is on the side of w.
inline Vec3 facing(const Vec3& n, const Vec3& w) { return glm::dot(n, w) < 0 ? -n : n; }

/// Frame about unit n without a preferred tangent (Duff et al. 2017, Building an Orthonormal Basis, Revisited).
inline Frame make_frame(const Vec3& n) {
  const float sign = std::copysign(1.0f, n.z);
  const float a = -1.0f / (sign + n.z);
  const float b = n.x * n.y * a;
  return {{1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

/// Frame about unit n whose s is the tangent projected; falls back to make_frame(n) where the tangent is useless.
inline Frame make_frame(const Vec3& n, const Vec3& tangent) {
  const Vec3 s = tangent - n * glm::dot(n, tangent);
  const float l2 = length2(s);
  if (!(l2 > 1e-12f * length2(tangent)) || !std::isfinite(l2)) return make_frame(n);
  const Vec3 unit = s / std::sqrt(l2);
  return {unit, glm::cross(n, unit), n};
}

}  // namespace ajar
