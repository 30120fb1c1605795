// Enters: a render, finished or at work.
// Leaves: what its time went into and what that brought, as JSON: the same in the record of an image, in its log, and
// in the results of a bench.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "ajar/render/render.h"

namespace ajar {

/// A render's seconds split into "trace", "learn" (recording what paths see, as a share of tracing estimated from the
/// timed samples) and "rebuild" (making the next fields between passes).
nlohmann::ordered_json phases_json(double seconds, double between_passes, const TimedTicks& ticks);

/// Adds to a record "mean_path_edges", "light_subpaths_per_sample", "camera_samples_of_a_pass" where guided passes have
/// them, "goes_on", "zero_contribution_paths", "tracing" (shares of the tracing time), "fields" where anything is
/// learned, "caustics", "merges" where there are any, and "strategies": a list of {s, t, joins, rays, visible, energy,
/// time}, energy as a share of the image's, time as a share of tracing.
void add_account(nlohmann::ordered_json& record, const RenderState& state);

/// The most memory that this process has had.
double peak_bytes();

}  // namespace ajar
