// Enters: uniform numbers in [0,1)^2.
// Leaves: directions and points with their densities. Each warp has its density beside it.
#pragma once

#include "ajar/core/vec.h"

namespace ajar {

/// True with probability p; stretches u over the part that was taken, so that it is uniform again.
inline bool take_part(float& u, float p) {
  if (u < p) {
    u = std::min(u / p, one_minus_epsilon);
    return true;
  }
  u = std::min((u - p) / (1 - p), one_minus_epsilon);
  return false;
}

/// Unit disk, concentric (Shirley and Chiu 1997); density 1/pi per area.
inline Vec2 to_disk(const Vec2& u) {
  const float a = 2 * u.x - 1, b = 2 * u.y - 1;
  if (a == 0 && b == 0) return {0, 0};
  const bool wide = std::abs(a) > std::abs(b);
  const float r = wide ? a : b;
  const float phi = wide ? (pi / 4) * (b / a) : (pi / 2) - (pi / 4) * (a / b);
  return {r * std::cos(phi), r * std::sin(phi)};
}

/// Tent over (-1, 1); density 1 - |x|.
inline float to_tent(float u) { return u < 0.5f ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 - 2 * u); }

/// Cosine-weighted hemisphere about +z; density cos / pi [1/sr].
inline Vec3 to_cosine_hemisphere(const Vec2& u) {
  const Vec2 d = to_disk(u);
  return {d.x, d.y, safe_sqrt(1 - d.x * d.x - d.y * d.y)};
}
inline float cosine_hemisphere_pdf(const Vec3& w) { return w.z > 0 ? w.z * inv_pi : 0; }

/// Whole sphere; density 1/(4 pi) [1/sr].
inline Vec3 to_sphere(const Vec2& u) {
  const float z = 1 - 2 * u.x, r = safe_sqrt(1 - z * z), phi = 2 * pi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), z};
}
inline constexpr float sphere_pdf = inv_pi / 4;

/// Cone about +z with 1 - cos(half angle) = height; density 1/(2 pi height) [1/sr]. Exact for tiny cones too.
inline Vec3 to_cone(const Vec2& u, float height) {
  const float h = u.x * height, r = safe_sqrt(h * (2 - h)), phi = 2 * pi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), 1 - h};
}
inline float cone_pdf(float height) { return 1 / (2 * pi * height); }

/// Barycentric weights of a triangle's 2nd and 3rd vertex, uniform by area.
inline Vec2 to_triangle(const Vec2& u) {
  const float r = std::sqrt(u.x);
  return {r * (1 - u.y), r * u.y};
}

}  // namespace ajar
