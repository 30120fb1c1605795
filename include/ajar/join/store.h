// Enters: light subpaths of many samples.
// Leaves: for a camera vertex, one of all their vertices to join, drawn by what it is expected to bring.
#pragma once

#include <span>

#include "ajar/core/sampler.h"
#include "ajar/path/walk.h"

namespace ajar {

/// Vertices of light subpaths that can be joined (s >= 2), and all vertices that their joins read.
struct LightStore {
  /// What a choice reads of a vertex.
  struct Place {
    Vec3 p{0};
    float flux = 0;  ///< luminance that it scatters at right angles, taken as diffuse [per area and solid angle]
    Vec3 n{0};       ///< shading normal on the side that it is lit from
    float near = 0;  ///< (J1): geometry terms above 1 / near make the join the lesser strategy
    uint32_t region = no_region;
    uint32_t first = 0;  ///< of its subpath among the vertices
    int s = 0;           ///< vertices of the subpath up to this one
    float share = 1;     ///< of the subpath's walk (walk.h, first_share)
    bool opaque = true;
  };
  std::vector<Vertex> vertices;
  std::vector<Place> places;
  uint32_t paths = 0;  ///< light subpaths that were tried, those that brought no vertex too

  std::span<const Vertex> subpath(const Place& at) const { return {vertices.data() + at.first, size_t(at.s)}; }
};

struct StoreChoice {
  const LightStore::Place* place = nullptr;
  float weight = 0;  ///< with which the join counts: its sum over all places and light subpaths, for one subpath
};

void clear(LightStore& store);
/// inner as in WalkOptions; share of the walk.
void add(LightStore& store, const Subpath& light, double share, double inner);
/// Draws from a few candidates, themselves drawn evenly, in proportion to what they would bring unoccluded times the
/// chance that they are seen (Talbot et al. 2005). most: largest s. False where none would bring anything. Takes one
/// pair of numbers.
bool choose(const LightStore& store, const Vertex& camera, double inner, int most, Sampler& sampler, StoreChoice& out);

}  // namespace ajar
