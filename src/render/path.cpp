// Unidirectional path tracing with next-event estimation: camera subpaths, strategies s = 0 and s = 1 alone.

#include "job.h"

namespace ajar {
namespace {

// Weight of a ray that found light with density own, against next-event estimation of density other.
float hit_weight(Heuristic h, double own, double other) { return float(1 / (1 + raise(h, ratio(other, own)))); }

// Light that the path ran into: s = 0.
Rgb hit_light(const Scene& scene, Heuristic h, const Surface& at, const Vec3& from, const Vec3& d, double pdf,
              bool alone) {
  const LightPoint point = light_point(scene, at);
  if (point.light == none) return Rgb(0);
  const Rgb radiance = emitted(scene, at, -d);
  if (alone || is_black(radiance)) return radiance;
  return radiance * hit_weight(h, pdf, double(scene.light_choice.pdf(point.light)) * pdf_direct(scene, point, from, d));
}

Rgb hit_sky(const Scene& scene, Heuristic h, const Vec3& from, const Vec3& d, double pdf, bool alone) {
  Rgb sum(0);
  for (const uint32_t light : scene.infinite_lights) {
    const Rgb radiance = environment(scene, light, d);
    if (is_black(radiance)) continue;
    const double other =
        alone ? 0 : double(scene.light_choice.pdf(light)) * pdf_direct(scene, light_point(scene, light, d), from, d);
    sum += radiance * hit_weight(h, pdf, other);
  }
  return sum;
}

// Next-event estimation, s = 1: leaves the shadow ray and what it would bring with the flight.
void sample_light(const Job& job, const Guide& guide, const Surface& at, Sampler& sampler, Flight& f) {
  const Scene& scene = *job.scene;
  float pick;
  const uint32_t light = choose_light(scene, sampler, pick);
  const Vec2 u = sampler.next2();
  DirectSample d;
  if (!sample_direct(scene, light, at.p, u, d)) return;
  const GuideEval e = evaluate(guide, d.wi, Mode::radiance);
  if (is_black(e.f_cos)) return;
  const LightPoint& l = d.point;
  const bool alone = l.delta_position || l.delta_direction;
  const float w = alone ? 1 : hit_weight(job.walk.heuristic, double(pick) * d.pdf, e.pdf);
  f.direct = f.beta * e.f_cos * d.radiance * (w / (pick * d.pdf));
  f.shadow_o = offset(at.p, at.ng, at.error, d.wi);
  f.shadow_d = d.wi, f.shadow_t_max = infinity;
  if (l.infinite) return;
  const Vec3 end = l.delta_position ? l.p : shadow_end(l.p, l.n, l.error, -d.wi, d.distance);
  f.shadow_d = end - f.shadow_o, f.shadow_t_max = 1;
}

// Chooses where the path goes on; false where it ends.
bool scatter(const Job& job, const Guide& guide, const Surface& at, int edges, Sampler& sampler, Flight& f) {
  const Vec2 u_lobe = sampler.next2(), u = sampler.next2();
  GuideSample s;
  if (!sample(guide, u_lobe.x, u, Mode::radiance, s) || is_black(s.weight)) return false;
  f.beta *= s.weight;
  f.survival *= s.weight * sqr(s.eta);
  if (edges >= job.walk.roulette_from) {
    const float keep = std::min(max_component(f.survival), 0.95f);
    if (!(u_lobe.y < keep)) return false;
    f.beta /= keep;
    f.survival /= keep;
  }
  f.o = offset(at.p, at.ng, at.error, s.wi), f.d = s.wi;
  f.t_min = 0, f.t_max = infinity;
  f.from = at.p;
  f.pdf = s.pdf;
  f.alone = s.delta;
  return true;
}

// What happens at the end of a ray; false where the path ends.
bool arrive(const Job& job, int edges, Sample& sample, Flight& f) {
  const Scene& scene = *job.scene;
  const Heuristic h = job.walk.heuristic;
  if (!f.found) {
    if (!scene.infinite_lights.empty()) sample.value += f.beta * hit_sky(scene, h, f.from, f.d, f.pdf, f.alone);
    return false;
  }
  const Surface at = make_surface(scene, f.hit, f.o, f.d);
  if (scene.shapes[f.hit.shape].light != none)
    sample.value += f.beta * hit_light(scene, h, at, f.from, f.d, f.pdf, f.alone);
  if (edges >= job.walk.max_edges) return false;
  Guide guide;
  make_guide(scene, at, -f.d, guide);
  if (connectable(guide) && !scene.lights.empty()) sample_light(job, guide, at, sample.sampler, f);
  return scatter(job, guide, at, edges, sample.sampler, f);
}

void start(const Job& job, std::span<const Sample> samples, std::vector<Flight>& flights) {
  flights.assign(samples.size(), {});
  for (uint32_t i = 0; i < samples.size(); ++i) {
    const CameraRay ray = generate(job.scene->camera, samples[i].raster, samples[i].lens);
    Flight& f = flights[i];
    f.sample = i;
    f.o = f.from = ray.o, f.d = ray.d, f.t_min = ray.t_min, f.t_max = ray.t_max;
  }
}

// Paths advance together, one edge at a time: rays of different paths do not depend on each other, so the processor
// overlaps their waits for memory, which one path alone would have to sit out.
void trace_together(const Job& job, std::span<Sample> samples, Scratch& scratch) {
  std::vector<Flight>& flights = scratch.flights;
  start(job, samples, flights);
  for (int edges = 1; !flights.empty(); ++edges) {
    scratch.counters.camera_rays += flights.size();
    for (Flight& f : flights) f.found = job.accel->intersect(f.o, f.d, f.t_min, f.t_max, f.hit);
    for (Flight& f : flights) f.alive = arrive(job, edges, samples[f.sample], f);
    for (Flight& f : flights) {
      if (is_black(f.direct)) continue;
      ++scratch.counters.shadow_rays;
      if (!job.accel->occluded(f.shadow_o, f.shadow_d, f.shadow_t_max)) samples[f.sample].value += f.direct;
      f.direct = Rgb(0);
    }
    std::erase_if(flights, [](const Flight& f) { return !f.alive; });
  }
}

// As many as keep the machine busy and fit its first-level cache.
constexpr size_t together = 64;

}  // namespace

void trace_path(const Job& job, std::span<Sample> samples, Scratch& scratch) {
  for (size_t i = 0; i < samples.size(); i += together)
    trace_together(job, samples.subspan(i, std::min(together, samples.size() - i)), scratch);
}

}  // namespace ajar
