#include "ajar/field/walls.h"

#include <algorithm>
#include <numeric>

#include "ajar/accel/sight.h"
#include "ajar/core/parallel.h"
#include "ajar/core/sampler.h"
#include "ajar/core/warp.h"
#include "ajar/field/portals.h"
#include "ajar/scene/bsdf.h"
#include "ajar/scene/geometry.h"
#include "ajar/scene/light.h"
#include "keys.h"

namespace ajar {
namespace {

constexpr uint32_t walks = 2048, bounces = 16;  // of the camera, and as many of the lights
constexpr size_t most_points = 64;              // of a cube: a bit each of a uint64_t
constexpr float most_middle = 0.2f;             // of the scene's radius: larger ones are the scene
constexpr float largest_around = 20;            // scene's radius over the middle's: cubes are there for no more

// A point on a surface and its normal on the side where light can come from.
struct Spot {
  Vec3 p{0}, n{0, 0, 1};
};

bool start(const Scene& scene, Side side, Sampler& sampler, CameraRay& out) {
  const Vec2 u = sampler.next2(), v = sampler.next2();
  if (side == Side::camera) {
    const Camera& c = scene.camera;
    out = generate(c, Vec2(c.crop_x, c.crop_y) + u * Vec2(c.crop_width, c.crop_height), v);
    return true;
  }
  if (scene.lights.empty()) return false;
  const uint32_t light =
      std::min(uint32_t(sampler.next1() * float(scene.lights.size())), uint32_t(scene.lights.size() - 1));
  EmissionSample e;
  if (!sample_emission(scene, light, u, v, e)) return false;
  out = {e.point.p, e.direction};
  if (!e.point.infinite && !e.point.delta_position) out.o = offset(e.point.p, e.point.n, e.point.error, e.direction);
  return true;
}

// As if all surfaces were matt and lost nothing; what is clear is passed straight.
void walk(const Scene& scene, const Accel& accel, Side side, uint32_t number, std::vector<Spot>& out) {
  Sampler sampler = make_sampler(SamplerKind::independent, 0, side, number, 0);
  CameraRay ray;
  if (!start(scene, side, sampler, ray)) return;
  for (uint32_t i = 0; i < bounces; ++i) {
    Hit hit;
    const bool looks = i == 0 && side == Side::camera;
    if (!(looks ? first_seen(scene, accel, ray, hit) : accel.intersect(ray.o, ray.d, ray.t_min, ray.t_max, hit)))
      return;
    const Surface surface = make_surface(scene, hit, ray.o, ray.d);
    const Vec3 n = glm::dot(surface.ng, ray.d) > 0 ? -surface.ng : surface.ng;
    Frame frame = surface.frame;
    Bsdf bsdf;
    resolve(scene, surface, -ray.d, frame, bsdf);
    const Vec2 u = sampler.next2();
    if (bsdf.has_smooth) {
      out.push_back({surface.p, n});
      ray.d = make_frame(n).to_world(to_cosine_hemisphere(u));
    }
    ray = {offset(surface.p, surface.ng, surface.error, ray.d), ray.d};
  }
}

// What walks of the camera (even) and of the lights (odd) found.
using Found = std::vector<std::vector<Spot>>;
Found find_spots(const Scene& scene, const Accel& accel) {
  Found found(2 * walks);
  parallel_for(2 * walks, [&](uint32_t i) { walk(scene, accel, i % 2 ? Side::light : Side::camera, i / 2, found[i]); });
  return found;
}

struct Ball {
  Vec3 center{0};
  float radius = infinity;
};

// The part of the scene where nearly all of the camera's walks go.
Ball visited_part(const Found& found) {
  constexpr size_t least_spots = 256;
  constexpr float left_out = 0.05f, margin = 1.3f;  // of the spots on either side; around what is left
  Ball b;
  Vec3 half(0);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> x;
    for (size_t i = 0; i < found.size(); i += 2)
      for (const Spot& s : found[i]) x.push_back(s.p[axis]);
    if (x.size() < least_spots) return b;
    const auto at = [&](float share) {
      const auto nth = x.begin() + std::ptrdiff_t(share * float(x.size() - 1));
      std::nth_element(x.begin(), nth, x.end());
      return *nth;
    };
    const float low = at(left_out), high = at(1 - left_out);
    b.center[axis] = 0.5f * (low + high), half[axis] = 0.5f * (high - low);
  }
  b.radius = margin * std::max({half.x, half.y, half.z});
  return b;
}

// Around a house there may be a lawn that is much larger: cubes of its size would hold whole rooms. Not under a sky:
// docs/results/fields.md. Returns what portals lie in.
Ball focus_on_middle(const Scene& scene, const Found& found, CellTable& table) {
  const Ball all{scene.center, scene.radius};
  if (!scene.infinite_lights.empty()) return all;
  const Ball middle = visited_part(found);
  if (!(middle.radius < most_middle * scene.radius)) return all;
  const float radius = std::max(middle.radius, scene.radius / largest_around);
  table = make_cell_table(middle.center, radius);
  return {middle.center, std::min(2 * radius, scene.radius)};
}

// Cube by cube; some of it where there is much.
std::vector<std::vector<Spot>> spots_of_cubes(const Found& found, const CellTable& table) {
  std::vector<std::vector<Spot>> cubes(table.compartments.size());
  for (const std::vector<Spot>& spots : found)
    for (const Spot& s : spots)
      if (const size_t cube = top_cube(table, s.p); cube < cubes.size()) cubes[cube].push_back(s);
  for (std::vector<Spot>& cube : cubes) {
    if (cube.size() <= most_points) continue;
    for (size_t i = 0; i < most_points; ++i) cube[i] = cube[i * cube.size() / most_points];
    cube.resize(most_points);
  }
  return cubes;
}

// One cube: its points; which others would share a cell with each, and which each sees, as rows of bits.
struct Sight {
  std::vector<Spot> spots;
  std::vector<uint64_t> like, sees;
};

// A plane has to part so many pairs that would share a cell, and no larger share of them may see each other across it.
constexpr int least_pairs = 16;
constexpr float most_seen = 0.25f;

// Pairs of other normals are asked only where enough of the same do not see each other for there to be a plane.
Sight look(const Accel& accel, std::vector<Spot> spots, float lift) {
  Sight s{std::move(spots), {}, {}};
  const size_t n = s.spots.size();
  s.like.assign(n, 0), s.sees.assign(n, 0);
  const auto bit = [](size_t k) { return uint64_t(1) << k; };
  const auto ask = [&](size_t i, size_t j) {
    const Vec3 a = s.spots[i].p + lift * s.spots[i].n, b = s.spots[j].p + lift * s.spots[j].n;
    if (accel.occluded(a, b - a, 1)) return false;
    s.sees[i] |= bit(j), s.sees[j] |= bit(i);
    return true;
  };
  std::vector<uint32_t> bins;
  for (const Spot& spot : s.spots) bins.push_back(normal_bin(spot.n));
  int hidden = 0;
  for (size_t i = 0; i < n; ++i)
    for (size_t j = 0; j < i; ++j) {
      if (bins[i] != bins[j]) continue;
      s.like[i] |= bit(j), s.like[j] |= bit(i);
      hidden += !ask(i, j);
    }
  if (float(hidden) <= (1 - most_seen) * least_pairs) return s;
  for (size_t i = 0; i < n; ++i)
    for (size_t j = 0; j < i; ++j)
      if (bins[i] != bins[j]) ask(i, j);
  return s;
}

struct Plane {
  float at = 0;
  int axis = -1;  // -1: none
  float score = 0;
};

// The plane that the most pairs of points lie on two sides of and do not see each other, where it parts points that
// would share a cell, and next to none of these see each other.
Plane best_plane(const Sight& s, std::vector<uint32_t> of, float edge) {
  const size_t n = of.size();
  Plane best;
  uint64_t all = 0;
  for (const uint32_t i : of) all |= uint64_t(1) << i;
  for (int axis = 0; axis < 3; ++axis) {
    const auto x = [&](size_t k) { return s.spots[of[k]].p[axis]; };
    std::sort(of.begin(), of.end(), [&](uint32_t a, uint32_t b) {
      return std::pair(s.spots[a].p[axis], a) < std::pair(s.spots[b].p[axis], b);
    });
    uint64_t below = 0;
    int pairs = 0, across = 0, hidden = 0;
    for (size_t k = 0; k + 1 < n; ++k) {
      const auto moved = [&](uint64_t with) {
        return std::popcount(with & all & ~below) - std::popcount(with & below);
      };
      const uint64_t like = s.like[of[k]], sees = s.sees[of[k]];
      pairs += moved(like), across += moved(like & sees), hidden += moved(~sees & ~(uint64_t(1) << of[k]));
      below |= uint64_t(1) << of[k];
      if (pairs < least_pairs || x(k + 1) - x(k) < 1e-3f * edge) continue;
      const float score = float(hidden) * (1 - float(across) / (most_seen * float(pairs)));
      if (score > best.score) best = {0.5f * (x(k) + x(k + 1)), axis, score};
    }
  }
  return best;
}

// Compartments so far, those still to be cut among them, and how many have their number.
struct Sides {
  int all = 1, numbered = 0;
};

// Cuts a compartment as often as pays; returns what leads to it: a cut's index, or ~side.
int32_t cut(const Sight& s, const std::vector<uint32_t>& of, float edge, Sides& sides, std::vector<CellCut>& cuts) {
  const Plane plane = sides.all < most_compartments ? best_plane(s, of, edge) : Plane{};
  if (plane.axis < 0) return ~sides.numbered++;
  ++sides.all;
  std::vector<uint32_t> below, above;
  for (const uint32_t i : of) (s.spots[i].p[plane.axis] < plane.at ? below : above).push_back(i);
  const int32_t here = int32_t(cuts.size());
  cuts.push_back({plane.at, plane.axis, 0, 0});
  const int32_t first = cut(s, below, edge, sides, cuts);
  const int32_t second = cut(s, above, edge, sides, cuts);
  cuts[size_t(here)].below = first, cuts[size_t(here)].above = second;
  return here;
}

}  // namespace

void cut_along_walls(const Scene& scene, const Accel& accel, CellTable& table) {
  const Found found = find_spots(scene, accel);
  const Ball part = focus_on_middle(scene, found, table);
  table.compartments.assign(all_top_cubes, ~0);
  const std::vector<std::vector<Spot>> cubes = spots_of_cubes(found, table);
  std::vector<std::vector<CellCut>> cuts(cubes.size());
  parallel_for(cubes.size(), [&](size_t c) {
    if (cubes[c].size() < 8) return;
    std::vector<uint32_t> of(cubes[c].size());
    std::iota(of.begin(), of.end(), 0);
    Sides sides;
    cut(look(accel, cubes[c], table.width / 64), of, table.width, sides, cuts[c]);
  });
  for (size_t c = 0; c < cubes.size(); ++c) {
    if (cuts[c].empty()) continue;
    const int32_t shift = int32_t(table.cuts.size());
    table.compartments[c] = shift;
    for (CellCut k : cuts[c]) {
      if (k.below >= 0) k.below += shift;
      if (k.above >= 0) k.above += shift;
      table.cuts.push_back(k);
    }
  }
  table.shortcuts = {};
  table.portals = find_portals(table.cuts, part.center, part.radius, table.width);
}

}  // namespace ajar
