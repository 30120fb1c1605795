// Enters: a film, and what is to be done for its pixels.
// Leaves: it is done, for all of them or for those around one.
#pragma once

#include <algorithm>
#include <vector>

#include "ajar/core/parallel.h"
#include "ajar/film/film.h"

namespace ajar {

/// value(x, y) of every pixel, rows from the top.
template <class F>
auto each_pixel(const Film& film, const F& value) {
  std::vector<decltype(value(0, 0))> out(film.pixels());
  parallel_for(film.height, [&](int y) {
    for (int x = 0; x < film.width; ++x) out[size_t(y) * film.width + x] = value(x, y);
  });
  return out;
}

/// Calls use(pixel), row by row, for those up to `reach` away in x and y, the pixel itself among them.
template <class F>
void for_each_around(const Film& film, int x, int y, int reach, const F& use) {
  const int xa = std::max(0, x - reach), xb = std::min(film.width - 1, x + reach);
  const int ya = std::max(0, y - reach), yb = std::min(film.height - 1, y + reach);
  for (int py = ya; py <= yb; ++py)
    for (int px = xa; px <= xb; ++px) use(size_t(py) * film.width + px);
}

}  // namespace ajar
