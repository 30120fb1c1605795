// Enters: a camera vertex, and a block of light vertices.
// Leaves: what each of their joins is expected to bring.
#pragma once

#include "ajar/join/store.h"
#include "ajar/scene/bsdf/gloss.h"

namespace ajar {

using Values = LightStore::Values;

/// A camera vertex, as joins with many lights see it.
struct Seer {
  const Vertex* vertex = nullptr;
  Gloss gloss;
  float near = 0;         ///< as Block::near, of the camera vertex
  float near_lights = 1;  ///< factor on Block::near
};

/// Up to a factor that all of a camera vertex share: unoccluded, with the weight against the camera subpath that finds
/// the light vertex, or the light subpath that finds the camera's (J1). Nothing of those with s above most.
void expect(const LightStore::Block& block, const Seer& seer, int most, Values& out);
/// Times the chance that they are seen from a region.
void apply_chances(const LightStore::Block& block, const Views& views, uint32_t region, Values& values);

}  // namespace ajar
