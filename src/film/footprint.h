// Enters: a place on the film's raster where a splat falls.
// Leaves: the pixels that it reaches, each with what the filter gives it.
#pragma once

#include <cmath>

#include "ajar/film/film.h"

namespace ajar {

/// Calls add(pixel, weight along x, weight along y) for pixels of rows y_from .. y_to - 1 whose centres lie within the
/// filter's radius.
template <class Add>
void for_each_reached(const Film& film, const Vec2& raster, int y_from, int y_to, const Add& add) {
  const float r = film.filter.radius, x = raster.x - float(film.x0) - 0.5f, y = raster.y - float(film.y0) - 0.5f;
  const int xa = std::max(0, int(std::ceil(x - r))), xb = std::min(film.width - 1, int(std::floor(x + r)));
  const int ya = std::max(y_from, int(std::ceil(y - r))), yb = std::min(y_to - 1, int(std::floor(y + r)));
  for (int py = ya; py <= yb; ++py) {
    const float wy = eval(film.filter, y - float(py));
    for (int px = xa; px <= xb; ++px) add(size_t(py) * film.width + px, eval(film.filter, x - float(px)), wy);
  }
}

}  // namespace ajar
