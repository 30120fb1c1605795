// Enters: a scene that rays can be traced through.
// Leaves: where walls divide the cells of its surfaces: what two rooms receive has nothing in common, however near to
// each other they are.
#pragma once

#include "ajar/accel/accel.h"
#include "ajar/field/cells.h"

namespace ajar {

/// Cuts the cubes of level 0 into compartments, along planes that hardly any two points on either side see each other
/// across (G9), and leaves the portals in these planes. Points are where matt walks from the camera and the lights come
/// to; the same for the same scene.
void cut_along_walls(const Scene& scene, const Accel& accel, CellTable& table);

}  // namespace ajar
