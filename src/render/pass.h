// Enters: the job of a render, its options, and its state after the passes so far.
// Leaves: what is traced next, and how: numbers of samples, of light subpaths, of joins.
#pragma once

#include "ajar/render/render.h"
#include "job.h"

namespace ajar {

/// Chunks of the pass at hand that are traced at once, one after another in the film.
struct Pass {
  Job job;
  bool plain = false;   ///< path tracing in a guided integrator's place; nothing is learned
  uint32_t chunks = 0;  ///< how many; with job.light_half all light halves are traced before the camera halves, and
                        ///< their number depends on no thread and no clock
};

/// Where it is time to, looks at what the passes so far have shown, and notes in the state what is to be done from then
/// on. job: of the render (start.h).
Pass plan_pass(const Job& job, const RenderOptions& options, RenderState& state);

}  // namespace ajar
