// Enters: the frames of an animation, and those of a reference.
// Leaves: error and flicker per frame and over all; JSON, CSV and a plot of them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "ajar/film/picture.h"

namespace ajar {

/// What is known of one frame. NaN: not known (no reference, no frame before).
struct FrameFigures {
  int frame = 0;
  std::map<std::string, std::string> parameters;
  double seconds = 0, cpu_seconds = 0, spp = 0;
  double mean = 0;                            ///< of R, G and B
  double relmse = NAN, relmse_trimmed = NAN;  ///< as in metrics.h
  double flicker = NAN;                       ///< of the step from the frame before
};

/// Mean over pixels and channels of ((now - before) - (reference now - reference before))^2 / (reference now^2 + 0.01).
/// All four of one size, with channels R, G, B. Throws Error.
double flicker(const Picture& before, const Picture& now, const Picture& reference_before,
               const Picture& reference_now);

/// Means over the frames where a figure is known; NaN where it is nowhere.
struct SequenceFigures {
  double seconds = 0, cpu_seconds = 0, spp = 0, relmse = NAN, relmse_trimmed = NAN, flicker = NAN;
};
SequenceFigures mean_of(const std::vector<FrameFigures>& frames);

/// One object: "frames_done", "mean" and "frames". Unknown figures are null.
std::string sequence_json(const std::vector<FrameFigures>& frames);
/// A line of names, and one of each frame; unknown figures are left empty.
std::string sequence_csv(const std::vector<FrameFigures>& frames);
/// Error and flicker over frames, in two panels with logarithmic axes; without a reference, the mean and the seconds.
std::string sequence_svg(const std::vector<FrameFigures>& frames, const std::string& title);

}  // namespace ajar
