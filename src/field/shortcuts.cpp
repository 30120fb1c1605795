#include "shortcuts.h"

#include <algorithm>

namespace ajar {
namespace {

constexpr int most_depth = 2;

using Parts = std::array<CellTable::Part, 8>;

bool is_any_known(const Parts& parts) {
  return std::any_of(parts.begin(), parts.end(), [](const CellTable::Part& p) { return p.cell != none; });
}

// Levels of leaves that tell apart what is known below a part, most_depth at most.
int depth_below(const CellTable& table, const CellTable::Part& part, int most = most_depth) {
  if (part.parts == 0 || most == 0 || !is_any_known(table.parts[part.parts])) return 0;
  int deepest = 0;
  for (const CellTable::Part& p : table.parts[part.parts])
    if (p.cell != none) deepest = std::max(deepest, depth_below(table, p, most - 1));
  return 1 + deepest;
}

// Of one kind in one cube.
struct Leaves {
  const CellTable& table;
  int depth;
  uint32_t* out;  // 8^depth of them

  uint32_t leaf_of(const CellTable::Part& part, int level) const {
    if (part.parts == 0) return part.cell;
    if (is_any_known(table.parts[part.parts])) return none;
    return make_leaf(part.cell, level + 1);
  }
  void fill(uint32_t leaf, int level, const glm::uvec3& c) const {
    const uint32_t across = 1u << (depth - level);
    for (uint32_t z = 0; z < across; ++z)
      for (uint32_t y = 0; y < across; ++y)
        for (uint32_t x = 0; x < across; ++x) {
          const glm::uvec3 at = across * c + glm::uvec3(x, y, z);
          out[(at.z << depth | at.y) << depth | at.x] = leaf;
        }
  }
  // c: the part among those of its level in the cube.
  void enter(const CellTable::Part& part, int level, const glm::uvec3& c) const {
    if (level == depth || part.parts == 0 || !is_any_known(table.parts[part.parts]))
      return fill(leaf_of(part, level), level, c);
    for (uint32_t i = 0; i < 8; ++i) {
      const CellTable::Part& p = table.parts[part.parts][i];
      if (p.cell != none)
        enter(p, level + 1, part_of(c, i));
      else
        fill(make_leaf(part.cell, level + 1), level + 1, part_of(c, i));
    }
  }
};

// Rows of a cube: as many as find may ask for.
size_t rows_of(const CellTable& table, size_t cube) {
  return table.compartments.empty() || table.compartments[cube] == ~0 ? 1 : size_t(most_compartments);
}

}  // namespace

void shorten(CellTable& table) {
  Shortcuts& s = table.shortcuts;
  s = {};
  // So that places of leaves, 8^most_depth of a cell at most, and cells have room in their bits.
  if (!table.probes.empty() || table.used == 0 || table.used > size_t(1) << (first_bits - 3 * most_depth - 1)) return;
  s.rows.assign(all_top_cubes + 1, 0);
  s.tops.assign(most_compartments, {});  // nobody's
  s.leaves.assign(1, none);
  for (const CellTable::Slot& slot : table.slots) {
    if (slot.key == 0 || level_of(slot.key) != 0) continue;
    const CellKind kind = kind_of(slot.key);
    const size_t cube = top_cube(table, coordinates_of(slot.key));
    if (cube == all_top_cubes || kind.compartment >= rows_of(table, cube)) continue;
    if (s.rows[cube] == 0) {
      s.rows[cube] = uint32_t(s.tops.size());
      s.tops.resize(s.tops.size() + rows_of(table, cube));
    }
    const int depth = depth_below(table, slot.at);
    const size_t first = s.leaves.size();
    s.leaves.resize(first + (size_t(1) << 3 * depth));
    Leaves{table, depth, &s.leaves[first]}.enter(slot.at, 0, glm::uvec3(0));
    s.tops[s.rows[cube] + kind.compartment][kind.normal] = uint32_t(first) | uint32_t(depth) << first_bits;
  }
}

}  // namespace ajar
