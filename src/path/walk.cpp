#include "ajar/path/walk.h"

#include "ajar/accel/sight.h"

namespace ajar {
namespace {

// v_i of (R2) for i = n - 1 >= 1, the strategy that would connect the last vertex to the one before it.
double v_of_walk(const WalkOptions& options, const Subpath& subpath, const Walk& walk) {
  const int last = subpath.n - 1;
  if (subpath[last].delta || subpath[last - 1].delta) return 0;
  if (last == 1)
    return raise(options.heuristic, walk.side == Side::camera ? options.counts.light_paths : subpath.nee_ratio);
  return raise(options.heuristic, join_count(options.counts, subpath[last - 1].seen));
}

// S of the subpath's last vertex, now that its event is known.
double sum_of_last(const WalkOptions& options, const Subpath& subpath, const Walk& walk) {
  const Vertex& last = subpath[subpath.n - 1];
  if (subpath.n == 1) return last.sum;
  double v = v_of_walk(options, subpath, walk);
  if (last.merge > 0 && !last.delta) {
    const double part = walk.side == Side::camera ? 1 : options.counts.merge_inner;
    v += merge_at(options.heuristic, last.own, last.merge * part);  // (K5)
  }
  const double r = raise(options.heuristic, ratio(walk.other_before, subpath[subpath.n - 2].own));
  return extend(v, r, last.sum);  // (R2)
}

// The new vertex that a walk found from the one before, on either side, but for what its merges count for.
void set_vertex(const Walk& walk, const Surface& surface, const Vertex& before, Vertex& v) {
  const float cosine = std::abs(glm::dot(surface.ng, walk.d));
  v.p = surface.p, v.error = surface.error, v.ng = surface.ng;
  v.distance2 = walk.planar ? 1 : length2(v.p - before.p);
  v.beta = walk.beta;
  v.own = walk.pdf * cosine / v.distance2;
  v.back = walk.planar ? 1 : (before.ng == Vec3(0) ? 1 : std::abs(glm::dot(before.ng, walk.d))) / v.distance2;
  v.sum = walk.sum;
  v.delta = false, v.infinite = false, v.seen = false;
  v.emitted = 0, v.received = 0, v.next_events = 1;
}

// What the camera's vertices have beside: whether the lens sees them, for the first the density of its pixel, and for
// those beyond the first that is merged how much less their merges count.
void set_camera_vertex(const Camera& camera, const SampleCounts& counts, bool first, const Vertex& before,
                       const Walk& walk, Vertex& v) {
  v.seen = first || (before.seen && before.delta);
  if (first) {
    v.own = raster_factor(camera, before.p, v.p) * std::abs(glm::dot(v.ng, walk.d));
    return;
  }
  if (!v.seen) v.merge *= float(counts.merge_inner);
}

}  // namespace

Counters& Counters::operator+=(const Counters& o) {
  camera_rays += o.camera_rays, light_rays += o.light_rays, shadow_rays += o.shadow_rays;
  camera_paths += o.camera_paths, light_paths += o.light_paths;
  zero_paths += o.zero_paths;
  joins += o.joins, beyond += o.beyond;
  return *this;
}

void start_camera(const Scene& scene, const Vec2& raster, const Vec2& lens, Subpath& subpath, Walk& walk) {
  const CameraRay ray = generate(scene.camera, raster, lens);
  subpath.clear();
  Vertex& v = subpath.add();
  v.p = ray.o, v.error = 0, v.ng = Vec3(0);
  v.own = 1, v.sum = 0, v.delta = false, v.infinite = false, v.seen = false;
  v.beta = Rgb(1);
  walk = Walk{};
  walk.o = ray.o, walk.d = ray.d, walk.t_min = ray.t_min, walk.t_max = ray.t_max;
}

bool start_light(const Scene& scene, const WalkOptions& options, Sampler& sampler, Subpath& subpath, Walk& walk) {
  subpath.clear();
  if (scene.lights.empty()) return false;
  walk = Walk{};
  const uint32_t choice = sampler.skip();
  const float u_choice = scene.light_tree.pieces.size() > 1 ? sampler.at(choice).x : 0;
  const Vec2 u_position = sampler.next2(), u_direction = sampler.next2();
  EmissionSample& e = walk.start;
  if (!sample_emission(scene, options.fields, u_choice, u_position, u_direction, e) || is_black(e.radiance))
    return false;
  const LightPoint& point = e.point;
  const bool place = point.infinite || point.delta_position;
  const float cosine = place ? 1 : std::abs(glm::dot(point.n, e.direction));
  Vertex& v = subpath.add();
  v.p = point.p, v.error = point.error, v.ng = point.n;
  v.infinite = point.infinite;
  v.delta = false, v.seen = false;
  v.own = point.infinite ? e.pdf_direction : e.pdf_position;
  v.sum = point.delta_position || point.delta_direction ? 0 : 1;
  v.beta = e.radiance / (point.infinite ? e.pdf_direction : e.pdf_position);
  v.point = point;
  walk.side = Side::light;
  walk.o = place ? point.p : offset(point.p, point.n, point.error, e.direction);
  walk.d = e.direction;
  walk.planar = point.infinite;
  walk.pdf = point.infinite ? e.pdf_position : e.pdf_direction;
  walk.beta = v.beta * float(cosine / walk.pdf);
  return true;
}

double ratio_of_next_event(const Scene& scene, const Vertex& x, const LightPoint& point, const Vec3& wi,
                           double distance2, const EmissionPdf& emission) {
  double direct;
  // Where the normals disagree nothing scatters but what is merged, beside it, by a normal that is bent otherwise.
  if (x.guide.blocked) {
    Guide flat = x.guide;
    flat.frame.n = flat.ng;
    direct = pdf_next_event(scene, flat, point, wi);
  } else {
    direct = pdf_next_event(scene, x.guide, point, wi);
  }
  if (point.infinite) return ratio(direct, emission.direction);
  if (point.delta_position) return ratio(direct, emission.position);
  return ratio(direct * std::abs(glm::dot(point.n, wi)) / distance2, emission.position);
}

bool step(const Scene& scene, const Accel& accel, const WalkOptions& options, Subpath& subpath, Walk& walk,
          Surface& surface) {
  walk.sum = sum_of_last(options, subpath, walk);
  const CameraRay ray{walk.o, walk.d, walk.t_min, walk.t_max};
  const bool first = subpath.n == 1, by_camera = walk.side == Side::camera;
  Hit hit;
  walk.escaped = !(first && by_camera ? first_seen(scene, accel, ray, hit)
                                      : accel.intersect(ray.o, ray.d, ray.t_min, ray.t_max, hit));
  if (walk.escaped) return false;
  set_surface(scene, hit, walk.o, walk.d, surface);
  Vertex& v = subpath.add();
  const Vertex& before = subpath[subpath.n - 2];
  set_vertex(walk, surface, before, v);
  v.shape = hit.shape;
  v.merge = merge_density(options.merging, v.p);
  if (by_camera) set_camera_vertex(scene.camera, options.counts, first, before, walk, v);
  make_guide(scene, options.fields, walk.side, surface, -walk.d, v.guide);
  if (first && !by_camera)
    subpath.nee_ratio = ratio_of_next_event(scene, v, before.point, -walk.d, v.distance2,
                                            {walk.start.pdf_position, walk.start.pdf_direction});
  return true;
}

bool scatter(const WalkOptions& options, Sampler& sampler, Subpath& subpath, Walk& walk) {
  Vertex& v = subpath[subpath.n - 1];
  const Mode mode = walk.side == Side::camera ? Mode::radiance : Mode::importance;
  GuideSample s;
  walk.beta = v.beta;
  const float q =
      choose_direction(v.guide, mode, options, subpath.n, sampler, walk.beta, walk.survival, walk.promise, s);
  if (q == 0) return false;
  walk.sure = walk.sure && q == 1;
  v.delta = s.delta;
  walk.o = offset(v.p, v.ng, v.error, s.wi);
  walk.d = s.wi;
  walk.t_min = 0, walk.t_max = infinity;
  walk.pdf = s.pdf;
  walk.planar = false;
  walk.other_before = double(s.pdf_reverse) * v.back;
  return true;
}

}  // namespace ajar
