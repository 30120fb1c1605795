// Enters: points on surfaces with the side that they are seen from.
// Leaves: the cell of a point: a cube of space and a range of normals. Cells nest; a cell that was divided answers only
// where its parts are not known.
#pragma once

#include <array>
#include <vector>

#include "ajar/core/frame.h"
#include "ajar/scene/motion.h"
#include "ajar/scene/surface.h"

namespace ajar {

/// Name of a cell: level, compartment of its cube of level 0, direction of the normal (26 bins), integer coordinates at
/// that level; never 0.
using CellKey = uint64_t;

inline constexpr int most_cell_levels = 9;
/// Ranges of directions of a normal, one of which is empty.
inline constexpr int normal_bins = 27;
/// Of a cube of level 0.
inline constexpr int most_compartments = 16;
/// Cubes of level 0 along an axis, where walls are looked for.
inline constexpr int top_cubes = 13;

/// A plane across a cube of level 0. What is on either side of it: another cut, or ~compartment.
struct CellCut {
  float at = 0;  ///< world coordinate along the axis
  int32_t axis = 0, below = ~0, above = ~0;
};

/// A disk beside a wall, across the scene or twice the part that cubes follow: what passes the wall passes the disk. It
/// lies where paths through the wall are closest together.
struct Portal {
  int32_t axis = 0;  ///< normal to it
  float wall = 0;    ///< where the wall is along the axis
  Vec3 center{0};
  float radius = 1;
};

/// A point on a surface, with a hemisphere on either side of it.
struct Probe {
  Vec3 p{0}, n{0, 0, 1};
  uint32_t axis = 0;  ///< along which it divides the probes beside it (make_probe_table)
};

/// What find reads while the table does not change (src/field/shortcuts.h).
struct Shortcuts {
  std::vector<uint32_t> rows;  ///< per top cube, and for all other cubes: of its first compartment
  std::vector<std::array<uint32_t, normal_bins>> tops;  ///< per row and normal: its leaves
  std::vector<uint32_t> leaves;                         ///< cells; none: nothing is prepared
};

/// Cells of all levels in one open hash table, and the way from one to its parts.
struct CellTable {
  /// One of the eight cubes of a divided cell; none where it is not known.
  struct Part {
    uint32_t cell = none;
    uint32_t parts = 0;  ///< which of CellTable::parts it is divided into; 0: undivided
  };
  struct Slot {
    CellKey key = 0;
    Part at;
  };
  Vec3 origin{0};
  float width = 1;                         ///< edge of the cubes of level 0
  uint32_t first = 0;                      ///< coordinate of the first of the top_cubes, along all axes
  std::vector<Slot> slots;                 ///< a power of two of them; none: nothing is known anywhere
  std::vector<std::array<Part, 8>> parts;  ///< of every divided cell, by octants; the first is nobody's
  std::vector<CellCut> cuts;
  std::vector<int32_t> compartments;  ///< per cube of level 0: its first cut, or ~0; empty: nothing is cut
  std::vector<Portal> portals;        ///< of the walls that cut the most
  std::vector<Probe> probes;  ///< not empty: cells are theirs, not cubes; a kd-tree: the middle of a range divides it
  size_t used = 0;
  Shortcuts shortcuts;  ///< as shorten left them; none where the table has changed since

  float edge(int level) const { return std::ldexp(width, -level); }
};

/// Where a point is: its cell, none if unknown.
struct Place {
  uint32_t cell = none;
  CellKey missing = 0;  ///< the cell that ought to be there in place of it; 0 if nothing is missing
};

/// For a scene in a ball, in the middle of what keys reach: some twenty times the radius all around, for what moves.
/// width: of cubes of level 0; 0: a sixth of the radius.
CellTable make_cell_table(const Vec3& center, float radius, float width = 0);
/// area: of the surfaces that the probes stand for [m^2].
CellTable make_probe_table(std::vector<Probe> probes, double area);
/// Which of 26 ranges of directions a unit normal is in, from 0 to 26 without 13; no cell holds two of them.
uint32_t normal_bin(const Vec3& n);
/// Number of the cube of level 0 around a point; past the last one where there is none.
size_t top_cube(const CellTable& table, const Vec3& p);
/// The smallest cell that a point with this normal is in; n: unit, on the side that matters. None beyond what keys
/// reach.
Place find(const CellTable& table, const Vec3& p, const Vec3& n);
/// Gives the key, which is not there yet, a cell.
void insert(CellTable& table, CellKey key, uint32_t cell);
/// The cell of this key, none if there is none.
uint32_t cell_of(const CellTable& table, CellKey key);
/// From now on find looks for smaller cells, of the next level, in this one, whose key is there.
void set_divided(CellTable& table, CellKey key);
/// Prepares shortcuts for find, until a cell is inserted or divided, or walls are cut.
void shorten(CellTable& table);
/// 0: largest; a cube of the next level is half as wide.
int level_of(CellKey key);
/// The cube of a cell; of a probe, its point.
Box cube_of(const CellTable& table, CellKey key);
Vec3 middle_of(const CellTable& table, CellKey key);
/// Key of the cell that contains this one, 0 at level 0.
CellKey parent_of(CellKey key);

}  // namespace ajar
