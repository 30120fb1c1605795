// Enters: small images that several integrators made of one scene, pass by pass.
// Leaves: how noisy a sample of each is, and how much of what others saw it missed.
#pragma once

#include <string>
#include <vector>

#include "ajar/film/film.h"

namespace ajar {

/// What one integrator saw: luminance of every pixel in every pass. Passes have the same numbers in all sights that are
/// judged together, so that camera rays are the same, and what is theirs alone (edges of a lamp in sight) is the same
/// noise in all.
struct Sight {
  int width = 0, height = 0;
  std::vector<std::vector<float>> passes;
  std::vector<double> sum;  ///< over passes, as the film has it
};
/// To be called whenever a pass has come in.
void look(const Film& film, Sight& sight);

/// Of one sample; relMSE as ajar compare has it, of the image exposed to a mean of a fifth.
struct Judgement {
  double error = infinity;  ///< without the worst 0.1 % of pixels; infinite where less than a tenth of the light
                            ///< was seen, or there is nothing to compare with
  double deviation = 0;     ///< standard deviation of that
  double unseen = 0;        ///< beyond that, of what the samples missed and others saw; at least
};
/// Of two sights or more: each is held against the others.
std::vector<Judgement> judge(const std::vector<Sight>& sights);

/// CPU time of a ray with all that hangs on it [us], about: benchmarks/ray_cost.sh (docs/results/plan.md). Costs are
/// reckoned from it, so that what is decided does not depend on the clock. For path, bdpt, and guided integrators of
/// images.
double ray_cost(const std::string& integrator);

}  // namespace ajar
