// Enters: which joins between regions of the scene were free, and which were blocked.
// Leaves: how likely two regions see each other, for whoever chooses what to join. A choice that this steers stays
// unbiased whatever it says: no pair is ruled out.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ajar {

/// Regions are the cells of the top level; where there are more of these than memory has room for, several share one.
/// Lists hold a value for each pair of them, by pair_index.
struct Views {
  uint32_t regions = 0;
  std::vector<float> tried, seen;  ///< joins so far, older ones counting less, and those of them that were free
  std::vector<uint8_t> chance;     ///< square root of the probability that a join is free, in steps of 1/255: what
                                   ///< choices are made by
};

/// Joins between regions since the last lesson: tried, free, in turns, for each pair.
struct ViewTallies {
  std::vector<uint32_t> counts;
};

inline constexpr uint32_t most_regions = 512, no_region = ~0u;
inline constexpr std::size_t bytes_of_pair = 2 * sizeof(float) + sizeof(uint8_t);

/// Pairs of so many regions, those of a region with itself too.
inline uint32_t pair_count(uint32_t regions) { return regions * (regions + 1) / 2; }
/// Either way round; the same however many regions there are.
inline uint32_t pair_index(uint32_t a, uint32_t b) { return pair_count(std::max(a, b)) + std::min(a, b); }

/// So many regions that so much memory has room for their pairs; most_regions at most.
inline uint32_t affordable_regions(double memory) {
  return std::min(most_regions, uint32_t(std::sqrt(2 * memory / double(bytes_of_pair) + 0.25) - 0.5));
}

/// Chances are stored in steps of it.
inline constexpr float chance_step = 1 / 255.0f;
/// Views::chance of two regions, 1 where either is not among those that are known.
inline float chance(const Views& v, uint32_t a, uint32_t b) {
  return a < v.regions && b < v.regions ? float(v.chance[pair_index(a, b)]) * chance_step : 1;
}
inline std::size_t bytes(const Views& v) { return v.tried.size() * bytes_of_pair; }
/// Counts of zero for its pairs.
ViewTallies start_tallies(const Views& views);
/// A join between two regions was tried; free: nothing was in its way. Threads may record at once.
void record_join(const Views& views, ViewTallies& tallies, uint32_t a, uint32_t b, bool free);
/// The next views, of so many regions: of older evidence the share kept counts.
Views learn_views(const Views& views, const ViewTallies& tallies, uint32_t regions, float kept);

}  // namespace ajar
