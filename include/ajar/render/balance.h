// Enters: what camera subpaths bring behind their first vertex, how much that varies, and what it costs.
// Leaves: how many of them are to go on.
#pragma once

#include <vector>

#include "ajar/film/film.h"
#include "ajar/path/walk.h"

namespace ajar {

/// Sums over the passes: luminance found in a pixel behind the first vertex that is joined, by a camera subpath that
/// roulette might have ended; of one in each pass, as it varies in the mean of all.
struct Beyond {
  float sum = 0, square = 0;
};

/// What roulette spares makes as large a share of the variance as of the work, or else more, or fewer, are to go on.
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
