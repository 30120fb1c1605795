// Enters: what a strategy found, before visibility or after.
// Leaves: it in its pixel, on the film and in the strategy's image; what it brought and cost in the ledger.
#pragma once

#include "job.h"

namespace ajar {

/// The time since the last charge goes to a part of the ledger.
inline void charge(Scratch& scratch, uint64_t& part) {
  if (scratch.clock == 0) return;
  const uint64_t now = clock_ticks(), took = now - scratch.clock;
  if (took < interrupted_ticks) part += took;
  scratch.clock = now;
}

inline void charge(Scratch& scratch, uint64_t Ledger::*part) {
  if (scratch.clock != 0) charge(scratch, scratch.ledger->*part);  // where nothing is timed there may be no ledger
}

/// A join was tried, with success or without.
inline void charge_join(Scratch& scratch, int s, int t) {
  StrategyCost& cost = scratch.ledger->at(s, t);
  ++cost.joins;
  scratch.counters.joins += t > 1;
  charge(scratch, cost.ticks);
}

/// Traces the shadow ray of a join to the t-th camera vertex; the first is the lens.
inline bool is_unblocked(const Job& job, const Segment& s, int t) {
  return t == 1 ? camera_sees(*job.scene, *job.accel, s.o, s.d, s.t_max) : visible(*job.accel, s);
}
/// The same, counted as one of strategy (s, t).
inline bool is_unblocked(const Job& job, const Segment& segment, int s, int t, Scratch& scratch) {
  ++scratch.counters.shadow_rays;
  ++scratch.ledger->at(s, t).rays;
  return is_unblocked(job, segment, t);
}

/// Law 6: only finite, non-negative values may go on; others are counted, and the path of the first is kept.
inline bool accept(const Rgb& value, uint64_t path, Scratch& scratch) {
  if (value.x >= 0 && value.y >= 0 && value.z >= 0 && value.x + value.y + value.z < infinity) return true;
  ++scratch.rejected;
  if (scratch.rejected_at == Scratch::no_path) scratch.rejected_at = path;
  return false;
}

/// Notes what a join adds to its pixel; its luminance.
inline double gain(StrategyCost& cost, const Rgb& pixel) {
  ++cost.visible;
  const float energy = luminance(pixel);
  if (!(std::abs(energy) < infinity)) return 0;
  cost.energy += double(energy);
  return double(energy);
}

/// On request alone, and not to be in the way of what is asked for each time.
[[gnu::noinline]] inline void show(std::vector<Strategy>& strategies, const Strategy& found) {
  strategies.push_back(found);
}

/// Adds what strategy (s, t) found, raw and weighted, to the sample's own pixel. s < 0: by merging (see Strategy).
inline void add_to_pixel(Sample& sample, Scratch& scratch, int s, int t, const Rgb& raw, const Rgb& weighted) {
  if (!accept(weighted, sample.path, scratch)) return;
  sample.value += weighted;
  const Rgb filtered = weighted * sample.weight;
  gain(s < 0 ? scratch.ledger->merge_at(-s, t) : scratch.ledger->at(s, t), filtered);
  if (scratch.strategies) show(*scratch.strategies, {s, t, Vec2(sample.x, sample.y), raw * sample.weight, filtered});
}

/// Whether light came to the subpath's last vertex by way of a delta event.
inline bool came_by_delta(const Subpath& light) {
  for (int i = 1; i + 1 < light.n; ++i)
    if (light[i].delta) return true;
  return false;
}

/// Notes what the light subpath's last vertex adds to the image, splatted there; the filter's integral is 1. What
/// filters carry over the border of the film, one way and the other, is taken for equal.
inline void gain_splat(const Job& job, const Splat& splat, Scratch& scratch) {
  const Camera& c = job.scene->camera;
  const Vec2 at = splat.raster - Vec2(c.crop_x, c.crop_y);
  const bool inside = at.x >= 0 && at.y >= 0 && at.x < float(c.crop_width) && at.y < float(c.crop_height);
  const Rgb pixel = inside ? splat.value * float(1 / pixels_of(c)) : Rgb(0);
  const double energy = gain(scratch.ledger->at(scratch.light.n, 1), pixel);
  if (came_by_delta(scratch.light)) scratch.ledger->caustics += energy;
}

/// Splats what the light subpath's last vertex brings the lens, raw and weighted; the film filters it.
inline void add_splat(const Job& job, const Sample& sample, Scratch& scratch, const Vec2& raster, const Rgb& raw,
                      const Rgb& weighted) {
  if (!accept(weighted, sample.path, scratch)) return;
  const float counts = scratch.halves->splat_counts;
  scratch.splats->push_back({raster, weighted * counts});
  gain_splat(job, scratch.splats->back(), scratch);
  if (scratch.strategies) show(*scratch.strategies, {scratch.light.n, 1, raster, raw * counts, weighted * counts});
}

}  // namespace ajar
