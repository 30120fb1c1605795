// Enters: nothing.
// Leaves: stiff and extreme scenes, each with what its image must be: the cases of the stress suite (docs/stress.md).
#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "ajar/render/render.h"

namespace ajar::stress {

/// A scene and the question whether its image is right. The right image is, in this order: answer, in every pixel and
/// channel; factor times the image of twin; the image that the judge makes of the case itself. None of them where
/// judge is empty: then it only has to end, without a rejected value. Where make throws an Error, that is the answer,
/// and refused says what it has to be about.
struct Case {
  std::string group;  ///< its first case is the ordinary one, which the others' noise and time are held against
  std::string name;
  std::function<Scene()> make;
  double answer = -1;  ///< negative: not known
  std::function<Scene()> twin = nullptr;
  double factor = 1;
  std::string judge = "path";
  bool path = true;   ///< rays that run into lights, and next-event estimation, can find all its light
  bool light = true;  ///< paths from the lights, joined to the lens, can find all its light
  std::vector<std::string> blind = {};  ///< further integrators that cannot find all its light (docs/limits.md)
  bool tails = false;  ///< noise has so long tails that small parts of the image look quiet: its mean alone is judged
  bool limit = false;  ///< it may be wrong, and docs/limits.md says why
  std::string refused = {};  ///< make is to throw an Error that says this; empty: it is to throw none
  double faint = 0;  ///< blocks below this part of the image's brightness are not judged: some never meet their light
  int max_depth = -1;
  uint32_t passes = 8;
  bool large = false;                                 ///< takes minutes or gigabytes: left out unless asked for
  std::function<void(LearnOptions&)> tune = nullptr;  ///< of guided integrators
  std::function<StoredFields()> fields = nullptr;     ///< what guided integrators begin with
  size_t least_cells = 0, most_cells = ~size_t(0);    ///< that fields must come to have
};

inline void PrintTo(const Case& c, std::ostream* out) { *out << c.group << ", " << c.name; }  // for GoogleTest

std::vector<Case> cases();
/// Those whose trouble is in the learned fields, and those that are to be refused; cases() has them too.
std::vector<Case> learning_cases();

}  // namespace ajar::stress
