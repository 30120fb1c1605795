// Enters: levels, kinds and coordinates of cells.
// Leaves: their keys, and the same back.
#pragma once

#include <algorithm>

#include "ajar/field/cells.h"

namespace ajar {

// Bits of a key, from the lowest: x, y, z (17 each), normal (5), compartment (4), level + 1 (4).
inline constexpr int coordinate_bits = 17, most_coordinate = (1 << coordinate_bits) - 1;
inline constexpr int at_normal = 3 * coordinate_bits, at_compartment = at_normal + 5, at_level = at_compartment + 4;

// Normal's bin and compartment, as a key has them: the same for a cell's parts.
struct CellKind {
  uint32_t normal = 0, compartment = 0;
};

inline CellKey make_key(int level, const CellKind& kind, const glm::uvec3& c) {
  return (uint64_t(level + 1) << at_level) | (uint64_t(kind.compartment) << at_compartment) |
         (uint64_t(kind.normal) << at_normal) | (uint64_t(c.z) << 2 * coordinate_bits) |
         (uint64_t(c.y) << coordinate_bits) | c.x;
}
inline glm::uvec3 coordinates_of(CellKey key) {
  return {key & most_coordinate, (key >> coordinate_bits) & most_coordinate,
          (key >> 2 * coordinate_bits) & most_coordinate};
}
inline CellKind kind_of(CellKey key) { return {uint32_t(key >> at_normal) & 31, uint32_t(key >> at_compartment) & 15}; }

// Which of the eight parts of a cube its coordinates, at their level, make it; and where a part is.
inline uint32_t octant_of(const glm::uvec3& c) { return (c.x & 1) | (c.y & 1) << 1 | (c.z & 1) << 2; }
inline glm::uvec3 part_of(const glm::uvec3& c, uint32_t octant) {
  return 2u * c + glm::uvec3(octant & 1, octant >> 1 & 1, octant >> 2);
}

inline constexpr size_t all_top_cubes = size_t(top_cubes) * top_cubes * top_cubes;
// Number of a cube of level 0 among those that walls are looked for in; all_top_cubes elsewhere.
inline size_t top_cube(const CellTable& table, const glm::uvec3& at_top) {
  const glm::uvec3 c = at_top - table.first;  // wraps around before it
  if (std::max({c.x, c.y, c.z}) >= uint32_t(top_cubes)) return all_top_cubes;
  return (size_t(c.z) * top_cubes + c.y) * top_cubes + c.x;
}

}  // namespace ajar
