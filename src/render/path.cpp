// Unidirectional path tracing with next-event estimation: camera subpaths, strategies s = 0 and s = 1 alone.

#include "contribution.h"
#include "integrators.h"

namespace ajar {
namespace {

// Light that the path ran into: s = 0.
Rgb hit_light(const Scene& scene, Heuristic h, const Guide& before, const Surface& at, const Vec3& d, double pdf,
              bool alone) {
  const LightPoint point = light_point(scene, at);
  if (point.light == none) return Rgb(0);
  const Rgb radiance = emitted(scene, at, -d);
  if (alone || is_black(radiance)) return radiance;
  return radiance * weight_against(h, pdf, pdf_next_event(scene, before, point, d));
}

Rgb hit_sky(const Scene& scene, Heuristic h, const Guide& before, const Vec3& d, double pdf, bool alone) {
  Rgb sum(0);
  for (const uint32_t light : scene.infinite_lights) {
    const Rgb radiance = environment(scene, light, d);
    if (is_black(radiance)) continue;
    const double other = alone ? 0 : pdf_next_event(scene, before, light_point(scene, light, d), d);
    sum += radiance * weight_against(h, pdf, other);
  }
  return sum;
}

// Next-event estimation: s = 1, at the last of t vertices.
Rgb direct(const Job& job, const Guide& guide, const Surface& at, Sampler& sampler, int t, bool teaches,
           Scratch& scratch) {
  DirectSample d;
  LightChances chances;
  LightNumbers u;
  const auto learn = [&](float arrives) {
    if (!teaches) return;
    record_next_event(*job.scene, guide, chances, *job.training, d.point, arrives);
    record_place(guide, at.ng, *job.training, scratch.sightings);
    charge(scratch, &Ledger::learn_ticks);
  };
  const bool found = draw_light(*job.scene, guide, sampler, u) && sample_next_event(*job.scene, guide, chances, u, d);
  const GuideEval e = found ? evaluate(guide, d.wi, Mode::radiance) : GuideEval{};
  if (is_black(e.f_cos)) {
    learn(0);
    return Rgb(0);
  }
  ++scratch.counters.shadow_rays;
  ++scratch.ledger->at(1, t).rays;
  const bool free = visible(*job.accel, segment_to(d, at.p, at.ng, at.error));
  learn(free ? max_component(d.radiance) * std::abs(glm::dot(at.ng, d.wi)) / d.pdf : 0);
  if (!free) return Rgb(0);
  const LightPoint& l = d.point;
  const bool alone = l.delta_position || l.delta_direction;
  const float w = alone ? 1 : weight_against(job.walk.heuristic, d.pdf, e.pdf);
  return e.f_cos * d.radiance * (w / d.pdf);
}

// The ray that a path sends next, with what its end needs to know about it.
struct Flight {
  Vec3 o{0}, d{0};
  float t_min = 0, t_max = infinity;
  double pdf = 1;     // of its direction, per solid angle
  bool alone = true;  // next-event estimation could not have found its end
  Rgb beta{1}, survival{1};
  float promise = 0;
};

// What a join of s light and t camera vertices found goes to its pixel.
void add(Sample& sample, Scratch& scratch, int s, int t, const Rgb& found) {
  if (!is_black(found)) add_to_pixel(sample, scratch, s, t, found, found);
  charge_join(scratch, s, t);
}

// Chooses where the path goes on; false where it ends.
bool scatter(const Job& job, const Guide& guide, const Surface& at, int edges, Sampler& sampler, Flight& f) {
  GuideSample s;
  if (choose_direction(guide, Mode::radiance, job.walk, edges + 1, sampler, f.beta, f.survival, f.promise, s) == 0)
    return false;
  f.o = offset(at.p, at.ng, at.error, s.wi), f.d = s.wi;
  f.t_min = 0, f.t_max = infinity;
  f.pdf = s.pdf;
  f.alone = s.delta || !job.next_event;
  return true;
}

}  // namespace

void trace_path(const Job& job, Sample& sample, Scratch& scratch) {
  const Scene& scene = *job.scene;
  const Heuristic h = job.walk.heuristic;
  const CameraRay ray = generate(scene.camera, sample.raster, sample.lens);
  Flight f{ray.o, ray.d, ray.t_min, ray.t_max};
  Guide guide;
  for (int edges = 1;; ++edges) {
    Hit hit;
    ++scratch.counters.camera_rays;
    const int t = edges + 1;  // vertices
    const bool hits =
        edges == 1 ? first_seen(scene, *job.accel, ray, hit) : job.accel->intersect(f.o, f.d, f.t_min, f.t_max, hit);
    const bool shows = shows_lights(scene.camera, edges);
    charge(scratch, &Ledger::camera_ticks);
    if (!hits) {
      if (shows && !scene.infinite_lights.empty())
        add(sample, scratch, 0, t, f.beta * hit_sky(scene, h, guide, f.d, f.pdf, f.alone));
      return;
    }
    const Surface at = make_surface(scene, hit, f.o, f.d);
    if (shows && scene.shapes[hit.shape].light != none)
      add(sample, scratch, 0, t, f.beta * hit_light(scene, h, guide, at, f.d, f.pdf, f.alone));
    if (edges >= job.walk.max_edges) return;
    make_guide(scene, job.walk.fields, Side::camera, at, -f.d, guide);
    charge(scratch, &Ledger::camera_ticks);
    if (job.next_event && connectable(guide) && !scene.lights.empty())
      add(sample, scratch, 1, t, f.beta * direct(job, guide, at, scratch.numbers, t, sample.teaches, scratch));
    if (!scatter(job, guide, at, edges, scratch.numbers, f)) return;
  }
}

}  // namespace ajar
