// Enters: contributions labelled with their strategy (s, t).
// Leaves: one image per strategy, raw and weighted (Veach 1997, figure 10.2).
#pragma once

#include <map>

#include "ajar/film/film.h"

namespace ajar {

/// A contribution of the strategy with s light and t camera vertices; -s where it merges them, and the vertex that they
/// share counts on both sides. For t = 1 raster is where it lands and the values
/// are still to be divided by the number of light subpaths; else raster is its pixel in the crop window.
struct Strategy {
  int s = 0, t = 0;
  Vec2 raster{0};
  Rgb raw{0}, weighted{0};
};

/// Of the strategies that have an image: paths of ten edges.
inline constexpr int most_vertices = 11;

struct Pyramid {
  struct Layer {
    std::vector<glm::dvec3> raw, weighted;  ///< sums over passes, that at work among them
  };
  bool kept = false;  ///< from the first pass on
  std::map<std::pair<int, int>, Layer> layers;
};

/// Adds the contributions of consecutive chunks in their order, but for those of more than most_vertices.
void merge(Pyramid& pyramid, const Film& film, const std::vector<std::vector<Strategy>>& chunks);
/// Whether write_pyramid gives a file such a name, and takes away one that has it.
bool is_layer(const std::string& name);
/// Writes DIR/s1t2.exr ... (weighted) and DIR/s1t2-raw.exr ..., m2t2.exr where merged, in place of all that are there.
/// The weighted ones add up to the image of paths of so many vertices, but for what limits take from it and for virtual
/// point lights, which have none (vpl, plain-vpl). Throws Error.
void write_pyramid(const Pyramid& pyramid, const Film& film, const std::string& folder);

}  // namespace ajar
