// Enters: what the camera samples of a pixel brought, how much they varied, and what they had in common with those
// beside them.
// Leaves: how many of them each pixel is to have in a pass: more where the image is noisy.
#pragma once

#include <vector>

#include "ajar/film/film.h"

namespace ajar {

/// Sums over the camera samples of a pixel: luminance that one brings, filtered, without splats.
struct PixelSpread {
  float sum = 0, square = 0;
  uint32_t samples = 0;         ///< that the sums are of
  uint32_t counts[2] = {0, 0};  ///< in even passes and odd ones: numbers of their sequences that are used up
  float mean = 0, beside = 0;   ///< over passes: of their means, and of these times those of the pixel to the right
};

/// A pass is the mean of a pixel's samples in it, so that it counts as much in one pixel as in another. How many is
/// told by the pixels around it alone: points of a sequence lie where those before them do not, so that a pixel whose
/// own first points had a say would be too bright, or too dark. (A1)
struct Adaptive {
  std::vector<PixelSpread> spread;  ///< per pixel; empty until looked at
  uint32_t passes = 0;              ///< that it is of
  std::vector<uint8_t> counts;      ///< camera samples of each pixel in a pass; empty: one
  uint32_t first = 0;               ///< pass that it begins with, of those that were dropped, too; even
  static constexpr double most = 8;
};

/// Camera samples of a pixel in a pass.
inline uint32_t count_of(const Adaptive* adaptive, uint64_t pixel) {
  return adaptive && !adaptive->counts.empty() ? adaptive->counts[pixel] : 1;
}
/// In the mean of all pixels.
double mean_count(const Adaptive& adaptive);
/// In the mean, of the passes that it is of, with the part of the pass at work.
double samples_of_pass(const Film& film, const Adaptive& adaptive);
/// Passes of one camera sample each that would have drawn all numbers which were drawn so far.
uint32_t passes_drawn(const Film& film, const Adaptive& adaptive);
/// Notes the pass whose image the film has, and is about to take in.
void note_pass(const Film& film, Adaptive& adaptive);
/// Of another image to come: its samples go on from the numbers that are used up.
void forget_sums(Adaptive& adaptive);
/// Chooses the counts anew. Does nothing while there are fewer than two passes, or where the film is black.
void allot(const Film& film, Adaptive& adaptive);

}  // namespace ajar
