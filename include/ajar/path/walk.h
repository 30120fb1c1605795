// Enters: the start of a subpath on the lens or on a light, a sampler.
// Leaves: the subpath, vertex by vertex, with throughput, densities of both sides and MIS prefix sums.
#pragma once

#include "ajar/accel/accel.h"
#include "ajar/core/sampler.h"
#include "ajar/field/emission.h"
#include "ajar/field/nextevent.h"
#include "ajar/path/prefix.h"
#include "ajar/path/vertex.h"

namespace ajar {

/// Counts of one thread; added up at the end.
struct Counters {
  uint64_t camera_rays = 0, light_rays = 0, shadow_rays = 0;
  uint64_t camera_paths = 0, light_paths = 0;
  uint64_t zero_paths = 0;  ///< samples that brought nothing: black, and no splat
  uint64_t joins = 0;       ///< tried at camera vertices: next-event estimations and hits of lights too
  uint64_t beyond = 0;      ///< rays of camera subpaths and joins behind the first vertex that is joined, where
                            ///< roulette might have ended the subpath

  Counters& operator+=(const Counters& o);
};

/// Where light subpaths are merged into camera subpaths: within a radius that depends on the place alone, so that both
/// sides agree on it. It is as large as so many pixels look from the eye, wherever the place is seen from.
struct Merging {
  double paths = 0;  ///< light subpaths that each camera vertex is merged with; 0: no merging
  Vec3 eye{0};
  float per_distance = 0;     ///< radius over distance from the eye, steepest_radius at most
  float least = 0, most = 0;  ///< radius [m]
};

/// Radii that change faster would need light vertices of more than two sizes at once (join/photons.h).
inline constexpr float steepest_radius = 0.25f;

inline float merge_radius(const Merging& m, const Vec3& p) {
  return std::clamp(m.per_distance * std::sqrt(length2(p - m.eye)), m.least, m.most);
}

/// pi r^2 N: what one side's density at a place is multiplied by for a merge there.
inline float merge_density(const Merging& m, const Vec3& p) {
  return m.paths > 0 ? pi * sqr(merge_radius(m, p)) * float(m.paths) : 0;
}

/// Beyond so many vertices no subpath is sure to go on.
inline constexpr int sure_vertices = 64;

struct WalkOptions {
  int max_edges = 1 << 20;  ///< of a whole path from light to camera
  int roulette_from = 5;    ///< edges that are traced without roulette
  Heuristic heuristic = Heuristic::power;
  float window = 5;                ///< guided subpaths that promise less than 1 / window of their start face roulette
  float goes_on = 1;               ///< so many times more camera subpaths go on than that (G16)
  const Fields* fields = nullptr;  ///< guide the subpaths; null: unguided
  SampleCounts counts;
  Merging merging;
};

/// The ray that will find the next vertex, and what that vertex needs to know about its making.
struct Walk {
  Side side = Side::camera;
  Vec3 o{0}, d{0, 0, 1};
  float t_min = 0, t_max = infinity;
  Rgb beta{1};          ///< throughput that the next vertex receives
  double pdf = 1;       ///< solid-angle density of d; when planar, density per area perpendicular to d; from the lens
                        ///< 1, after a delta event its probability
  bool planar = false;  ///< parallel light from infinity: no 1/d^2
  double other_before = 0;  ///< area density of a_(n-2) as the other side would generate it from a_(n-1)
  double sum = 0;           ///< S of the vertex that the ray leaves (R2); set by step, also when the ray escapes
  bool escaped = false;     ///< the ray left the scene
  EmissionSample start;     ///< of a light subpath
  Rgb survival{1};          ///< throughput since the start, for roulette
  bool sure = true;         ///< roulette could not have ended it so far
  float promise = 0;        ///< what the fields expected the subpath to bring when it began; 0: they do not know
};

/// Numbers of a vertex's next-event estimation: takes two pairs, of which a single light uses one. False where that
/// light cannot be seen.
inline bool draw_light(const Scene& scene, const Guide& guide, Sampler& sampler, LightNumbers& u) {
  const uint32_t choice = sampler.skip(), point = sampler.skip();
  if (guide.bsdf.opaque && scene.lights.size() == 1 && !may_light(scene, 0, guide.p, guide.frame.n)) return false;
  u.choice = chooses_light(scene, guide) ? sampler.at(choice).x : 0;
  u.point = sampler.at(point);
  return true;
}

/// The largest probability of going on that roulette knows. A constant c would give paths through surfaces of albedo
/// above sqrt(c) weights of infinite variance, however many paths; this one lets a path of n vertices live with a
/// chance of about 9 / n, so that its weight grows slower than any albedo takes away, and a path that loses nothing
/// still ends soon.
inline float surest(int vertices) { return std::max(0.95f, 1 - 1 / float(vertices)); }  // (R4)

/// The lowest probability from least to most with which roulette by what fields expect does not raise a throughput to
/// more than the window's times that of the start: what they know nothing of, or lie about, would come back as rare and
/// bright samples. (G6, G15)
inline float lowest_chance(const WalkOptions& options, const Rgb& survival, float least, float most) {
  return std::clamp(max_component(survival) / options.window, least, most);
}

/// Probability that a subpath of so many vertices goes on. Where the field knows what is still to be expected of it,
/// that decides, against what was expected at its start (promised: set here the first time that it is known), within
/// lowest_chance. Elsewhere the throughput decides.
inline float survival_probability(const WalkOptions& options, const Guide& guide, int vertices, const Rgb& beta,
                                  const Rgb& survival, float& promised) {
  if (options.fields) {
    const Promise p = promise(guide, beta);
    if (!(promised > 0)) promised = p.all;
    const float most = vertices > sure_vertices ? surest(vertices) : 1;
    const float least = lowest_chance(options, survival, 0.05f, most);
    if (p.beyond > 0 && promised > 0) {
      const float window = guide.side == Side::camera ? options.window * options.goes_on : options.window;
      return std::clamp(window * p.beyond / promised, least, most);  // (G6)
    }
  }
  return vertices > options.roulette_from ? std::min(max_component(survival), surest(vertices)) : 1;
}

/// Samples the direction in which a path goes on, beta and survival times its weight; with roulette only some go on.
/// Returns the probability with which it did; 0 where it ends. Takes two pairs of numbers.
inline float choose_direction(const Guide& guide, Mode mode, const WalkOptions& options, int vertices, Sampler& sampler,
                              Rgb& beta, Rgb& survival, float& promised, GuideSample& out) {
  const uint32_t lobe_and_roulette = sampler.skip();
  const float u_lobe = chooses(guide) ? sampler.at(lobe_and_roulette).x : 0;
  const Rgb arrived = beta;
  if (!sample(guide, u_lobe, sampler.next2(), mode, out) || is_black(out.weight)) return 0;
  beta *= out.weight;
  survival *= out.weight * (mode == Mode::radiance ? sqr(out.eta) : 1.0f);
  const float q = survival_probability(options, guide, vertices, arrived, survival, promised);
  if (q == 1) return 1;
  if (!(sampler.at(lobe_and_roulette).y < q)) return 0;
  beta /= q;
  survival /= q;
  return q;
}

/// Starts at the camera: vertex 0 and the ray through a raster position.
void start_camera(const Scene& scene, const Vec2& raster, const Vec2& lens, Subpath& subpath, Walk& walk);
/// Starts at a light; false where there is none or it emits nothing here.
bool start_light(const Scene& scene, const WalkOptions& options, Sampler& sampler, Subpath& subpath, Walk& walk);
/// Traces the ray and adds the vertex that it hits; false when it escapes. surface is what was hit.
bool step(const Scene& scene, const Accel& accel, const WalkOptions& options, Subpath& subpath, Walk& walk,
          Surface& surface);
/// Samples the direction in which the subpath goes on from its last vertex; false when it ends there.
bool scatter(const WalkOptions& options, Sampler& sampler, Subpath& subpath, Walk& walk);

/// Where a shadow ray of this length and unit direction d (away from the surface) ends, off the surface that it goes
/// to: the ray tracer's rounding of the distance grows with the length.
inline Vec3 shadow_end(const Vec3& p, const Vec3& ng, float error, const Vec3& d, float length) {
  return offset(p, ng, std::max(error, 0x1p-20f * length), d);
}

/// What must be free for two points to see each other: o + t d, t in (0, t_max), off the surfaces at both ends.
struct Segment {
  Vec3 o{0}, d{0};
  float t_max = 1;
};

/// From a surface point to the light's point that next-event estimation found for it.
inline Segment segment_to(const DirectSample& light, const Vec3& p, const Vec3& ng, float error) {
  const LightPoint& l = light.point;
  const Vec3 o = offset(p, ng, error, light.wi);
  if (l.infinite) return {o, light.wi, infinity};
  return {o, (l.delta_position ? l.p : shadow_end(l.p, l.n, l.error, -light.wi, light.distance)) - o};
}

inline bool visible(const Accel& accel, const Segment& s) { return !accel.occluded(s.o, s.d, s.t_max); }

/// p_N / p_L: density of next-event estimation at a vertex x over that of emission for the same point of a light, along
/// unit wi (x to light). emission: of that point and direction.
double ratio_of_next_event(const Scene& scene, const Vertex& x, const LightPoint& point, const Vec3& wi,
                           double distance2, const EmissionPdf& emission);

}  // namespace ajar
