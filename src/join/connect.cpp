#include "ajar/join/connect.h"

#include "ajar/accel/sight.h"

namespace ajar {
namespace {

// The camera's end on a light, n-th of its vertices, that a ray from the vertex before ran into.
End end_on_light(int n, double own, double other, const Vertex& before, double other_before, double sum) {
  return {n, own, other, before.own, other_before, before.delta, sum, 0, false, before.seen};
}

}  // namespace

bool join_hit(const Scene& scene, const Fields* fields, const Subpath& camera, const Surface& surface, Candidate& out) {
  const LightPoint point = light_point(scene, surface);
  const Vertex& v = camera[camera.n - 1];
  if (point.light == none || !shows_lights(scene.camera, camera.n - 1)) return false;
  const Rgb radiance = emitted(scene, surface, v.guide.wo);
  if (is_black(radiance)) return false;
  out.value = v.beta * radiance;
  out.arrives = radiance;
  const EmissionPdf emission = pdf_emission(scene, fields, point, v.guide.wo);
  const Vertex& before = camera[camera.n - 2];
  out.light = {};
  out.camera = end_on_light(camera.n, v.own, emission.position, before, emission.direction * v.back, v.sum);
  const bool may_ask = camera.n > 2;  // lights, from the vertex before
  out.nee.ratio = may_ask ? ratio_of_next_event(scene, before, point, -v.guide.wo, v.distance2, emission) : 0;
  out.nee.rays = before.next_events;
  return true;
}

bool join_escape(const Scene& scene, const Fields* fields, uint32_t light, const Subpath& camera, const Walk& walk,
                 Candidate& out) {
  if (!shows_lights(scene.camera, camera.n)) return false;
  const Rgb radiance = environment(scene, light, walk.d);
  if (is_black(radiance)) return false;
  out.value = walk.beta * radiance;
  out.arrives = radiance;
  LightPoint point = light_point(scene, light, walk.d);
  const Vertex& before = camera[camera.n - 1];
  point.p = before.p;
  const EmissionPdf emission = pdf_emission(scene, fields, point, -walk.d);
  const double cosine = std::abs(glm::dot(before.ng, walk.d));
  out.light = {};
  out.camera = end_on_light(camera.n + 1, walk.pdf, emission.direction, before, emission.position * cosine, walk.sum);
  out.nee.ratio = camera.n > 1 ? ratio_of_next_event(scene, before, point, walk.d, 1, emission) : 0;
  out.nee.rays = before.next_events;
  return true;
}

bool join_light(const Scene& scene, const Fields* fields, const Subpath& camera, int t, LightChances& chances,
                const LightNumbers& u, Candidate& out) {
  const Vertex& c = camera[t - 1];
  DirectSample d;
  const bool found = sample_next_event(scene, c.guide, chances, u, d);
  out.point = d.point;
  if (!found) return false;
  const GuideEval e = evaluate_bsdf(c.guide, d.wi, Mode::radiance);
  out.arrives = d.radiance * std::abs(glm::dot(c.ng, d.wi)) / d.pdf;
  out.value = c.beta * e.f_cos * d.radiance / d.pdf;
  if (is_black(out.value)) return false;
  const LightPoint& point = d.point;
  const float d2 = point.infinite ? 1 : sqr(d.distance);
  const float cos_light = point.infinite || point.delta_position ? 1 : std::abs(glm::dot(point.n, d.wi));
  const double cos_here = std::abs(glm::dot(c.ng, d.wi));
  const EmissionPdf emission = pdf_emission(scene, fields, point, -d.wi);
  const bool hittable = !point.delta_position && !point.delta_direction;
  const double own = point.infinite ? emission.direction : emission.position;
  const double to_here = point.infinite ? emission.position : emission.direction;
  const double nee = hittable ? double(d.pdf) * cos_light / d2 : double(d.pdf);
  out.light = {.n = 1, .own = own, .sum_before = hittable ? 1.0 : 0.0};
  out.light_found = {&c.guide, d.wi, e.pdf, cos_light, d2};
  out.camera = end_at(camera.first(t), to_here * cos_here / d2, e.pdf_reverse);
  out.nee = {ratio(nee, own), double(c.next_events)};
  out.segment = segment_to(d, c.p, c.ng, c.error);
  return true;
}

LightEnd light_end(const Subpath& light, int s) {
  const Vertex& before = light[s - 2];
  return {&light[s - 1], s, before.delta, before.own, light.nee_ratio};
}

bool look_between(const Vertex& a, const Vertex& c, Between& out) {
  const Vec3 between = c.p - a.p;
  if (!may_scatter(c.guide, -between) || !may_scatter(a.guide, between)) return false;
  out.distance2 = length2(between);
  if (!(out.distance2 > 0)) return false;
  const float distance = std::sqrt(out.distance2);
  out.w = between / distance;
  const Vec3 from = offset(c.p, c.ng, c.error, -out.w);
  out.segment = {from, shadow_end(a.p, a.ng, a.error, out.w, distance) - from};
  return true;
}

bool join_vertices(const LightEnd& light, std::span<const Vertex> camera, const Between& between, Candidate& out) {
  const Vertex& a = *light.vertex;
  const Vertex& c = camera.back();
  const Vec3 w = between.w;
  const float d2 = between.distance2;
  const GuideEval ec = evaluate_bsdf(c.guide, -w, Mode::radiance);
  if (is_black(ec.f_cos)) return false;
  const GuideEval ea = evaluate_bsdf(a.guide, w, Mode::importance);
  out.value = a.beta * ea.f_cos * ec.f_cos * c.beta / d2;
  if (is_black(out.value)) return false;
  out.light = {light.s, a.own, 0, light.own_before, ea.pdf_reverse * a.back, light.delta_before, a.sum, a.merge};
  out.light_found = {&c.guide, -w, ec.pdf, std::abs(glm::dot(a.ng, w)), d2};
  out.camera = end_at(camera, 0, ec.pdf_reverse);
  out.camera_found = {&a.guide, w, ea.pdf, std::abs(glm::dot(c.ng, w)), d2};
  out.nee = {light.nee_ratio, 1};
  return true;
}

bool join_camera(const Scene& scene, const Vec2& lens, const Subpath& light, int s, Candidate& out) {
  const Vertex& a = light[s - 1];
  if (s == 1 ? !shows_lights(scene.camera, 1) : is_passed(scene, a.shape)) return false;
  CameraConnection k;
  if (a.infinite || !connect(scene.camera, a.p, lens, scene.filter.radius, k)) return false;
  const double cosine = a.ng == Vec3(0) ? 1 : std::abs(glm::dot(a.ng, k.w));
  out.arrives = Rgb(cosine * k.factor);
  if (s == 1) {  // the light's own point, seen directly
    if (a.point.delta_position || !(glm::dot(a.ng, k.w) > 0)) return false;
    out.value = a.beta * float(cosine * k.factor);
    out.light = {.n = 1, .own = a.own, .other = k.factor * cosine, .sum_before = a.sum};
  } else {
    const GuideEval e = evaluate_bsdf(a.guide, k.w, Mode::importance);
    out.value = a.beta * e.f_cos * k.factor;  // (P3)
    out.light = end_at(light.first(s), k.factor * cosine, e.pdf_reverse);
  }
  if (is_black(out.value)) return false;
  out.camera = {.n = 1};
  out.nee = {light.nee_ratio, 1};
  out.raster = k.raster;
  const Vec3 from = a.ng == Vec3(0) ? a.p : offset(a.p, a.ng, a.error, k.w);
  out.segment = {from, k.p - from};
  // Nearer than the near plane nothing is in the way, as for camera rays. Those of an orthographic one begin there.
  const Camera& camera = scene.camera;
  if (camera.near_clip > 0 && camera.kind != CameraKind::orthographic)
    out.segment.t_max = 1 - camera.near_clip / in_camera(camera, a.p).z;
  return true;
}

void complete(Candidate& c) {
  const auto ask = [](Finding& f, double& density) {
    if (f.guide) density = double(with_field(*f.guide, f.w, f.pdf)) * f.cosine / f.distance2;
    f.guide = nullptr;
  };
  ask(c.light_found, c.light.other);
  ask(c.camera_found, c.camera.other);
}

}  // namespace ajar
