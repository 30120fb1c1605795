// Enters: walls that cut cells (walls.h), a field's strata over the disks in their planes.
// Leaves: directions towards where a wall lets light, or importance, through: what one cell finds there serves all.
#pragma once

#include "ajar/field/fields.h"

namespace ajar {

inline constexpr size_t most_portals = 2;
/// What ends within so many widths of a cube of level 0 from a portal's plane does not count as having come through.
inline constexpr float portal_margin = 0.25f;

/// Planes that the most cuts share, as disks across a sphere; width: of the cubes that were cut.
std::vector<Portal> find_portals(const std::vector<CellCut>& cuts, const Vec3& center, float radius, float width);
/// Gives both fields strata for the portals of their table, that know nothing. False where they have them already.
bool add_portals(Fields& fields);

// What the axes beside a given one are.
inline constexpr int first_beside[] = {1, 2, 0}, second_beside[] = {2, 0, 1};

/// Where a ray passes through a portal's plane.
struct Crossing {
  uint32_t cell = none;  ///< among Field::portals
  Vec2 square{0};        ///< on the disk, as the square of its strata (G1)
  float distance = 0;    ///< from the ray's origin
  float density = 0;     ///< area of the square per solid angle at the ray's origin
};
/// w: unit. False where the ray misses the disk.
inline bool cross(const Portal& portal, uint32_t number, const Vec3& p, const Vec3& w, Crossing& out) {
  const int a = portal.axis, b = first_beside[a], c = second_beside[a];
  const float per_axis = 1 / component(w, a), scale = 1 / portal.radius;
  out.distance = (component(portal.center, a) - component(p, a)) * per_axis;
  const float x = (component(p, b) - component(portal.center, b) + out.distance * component(w, b)) * scale,
              y = (component(p, c) - component(portal.center, c) + out.distance * component(w, c)) * scale;
  if (!((out.distance > 0) & (out.distance < infinity) & (x * x + y * y < 1))) return false;
  out.cell = 2 * number + (per_axis > 0);
  float per_disk;
  out.square = to_square({x, y, 1}, per_disk);
  out.density = per_disk * sqr(out.distance * scale) * std::abs(per_axis);  // (G12)
  return true;
}

/// Paths through an opening as lines, to find where they are closest together: sums of (G13), in fixed point.
inline constexpr size_t line_sums = 11;
/// p, w: a ray through the portal; weight: what it carries.
void record_line(const Portal& portal, const Vec3& p, const Vec3& w, double weight, int64_t* sums);
/// Where on its axis, so far from the wall at most, lines through a portal are closest together.
float narrowest(const Portal& portal, const double* sums, float most);

/// The cell's portal, as it is seen from p.
struct Opening {
  uint32_t portal = none, cell = none;
  float share = 0;  ///< h of (G11): of the field's directions, those that are drawn through it
};
inline Opening opening(const Fields& fields, const Field& field, uint32_t cell, const Vec3& p) {
  const FieldCell& c = field.cells[cell];
  if (c.portal == FieldCell::no_portal) return {};
  const Portal& portal = fields.table.portals[c.portal];
  const float across = component(portal.center, portal.axis) - component(p, portal.axis);
  // In the plane directions do not tell places.
  if (!(std::abs(across) > 1e-3f * portal.radius)) return {};
  const uint32_t seen = 2 * uint32_t(c.portal) + (across > 0);
  return {c.portal, seen, c.through * field.portals[seen].mix};
}
/// u in [0,1)^2.
Vec3 sample(const Fields& fields, const Field& field, const Opening& opening, const Vec3& p, const Vec2& u);

}  // namespace ajar
