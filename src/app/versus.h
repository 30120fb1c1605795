// Enters: a finished render.
// Leaves: how much error another integrator would have left in the same time.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "ajar/render/render.h"

namespace ajar {

/// Of the budget, that the other integrator has.
inline constexpr double versus_share = 0.1;

struct Versus {
  std::string integrator;  ///< empty: nothing was compared
  double seconds = 0, cpu_seconds = 0, spp = 0;
  ErrorEstimate error;     ///< after that time
  ErrorEstimate expected;  ///< after the CPU time of the render that it is held against: error falls as 1 / time
};

/// Throws Error unless both are known and the other one's error falls as 1 / time: guided ones drop passes, and
/// merging ones are biased. integrator may be none, where it is not known yet.
void check_versus(const std::string& other, const std::string& integrator);
/// Renders with the other integrator, all other options alike, for a ninth of the time that the render took. Infinite
/// errors where that is too short for two passes.
Versus run_versus(const Scene& scene, const Accel& accel, RenderOptions options, const std::string& other,
                  const RenderState& done, const Monitor& monitor);
/// A line for the user.
std::string describe(const Versus& versus, const RenderState& done);
nlohmann::ordered_json to_json(const Versus& versus, const RenderState& done);

}  // namespace ajar
