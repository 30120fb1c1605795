// Enters: an animation with frames to render.
// Leaves: their images, and fields for frames that follow.
#pragma once

#include "animation.h"

namespace ajar {

/// From the first frame whose fields are needed to the last that is missing. Throws Error, and Interrupted.
void render_frames(Animation&);

}  // namespace ajar
