// Enters: vertices of light subpaths.
// Leaves: those near a place, for merging: a hash grid, the same for any number of threads.
#pragma once

#include <array>
#include <vector>

#include "ajar/join/mis.h"
#include "ajar/path/walk.h"

namespace ajar {

/// A vertex a_i, i >= 1, of a light subpath, with what merging reads of it: one cache line.
struct alignas(64) Photon {
  Vec3 p{0};
  int s = 0;        ///< vertices of the subpath up to this one
  Vec3 wi{0};       ///< to the vertex before, unit
  float fixed = 0;  ///< MergeSide
  Rgb beta{0};      ///< flux that arrives, times the number of light subpaths
  float slope = 0;
  Vec3 n{0};              ///< geometric normal on the side that the light arrives on
  bool straight = false;  ///< nothing but deltas lies between it and the light
};

/// Photons by the cell of a grid that they are in. The radius changes with the place, and so does the edge of the
/// cells: the least power of two that is not below a diameter. A cell's photons follow each other, with those of others
/// that share its hash.
struct PhotonMap {
  Merging merging;
  std::vector<Photon> photons;
  std::vector<uint32_t> begin;  ///< of each bucket; one more at the end; a power of two of buckets
};

using Photons = std::vector<Photon>;

/// Adds the vertices of a light subpath at which it can be merged, with s >= 2.
void add_photons(Photons& photons, const Subpath& light, Heuristic h, const SampleCounts& counts);
/// Puts all into the map, which forgets those that it held. Within a cell they keep their order. Throws Error
/// from 2^31 of them on.
void fill(PhotonMap& map, const Merging& merging, const std::vector<const Photons*>& lists);

/// Buckets that hold all photons within the radius of a place, each once: of cells of two levels at most, 27 of the
/// finer and 8 of the coarser one.
struct Buckets {
  std::array<uint32_t, 35> of;
  int n = 0;
};
Buckets buckets_near(const PhotonMap& map, const Vec3& p, float radius);

/// Calls f(photon) for each within the radius of p.
template <class F>
void for_each_near(const PhotonMap& map, const Vec3& p, float radius, const F& f) {
  if (map.photons.empty()) return;
  const Buckets near = buckets_near(map, p, radius);
  for (int b = 0; b < near.n; ++b)
    for (uint32_t i = map.begin[near.of[size_t(b)]]; i < map.begin[near.of[size_t(b)] + 1]; ++i)
      if (length2(map.photons[i].p - p) < sqr(radius)) f(map.photons[i]);
}

}  // namespace ajar
