// Enters: nothing.
// Leaves: the vector, matrix and colour types of the house, and the few operations on them that GLM lacks.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>

namespace ajar {

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec4 = glm::vec4;
using Mat3 = glm::mat3;
using Mat4 = glm::mat4;
using Rgb = glm::vec3;  ///< Linear RGB with the sRGB / Rec. 709 primaries; radiometric unit as the name says.

static_assert(sizeof(Vec3) == 12 && alignof(Vec3) == 4 && alignof(Vec4) == 4 && alignof(Mat4) == 4,
              "Ajar's libraries hold GLM's types without alignment: leave GLM_FORCE_DEFAULT_ALIGNED_GENTYPES out");

inline constexpr float pi = std::numbers::pi_v<float>;
inline constexpr float inv_pi = std::numbers::inv_pi_v<float>;
inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline constexpr float one_minus_epsilon = 0x1.fffffep-1f;

inline float sqr(float x) { return x * x; }
inline double sqr(double x) { return x * x; }  // in double: a luminance of 1e20 has a square
inline float length2(const Vec3& v) { return glm::dot(v, v); }
inline float max_component(const Vec3& v) { return std::max(v.x, std::max(v.y, v.z)); }
inline float max_abs(const Vec3& v) { return std::max(std::abs(v.x), std::max(std::abs(v.y), std::abs(v.z))); }
/// v[axis], read by address: GLM's operator asks which axis it is.
inline float component(const Vec3& v, int axis) { return (&v.x)[axis]; }
inline bool is_black(const Rgb& c) { return c.x == 0 && c.y == 0 && c.z == 0; }
inline bool is_finite(const Vec3& v) { return std::isfinite(v.x + v.y + v.z); }
inline float safe_sqrt(float x) { return std::sqrt(std::max(x, 0.0f)); }
inline Vec3 map_vector(const Mat4& m, const Vec3& v) { return Vec3(m[0]) * v.x + Vec3(m[1]) * v.y + Vec3(m[2]) * v.z; }
inline Vec3 map_point(const Mat4& m, const Vec3& p) { return map_vector(m, p) + Vec3(m[3]); }
inline Mat4 inverse(const Mat4& m) { return Mat4(glm::inverse(glm::dmat4(m))); }

/// Relative luminance of linear Rec. 709 RGB (ITU-R BT.709).
inline float luminance(const Rgb& c) { return 0.212671f * c.x + 0.715160f * c.y + 0.072169f * c.z; }
inline double luminance(const glm::dvec3& c) { return 0.212671 * c.x + 0.715160 * c.y + 0.072169 * c.z; }
/// Over the channels, as errors are averaged (docs/notation.md, E1).
inline double mean(const glm::dvec3& channels) { return (channels.x + channels.y + channels.z) / 3; }

}  // namespace ajar
