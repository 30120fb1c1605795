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
  float radius = infinity;  ///< of a ball about the middle, where that is less than the box's
  double weight = 0;        ///< pi times what goes to the steradian where it is most: of a flat lamp its watts
};
inline Vec3 middle(const LightBounds& b) { return 0.5f * b.low + 0.5f * b.high; }
/// Of a ball about the middle.
inline float radius_of(const LightBounds& b) { return std::min(b.radius, 0.5f * std::sqrt(length2(b.high - b.low))); }

struct BoundedPiece {
  LightPiece piece;
  LightBounds bounds;
  double watts = 0;  ///< what light subpaths are begun by
  double peak = 1;   ///< pi times what goes to the steradian where it is most, over watts
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
