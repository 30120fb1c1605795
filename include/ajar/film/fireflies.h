// Enters: what every pass brings each pixel.
// Leaves: what is too bright for what other passes saw around it.
#pragma once

#include <vector>

#include "ajar/film/film.h"

namespace ajar {

/// From now on the film keeps what its limits need.
void limit_fireflies(Film& film);
/// Of a pixel that a pass brought this, which counts for so much; passes in their order.
void note(Film& film, size_t pixel, const Rgb& value, float weight = 1);
/// Per pixel, the luminance that a pass may bring it (docs/notation.md, F1): twice what at least Film::brightest_kept
/// passes brought it or a pixel up to two away. Infinite before there are that many passes.
std::vector<float> limits(const Film& film);
/// What the passes brought a pixel beyond its limit, all together: of the film's sums.
glm::dvec3 excess(const Film& film, size_t pixel, float limit);
/// What of a value is left where it is darkened to that luminance: 1 where it has less.
float kept_share(const Rgb& value, float limit);

}  // namespace ajar
