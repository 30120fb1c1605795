// Enters: numbers up to 1.7e38.
// Leaves: the angle that they make, in less time than the standard library takes.
#pragma once

#include <algorithm>
#include <cmath>

namespace ajar {

/// Within 3e-7 [rad] of std::atan2, whose signs and quadrants it has; (0, 0) is 0 or pi as there. Minimax polynomial of
/// the arc tangent up to tan(pi/8) by Moshier (Cephes, single precision); no branches.
inline float fast_atan2(float y, float x) {
  constexpr float pi_2 = 1.57079633f, pi_4 = 0.78539816f, tangent = 0.41421356f;  // tan(pi/8)
  const float ax = std::abs(x), ay = std::abs(y), large = std::max(ax, ay), small = std::min(ax, ay);
  const bool steep = small > tangent * large;  // atan(q) = pi/4 + atan((q - 1) / (q + 1))
  const float over = steep ? small - large : small, under = steep ? small + large : large;
  const float q = under > 0 ? over / under : 0, z = q * q;
  const float series = ((8.05374449538e-2f * z - 1.38776856032e-1f) * z + 1.99777106478e-1f) * z - 3.33329491539e-1f;
  float angle = series * z * q + q + (steep ? pi_4 : 0);
  angle = ay > ax ? pi_2 - angle : angle;
  angle = std::signbit(x) ? 2 * pi_2 - angle : angle;
  return std::copysign(angle, y);
}

}  // namespace ajar
