#include "ajar/join/mis.h"

namespace ajar {
namespace {

// v of (R2) for the strategy that connects the end's last vertex to the one before.
double v_of_last(const End& end, double first, double inner) {
  return end.delta_before ? 0 : (end.n == 2 ? first : inner);
}

// Sum over the strategies that take vertices away from this end, relative to "this end keeps all n with ordinary
// densities". first and inner, raised, are v of the strategies that leave one vertex and more; the ratios of density
// are raised here.
double handed_over(Heuristic h, const End& end, double first, double inner, double merge_count) {
  if (end.n == 0) return 0;
  const double last = raise(h, ratio(end.other, end.own));
  if (end.n == 1) return last * end.sum_before;                                                   // S_0
  const double v = v_of_last(end, first, inner) + merge_at(h, end.own, end.merge * merge_count);  // (K5)
  return last * extend(v, raise(h, ratio(end.other_before, end.own_before)), end.sum_before);     // (R3)
}

// Whether the lens sees the vertex of next-event estimation.
bool sees_first(const End& light, const End& camera) {
  return light.n == 0 ? camera.seen_before : light.n == 1 ? camera.seen : light.n == 2 && camera.n == 1;
}

// What s = 0 or s = 1, at hand, has of what they have both: by densities, where each ray to a light counts. (J11)
double share_of_pair(double hit, double nee, double rays, bool hits) {
  const double both = hit + rays * nee;
  return both > 0 ? (hits ? hit : rays * nee) / both * (hit + nee) : 0;
}

}  // namespace

double mis_weight(Heuristic h, const End& light, const End& camera, const NextEvent& nee, const SampleCounts& counts) {
  const double first_seen = sees_first(light, camera) ? counts.first_seen : 1;
  const double lit = raise(h, nee.ratio * first_seen), film = raise(h, counts.light_paths);
  // Everything relative to the product of ordinary densities with s vertices from emission and t from the camera. (R1)
  const bool both_walked = light.n > 1 && camera.n > 1;
  const double here =
      both_walked ? raise(h, join_count(counts, camera.seen)) : (light.n == 1 ? lit : 1) * (camera.n == 1 ? film : 1);
  // The light's last vertex becomes the camera's.
  const bool seen = camera.n == 1;
  const double fewer_light =
      handed_over(h, light, lit, raise(h, join_count(counts, seen)), seen ? 1 : counts.merge_inner);
  // A strategy with t - 1 .. 1 camera vertices; s + 1 of light: next-event estimation where that is the first one.
  double fewer_camera, next_event = here;
  if (light.n == 0 && camera.n >= 2) {
    // s = 1 next: the connection of c_(t-2) to the light's point found afresh.
    const double last = raise(h, ratio(camera.other, camera.own));
    const double v = v_of_last(camera, 0, lit);
    fewer_camera = last * extend(v, raise(h, ratio(camera.other_before, camera.own_before)), camera.sum_before);
    next_event = last * v;
  } else {
    fewer_camera = handed_over(h, camera, film, raise(h, join_count(counts, camera.seen_before)), 1);
  }
  const double all = here + fewer_light + fewer_camera, rays = raise(h, nee.rays / first_seen);
  if (light.n > 1 || rays == 1) return here / all;
  return share_of_pair(light.n == 0 ? here : fewer_light, next_event, rays, light.n == 0) / all;
}

double mis_of_camera(Heuristic h, const End& light, const End& camera, const NextEvent& nee,
                     const SampleCounts& counts) {
  const double film = raise(h, counts.light_paths), inner = raise(h, counts.inner);
  const double fewer_light = handed_over(h, light, raise(h, nee.ratio), inner, 0),
               fewer_camera = handed_over(h, camera, film, inner, 0);
  return fewer_light > 0 ? fewer_light / (fewer_light + fewer_camera) : fewer_camera > 0 ? 0 : 1;
}

MergeSide merge_side(Heuristic h, const End& end, double back, double first, const SampleCounts& counts) {
  const double own = raise(h, ratio(1, end.own));
  const double before = std::min(raise(h, ratio(back, end.own_before)) * end.sum_before, largest_ratio * largest_ratio);
  return {v_of_last(end, raise(h, first), raise(h, join_count(counts, end.seen_before))) * own, before * own};
}

double merge_weight(Heuristic h, double merge, const MergeSide& light, double light_reverse, const MergeSide& camera,
                    double camera_reverse) {
  const double here = raise(h, merge);
  const double sum_light = light.fixed + light.slope * raise(h, light_reverse);
  const double sum_camera = camera.fixed + camera.slope * raise(h, camera_reverse);
  return here > 0 ? here / (here + sum_light + sum_camera) : 0;  // (K6)
}

}  // namespace ajar
