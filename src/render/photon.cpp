// The photon map: light that arrives at the first surface which does not only reflect or refract it sharply is that of
// the light vertices nearby, and nothing else (Jensen 1996; the radius shrinks from pass to pass as in Knaus and
// Zwicker 2011).

#include "contribution.h"
#include "integrators.h"
#include "merge.h"

namespace ajar {

namespace {

void follow(const Job& job, Sample& sample, Scratch& scratch, Walk walk, bool gathers, int rays);

// Final gather: rays go on from the camera subpath's last vertex, and what they find is merged there. Those that a
// delta sends on are no gather: they see what the eye would.
void gather(const Job& job, Sample& sample, Scratch& scratch, const Walk& walk, int rays) {
  Subpath& camera = scratch.camera;
  const int t = camera.n;
  for (int i = 0; i < rays; ++i) {
    Walk ray = walk;
    camera.n = t;
    ++sample.gathers;
    if (!scatter(job.walk, scratch.numbers, camera, ray)) continue;
    ray.beta /= float(rays);
    follow(job, sample, scratch, ray, !camera[t - 1].delta, 1);
  }
}

// Through what reflects or refracts sharply to where light vertices are merged. rays: of a final gather from there.
// What gathers does not see lamps: their light is merged where it came from.
void follow(const Job& job, Sample& sample, Scratch& scratch, Walk walk, bool gathers, int rays) {
  const Scene& scene = *job.scene;
  Subpath& camera = scratch.camera;
  Surface surface;
  const auto add = [&](int t, const Rgb& found) {
    add_to_pixel(sample, scratch, 0, t, found, found);
    charge_join(scratch, 0, t);
  };
  do {
    ++scratch.counters.camera_rays;
    const bool shows = !gathers && shows_lights(scene.camera, camera.n);
    const bool hit = step(scene, *job.accel, job.walk, camera, walk, surface);
    charge(scratch, &Ledger::camera_ticks);
    if (!hit) {
      for (const uint32_t light : scene.infinite_lights)
        if (shows) add(camera.n + 1, walk.beta * environment(scene, light, walk.d));
      return;
    }
    const Vertex& v = camera[camera.n - 1];
    const bool emits = scene.shapes[surface.shape].light != none;
    if (emits && shows) add(camera.n, v.beta * emitted(scene, surface, v.guide.wo));
    if (camera.n > job.walk.max_edges) return;
    if (!connectable(v.guide)) continue;
    join_merged(job, sample, scratch);
    if (!gathers && job.final_gather > 0) return gather(job, sample, scratch, walk, rays);
  } while (scatter(job.walk, scratch.numbers, camera, walk) && camera[camera.n - 1].delta);
}

}  // namespace

void trace_photon(const Job& job, Sample& sample, Scratch& scratch) {
  Walk walk;
  start_camera(*job.scene, sample.raster, sample.lens, scratch.camera, walk);
  follow(job, sample, scratch, walk, false, job.final_gather);
}

}  // namespace ajar
