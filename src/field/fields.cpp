#include "ajar/field/fields.h"

#include "ajar/core/sampler.h"

namespace ajar {

const Field& Fields::of(Side side) const { return side == Side::camera ? q : w; }

size_t find_stratum(const Fields& fields, const Field& field, uint32_t cell, const Vec3& local) {
  if (fields.structure != Structure::adaptive) {
    const Patch at = patch_of(local);
    return 16 * size_t(field.nodes[field.cells[cell].root].child(at.zone)) + size_t(at.segment);
  }
  return find_stratum(field, cell, to_square(local));
}

size_t find_stratum(const Field& field, uint32_t cell, Vec2 at) {
  uint32_t node = field.cells[cell].root;
  int i = descend(at);
  while (field.nodes[node].is_divided(i)) {
    node = field.nodes[node].child(i);
    i = descend(at);
  }
  return 16 * size_t(node) + size_t(i);
}

float pdf(const Fields& fields, const Field& field, uint32_t cell, const Vec3& w) {
  const Vec3 local = fields.cells[cell].frame.to_local(w);
  if (!(local.z > 0)) return 0;
  if (fields.structure != Structure::adaptive) return patch_density(field.nodes, field.cells[cell].root, local);
  return density(field.nodes, field.cells[cell].root, to_square(local)) * square_density(local);
}

Vec3 sample(const Fields& fields, const Field& field, uint32_t cell, const Vec2& u, float& pdf) {
  if (fields.structure != Structure::adaptive)
    return fields.cells[cell].frame.to_world(sample_patch(field.nodes, field.cells[cell].root, u, pdf));
  float over_square;
  const Vec2 at = sample(field.nodes, field.cells[cell].root, u, over_square);
  const Vec3 local = from_square(at);
  pdf = over_square * square_density(local);
  return fields.cells[cell].frame.to_world(local);
}

size_t bytes(const Fields& f) {
  const auto of = [](const Field& x) {
    return x.cells.size() * sizeof(FieldCell) + x.nodes.size() * (sizeof(StrataNode) + 32 * sizeof(float));
  };
  return f.table.slots.size() * sizeof(CellTable::Slot) + f.table.probes.size() * sizeof(Probe) +
         f.cells.size() * sizeof(Cell) + bytes(f.views) + of(f.q) + of(f.w) + of(f.disk) +
         bytes(f.lights) + bytes(f.starts);
}

}  // namespace ajar
