// Enters: a scene, options, a state that start_render made.
// Leaves: what all passes of the render have in common.
#pragma once

#include "ajar/render/render.h"
#include "job.h"

namespace ajar {

/// Throws Error where a state was not started for this scene and these options.
void check_state(const Scene& scene, const RenderOptions& options, const RenderState& state);
/// Traces the integrator, learns into the state; what differs from pass to pass is left to plan_pass.
Job make_job(const Scene& scene, const Accel& accel, const RenderOptions& options, RenderState& state);

}  // namespace ajar
