// Enters: the scenes of an animation's frames, options.
// Leaves: its last frame, rendered as animations render it.
#pragma once

#include <functional>
#include <span>

#include "ajar/render/sequence.h"
#include "measure.h"

namespace ajar {

/// Fails the test where a value was rejected, passes are missing, or the image taught the fields. between: what becomes
/// of the carried fields after each frame's lessons; nothing: they stay as they are.
Picture last_frame(std::span<const Scene> frames, const RenderOptions& options, const SequenceOptions& sequence,
                   const std::function<void(Carried&)>& between = {});

}  // namespace ajar
