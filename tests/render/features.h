// Leaves: one small scene for each feature, with the integrators that can sample all of its light.
#pragma once

#include <ostream>
#include <span>
#include <vector>

#include "ajar/path/prefix.h"
#include "ajar/scene/scene.h"

namespace ajar {

struct Feature {
  const char* name;
  Scene (*make)();
  const char* integrators = "pbl";  ///< initials of those that can
  int max_depth = -1;
  Heuristic heuristic = Heuristic::power;
  uint32_t effort = 1;  ///< factor on the passes, for mistakes that are faint: tests/mutants/list has one for each
};
inline void PrintTo(const Feature& f, std::ostream* out) { *out << f.name; }

std::vector<Feature> features();

}  // namespace ajar
