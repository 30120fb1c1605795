#include "ajar/field/portals.h"

#include <algorithm>
#include <atomic>

#include "fixed.h"
#include "tree.h"

namespace ajar {
namespace {

// Cuts of one plane lie within this share of a cube's width of each other; so many make a wall.
constexpr float one_plane = 1 / 8.0f;
constexpr size_t least_cuts = 4;

// Where lines through a wall are closest together, heavier ones count as this.
constexpr double heaviest_line = 1024;

struct Wall {
  size_t cuts = 0;
  int axis = 0;
  float at = 0;
};

// The plane of the most cuts, whose places are taken away with what is beside them; places: sorted, for each axis.
Wall take_wall(std::vector<float> (&places)[3], float width) {
  Wall best;
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<float>& x = places[axis];
    for (size_t i = 0, j = 0; i < x.size(); ++i) {
      while (j < x.size() && x[j] - x[i] <= one_plane * width) ++j;
      if (j - i > best.cuts) best = {j - i, axis, x[(i + j) / 2]};
    }
  }
  std::erase_if(places[best.axis], [&](float x) { return std::abs(x - best.at) <= 2 * one_plane * width; });
  return best;
}

}  // namespace

std::vector<Portal> find_portals(const std::vector<CellCut>& cuts, const Vec3& center, float radius, float width) {
  std::vector<float> places[3];
  for (const CellCut& c : cuts) places[c.axis].push_back(c.at);
  for (std::vector<float>& x : places) std::sort(x.begin(), x.end());
  std::vector<Portal> portals;
  while (portals.size() < most_portals) {
    const Wall wall = take_wall(places, width);
    if (wall.cuts < least_cuts) break;
    Vec3 middle = center;
    middle[wall.axis] = wall.at;
    const float disk = safe_sqrt(sqr(radius) - length2(middle - center));
    if (disk > 0) portals.push_back({wall.axis, wall.at, middle, disk});
  }
  return portals;
}

bool add_portals(Fields& fields) {
  const size_t n = 2 * fields.table.portals.size();
  if (fields.q.portals.size() == n) return false;
  fields.lines.assign(n / 2 * line_sums, 0);
  for (Field* f : {&fields.q, &fields.w})
    while (f->portals.size() < n) {
      add_cell(*f, none, Structure::adaptive);
      f->portals.push_back(f->cells.back());
      f->cells.pop_back();
    }
  return true;
}

void record_line(const Portal& portal, const Vec3& p, const Vec3& w, double weight, int64_t* sums) {
  const int a = portal.axis, beside[2] = {first_beside[a], second_beside[a]};
  const double along = w[a], carried = std::min(weight, heaviest_line) * along * along;
  // Not cut, which would depend on the order: after some 10^8 of the heaviest it starts again at the other end.
  const auto put_signed = [&](size_t i, double x) {
    const int64_t n = x < 0 ? -to_fixed(-x, value_step) : to_fixed(x, value_step);
    std::atomic_ref<int64_t>(sums[i]).fetch_add(n, std::memory_order_relaxed);
  };
  add(sums[0], to_fixed(carried, value_step));
  for (size_t i = 0; i < 2; ++i) {
    const int b = beside[i];
    const double slope = w[b] / along, at = (p[b] - portal.center[b] + slope * (portal.wall - p[a])) / portal.radius;
    const size_t first = 1 + 5 * i;
    put_signed(first, carried * at), put_signed(first + 1, carried * slope),
        put_signed(first + 3, carried * at * slope);
    add(sums[first + 2], to_fixed(carried * at * at, value_step));
    add(sums[first + 4], to_fixed(carried * slope * slope, value_step));
  }
}

float narrowest(const Portal& portal, const double* sums, float most) {
  if (!(sums[0] > 0)) return portal.wall;
  double best = infinity, found = 0;
  constexpr int steps = 32;
  for (int k = -steps; k <= steps; ++k) {
    const double s = double(most) / portal.radius * k / steps;
    double area = 1;
    for (size_t i = 0; i < 2; ++i) {
      const double* m = sums + 1 + 5 * i;
      const double mean = (m[0] + s * m[1]) / sums[0];
      area *= (m[2] + 2 * s * m[3] + s * s * m[4]) / sums[0] - mean * mean;  // (G13)
    }
    if (area < best) best = area, found = s * portal.radius;
  }
  return portal.wall + float(found);
}

Vec3 sample(const Fields& fields, const Field& field, const Opening& opening, const Vec3& p, const Vec2& u) {
  const Portal& portal = fields.table.portals[opening.portal];
  float over_square;
  const Vec3 at = from_square(sample(field.nodes, field.portals[opening.cell].root, u, over_square));
  Vec3 to = portal.center - p;
  to[first_beside[portal.axis]] += portal.radius * at.x;
  to[second_beside[portal.axis]] += portal.radius * at.y;
  return glm::normalize(to);
}

}  // namespace ajar
