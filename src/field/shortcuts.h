// Enters: a table of cells, and points in cubes of level 0.
// Leaves: the cells of the points, of the three coarsest levels, in three reads and without a branch that would be
// guessed wrong.
#pragma once

#include "keys.h"

namespace ajar {

// What a top says: how many levels of leaves, and where they begin.
inline constexpr int first_bits = 30;
inline constexpr uint32_t first_mask = (1u << first_bits) - 1;
// What a leaf says: which level of the cell is missing there, 0 if none is, and the cell in place of it. `none`: the
// table is to be asked.
inline constexpr int cell_bits = 28;
inline constexpr uint32_t cell_mask = (1u << cell_bits) - 1;
inline uint32_t make_leaf(uint32_t cell, int missing) { return uint32_t(missing) << cell_bits | cell; }

// Place of a point among the leaves so many levels below its cube of level 0.
inline uint32_t place_below(const glm::uvec3& finest, uint32_t depth) {
  const uint32_t mask = (1u << depth) - 1, shift = uint32_t(most_cell_levels) - depth;
  return ((finest.z >> shift & mask) << depth | (finest.y >> shift & mask)) << depth | (finest.x >> shift & mask);
}

// cube: of top_cube. False where the table is to be asked.
inline bool follow(const Shortcuts& s, size_t cube, const CellKind& kind, const glm::uvec3& finest, Place& out) {
  if (s.leaves.empty()) return false;
  const uint32_t top = s.tops[s.rows[cube] + kind.compartment][kind.normal];
  const uint32_t leaf = s.leaves[(top & first_mask) + place_below(finest, top >> first_bits)];
  if (leaf == none) return false;
  const uint32_t level = leaf >> cell_bits;
  const CellKey missing = make_key(int(level), kind, finest >> (uint32_t(most_cell_levels) - level));
  out = {leaf & cell_mask, level != 0 ? missing : 0};
  return true;
}

}  // namespace ajar
