// Light tracing alone: light subpaths, every vertex joined to the lens (t = 1).

#include "light.h"
#include "contribution.h"
#include "integrators.h"

namespace ajar {
namespace {

// t = 1 at the light subpath's last vertex; its first is the light itself.
void splat_last(const Job& job, const Sample& sample, Scratch& scratch) {
  const Subpath& light = scratch.light;
  if (light.n > 1 && !connectable(light[light.n - 1].guide)) return;
  Candidate c;
  if (join_camera(*job.scene, sample.lens, light, light.n, c) && is_unblocked(job, c.segment, light.n, 1, scratch))
    add_splat(job, sample, scratch, c.raster, c.value, c.value);
  charge_join(scratch, light.n, 1);
}

}  // namespace

bool follow_light(const Job& job, Sampler& sampler, Scratch& scratch, Walk& walk, Surface& surface) {
  Subpath& light = scratch.light;
  if (light.n >= job.walk.max_edges || (light.n > 1 && !scatter(job.walk, sampler, light, walk))) return false;
  ++scratch.counters.light_rays;
  const bool hit = step(*job.scene, *job.accel, job.walk, light, walk, surface);
  charge(scratch, &Ledger::light_ticks);
  return hit;
}

void trace_light(const Job& job, Sample& sample, Scratch& scratch) {
  Sampler sampler = make_sampler(job.sampler, job.seed, Side::light, sample.path, sample.pass);
  Walk walk;
  if (!start_light(*job.scene, job.walk, sampler, scratch.light, walk)) return;
  ++scratch.counters.light_paths;
  Surface surface;
  do splat_last(job, sample, scratch);
  while (follow_light(job, sampler, scratch, walk, surface));
}

}  // namespace ajar
