// Enters: a scene.
// Leaves: points on its surfaces where hemispheres may stand.
#pragma once

#include "ajar/field/cells.h"
#include "ajar/scene/scene.h"

namespace ajar {

/// Area of all surfaces, as often as they are placed [m^2].
double area(const Scene& scene);
/// So many Hammersley points spread over the surfaces by area (Dahm and Keller 2017, figure 7f). area: of them all.
std::vector<Probe> place_probes(const Scene& scene, uint32_t count, double& area);

}  // namespace ajar
