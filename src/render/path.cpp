// Unidirectional path tracing with next-event estimation: camera subpaths, strategies s = 0 and s = 1 alone.

#include "job.h"

namespace ajar {
namespace {

struct Ray {
  Vec3 o, d;
  float t_min, t_max;
};

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

// Next-event estimation: s = 1.
Rgb direct(const Job& job, const Guide& guide, const Surface& at, Sampler& sampler, Scratch& scratch) {
  const Scene& scene = *job.scene;
  float pick;
  const uint32_t light = choose_light(scene, sampler, pick);
  const Vec2 u = sampler.next2();
  DirectSample d;
  if (!sample_direct(scene, light, at.p, u, d)) return Rgb(0);
  const GuideEval e = evaluate(guide, d.wi, Mode::radiance);
  if (is_black(e.f_cos)) return Rgb(0);
  const Vec3 o = offset(at.p, at.ng, at.error, d.wi);
  ++scratch.counters.shadow_rays;
  if (d.point.infinite) {
    if (job.accel->occluded(o, d.wi, infinity)) return Rgb(0);
  } else {
    const LightPoint& l = d.point;
    const Vec3 end = l.delta_position ? l.p : shadow_end(l.p, l.n, l.error, -d.wi, d.distance);
    if (job.accel->occluded(o, end - o, 1)) return Rgb(0);
  }
  const bool alone = d.point.delta_position || d.point.delta_direction;
  const float w = alone ? 1 : hit_weight(job.walk.heuristic, double(pick) * d.pdf, e.pdf);
  return e.f_cos * d.radiance * (w / (pick * d.pdf));
}

}  // namespace

Rgb trace_path(const Job& job, const PixelSample&, const Vec2& raster, const Vec2& lens, Sampler& sampler,
               Scratch& scratch) {
  const Scene& scene = *job.scene;
  const CameraRay start = generate(scene.camera, raster, lens);
  Ray ray{start.o, start.d, start.t_min, start.t_max};
  Rgb value(0), beta(1), survival(1);
  Vec3 from = start.o;
  double pdf = 1;
  bool alone = true;  // the last direction could not have come from next-event estimation
  Guide guide;
  for (int edges = 1;; ++edges) {
    Hit hit;
    ++scratch.counters.camera_rays;
    if (!job.accel->intersect(ray.o, ray.d, ray.t_min, ray.t_max, hit)) {
      if (!scene.infinite_lights.empty()) value += beta * hit_sky(scene, job.walk.heuristic, from, ray.d, pdf, alone);
      break;
    }
    const Surface at = make_surface(scene, hit, ray.o, ray.d);
    if (scene.shapes[hit.shape].light != none)
      value += beta * hit_light(scene, job.walk.heuristic, at, from, ray.d, pdf, alone);
    if (edges >= job.walk.max_edges) break;
    make_guide(scene, at, -ray.d, guide);
    if (connectable(guide) && !scene.lights.empty()) value += beta * direct(job, guide, at, sampler, scratch);
    const Vec2 u_lobe = sampler.next2(), u = sampler.next2();
    GuideSample s;
    if (!sample(guide, u_lobe.x, u, Mode::radiance, s) || is_black(s.weight)) break;
    beta *= s.weight;
    survival *= s.weight * sqr(s.eta);
    if (edges >= job.walk.roulette_from) {
      const float keep = std::min(max_component(survival), 0.95f);
      if (!(u_lobe.y < keep)) break;
      beta /= keep;
      survival /= keep;
    }
    ray = {offset(at.p, at.ng, at.error, s.wi), s.wi, 0, infinity};
    from = at.p;
    pdf = s.pdf;
    alone = s.delta;
  }
  return value;
}

}  // namespace ajar
