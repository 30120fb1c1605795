// Enters: directions above a cell of a field.
// Leaves: the share of the field in each stratum of directions, as a tree that is fine where the field is strong:
// sample and density.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "ajar/core/angle.h"
#include "ajar/core/vec.h"

namespace ajar {

/// Sixteen strata, 4 x 4, of a square of directions; each may be divided again by a node of its own. Shares are
/// cumulative sums in steps of 2^-16.
struct StrataNode {
  uint16_t before[17] = {};  ///< share of the strata before this one; before[0] = before[16] = 0: all wrap around
  uint16_t divided = 0;      ///< bit i: stratum i has a node
  uint32_t children = 0;     ///< index of the first of these nodes; they follow each other

  bool operator==(const StrataNode&) const = default;
  uint32_t child(int i) const { return children + uint32_t(std::popcount(unsigned(divided & ((1u << i) - 1)))); }
  bool is_divided(int i) const { return (divided >> i) & 1; }
  /// Share of stratum i, in steps of 2^-16: less than all.
  uint32_t steps(int i) const { return uint16_t(before[i + 1] - before[i]); }
};

/// A number that is not negative in 16 bits, eight of them for the exponent: rounding errs by 2^-9 of it at most. What
/// is too large becomes the largest.
struct UFloat16 {
  uint16_t bits = 0;

  UFloat16() = default;
  UFloat16(float x) : bits(uint16_t(std::min((std::bit_cast<uint32_t>(std::max(x, 0.0f)) + 0x4000u) >> 15, most))) {}
  operator float() const { return std::bit_cast<float>(uint32_t(bits) << 15); }
  static constexpr uint32_t most = 0xfeff;
};

/// Levels of nodes at most: 4^5 = 1024 strata across the hemisphere.
inline constexpr int most_levels = 5;

/// The unit square over the hemisphere about +z: the unit disk of the direction's (x, y), stretched along its radii to
/// the square [-1,1]^2. Without trigonometry, so that both ways are exact to rounding.
/// density: area of the unit square per solid angle at the direction; with 1 for local.z, per area of the unit disk.
inline Vec2 to_square(const Vec3& local, float& density) {
  const float r2 = local.x * local.x + local.y * local.y, m = std::max(std::abs(local.x), std::abs(local.y));
  const float stretch = r2 > 0 ? std::sqrt(r2) / m : 1;
  density = 0.25f * local.z * stretch * stretch;
  const auto place = [&](float x) { return std::min(std::max(x * (0.5f * stretch) + 0.5f, 0.0f), one_minus_epsilon); };
  return {place(local.x), place(local.y)};
}
inline Vec2 to_square(const Vec3& local) {
  float density;
  return to_square(local, density);
}
inline Vec3 from_square(const Vec2& square) {
  const Vec2 a = 2.0f * square - 1.0f;
  const float l2 = glm::dot(a, a), m = std::max(std::abs(a.x), std::abs(a.y));
  const float shrink = l2 > 0 ? m / std::sqrt(l2) : 0;
  return {a.x * shrink, a.y * shrink, safe_sqrt(1 - m * m)};
}
/// The density of to_square alone.
inline float square_density(const Vec3& local) {
  const float x2 = local.x * local.x, y2 = local.y * local.y, m2 = std::max(x2, y2);
  return local.z * (m2 > 0 ? (x2 + y2) / m2 : 1) * 0.25f;
}

/// The other division (Comi 2019, 3.2.2): zones of the hemisphere of equal height, each cut into segments: 72 patches
/// of equal solid angle. They are a tree of two levels, zones and segments, in the last of a node's sixteen places; the
/// places before them are empty.
inline constexpr int zones = 6, segments = 12, no_zones = 16 - zones, no_segments = 16 - segments;
inline constexpr float patch_angle = 2 * pi / (zones * segments);  ///< [sr]

/// Places of a direction's zone and segment.
struct Patch {
  int zone = no_zones, segment = no_segments;
};
inline Patch patch_of(const Vec3& local) {
  const float turn = fast_atan2(local.y, local.x) / (2 * pi);
  const int zone = int(local.z * zones), segment = int((turn < 0 ? turn + 1 : turn) * segments);
  return {no_zones + std::clamp(zone, 0, zones - 1), no_segments + std::clamp(segment, 0, segments - 1)};
}
/// Integral of the cosine over a patch of this zone [sr].
inline float patch_cosine(int zone) { return patch_angle * (float(zone - no_zones) + 0.5f) / zones; }

/// Density per solid angle of the patches under node root.
float patch_density(const std::vector<StrataNode>& nodes, uint32_t root, const Vec3& local);
/// Draws a direction, uniform within its patch; u in [0,1)^2. Leaves its density per solid angle.
Vec3 sample_patch(const std::vector<StrataNode>& nodes, uint32_t root, const Vec2& u, float& density);

/// Draws a point of the unit square; u in [0,1)^2. Leaves its density.
Vec2 sample(const std::vector<StrataNode>& nodes, uint32_t root, const Vec2& u, float& density);

/// Strata that a point of the unit square is in, from the root down.
class Descent {
 public:
  explicit Descent(const Vec2& at) : at_(uint32_t(at.y * finest) << 16 | uint32_t(at.x * finest)) {}
  /// Stratum at the next level; most_levels times at most, and one more where they are odd.
  int next() {
    shift_ -= 2;
    return int((at_ >> (shift_ + 14) & 12) | (at_ >> shift_ & 3));
  }

 private:
  static constexpr int levels = most_levels + most_levels % 2;
  static constexpr float finest = 1 << 2 * levels;  // strata of the last of these levels along an edge
  uint32_t at_;                                     // y << 16 | x
  int shift_ = 2 * levels;
};

/// What is below a leaf: strata that are even, and change nothing.
inline constexpr StrataNode leaf_strata{{0, 1 << 12, 2 << 12, 3 << 12, 4 << 12, 5 << 12, 6 << 12, 7 << 12, 8 << 12,
                                         9 << 12, 10 << 12, 11 << 12, 12 << 12, 13 << 12, 14 << 12, 15 << 12, 0}};

/// A point's way down a tree, with the density over the square that the strata so far have. Two levels at a time, where
/// most leaves are, without branches, which would be guessed wrong. Past the leaf come strata that change nothing.
class Way {
 public:
  Way(const StrataNode* nodes, uint32_t root, const Vec2& at) : nodes_(nodes), node_(nodes + root), down_(at) {}
  void go_on() {
    const float upper = enter(), lower = enter();
    density_ = density_ * upper * lower * 0x1p-24f;
  }
  bool goes_on() const { return node_ != &leaf_strata; }
  float density() const { return density_; }

 private:
  // Share of the stratum at the next level, in steps of 2^-12 of an even one.
  float enter() {
    const StrataNode& at = *node_;
    const int i = down_.next();
    const uint32_t steps = at.steps(i);
    const uintptr_t leaf = uintptr_t(&leaf_strata), below = uintptr_t(nodes_) + at.child(i) * sizeof(StrataNode);
    node_ = reinterpret_cast<const StrataNode*>(leaf ^ ((leaf ^ below) & -uintptr_t(at.is_divided(i))));
    return float(int(steps));
  }

  const StrataNode *nodes_, *node_;
  Descent down_;
  float density_ = 1;
};

/// Density over the unit square of the tree under node root.
inline float density(const std::vector<StrataNode>& nodes, uint32_t root, const Vec2& at) {
  Way way(nodes.data(), root, at);
  do {
    way.go_on();
  } while (way.goes_on());
  return way.density();
}

}  // namespace ajar
