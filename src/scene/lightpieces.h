// Enters: prepared lights.
// Leaves: their pieces with bounds, for the tree over them. Private to the room.
#pragma once

#include "ajar/scene/scene.h"

namespace ajar {

/// What is known of a piece, or of several together.
struct LightBounds {
  Vec3 low{infinity}, high{-infinity};  ///< infinite: of the axes
  Vec3 axis{0, 0, 1};
  float cos_spread = 1, cos_reach = 1;
  double weight = 0;
};
struct BoundedPiece {
  LightPiece piece;
  LightBounds bounds;
  double watts = 0;  ///< what light subpaths are begun by
  bool infinite = false;
};

/// Of both.
LightBounds join(const LightBounds& a, const LightBounds& b);

/// Fills the tree's tilings and tiling.
void make_tilings(const Scene& scene, LightTree& tree);
/// All pieces of all lights, in order; those that give nothing have no watts, and those that next-event estimation is
/// not to ask for no weight.
std::vector<BoundedPiece> light_pieces(const Scene& scene, const LightTree& tree);

}  // namespace ajar
