// Light tracing alone: light subpaths, every vertex joined to the lens (t = 1).

#include "job.h"

namespace ajar {

Rgb trace_light(const Job& job, const PixelSample& sample, const Vec2&, const Vec2& lens, Sampler&, Scratch& scratch) {
  const Scene& scene = *job.scene;
  Sampler sampler = make_sampler(job.sampler, job.seed, Side::light, sample.path, sample.pass);
  Subpath& light = scratch.light;
  Walk walk;
  if (!start_light(scene, sampler, light, walk)) return Rgb(0);
  ++scratch.counters.light_paths;
  Surface surface;
  for (;;) {
    Candidate c;
    if (join_camera(scene, lens, light, light.n, 1, job.walk.light_paths, c)) {
      ++scratch.counters.shadow_rays;
      if (visible(*job.accel, c) && accept(c.value, scratch)) scratch.splats->push_back({c.raster, c.value});
    }
    if (light.n >= job.walk.max_edges) break;
    if (light.n > 1 && !scatter(job.walk, sampler, light, walk)) break;
    ++scratch.counters.light_rays;
    if (!step(scene, *job.accel, job.walk, light, walk, surface)) break;
  }
  return Rgb(0);
}

}  // namespace ajar
