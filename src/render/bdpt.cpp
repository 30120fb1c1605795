// Bidirectional path tracing (Veach 1997, chapter 10): all strategies (s, t) with t >= 1, joined by multiple importance
// sampling.

#include "job.h"

namespace ajar {
namespace {

struct Sample {
  const Job& job;
  const PixelSample& pixel;
  Scratch& scratch;
  double light_share = 1;  // of the light walk, for s = 2
  Rgb value{0};
};

// Weighs a visible candidate and puts it where it belongs.
void add(Sample& sample, const Candidate& c, int s, int t) {
  const float w = float(weight(sample.job.walk.heuristic, c));
  const Rgb weighted = c.value * w;
  if (!accept(weighted, sample.scratch)) return;
  if (t == 1)
    sample.scratch.splats->push_back({c.raster, weighted});
  else
    sample.value += weighted;
  if (!sample.scratch.strategies) return;
  const Vec2 raster = t == 1 ? c.raster : Vec2(sample.pixel.x, sample.pixel.y);
  sample.scratch.strategies->push_back({s, t, raster, c.value, weighted});
}

void add_if_visible(Sample& sample, const Candidate& c, int s, int t) {
  ++sample.scratch.counters.shadow_rays;
  if (visible(*sample.job.accel, c)) add(sample, c, s, t);
}

// The light subpath, and t = 1 at every vertex. The light itself, s = 1, is left to the camera ray that sees it.
void trace_light_subpath(Sample& sample, const Vec2& lens) {
  const Job& job = sample.job;
  Sampler sampler = make_sampler(job.sampler, job.seed, Side::light, sample.pixel.path, sample.pixel.pass);
  Subpath& light = sample.scratch.light;
  Walk walk;
  if (!start_light(*job.scene, sampler, light, walk)) return;
  ++sample.scratch.counters.light_paths;
  ++sample.scratch.counters.light_paths;
  Surface surface;
  while (light.n < job.walk.max_edges) {
    if (light.n > 1 && !scatter(job.walk, sampler, light, walk)) return;
    ++sample.scratch.counters.light_rays;
    if (!step(*job.scene, *job.accel, job.walk, light, walk, surface)) return;
    sample.light_share = walk.first_share;
    Candidate c;
    if (connectable(light[light.n - 1].guide) &&
        join_camera(*job.scene, lens, light, light.n, sample.light_share, job.walk.light_paths, c))
      add_if_visible(sample, c, light.n, 1);
  }
}

// All joins at the camera subpath's last vertex: s = 0 (surface), 1 and more.
void join_all(Sample& sample, const Surface& surface, Sampler& sampler) {
  const Job& job = sample.job;
  const Subpath& camera = sample.scratch.camera;
  const Subpath& light = sample.scratch.light;
  const int t = camera.n;
  Candidate c;
  if (join_hit(*job.scene, camera, surface, c)) add(sample, c, 0, t);
  if (t > job.walk.max_edges || !connectable(camera[t - 1].guide)) return;
  const double light_paths = job.walk.light_paths;
  if (!job.scene->lights.empty() && join_light(*job.scene, sampler, camera, t, light_paths, c))
    add_if_visible(sample, c, 1, t);
  const int most = std::min(light.n, job.walk.max_edges + 1 - t);
  for (int s = 2; s <= most; ++s)
    if (connectable(light[s - 1].guide) && join_vertices(light, s, sample.light_share, camera, t, light_paths, c))
      add_if_visible(sample, c, s, t);
}

}  // namespace

Rgb trace_bdpt(const Job& job, const PixelSample& pixel, const Vec2& raster, const Vec2& lens, Sampler& sampler,
               Scratch& scratch) {
  Sample sample{job, pixel, scratch};
  scratch.light.n = 0;
  trace_light_subpath(sample, lens);
  Subpath& camera = scratch.camera;
  Walk walk;
  start_camera(*job.scene, job.walk, raster, lens, camera, walk);
  Surface surface;
  do {
    ++scratch.counters.camera_rays;
    if (!step(*job.scene, *job.accel, job.walk, camera, walk, surface)) {
      Candidate c;
      for (const uint32_t l : job.scene->infinite_lights)
        if (join_escape(*job.scene, l, camera, walk, c)) add(sample, c, 0, camera.n + 1);
      break;
    }
    join_all(sample, surface, sampler);
  } while (camera.n <= job.walk.max_edges && scatter(job.walk, sampler, camera, walk));
  return sample.value;
}

}  // namespace ajar
