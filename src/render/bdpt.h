// Enters: a join that a subpath found; what a vertex received.
// Leaves: the one weighed, where it belongs; what the other teaches. For both halves of bidirectional path tracing.
#pragma once

#include "job.h"

namespace ajar {

/// One camera sample with its light subpath, at work.
struct Work {
  const Job& job;
  Sample& sample;
  Scratch& scratch;
  double light_share = 1;  ///< of the light walk, for s = 2
  float pixel = -1;        ///< radiance that the pixel is expected to have; 0: fields do not know; -1: not asked yet
};

inline float weigh(const Work& work, Candidate& c) {
  c.shares.inner = work.job.walk.inner_share, c.shares.seen = work.job.walk.seen_share;
  c.shares.merge_inner = work.job.walk.merging.inner, c.shares.first_seen = work.job.walk.first_seen;
  if (!work.job.next_event) c.shares.light_first = 0;
  return float(weight(work.job.walk.heuristic, c));
}

/// Weighs a visible candidate and puts it where it belongs.
inline void add(Work& work, Candidate& c, int s, int t) {
  const float w = weigh(work, c);
  const Rgb weighted = c.value * w;
  if (!accept(weighted, work.sample, work.scratch)) return;
  if (t == 1) {
    work.scratch.splats->push_back({c.raster, weighted * work.scratch.halves->splat_counts});
    gain_splat(work.job, work.scratch);
  } else {
    work.sample.value += weighted;
    gain(work.scratch, s, t, weighted * work.sample.filter);
  }
  if (!work.scratch.strategies) return;
  // What the camera sample found gets its filter here; splats are filtered on the film.
  const Vec2 raster = t == 1 ? c.raster : Vec2(work.sample.x, work.sample.y);
  const float filter = t == 1 ? work.scratch.halves->splat_counts : work.sample.filter;
  work.scratch.strategies->push_back({s, t, raster, c.value * filter, weighted * filter});
}

inline bool add_if_visible(Work& work, Candidate& c, int s, int t) {
  ++work.scratch.counters.shadow_rays;
  ++work.scratch.ledger->at(s, t).rays;
  if (!is_unblocked(work.job, c.segment, t)) return false;
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
