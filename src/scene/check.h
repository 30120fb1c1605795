// Enters: a scene as the loader or code made it, before anything is derived.
// Leaves: an Error that names the first of its parts that does not fit the others; else every index leads somewhere.
#pragma once

#include "ajar/scene/scene.h"

namespace ajar {

/// What finish() takes for granted. One pass over the triangles, in parallel; of all else sizes and indices alone.
void check_parts(const Scene& scene);
/// Of a camera alone.
void check_camera(const Camera& camera);

}  // namespace ajar
