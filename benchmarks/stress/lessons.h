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
};

/// Every wall emits 1: the radiance is 1 / (1 - albedo) everywhere, after lesson n at most 1 + albedo + ... to the n-th
/// term. What guided-path learns of it. LearnOptions::train 0: in so many passes, as a render does; else one lesson a
/// pass, of all paths, for so many.
std::vector<Lesson> lessons(float albedo, const LearnOptions& learn, uint32_t passes);

/// The first lesson whose mean is at least 1 - 1/e of the answer, where a fixed-point iteration that contracts with the
/// albedo is after 1/(1 - albedo) lessons; 0 where none is.
uint32_t lesson_of_convergence(const std::vector<Lesson>& all, float albedo);

}  // namespace ajar::stress
