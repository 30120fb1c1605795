// Enters: a case of the stress suite and an integrator.
// Leaves: what came of rendering it, and whether that is right.
#pragma once

#include "cases.h"
#include "kit/walls.h"
#include "kit/ztest.h"

namespace ajar::stress {

/// Independent renders of a case.
struct Outcome {
  int width = 0, height = 0;
  std::vector<std::vector<double>> runs;  ///< images, divided by the case's factor
  std::string refusal;                    ///< why it was not rendered
  uint64_t rejected = 0;
  std::string replay;      ///< of the first rejected value
  double paths = 0;        ///< camera samples in all images
  double cpu_seconds = 0;  ///< of rendering them, learning included
  size_t cells = 0;        ///< of the last render's fields
  double noise = 0;        ///< root of the mean variance of one pass, over the mean brightness
};

/// batches: of renders with seeds of their own, each of so many times the case's passes. walls: kept from render to
/// render of the case, for whom their time does not matter.
Outcome run(const Case& c, const std::string& integrator, int batches, double passes = 1, CellTable* walls = nullptr);
/// What the image ought to be; runs of the judge or twin, with other seeds, if they must be made. Nothing where it is
/// not known.
Outcome reference(const Case& c, int batches);
/// Whether the integrator can find all the light of the case.
bool can_find(const Case& c, const std::string& integrator);
/// Whether it is held to its own image of the same scene, which says that it ends and no more.
bool judges_itself(const Case& c, const std::string& integrator);

struct Verdict {
  bool ok = false;
  double p = 1;         ///< that noise alone makes such a difference
  double noticed = 0;   ///< least share of the image, of some steps, that would be missed; infinity: none would
  std::string message;  ///< what is wrong
};
/// Merging is biased by what its radius blurs: it is allowed a deviation of a fiftieth of the brightness in every
/// block, besides noise, so that a tenth is too much. A case in which half of the image would not be missed is wrong.
Verdict judge(const Case& c, const std::string& integrator, const Outcome& outcome, const Outcome& reference);

}  // namespace ajar::stress
