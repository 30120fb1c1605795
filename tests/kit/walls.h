// Enters: tables of cells of one scene.
// Leaves: the walls in them, which are the same for every render of it: found once. To find them is a third of the time
// of a small guided one.
#pragma once

#include "ajar/field/cells.h"

namespace ajar::kit {

inline void copy_walls(const CellTable& from, CellTable& to) {
  to.cuts = from.cuts, to.compartments = from.compartments, to.portals = from.portals;
  to.shortcuts = {};
}

}  // namespace ajar::kit
