// Enters: a light subpath that was started.
// Leaves: its next vertex.
#pragma once

#include "job.h"

namespace ajar {

/// Follows the scratch's light subpath to its next vertex; false where it ends or escapes (Walk).
bool follow_light(const Job& job, Sampler& sampler, Scratch& scratch, Walk& walk, Surface& surface);

}  // namespace ajar
