// Light tracing alone: light subpaths, every vertex joined to the lens (t = 1).

#include "contribution.h"

namespace ajar {

void trace_light(const Job& job, Sample& sample, Scratch& scratch) {
  const Scene& scene = *job.scene;
  Sampler sampler = make_sampler(job.sampler, job.seed, Side::light, sample.path, sample.pass);
  Subpath& light = scratch.light;
  Walk walk;
  if (!start_light(scene, job.walk, sampler, light, walk)) return;
  ++scratch.counters.light_paths;
  Surface surface;
  for (;;) {
    Candidate c;
    const bool joins = light.n == 1 || connectable(light[light.n - 1].guide);
    if (joins && join_camera(scene, sample.lens, light, light.n, 1, job.walk.light_paths, c) &&
        is_unblocked(job, c.segment, light.n, 1, scratch))
      add_splat(job, sample, scratch, c.raster, c.value, c.value);
    if (joins) charge_join(scratch, light.n, 1);
    if (light.n >= job.walk.max_edges) return;
    if (light.n > 1 && !scatter(job.walk, sampler, light, walk)) return;
    ++scratch.counters.light_rays;
    const bool hit = step(scene, *job.accel, job.walk, light, walk, surface);
    charge(scratch, scratch.ledger->light_ticks);
    if (!hit) return;
  }
}

}  // namespace ajar
