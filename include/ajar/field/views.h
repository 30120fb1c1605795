// Enters: which joins between regions of the scene were free, and which were blocked.
// Leaves: how likely two regions see each other, for whoever chooses what to join. A choice that this steers stays
// unbiased whatever it says: no pair is ruled out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ajar {

/// Regions are the cells of the top level. Matrices of regions x regions, symmetric.
struct Views {
  uint32_t regions = 0;
  std::vector<float> tried, seen;  ///< joins so far, older ones counting less, and those of them that were free
  std::vector<float> chance;       ///< square root of the probability that a join is free: what choices are made by
};

/// Joins between regions since the last lesson: tried, free, in turns.
struct ViewTallies {
  std::vector<uint32_t> counts;
};

inline constexpr uint32_t most_regions = 512, no_region = ~0u;

inline float chance(const Views& v, uint32_t a, uint32_t b) {
  return a < v.regions && b < v.regions ? v.chance[std::size_t(a) * v.regions + b] : 1;
}
inline std::size_t bytes(const Views& v) { return 3 * v.tried.size() * sizeof(float); }
ViewTallies start_tallies(const Views& views);
void record_join(const Views& views, ViewTallies& tallies, uint32_t a, uint32_t b, bool free);
/// The next views, of so many regions: of older evidence the share kept counts.
Views learn_views(const Views& views, const ViewTallies& tallies, uint32_t regions, float kept);

}  // namespace ajar
