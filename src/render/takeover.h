// Enters: what a guided integrator found so far.
// Leaves: whether path tracing takes its place, or merging is left out (L2).
#pragma once

#include "job.h"

namespace ajar {

struct Plain;
struct RenderState;

/// The job of path tracing in a guided integrator's place: as path would have it, on the same film.
Job plainly(Job job);
/// Whether the next pass merges: not where the radius is 0, nor once that was left out, unless nothing may be.
bool merges_still(const RenderOptions& options, const Plain& plain);
/// After 4, 8, 16 ... 64 passes of a guided integrator: whether path tracing takes over, in RenderState::plain (L2);
/// after 8, 16, 32 ..., where it did: whether it gives the render back, which then is as it was. Does nothing where
/// nothing may be left out, or fields know too little. job: of the render. Scratches' counters are left empty.
void try_plain(const Job& job, const RenderOptions& options, std::vector<Scratch>& scratches, RenderState& state);

}  // namespace ajar
