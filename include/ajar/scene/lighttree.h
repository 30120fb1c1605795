// Enters: the scene's lights.
// Leaves: the pieces that light is drawn from (lamps, triangles of lamps, tiles of environments) and a tree over them,
// by which one is chosen for a point in logarithmic time (docs/method.md, "Many lights").
#pragma once

#include <vector>

#include "ajar/core/distribution.h"

namespace ajar {

struct Scene;

/// How next-event estimation chooses among lights. learned: as tree, for cells that have not learned better.
enum class LightChoice : uint8_t { uniform, power, tree, learned };
/// As the user writes them.
inline constexpr const char* light_choice_names[] = {"uniform", "power", "tree", "learned"};

/// What is chosen: all of a light, or a part of it: a triangle of its mesh, a tile of its sphere of directions.
struct LightPiece {
  uint32_t light = 0;
  uint32_t part = ~0u;  ///< none: all of the light
};

/// A rectangle of an environment's texels, [low, high) each way, with the choice of its rows.
struct Tile {
  glm::ivec2 low{0}, high{0};
  Distribution rows;
};

/// The tiles of one infinite light that is not a single direction. A constant light has a grid of texels of its own:
/// equal in solid angle.
struct Tiling {
  int width = 0, height = 0;
  std::vector<uint8_t> of_texel;  ///< number of every texel's tile, row by row
  std::vector<Tile> tiles;
};
inline uint32_t tile_of(const Tiling& t, int x, int y) { return t.of_texel[size_t(y) * size_t(t.width) + size_t(x)]; }

/// Bounds of the pieces below a node: a ball and a cone of directions that they shine to (infinite: that they are in).
struct LightNode {
  Vec3 center{0};
  float radius = 0;
  Vec3 axis{0, 0, 1};
  float cos_spread = -1, sin_spread = 0;  ///< of the cone about the axis that holds all normals
  float cos_reach = -1;                   ///< of how far around a normal light goes
  float weight = 0;                       ///< by which it is chosen, all else equal
  uint32_t first = 0, last = 0;           ///< its pieces, in the tree's order
  uint32_t left = 0;                      ///< children left and left + 1; 0: a leaf, of one piece
  bool infinite = false;
};

/// A light of a sky: its pieces [first, last) are one node's of the tree.
struct SkyLight {
  uint32_t light = 0, first = 0, last = 0;
  uint32_t node = 0;
  float share = 1;      ///< by which it is chosen, all else equal
  bool turned = false;  ///< of one direction: it may be behind a receiver
};

struct LightTree {
  LightChoice choice = LightChoice::tree;
  float infinity_scale = 1;           ///< of the importance of what is infinite far away, against that of lamps
  std::vector<LightNode> nodes;       ///< node 0 is the root; empty: nothing shines
  std::vector<LightPiece> pieces;     ///< in the order of the leaves; those that give nothing are left out
  std::vector<double> power_before;   ///< watts of the pieces before each, and of all: light subpaths start by it
  std::vector<uint32_t> first_piece;  ///< of every light, in `place`
  std::vector<uint32_t> place;        ///< of every part of every light: its place in the order; none if left out
  std::vector<Tiling> tilings;
  std::vector<uint32_t> tiling;   ///< of every light; none
  std::vector<uint32_t> regions;  ///< nodes that together hold all infinite pieces: a few parts of the sky
  std::vector<uint32_t> region;   ///< of every piece; none for finite ones
  std::vector<SkyLight> sky;      ///< where nothing but a few infinite lights shine: what is chosen from them whole
};

/// No more pieces than this by dividing meshes: those that are left stay whole.
inline constexpr size_t most_pieces = size_t(1) << 18, most_regions_of_sky = 32, most_tiles = 256, most_sky = 8;

/// Call when lights are prepared and bounds known. O(n log n).
LightTree make_light_tree(const Scene& scene, LightChoice choice);
/// Place of a part of a light in the tree's order; none if it is never chosen.
uint32_t place_of(const LightTree& tree, uint32_t light, uint32_t part);
size_t bytes(const LightTree& tree);

/// Where light is to arrive: at p, on the side of unit n; zero n: on any side.
struct Receiver {
  Vec3 p{0}, n{0};
};
/// Bound of what the receiver gets from the pieces below a node, up to a factor that all nodes share; by uniform and
/// power choice the node's weight.
float importance(const LightTree& tree, uint32_t node, const Receiver& at);
/// The largest: a few hundred of them still have a sum.
inline constexpr float most_importance = 1e36f;
/// Draws a piece below the node in proportion to bounds of what the receiver gets from it; u becomes uniform again, pdf
/// the probability. False where none can light the receiver.
bool choose(const LightTree& tree, uint32_t node, const Receiver& at, float& u, uint32_t& place, float& pdf);
/// Probability with which choose at the node takes this place, which is below it.
float choice_pdf(const LightTree& tree, uint32_t node, const Receiver& at, uint32_t place);
/// The plain choice: one of the sky's lights as a whole, by its power and whether it may be in front of the receiver.
/// u becomes uniform again.
const SkyLight& choose_of_sky(const LightTree& tree, const Receiver& at, float& u, float& pdf);
/// Probability of the same; 0 for what is not of the sky.
float sky_pdf(const LightTree& tree, const Receiver& at, uint32_t light);
/// Probability that the plain choice's light comes from below a node.
float sky_share(const LightTree& tree, const Receiver& at, uint32_t node);
/// Draws one of the pieces [first, last) by power alone.
uint32_t choose_by_power(const LightTree& tree, uint32_t first, uint32_t last, float& u);
inline double power_of(const LightTree& tree, uint32_t first, uint32_t last) {
  return tree.power_before[last] - tree.power_before[first];
}

}  // namespace ajar
