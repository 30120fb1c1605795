// Enters: a bsdf.
// Leaves: how it divides light between the surface's two sides, and how good a guide a field alone is for it there.
#pragma once

#include "ajar/scene/bsdf.h"

namespace ajar {

/// Of what does not pass straight through; the same from both sides of the surface.
struct Breadth {
  float near = 0;     ///< for what stays on its side, without the bsdf: 0 for narrow lobes, 1 for diffuse ones
  float through = 0;  ///< share that is scattered, evenly, to the other side
};
/// Zeros where light is refracted: it hardly turns by it, which no field of a few dozen strata resolves, and what comes
/// from all over the other side says little of it (docs/results/guiding.md, "Light that comes through").
Breadth breadth_of(const Bsdf& bsdf);

}  // namespace ajar
