#include "ajar/join/mis.h"

namespace ajar {
namespace {

// What a join of two walked vertices counts for, raised. (J7)
double join_share(Heuristic h, const Shares& shares, bool seen) { return raise(h, seen ? shares.seen : shares.inner); }

// v of (R2) for the strategy that connects the end's last vertex to the one before.
double share_before(const End& end, double first, double inner) {
  return end.delta_before ? 0 : (end.n == 2 ? first : inner);
}

// Sum over the strategies that take vertices away from this end, relative to "this end keeps all n with ordinary
// densities". first and inner are the raised shares of the strategies that leave one vertex and more; the ratios of
// density are raised here.
double handed_over(Heuristic h, const End& end, double first, double inner, double merge_share) {
  if (end.n == 0) return 0;
  const double last = raise(h, ratio(end.other, end.own));
  if (end.n == 1) return last * end.sum_before;                                                          // S_0
  const double share = share_before(end, first, inner) + merge_at(h, end.own, end.merge * merge_share);  // (K5)
  return last * extend(share, raise(h, ratio(end.other_before, end.own_before)), end.sum_before);        // (R3)
}

// Whether the lens sees the vertex of next-event estimation.
bool sees_first(const End& light, const End& camera) {
  return light.n == 0 ? camera.seen_before : light.n == 1 ? camera.seen : light.n == 2 && camera.n == 1;
}

// What s = 0 or s = 1, at hand, has of what they have both: by densities, where each ray to a light counts. (J11)
double share_of_pair(double hit, double nee, double rays, bool hits) {
  return (hits ? hit : rays * nee) / (hit + rays * nee) * (hit + nee);
}

}  // namespace

double mis_weight(Heuristic h, const End& light, const End& camera, const Shares& shares) {
  const double first_seen = sees_first(light, camera) ? shares.first_seen : 1;
  const double nee = raise(h, shares.light_first * first_seen), film = raise(h, shares.camera_first);
  // Everything relative to the product of ordinary densities with s vertices from emission and t from the camera. (R1)
  const bool both_walked = light.n > 1 && camera.n > 1;
  const double here =
      both_walked ? join_share(h, shares, camera.seen) : (light.n == 1 ? nee : 1) * (camera.n == 1 ? film : 1);
  // The light's last vertex becomes the camera's.
  const bool seen = camera.n == 1;
  const double fewer_light = handed_over(h, light, nee, join_share(h, shares, seen), seen ? 1 : shares.merge_inner);
  // A strategy with t - 1 .. 1 camera vertices; s + 1 of light: next-event estimation where that is the first one.
  double fewer_camera, next_event = here;
  if (light.n == 0 && camera.n >= 2) {
    // s = 1 next: the connection of c_(t-2) to the light's point found afresh.
    const double last = raise(h, ratio(camera.other, camera.own));
    const double share = camera.delta_before ? 0 : (camera.n == 2 ? 0.0 : nee);
    fewer_camera = last * extend(share, raise(h, ratio(camera.other_before, camera.own_before)), camera.sum_before);
    next_event = last * share;
  } else {
    fewer_camera = handed_over(h, camera, film, join_share(h, shares, camera.seen_before), 1);
  }
  const double all = here + fewer_light + fewer_camera, rays = raise(h, shares.next_events / first_seen);
  if (light.n > 1 || rays == 1) return here / all;
  return share_of_pair(light.n == 0 ? here : fewer_light, next_event, rays, light.n == 0) / all;
}

double mis_of_camera(Heuristic h, const End& light, const End& camera, const Shares& shares) {
  const double nee = raise(h, shares.light_first), film = raise(h, shares.camera_first), inner = raise(h, shares.inner);
  const double fewer_light = handed_over(h, light, nee, inner, 0),
               fewer_camera = handed_over(h, camera, film, inner, 0);
  return fewer_light > 0 ? fewer_light / (fewer_light + fewer_camera) : fewer_camera > 0 ? 0 : 1;
}

MergeSide merge_side(Heuristic h, const End& end, double back, const Shares& shares, Side side) {
  const double own = raise(h, ratio(1, end.own));
  const double first = raise(h, side == Side::light ? shares.light_first : shares.camera_first);
  const double before = std::min(raise(h, ratio(back, end.own_before)) * end.sum_before, largest_ratio * largest_ratio);
  return {share_before(end, first, join_share(h, shares, end.seen_before)) * own, before * own};
}

double merge_weight(Heuristic h, double merge, const MergeSide& light, double light_reverse, const MergeSide& camera,
                    double camera_reverse) {
  const double here = raise(h, merge);
  const double sum_light = light.fixed + light.slope * raise(h, light_reverse);
  const double sum_camera = camera.fixed + camera.slope * raise(h, camera_reverse);
  return here > 0 ? here / (here + sum_light + sum_camera) : 0;  // (K6)
}

}  // namespace ajar
