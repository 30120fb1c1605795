// Bidirectional path tracing (Veach 1997, chapter 10): all strategies (s, t) with t >= 1, joined by multiple importance
// sampling.

#include "job.h"

namespace ajar {
namespace {

// One camera sample with its light subpath, at work.
struct Work {
  const Job& job;
  Sample& sample;
  Scratch& scratch;
  double light_share = 1;  // of the light walk, for s = 2
};

// Weighs a visible candidate and puts it where it belongs.
void add(Work& work, const Candidate& c, int s, int t) {
  const float w = float(weight(work.job.walk.heuristic, c));
  const Rgb weighted = c.value * w;
  if (!accept(weighted, work.sample, work.scratch)) return;
  if (t == 1)
    work.scratch.splats->push_back({c.raster, weighted});
  else
    work.sample.value += weighted;
  if (!work.scratch.strategies) return;
  // What the camera sample found gets its filter here; splats are filtered on the film.
  const Vec2 raster = t == 1 ? c.raster : Vec2(work.sample.x, work.sample.y);
  const float filter = t == 1 ? 1 : work.sample.filter;
  work.scratch.strategies->push_back({s, t, raster, c.value * filter, weighted * filter});
}

void add_if_visible(Work& work, const Candidate& c, int s, int t) {
  ++work.scratch.counters.shadow_rays;
  if (visible(*work.job.accel, c.segment)) add(work, c, s, t);
}

// The light subpath, and t = 1 at every vertex. The light itself, s = 1, is left to the camera ray that sees it.
void trace_light_subpath(Work& work) {
  const Job& job = work.job;
  Sampler sampler = make_sampler(job.sampler, job.seed, Side::light, work.sample.path, work.sample.pass);
  Subpath& light = work.scratch.light;
  Walk walk;
  if (!start_light(*job.scene, sampler, light, walk)) return;
  ++work.scratch.counters.light_paths;
  Surface surface;
  while (light.n < job.walk.max_edges) {
    if (light.n > 1 && !scatter(job.walk, sampler, light, walk)) return;
    ++work.scratch.counters.light_rays;
    if (!step(*job.scene, *job.accel, job.walk, light, walk, surface)) return;
    work.light_share = walk.first_share;
    if (!connectable(light[light.n - 1].guide)) continue;
    Candidate c;
    if (join_camera(*job.scene, work.sample.lens, light, light.n, work.light_share, job.walk.light_paths, c))
      add_if_visible(work, c, light.n, 1);
  }
}

// All joins at the camera subpath's last vertex: s = 0 (surface), 1 and more.
void join_all(Work& work, const Surface& surface) {
  const Job& job = work.job;
  const Subpath& camera = work.scratch.camera;
  const Subpath& light = work.scratch.light;
  const int t = camera.n;
  if (job.scene->shapes[surface.shape].light != none) {
    Candidate c;
    if (join_hit(*job.scene, camera, surface, c)) add(work, c, 0, t);
  }
  if (t > job.walk.max_edges || !connectable(camera[t - 1].guide)) return;
  Candidate c;
  const double light_paths = job.walk.light_paths;
  if (!job.scene->lights.empty() && join_light(*job.scene, work.sample.sampler, camera, t, light_paths, c))
    add_if_visible(work, c, 1, t);
  const int most = std::min(light.n, job.walk.max_edges + 1 - t);
  for (int s = 2; s <= most; ++s)
    if (connectable(light[s - 1].guide) && join_vertices(light, s, work.light_share, camera, t, light_paths, c))
      add_if_visible(work, c, s, t);
}

void join_escapes(Work& work, const Walk& walk) {
  const Subpath& camera = work.scratch.camera;
  Candidate c;
  for (const uint32_t light : work.job.scene->infinite_lights)
    if (join_escape(*work.job.scene, light, camera, walk, c)) add(work, c, 0, camera.n + 1);
}

}  // namespace

void trace_bdpt(const Job& job, Sample& sample, Scratch& scratch) {
  Work work{job, sample, scratch};
  trace_light_subpath(work);
  Subpath& camera = scratch.camera;
  Walk walk;
  start_camera(*job.scene, job.walk, sample.raster, sample.lens, camera, walk);
  Surface surface;
  do {
    ++scratch.counters.camera_rays;
    if (!step(*job.scene, *job.accel, job.walk, camera, walk, surface)) {
      join_escapes(work, walk);
      break;
    }
    join_all(work, surface);
  } while (camera.n <= job.walk.max_edges && scatter(job.walk, sample.sampler, camera, walk));
}

}  // namespace ajar
