// Enters: independent renders (batches) of one scene by two integrators.
// Leaves: whether the two agree, and one image of both with its noise. How and why: docs/bench.md, "References".
#pragma once

#include <array>
#include <vector>

#include "ajar/film/picture.h"

namespace ajar {

/// An image with channels R, G, B, and how many samples per pixel it is worth.
struct ReferenceBatch {
  Picture image;
  double spp = 0;
};
using Batches = std::vector<ReferenceBatch>;

/// A mean of batches and the variance of that mean, from their spread.
struct Estimate {
  double mean = 0, variance = 0;
};

/// Difference of the means over one block of the image.
struct BlockTest {
  int x = 0, y = 0, width = 0, height = 0;
  char channel = 'R';
  Estimate first, second;
  double t = 0;  ///< of Welch's test; positive where the first is brighter
  double p = 1;  ///< two-sided, of this block alone
};

struct Agreement {
  double p = 1;     ///< probability of a block as far off as the worst, if all is noise (corrected for their number)
  BlockTest whole;  ///< of the whole image, the channel that is farthest off
  BlockTest worst;  ///< of all blocks
};

/// p below which two integrators disagree.
inline constexpr double least_agreement = 1e-4;

/// Both have at least two batches, all of one size.
Agreement agree(const Batches& first, const Batches& second);

struct Combined {
  Picture image;
  std::array<double, 2> weight{};  ///< of the two in the image, whole-image figures that sum to 1
  std::array<double, 2> relmse{};  ///< estimated, of each alone
  double relmse_both = 0;          ///< estimated, of the image
};
/// The mean of the two, each weighed by the inverse of its estimated error in the whole image.
Combined combine(const Batches& first, const Batches& second);

}  // namespace ajar
