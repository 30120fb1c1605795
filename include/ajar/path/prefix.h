// Enters: densities of a subpath's vertices as either side would have generated them.
// Leaves: the running sum over strategies with which MIS weighs a join in constant time. Pure functions.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace ajar {

enum class Heuristic : uint8_t { balance, power };  ///< power: exponent 2 (Veach 1997, section 9.2.3)
inline constexpr const char* heuristic_names[] = {"balance", "power"};

/// Ratio of densities under the heuristic.
inline double raise(Heuristic h, double ratio) { return h == Heuristic::power ? ratio * ratio : ratio; }
/// Bounded, like the sums below: nothing overflows, and no infinity meets a zero.
inline constexpr double largest_ratio = 1e150;
inline double ratio(double other, double own) {
  const double r = own > 0 ? other / own : 0;
  if (r < largest_ratio) return r;
  return std::isnan(r) ? 0 : largest_ratio;  // zero times infinity, where two vertices are one point
}

/// How many samples the strategies of one kind take, as factors on their densities; the same for all paths of a pass.
struct SampleCounts {
  double light_paths = 1;  ///< t = 1: light subpaths of a pass, each of which may splat to any pixel; with 0, and inner
                           ///< and seen of 0, weights are of s = 0 and s = 1 alone
  double inner = 1;        ///< joins of two vertices that both were walked to (J7)
  double seen = 1;         ///< the same where the lens sees the camera's vertex, itself or by way of deltas (J7)
  double first_seen = 1;   ///< s = 1 where the lens sees its vertex, itself or by way of deltas (J7)
  double merge_inner = 1;  ///< merges beyond the first vertex at which a camera subpath is merged (K3)
};

/// What joins of two walked vertices count for; seen: whether the lens sees the camera's. (J7)
inline double join_count(const SampleCounts& n, bool seen) { return seen ? n.seen : n.inner; }

/// Weight of a strategy of this density against one other that finds the same path, of a sample of each.
inline float weight_against(Heuristic h, double own, double other) {
  return float(1 / (1 + raise(h, ratio(other, own))));
}

/// Prefix sum over the strategies that cut a subpath a_0 a_1 .. at or before vertex i (docs/method.md, R2):
///   S_i = v_i + r_(i-1) S_(i-1)
/// with r_j = (density of a_j from the other side / from its own), raised, and v_i what the strategy counts for
/// that connects a_(i-1) to a_i, raised: 0 where either event is a delta; for i = 1 its density over that of the
/// subpath's own a_0 (next-event estimation, splats); else how many of its joins there are (J7). S_0 is 1 where a_0 can
/// be hit by a ray, else 0.
inline double extend(double v, double raised_ratio, double sum_before) {
  return v + std::min(largest_ratio * largest_ratio, raised_ratio * sum_before);
}

/// m_i, what merging at a vertex of this density adds to v_i (K5).
inline double merge_at(Heuristic h, double own, double merge) { return raise(h, std::min(largest_ratio, own * merge)); }

}  // namespace ajar
