// How much of a render is ray tracing: renders passes on one thread, records every ray on the way to Embree, then sends
// the same rays through a bare loop of rtcIntersect1 / rtcOccluded1. Prints rays/s of both and their ratio, in turn,
// several times; beside it the ratio that a renderer would reach which does nothing but find each hit's surface and
// draw one pair of numbers for each ray.
//
//   bench_rays SCENE.xml INTEGRATOR [WIDTH HEIGHT [PASSES [ROUNDS [MAX_DEPTH]]]]

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <cstdlib>

#include "ajar/core/error.h"
#include "ajar/core/sampler.h"
#include "ajar/render/render.h"
#include "ajar/scene/geometry.h"
#include "ajar/scene/load.h"

namespace {

struct Recorded {
  RTCRay ray;
  bool any_hit;
};

/// A ray as it was before Accel stretched it for Embree.
struct Asked {
  ajar::Vec3 o, d;
  float t_min, t_max;
  bool any_hit;
};

// The wrapped entry points below have no other way to reach the benchmark.
bool recording = false;
std::vector<Recorded> rays;
RTCScene traced = nullptr;

}  // namespace

extern "C" {
void __real_rtcIntersect1(RTCScene, RTCIntersectContext*, RTCRayHit*);
void __real_rtcOccluded1(RTCScene, RTCIntersectContext*, RTCRay*);

void __wrap_rtcIntersect1(RTCScene scene, RTCIntersectContext* context, RTCRayHit* hit) {
  if (recording) rays.push_back({hit->ray, false}), traced = scene;
  __real_rtcIntersect1(scene, context, hit);
}

void __wrap_rtcOccluded1(RTCScene scene, RTCIntersectContext* context, RTCRay* ray) {
  if (recording) rays.push_back({*ray, true}), traced = scene;
  __real_rtcOccluded1(scene, context, ray);
}
}

namespace {

using namespace ajar;

double render_once(const Scene& scene, const Accel& accel, const RenderOptions& options) {
  RenderState state = start_render(scene, options);
  render(scene, accel, options, state, [](const RenderState&) { return true; });
  return state.stats.cpu_seconds;
}

double bare_loop(uint64_t& hits) {
  const double start = process_cpu_seconds();
  for (const Recorded& r : rays) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (r.any_hit) {
      RTCRay ray = r.ray;
      __real_rtcOccluded1(traced, &context, &ray);
      hits += ray.tfar < 0;
    } else {
      RTCRayHit hit;
      hit.ray = r.ray;
      hit.hit.geomID = hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      __real_rtcIntersect1(traced, &context, &hit);
      hits += hit.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
  }
  return process_cpu_seconds() - start;
}

std::vector<Asked> asked() {
  std::vector<Asked> result;
  for (const auto& [ray, any_hit] : rays) {
    const Vec3 stretched(ray.dir_x, ray.dir_y, ray.dir_z);
    const float l = glm::length(stretched);
    result.push_back({{ray.org_x, ray.org_y, ray.org_z}, stretched / l, ray.tnear * l, ray.tfar * l, any_hit});
  }
  return result;
}

double least_loop(const Scene& scene, const Accel& accel, const std::vector<Asked>& asked, uint64_t& hits, float& sum) {
  const double start = process_cpu_seconds();
  Sampler sampler;
  uint32_t drawn = 0;
  for (const Asked& ray : asked) {
    if (drawn++ % 8 == 0)
      sampler.start(make_stream(SamplerKind::sobol, 1, Side::camera, drawn, 1));  // as often as paths
    Hit hit;
    const bool found = ray.any_hit ? accel.occluded(ray.o, ray.d, ray.t_max)
                                   : accel.intersect(ray.o, ray.d, ray.t_min, ray.t_max, hit);
    hits += found;
    if (found && !ray.any_hit) sum += make_surface(scene, hit, ray.o, ray.d).frame.n.x;
    sum += sampler.next2().x;
  }
  return process_cpu_seconds() - start;
}

int argument(int argc, char** argv, int i, int otherwise) { return argc > i ? std::atoi(argv[i]) : otherwise; }

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 3) return fmt::print("bench_rays SCENE.xml INTEGRATOR [WIDTH HEIGHT [PASSES [ROUNDS [MAX_DEPTH]]]]\n"), 2;
  Scene scene = load_scene(argv[1]);
  RenderOptions options;
  options.integrator = argv[2];
  options.threads = 1;
  options.max_depth = argument(argc, argv, 7, scene.hints.max_depth);
  const int width = argument(argc, argv, 3, 320), height = argument(argc, argv, 4, 180);
  scene.camera.plane.y = scene.camera.plane.x * float(height) / float(width);
  scene.camera.width = scene.camera.crop_width = width, scene.camera.height = scene.camera.crop_height = height;
  options.spp = uint32_t(argument(argc, argv, 5, 4));
  const Accel accel(scene);
  const double samples = double(width) * height * options.spp;
  recording = true;
  render_once(scene, accel, options);
  recording = false;
  const std::vector<Asked> plain = asked();
  fmt::print("{} {} {}x{}, {} passes: {:.2f} rays per sample\n", argv[1], argv[2], width, height, options.spp,
             double(rays.size()) / samples);
  for (int round = 0; round < argument(argc, argv, 6, 5); ++round) {
    uint64_t hits = 0, hits_again = 0;
    float sum = 0;
    double bare = 0, whole = 0;  // each round in the other order
    if (round % 2 == 0) bare = bare_loop(hits);
    whole = render_once(scene, accel, options);
    if (round % 2 == 1) bare = bare_loop(hits);
    const double least = least_loop(scene, accel, plain, hits_again, sum);
    if (std::abs(double(hits) - double(hits_again)) > 1e-3 * double(rays.size()))  // rounding moves a few
      throw Error(fmt::format("the loops find {} and {} hits, so they do not trace the same rays", hits, hits_again));
    fmt::print(
        "bare {:.3f} Mrays/s  render {:.3f} Mrays/s  ratio {:.3f}  at most {:.3f}  {:.3f} us CPU per sample  ({} hits, "
        "{:.0f})\n",
        rays.size() / bare * 1e-6, rays.size() / whole * 1e-6, bare / whole, bare / least, whole / samples * 1e6, hits,
        sum);
  }
  return 0;
} catch (const ajar::Error& e) {
  return fmt::print(stderr, "{}\n", e.what()), 2;
}
