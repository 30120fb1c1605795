#include "afresh.h"

#include "ajar/field/emission.h"
#include "ajar/join/connect.h"
#include "kit/stage.h"

namespace ajar {
namespace {

using namespace kit;

Vec3 towards(const WholePath& path, size_t from, size_t to) {
  if (path.light.infinite && (from == 0 || to == 0)) return from == 0 ? path.travel : -path.travel;
  return glm::normalize(path.points[to].p - path.points[from].p);
}

// Area density of a point that lies in direction w (from x, at distance^2) when w has this density per solid angle.
double to_area(double pdf, const Point& at, const Vec3& w, double distance2) {
  const double cosine = at.ng == Vec3(0) ? 1 : std::abs(double(glm::dot(at.ng, w)));
  return pdf * cosine / distance2;
}

double distance2(const WholePath& path, size_t a, size_t b) {
  return double(length2(path.points[a].p - path.points[b].p));
}

// Discrete probability of the delta event that turns wo into wi: looked for by drawing.
double delta_probability(const Guide& guide, const Vec3& wi, Mode mode) {
  GuideSample s;
  for (int i = 0; i < 512; ++i)
    if (sample(guide, (float(i) + 0.5f) / 512, Vec2(0.3f, 0.6f), mode, s) && s.delta && glm::dot(s.wi, wi) > 0.9999f)
      return s.pdf;
  return 0;
}

// Solid-angle density of leaving x_i towards `next`, having come from `before`.
double scatter_pdf(const Scene& scene, const WholePath& path, size_t before, size_t i, size_t next, Mode mode) {
  Guide guide;
  make_guide(scene, path.fields, mode == Mode::radiance ? Side::camera : Side::light, path.points[i].surface,
             towards(path, i, before), guide);
  const Vec3 wi = towards(path, i, next);
  return path.points[i].delta ? delta_probability(guide, wi, mode) : evaluate(guide, wi, mode).pdf;
}

double light_density(const Scene& scene, const WholePath& path, size_t i) {
  LightPoint light = path.light;
  if (light.infinite) light.p = path.points[1].p;
  const EmissionPdf emission = pdf_emission(scene, path.fields, light, path.travel);
  if (i == 0) return path.light.infinite ? emission.direction : emission.position;
  const Vec3 w = towards(path, i - 1, i);
  if (i == 1 && path.light.infinite) return to_area(emission.position, path.points[1], w, 1);
  const double pdf = i == 1 ? emission.direction : scatter_pdf(scene, path, i - 2, i - 1, i, Mode::importance);
  return to_area(pdf, path.points[i], w, distance2(path, i - 1, i));
}

double camera_density(const Scene& scene, const WholePath& path, size_t i) {
  const size_t k = path.points.size() - 1;
  if (i == k) return 1;
  const Vec3 w = towards(path, i + 1, i);
  if (i + 1 == k) return to_area(raster_factor(scene.camera, path.points[k].p, path.points[i].p), path.points[i], w, 1);
  const double pdf = scatter_pdf(scene, path, i + 2, i + 1, i, Mode::radiance);
  if (i == 0 && path.light.infinite) return pdf;
  return to_area(pdf, path.points[i], w, distance2(path, i + 1, i));
}

}  // namespace

OraclePath densities_afresh(const Scene& scene, const WholePath& path, const SampleCounts& counts,
                            const Merging& merging) {
  OraclePath out;
  const LightPoint& light = path.light;
  for (size_t i = 0; i < path.points.size(); ++i)
    out.vertices.push_back({light_density(scene, path, i), camera_density(scene, path, i),
                            i > 0 && path.points[i].delta, merge_density(merging, path.points[i].p)});
  out.inner = counts.inner, out.seen = counts.seen, out.first_seen = counts.first_seen;
  out.merge_inner = counts.merge_inner;
  out.hittable = !light.delta_position && !light.delta_direction;
  out.light_paths = counts.light_paths;
  out.nee = out.vertices[0].light;
  if (path.points.size() < 3) return out;
  const Vec3 wi = towards(path, 1, 0);
  Guide guide;
  make_guide(scene, path.fields, Side::camera, path.points[1].surface, towards(path, 1, 2), guide);
  const double direct = pdf_next_event(scene, guide, light, wi);
  out.nee =
      light.infinite || light.delta_position ? direct : to_area(direct, path.points[0], wi, distance2(path, 0, 1));
  return out;
}

}  // namespace ajar
