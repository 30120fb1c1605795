// Enters: an albedo.
// Leaves: what the learned field Q holds, lesson by lesson, of a closed box whose answer is known.
#pragma once

#include <vector>

#include "ajar/field/learn.h"

namespace ajar::stress {

struct Lesson {
  uint32_t number = 0, passes = 0;  ///< passes traced until then
  double mean = 0;                  ///< radiance that Q expects, irradiance / pi, over cells as they are visited
  double most = 0;                  ///< of any cell
  size_t cells = 0;
};

/// Every wall emits 1: the radiance is 1 / (1 - albedo) everywhere, after lesson n at most 1 + albedo + ... to the n-th
/// term. What guided-path learns of it from images of size x size. LearnOptions::train 0: in so many passes, as a
/// render does; else one lesson a pass, of all paths, for so many. Short paths teach as long ones do, only fewer
/// entries.
std::vector<Lesson> lessons(float albedo, const LearnOptions& learn, uint32_t passes, int size = 16,
                            int max_depth = -1);

/// The first lesson whose mean is that share of the answer; 0 where none is. Were every entry updated in every lesson,
/// it would be lesson log(1 - share) / log(albedo): about 3 / (1 - albedo) for 0.95.
uint32_t lesson_of_convergence(const std::vector<Lesson>& all, float albedo, double share);

}  // namespace ajar::stress
