// Enters: what camera subpaths bring behind their first vertex, how much that varies, and what it costs.
// Leaves: how many of them are to go on.
#pragma once

#include <vector>

#include "ajar/film/film.h"
#include "ajar/path/walk.h"

namespace ajar {

/// Of a pixel, the sum and the sum of squares over passes of x: the luminance that its first sample found beyond its
/// first joined vertex, where roulette might have ended it; times the root of the pixel's samples in the pass, so that
/// x varies as their mean does.
struct Beyond {
  float sum = 0, square = 0;
};

/// More or fewer camera subpaths survive, until what lies beyond has the same share of the variance as of the work.
/// (G16)
struct Balance {
  static constexpr float least = 1, most = 16;
  float goes_on = least;      ///< times what (G6) and (G15) ask for
  uint32_t passes = 0;        ///< since it was looked at
  Counters work;              ///< of these
  std::vector<Beyond> found;  ///< per pixel, of the same; empty until there are any
};
/// Looks at it anew, and clears the sums. Does nothing where there are none.
void rebalance(const Film& film, Balance& balance);
/// Clears the sums: what they are of is in no image any more.
void forget_sums(Balance& balance);

}  // namespace ajar
