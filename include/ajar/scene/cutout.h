// Enters: shapes with masks, or null, in their materials: outermost, inside of bump and normal maps, or in sums.
// Leaves: what a ray asks where it meets them: whether there is a surface at all.
#pragma once

#include "ajar/scene/scene.h"

namespace ajar {

/// Takes the masks off a shape's material. What they let pass is no surface to rays then: light goes through without a
/// bounce, and joins of subpaths see through it. In a sum (blend, mixture) they stay, and resolve() gives what is
/// stopped to the rest. Lamps keep their masks, since they shine where those let light pass too; so does what has holes
/// of its own on each side.
void cut_out(Scene& scene, Shape& shape);
/// Share of the rays that a point of a shape with masks stops, in [0, 1]. bary as in Hit.
float opacity(const Scene& scene, uint32_t shape, uint32_t prim, const Vec2& bary);
/// Whether it is 0 everywhere, as of the bsdf null.
bool is_open(const Scene& scene, const Shape& shape);

}  // namespace ajar
