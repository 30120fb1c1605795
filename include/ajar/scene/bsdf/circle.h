// Enters: angles as shares of a turn, points of the unit square.
// Leaves: points on the circle and cosine-distributed directions without calls to the mathematics library: bsdf
// sampling needs one per sample, and sincos would be half its price.
#pragma once

#include <bit>

#include "ajar/core/vec.h"

namespace ajar {

/// c ? a : b by a mask: for a coin toss such as a random quadrant a branch would be mispredicted half the time.
inline float select(bool c, float a, float b) {
  const uint32_t mask = 0 - uint32_t(c);
  return std::bit_cast<float>((std::bit_cast<uint32_t>(a) & mask) | (std::bit_cast<uint32_t>(b) & ~mask));
}
inline float flip_sign(float x, bool c) {
  return std::bit_cast<float>(std::bit_cast<uint32_t>(x) ^ (uint32_t(c) << 31));
}

/// (cos t, sin t) for |t| <= pi / 4 by Taylor's series; error below 4e-8.
inline Vec2 cos_sin_small(float t) {
  const float x = t * t;
  return {1 + x * (-1.0f / 2 + x * (1.0f / 24 + x * (-1.0f / 720 + x * (1.0f / 40320)))),
          t * (1 + x * (-1.0f / 6 + x * (1.0f / 120 + x * (-1.0f / 5040 + x * (1.0f / 362880)))))};
}

/// (cos, sin) of 2 pi u, u in [0, 1].
inline Vec2 circle(float u) {
  const int quarter = int(4 * u + 0.5f);
  const Vec2 p = cos_sin_small(2 * pi * (u - 0.25f * float(quarter)));
  const bool odd = quarter & 1, far = quarter & 2;
  return {flip_sign(select(odd, p.y, p.x), odd != far), flip_sign(select(odd, p.x, p.y), far)};
}

/// Cosine-weighted direction about +z, density cos / pi [1/sr]; concentric disk (Shirley and Chiu 1997).
inline Vec3 cosine_direction(const Vec2& u) {
  const float a = 2 * u.x - 1, b = 2 * u.y - 1;
  const bool wide = std::abs(a) > std::abs(b);
  const float r = select(wide, a, b), other = select(wide, b, a);
  if (r == 0) return {0, 0, 1};
  const Vec2 p = cos_sin_small(pi / 4 * (other / r));
  return {r * select(wide, p.x, p.y), r * select(wide, p.y, p.x), safe_sqrt(1 - r * r)};
}

}  // namespace ajar
