#include "ajar/field/fields.h"

#include "ajar/core/sampler.h"
#include "ajar/core/warp.h"
#include "ajar/field/portals.h"

namespace ajar {
namespace {

// Where p is beside the cell's centre, in its tangent plane, over R: well within the unit disk, so that p is within the
// sphere and every direction leaves it once.
inline Vec2 shift(const Fields& fields, const Field& field, uint32_t cell, const Vec3& p) {
  const Cell& c = fields.cells[cell];
  const Vec3 beside = field.cells[cell].near * (p - c.center);
  const Vec2 d(glm::dot(c.frame.s, beside), glm::dot(c.frame.t, beside));
  const float l2 = glm::dot(d, d);
  return l2 > sqr(0.9f) ? d * (0.9f / std::sqrt(l2)) : d;
}

// The inverse of centered; density as there.
Vec3 from_center(const Fields& fields, const Field& field, uint32_t cell, const Vec3& p, const Vec3& center,
                 float& density) {
  const Vec2 d = shift(fields, field, cell, p);
  const Vec3 v(center.x - d.x, center.y - d.y, center.z);
  const float t2 = glm::dot(v, v), t = std::sqrt(t2);
  density = t2 * t / std::max(glm::dot(v, center), 1e-12f);
  return v / t;
}

// As it is seen from the cell's centre; see centered.
inline Vec3 shifted(const Vec2& d, const Vec3& local, float& density) {
  const float along = d.x * local.x + d.y * local.y;
  const float cosine = std::sqrt(along * along + 1 - glm::dot(d, d)), t = cosine - along;
  density = t * t / cosine;
  return {d.x + t * local.x, d.y + t * local.y, t * local.z};
}

// Through a cell's portal alone. (G12)
float portal_pdf(const Fields& fields, const Field& field, const Opening& o, const Vec3& p, const Vec3& w) {
  Crossing at;
  if (!cross(fields.table.portals[o.portal], o.portal, p, w, at)) return 0;
  return at.density * density(field.nodes, field.portals[o.cell].root, at.square);
}

Vec3 sample_strata(const Fields& fields, const Field& field, uint32_t cell, const Vec3& p, const Vec2& u, float& pdf) {
  if (fields.structure != Structure::adaptive)
    return fields.cells[cell].frame.to_world(sample_patch(field.nodes, field.cells[cell].root, u, pdf));
  float over_square;
  const Vec2 at = sample(field.nodes, field.cells[cell].root, u, over_square);
  const Vec3 center = from_square(at), local = from_center(fields, field, cell, p, center, pdf);
  pdf *= over_square * square_density(center);
  return fields.cells[cell].frame.to_world(local);
}

}  // namespace

const Field& Fields::of(Side side) const { return side == Side::camera ? q : w; }

size_t find_stratum(const Fields& fields, const Field& field, uint32_t cell, const Vec3& local) {
  if (fields.structure != Structure::adaptive) {
    const Patch at = patch_of(local);
    return 16 * size_t(field.nodes[field.cells[cell].root].child(at.zone)) + size_t(at.segment);
  }
  return find_stratum(field, field.cells[cell], to_square(local));
}

size_t find_stratum(const Field& field, const FieldCell& cell, Vec2 at) {
  uint32_t node = cell.root;
  Descent down(at);
  int i = down.next();
  while (field.nodes[node].is_divided(i)) {
    node = field.nodes[node].child(i);
    i = down.next();
  }
  return 16 * size_t(node) + size_t(i);
}

Vec3 centered(const Fields& fields, const Field& field, uint32_t cell, const Vec3& p, const Vec3& local,
              float& density) {
  return shifted(shift(fields, field, cell, p), local, density);
}

float pdf(const Fields& fields, const Field& field, uint32_t cell, const Vec3& p, const Vec3& w) {
  const Vec3 local = fields.cells[cell].frame.to_local(w);
  if (!(local.z > 0)) return 0;
  const uint32_t root = field.cells[cell].root;
  if (fields.structure != Structure::adaptive) return patch_density(field.nodes, root, local);
  float per_center, stretch;
  const Vec2 at = to_square(shifted(shift(fields, field, cell, p), local, stretch), per_center);
  const float per_angle = per_center * stretch;
  const Opening o = opening(fields, field, cell, p);
  if (!(o.share > 0)) return per_angle * density(field.nodes, root, at);
  const float strata = (1 - o.share) * per_angle;
  Crossing on;
  if (!cross(fields.table.portals[o.portal], o.portal, p, w, on)) return strata * density(field.nodes, root, at);
  const StrataNode* nodes = field.nodes.data();
  Way down(nodes, root, at), beyond(nodes, field.portals[o.cell].root, on.square);
  do {  // both at once: what one waits for, the other works in
    down.go_on(), beyond.go_on();
  } while (int(down.goes_on()) | int(beyond.goes_on()));
  return strata * down.density() + o.share * on.density * beyond.density();  // (G11), (G12)
}

Vec3 sample(const Fields& fields, const Field& field, uint32_t cell, const Vec3& p, Vec2 u, float& density) {
  const Opening o = opening(fields, field, cell, p);
  if (o.share > 0 && take_part(u.x, o.share)) {
    const Vec3 w = sample(fields, field, o, p, u);
    density = pdf(fields, field, cell, p, w);
    return w;
  }
  const Vec3 w = sample_strata(fields, field, cell, p, u, density);
  if (o.share > 0) density = (1 - o.share) * density + o.share * portal_pdf(fields, field, o, p, w);
  return w;
}

size_t bytes(const Fields& f) {
  const auto of = [](const Field& x) {
    return (x.cells.size() + x.portals.size()) * sizeof(FieldCell) +
           x.nodes.size() * (sizeof(StrataNode) + 32 * sizeof(UFloat16));
  };
  return f.table.slots.size() * sizeof(CellTable::Slot) + f.table.parts.size() * sizeof(f.table.parts[0]) +
         f.table.probes.size() * sizeof(Probe) + f.cells.size() * sizeof(Cell) +
         bytes(f.views) + of(f.q) + of(f.w) + of(f.disk) + bytes(f.lights) + bytes(f.starts);
}

}  // namespace ajar
