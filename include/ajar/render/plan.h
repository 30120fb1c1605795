// Enters: a scene with its accelerator, options with a budget.
// Leaves: which parts of the method the scene needs, from what it contains and from what a short pilot measured.
#pragma once

#include "ajar/render/render.h"

namespace ajar {

/// One integrator in the pilot.
struct Trial {
  std::string integrator;
  uint32_t passes = 0;   ///< that count; guided integrators dropped more
  double error = 0;      ///< relMSE of a sample, exposed
  double deviation = 0;  ///< standard deviation of that
  double unseen = 0;     ///< beyond that, of what its samples missed and others saw, at least
  double cost = 0;       ///< of a sample [us], reckoned from its rays, so that it does not depend on the clock
  double waste = 1;      ///< factor on the time: samples that are dropped since they only teach
  /// Time to equal error, carefully: what decides. Infinite where nothing but black was seen.
  double price() const { return (error + 2 * deviation + unseen) * cost * waste; }
};

/// A part of the method.
struct Part {
  std::string name;
  bool on = true;
  std::string why;
};

struct Plan {
  std::string integrator;     ///< to render with
  std::vector<Trial> trials;  ///< none: the budget is too small for a pilot, or there was nothing to decide
  std::vector<Part> parts;
  int width = 0, height = 0;  ///< of the pilot
  double seconds = 0, cpu_seconds = 0;
};

/// Share of the budget that the pilot may take.
inline constexpr double pilot_share = 0.04;

/// CPU seconds that a render of this size has to have for a pilot.
double least_budget(const Camera& camera);

/// Renders small images with every candidate and takes the one with the smallest price; the simpler of two unless the
/// other is a tenth better. The same plan for the same scene, seed and budget. The camera has another size while the
/// pilot runs. Where the monitor says stop, the plan is what is known by then.
Plan make_plan(Scene& scene, const Accel& accel, const RenderOptions& options, const Monitor& monitor);
/// The parts as the user names them, for `--plan LIST`: "camera-guiding,light-guiding,light-subpaths". Sets integrator
/// and guidance. Throws Error for a name or a combination that does not exist.
void apply_parts(const std::vector<std::string>& parts, RenderOptions& options);

}  // namespace ajar
