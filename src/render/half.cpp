// The light half of bidirectional path tracing: the light subpath, its joins to the lens, and what is kept of it.

#include "bdpt.h"
#include "integrators.h"
#include "light.h"
#include "merge.h"

namespace ajar {
namespace {

// How camera subpaths would have come from the light subpath's last vertex, the first that scatters, to where it
// started: by next-event estimation, or straight through panes.
WayBack way_back(const Work& work, const Subpath& light, const Walk& walk) {
  const Guide& guide = light[light.n - 1].guide;
  const Vec3& d = walk.start.direction;
  if (light.n == 2) return {&guide, pdf_next_event(*work.job.scene, guide, walk.start.point, -d)};
  return glm::dot(guide.wo, -d) > straight_on ? WayBack{&guide, back_density(light[light.n - 1])} : WayBack{};
}

// What the light subpath brought to the first surface that scatters it, if it came to one: glass before it only passes
// light on.
void teach_start(const Work& work, const Subpath& light, const Walk& walk, bool arrived) {
  if (!work.sample.teaches || !work.job.guided) return;
  float brings = 0, per_watt = 0;
  WayBack way;
  if (arrived) {
    const Vertex& first = light[light.n - 1];
    if (walk.start.point.infinite) way = way_back(work, light, walk);
    const float started = luminance(light[1].beta);
    brings = promise(first.guide, first.beta).all, per_watt = started > 0 ? brings / started : 0;
  }
  record_start(*work.job.scene, *work.job.walk.fields, *work.job.training, walk.start, brings, per_watt, way);
  charge(work.scratch, &Ledger::learn_ticks);
}

// Luminance of the infinite lights in a direction, as far as rays that hit them bring it better than next-event
// estimation: of camera subpaths that go on as a matt surface would send them.
float left_to_hits(const Work& work, const Vertex& v, const Vec3& d) {
  const Scene& scene = *work.job.scene;
  float sum = 0;
  for (const uint32_t light : scene.infinite_lights) {
    const float radiance = luminance(environment(scene, light, d));
    if (!(radiance > 0)) continue;
    LightPoint point = light_point(scene, light, d);
    point.p = v.p;
    const double nee = connectable(v.guide) ? pdf_next_event(scene, v.guide, point, d) : 0;
    const double hit = inv_pi * std::abs(glm::dot(v.ng, d));
    sum += radiance / float(1 + raise(work.job.walk.heuristic, ratio(nee, hit)));
  }
  return sum;
}

}  // namespace

void trace_light_subpath(Work& work) {
  const Job& job = work.job;
  Sampler sampler = make_sampler(job.sampler, job.seed, Side::light, work.sample.path, work.sample.pass);
  Subpath& light = work.scratch.light;
  Walk walk;
  if (!start_light(*job.scene, job.walk, sampler, light, walk)) return;
  ++work.scratch.counters.light_paths;
  Surface surface;
  bool arrived = false;
  while (follow_light(job, sampler, work.scratch, walk, surface)) {
    const bool scatters_here = connectable(light[light.n - 1].guide);
    if (scatters_here && !arrived) teach_start(work, light, walk, true);
    arrived |= scatters_here;
    if (job.merges_alone || !scatters_here) continue;
    Candidate c;
    const bool seen =
        join_camera(*job.scene, work.sample.lens, light, light.n, c) && add_if_visible(work, c, light.n, 1);
    charge_join(work.scratch, light.n, 1);
    Received received;
    if (seen) add(received, light[light.n - 1].guide, c, 1);
    teach_direct(work, light[light.n - 1], received);
  }
  if (walk.escaped && work.sample.teaches && job.guided && light.n > 1)
    light.escape = escape_of(light, walk, left_to_hits(work, light[light.n - 1], walk.d));
  if (!arrived) teach_start(work, light, walk, false);
}

void trace_light_half(const Job& job, Sample& sample, Scratch& scratch) {
  Work work{job, sample, scratch};
  trace_light_subpath(work);
  if (!job.merges_alone) add(scratch.traced, scratch.light);
  if (job.walk.merging.paths > 0) keep_photons(job, sample, scratch);
  charge(scratch, &Ledger::light_ticks);
  if (!sample.teaches) return;
  record_subpath(*job.walk.fields, *job.training, scratch.sightings, scratch.light, Side::light);
  charge(scratch, &Ledger::learn_ticks);
}

}  // namespace ajar
