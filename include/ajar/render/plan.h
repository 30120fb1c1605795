// Enters: a scene, options with a budget.
// Leaves: which parts of the method the scene needs, from what it contains, what there is time for, and what a small
// render shows.
#pragma once

#include <optional>

#include "ajar/render/render.h"

namespace ajar {

/// A part of the method.
struct Part {
  std::string name;
  bool on = true;
  std::string why;
};

/// What the first passes of guided-bdpt showed, beside path tracing of some squares. (L2)
struct Pilot {
  int width = 0, height = 0;
  uint32_t passes = 0;           ///< of guided-bdpt when they were compared last; 0: nothing could be compared
  double ratio = 0;              ///< path tracing's error over guided-bdpt's after equal time
  bool plain = false;            ///< path tracing takes over
  bool settled = false;          ///< else the render goes on comparing
  double guided = 0;             ///< relMSE of a sample of guided-bdpt
  double path = 0;               ///< of path tracing, with what it has not seen
  double path_for_one = 0;       ///< samples of path tracing in the time of one
  double cpu_seconds = 0;        ///< of the pilot
  double budget = infinity;      ///< CPU seconds of the render; infinite where its noise alone ends it
  double saved_seconds() const;  ///< CPU, to equal error, by leaving out the worse of the two; nine budgets at most
  bool saves_more() const;       ///< than saved_seconds() says, which trusts no ratio beyond ten
};

struct Plan {
  std::string integrator;  ///< to render with
  std::vector<Part> parts;
  std::optional<Pilot> pilot;
};

/// CPU seconds that a render of this size has to have for learning to pay.
double least_budget(const Camera& camera);

/// guided-bdpt, which leaves the render to path tracing where that turns out to be enough (plain.h); path where there
/// is nothing to join, bdpt where there is no time to learn. Takes no time itself.
Plan make_plan(const Scene& scene, const RenderOptions& options);
/// Tells beforehand what the render will find out, by a small image of it, and notes that in the plan. The same for the
/// same scene, seed and budget. The camera has another size meanwhile, and its own again also where something throws.
/// Where the monitor says stop, nothing is noted.
void run_pilot(Scene& scene, const Accel& accel, const RenderOptions& options, const Monitor& monitor, Plan& plan);
/// The parts as the user names them, for `--plan LIST`: "camera-guiding,light-guiding,light-subpaths". Sets integrator
/// and guidance. Throws Error for a name or a combination that does not exist.
void apply_parts(const std::vector<std::string>& parts, RenderOptions& options);

}  // namespace ajar
