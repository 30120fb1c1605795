// Enters: a join that a subpath found; what a vertex received.
// Leaves: the one weighed, where it belongs; what the other teaches. For both halves of bidirectional path tracing.
#pragma once

#include "contribution.h"

namespace ajar {

inline float weigh(const Work& work, Candidate& c) {
  if (!work.job.next_event) c.nee.ratio = 0;
  return float(weight(work.job.walk.heuristic, c, work.job.walk.counts));
}

/// Weighs a visible candidate and puts it where it belongs.
inline void add(Work& work, Candidate& c, int s, int t) {
  const Rgb weighted = c.value * weigh(work, c);
  if (t == 1)
    add_splat(work.job, work.sample, work.scratch, c.raster, c.value, weighted);
  else
    add_to_pixel(work.sample, work.scratch, s, t, c.value, weighted);
}

inline bool add_if_visible(Work& work, Candidate& c, int s, int t) {
  if (!is_unblocked(work.job, c.segment, s, t, work.scratch)) return false;
  add(work, c, s, t);
  return true;
}

/// radiance: Escape::radiance.
inline Escape escape_of(const Subpath& subpath, const Walk& walk, float radiance) {
  const float arrived = luminance(subpath[subpath.n - 1].beta);
  return {walk.d, float(walk.pdf), radiance, arrived > 0 ? luminance(walk.beta) / arrived : 0};
}

/// What a vertex received from lights, or from the lens, themselves: on either side of its surface (Guide).
struct Received {
  float near = 0, far = 0;
};
inline void add(Received& sum, const Guide& guide, const Candidate& c, float share) {
  const bool far = guide.through > 0 && is_far(guide, c.segment.d);
  (far ? sum.far : sum.near) += luminance(c.arrives) * share;
}
/// Nothing where something is in the way.
inline void teach_direct(const Work& work, Vertex& v, const Received& received) {
  const Guide& guide = v.guide;
  if (!work.sample.teaches || !work.job.guided || !is_known(guide)) return;
  const Fields& fields = *work.job.walk.fields;
  const float scale = guide.side == Side::light ? relative_importance(fields, guide) : 1;
  v.received = scale * glm::mix(received.near, received.far, guide.through);
  const Field& field = fields.of(guide.side);
  Tallies& tallies = work.job.training->of(guide.side);
  record_direct(field, tallies, guide.cell, scale * received.near);
  if (guide.far_cell != none) record_direct(field, tallies, guide.far_cell, scale * received.far);
  charge(work.scratch, &Ledger::learn_ticks);
}

/// The light subpath, and t = 1 at every vertex. The light itself, s = 1, is left to the camera ray that sees it.
void trace_light_subpath(Work& work);

}  // namespace ajar
