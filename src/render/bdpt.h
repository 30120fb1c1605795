// Enters: a join that a subpath found; what a vertex received.
// Leaves: the one weighed, where it belongs; what the other teaches. For both halves of bidirectional path tracing.
#pragma once

#include "contribution.h"

namespace ajar {

inline float weigh(const Work& work, Candidate& c) {
  c.shares.inner = work.job.walk.inner_share, c.shares.seen = work.job.walk.seen_share;
  c.shares.merge_inner = work.job.walk.merging.inner, c.shares.first_seen = work.job.walk.first_seen;
  if (!work.job.next_event) c.shares.light_first = 0;
  return float(weight(work.job.walk.heuristic, c));
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

/// Radiance that a vertex is expected to scatter, never less than this share of a typical value: errors are judged
/// against it.
inline float expected_radiance(const Fields& fields, const Guide& guide, float least) {
  const double out = scatters(guide) * fields.q.cells[guide.cell].total;
  return float(std::sqrt(sqr(out) + sqr(double(least) * fields.q.unit)));
}

/// What a pixel's error counts for where the lens sees this vertex: errors are judged relative to the image, so the
/// lens's importance is divided by what the field expects the pixel to be. (G5)
inline float relative_importance(const Fields& fields, const Guide& guide) {
  return float(fields.q.unit) / expected_radiance(fields, guide, 0.02f);
}

/// radiance: Escape::radiance.
inline Escape escape_of(const Subpath& subpath, const Walk& walk, float radiance) {
  const float arrived = luminance(subpath[subpath.n - 1].beta);
  return {walk.d, float(walk.pdf), radiance, arrived > 0 ? luminance(walk.beta) / arrived : 0};
}

/// What a vertex received from the light, or the lens, itself: nothing where something is in the way.
inline void teach_direct(const Work& work, Vertex& v, float received) {
  const Guide& guide = v.guide;
  if (!work.sample.teaches || !work.job.guided || guide.cell == none) return;
  const Fields& fields = *work.job.walk.fields;
  if (guide.side == Side::light) received *= relative_importance(fields, guide);
  v.received = received;
  record_direct(fields.of(guide.side), work.job.training->of(guide.side), guide.cell, received);
  charge(work.scratch, work.scratch.ledger->learn_ticks);
}

/// The light subpath, and t = 1 at every vertex. The light itself, s = 1, is left to the camera ray that sees it.
void trace_light_subpath(Work& work);

}  // namespace ajar
