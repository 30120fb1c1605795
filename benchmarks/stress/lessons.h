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
/// term. What guided-path learns while it traces so many passes.
std::vector<Lesson> lessons(float albedo, Rule rule, uint32_t passes);

}  // namespace ajar::stress
