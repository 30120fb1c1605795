// The photon map: light that arrives at the first surface which does not only reflect or refract it sharply is that of
// the light vertices nearby, and nothing else (Jensen 1996; the radius shrinks from pass to pass as in Knaus and
// Zwicker 2011).

#include "job.h"

namespace ajar {

void trace_photons(const Job& job, Sample& sample, Scratch& scratch) {
  Sampler sampler = make_sampler(job.sampler, job.seed, Side::light, sample.path, sample.pass);
  Subpath& light = scratch.light;
  Walk walk;
  Surface surface;
  light.n = 0;
  if (start_light(*job.scene, job.walk, sampler, light, walk)) {
    ++scratch.counters.light_paths;
    while (light.n < job.walk.max_edges) {
      if (light.n > 1 && !scatter(job.walk, sampler, light, walk)) break;
      ++scratch.counters.light_rays;
      if (!step(*job.scene, *job.accel, job.walk, light, walk, surface)) break;
    }
  }
  keep_photons(job, sample, walk.first_share, scratch);
  charge(scratch, scratch.ledger->light_ticks);
}

void trace_photon(const Job& job, Sample& sample, Scratch& scratch) {
  const Scene& scene = *job.scene;
  Subpath& camera = scratch.camera;
  Walk walk;
  Surface surface;
  const auto add = [&](int t, const Rgb& found) {
    sample.value += found;
    gain(scratch, 0, t, found * sample.filter);
    charge_join(scratch, 0, t);
  };
  start_camera(scene, job.walk, sample.raster, sample.lens, camera, walk);
  do {
    ++scratch.counters.camera_rays;
    const bool hit = step(scene, *job.accel, job.walk, camera, walk, surface);
    charge(scratch, scratch.ledger->camera_ticks);
    if (!hit) {
      for (const uint32_t light : scene.infinite_lights)
        add(camera.n + 1, walk.beta * environment(scene, light, walk.d));
      return;
    }
    const Vertex& v = camera[camera.n - 1];
    if (scene.shapes[surface.shape].light != none) add(camera.n, v.beta * emitted(scene, surface, v.guide.wo));
    if (camera.n <= job.walk.max_edges && connectable(v.guide)) join_merged(job, sample, scratch);
  } while (camera.n <= job.walk.max_edges && scatter(job.walk, sample.sampler, camera, walk) &&
           camera[camera.n - 1].delta);
}

}  // namespace ajar
