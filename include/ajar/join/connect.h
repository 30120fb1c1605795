// Enters: a light subpath and a camera subpath.
// Leaves: candidates: one strategy's contribution before visibility, the segment to test, and the ends for its MIS
// weight.
#pragma once

#include "ajar/accel/accel.h"
#include "ajar/core/sampler.h"
#include "ajar/join/mis.h"
#include "ajar/path/walk.h"

namespace ajar {

/// The density with which a vertex of one end finds the last one of the other, before its field was asked: that takes
/// time, and only weights of what is visible need it.
struct Finding {
  const Guide* guide = nullptr;     ///< of the vertex; null: nothing is left to ask
  Vec3 w{0};                        ///< direction in which it finds the other
  float pdf = 0;                    ///< of its bsdf alone
  float cosine = 1, distance2 = 1;  ///< at the one that is found; between them
};

/// One way to join two subpaths. value is the contribution to the pixel (or the film, for t = 1, per unit of the filter
/// and light path), divided by all densities, without visibility and weight.
struct Candidate {
  Rgb value{0};
  Segment segment;  ///< that must be free
  End light, camera;
  Finding light_found, camera_found;  ///< what End::other will be, see complete
  NextEvent nee;
  LightPoint point;  ///< s = 1: of the light that was asked
  Vec2 raster{0};    ///< t = 1: where it lands
  Rgb arrives{0};    ///< at the last vertex of a subpath, from the light or lens itself: s = 0 radiance, s = 1
                     ///< irradiance, t = 1 importance (raster area per area); divided by densities, without visibility
};

/// The end of a subpath of two vertices or more at its last one: other is its area density from the other side, reverse
/// the density per solid angle of going back to the vertex before.
inline End end_at(std::span<const Vertex> subpath, double other, double reverse) {
  const Vertex& v = subpath.back();
  const Vertex& before = subpath[subpath.size() - 2];
  const bool delta = before.delta;
  return {int(subpath.size()), v.own, other, before.own, reverse * v.back, delta, v.sum, v.merge, v.seen, before.seen};
}
/// s = 0: the camera subpath's last vertex is on a light. surface is that of the vertex.
bool join_hit(const Scene& scene, const Fields* fields, const Subpath& camera, const Surface& surface, Candidate& out);
/// s = 0: the camera subpath left the scene in the walk's direction; one infinite light.
bool join_escape(const Scene& scene, const Fields* fields, uint32_t light, const Subpath& camera, const Walk& walk,
                 Candidate& out);
/// s = 1: next-event estimation at the camera subpath's vertex t - 1, whose chances these are.
bool join_light(const Scene& scene, const Fields* fields, const Subpath& camera, int t, LightChances& chances,
                const LightNumbers& u, Candidate& out);
/// The last vertex of a light subpath, and what joins to it read of the rest.
struct LightEnd {
  const Vertex* vertex = nullptr;
  int s = 0;  ///< vertices of the subpath, at least 2
  bool delta_before = false;
  double own_before = 1;  ///< Vertex::own of the vertex before
  double nee_ratio = 1;   ///< Subpath::nee_ratio
};
/// Of the first s >= 2 vertices of a light subpath.
LightEnd light_end(const Subpath& light, int s);
/// What lies between the last vertices of a light and a camera subpath.
struct Between {
  Vec3 w{0};  ///< from the light's to the camera's, unit
  float distance2 = 0;
  Segment segment;  ///< that must be free
};
/// False where one of them is sure to scatter nothing to the other. Quick: half of all joins are blocked, and need no
/// more.
bool look_between(const Vertex& light, const Vertex& camera, Between& out);
/// s >= 2, t >= 2: the last vertices of both, and what lies between. False where nothing is scattered.
bool join_vertices(const LightEnd& light, std::span<const Vertex> camera, const Between& between, Candidate& out);
/// All of it, visibility aside.
inline bool join_vertices(const LightEnd& light, std::span<const Vertex> camera, Candidate& out) {
  Between between;
  return look_between(*light.vertex, camera.back(), between) && join_vertices(light, camera, between, out);
}
/// t = 1: the light subpath's vertex s - 1 >= 0 and the lens.
bool join_camera(const Scene& scene, const Vec2& lens, const Subpath& light, int s, Candidate& out);

/// Asks the fields for the densities that are still open.
void complete(Candidate& c);
inline double weight(Heuristic h, Candidate& c, const SampleCounts& counts) {
  complete(c);
  return mis_weight(h, c.light, c.camera, c.nee, counts);
}

}  // namespace ajar
