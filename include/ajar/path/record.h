// Enters: a finished subpath.
// Leaves: what it teaches the fields, as records in a training.
#pragma once

#include "ajar/field/training.h"
#include "ajar/path/vertex.h"

namespace ajar {

/// Every segment between two vertices that scatter teaches four entries, whoever traced it: Q and W at either end (G2);
/// with Rule::returned one, the field of its side where it was sent from.
void record_subpath(const Fields& fields, Training& training, Sightings& sightings, const Subpath& subpath, Side side);

/// The vertex was here; ng: its geometric normal.
inline void record_place(const Guide& guide, const Vec3& ng, Training& training, Sightings& sightings) {
  record_place({guide.cell, guide.missing}, facing(ng, guide.wo), training.of(guide.side), sightings);
}

/// Cosine of what panes turn light by: their two refractions shift it, and hardly turn it.
inline constexpr float straight_on = 0.999f;
/// Density per solid angle with which the other side's subpaths are taken to leave the vertex to the one before it:
/// as from a matt surface, but for their field (G3).
double back_density(const Vertex& v);

}  // namespace ajar
