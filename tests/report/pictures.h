// Enters: a size.
// Leaves: pictures that need no file, the same on every machine.
#pragma once

#include <cmath>
#include <cstdint>

#include "ajar/film/picture.h"

namespace ajar::test {

inline Picture constant(int width, int height, const Rgb& value) {
  Picture picture{width, height, {"R", "G", "B"}, {}};
  for (int i = 0; i < width * height; ++i) picture.pixels.insert(picture.pixels.end(), {value.x, value.y, value.z});
  return picture;
}

/// Waves, a ramp that leaves [0,1], and checks; each value times 1 - noise / 2 to 1 + noise / 2 by a hash of pixel and
/// channel.
inline Picture pattern(int width, int height, double noise = 0) {
  Picture picture{width, height, {"R", "G", "B"}, {}};
  for (uint32_t y = 0; y < uint32_t(height); ++y)
    for (uint32_t x = 0; x < uint32_t(width); ++x) {
      const double values[3] = {0.5 + 0.5 * std::sin(x / 5.0) * std::cos(y / 7.0), x / double(width) * 1.2,
                                (x / 8 + y / 8) % 2 == 0 ? 0.8 : 0.05};
      for (uint32_t c = 0; c < 3; ++c) {
        uint32_t v = ((x * 73856093u) ^ (y * 19349663u) ^ (c * 83492791u)) * 2654435761u;
        v = (v ^ (v >> 15)) * 2246822519u;
        v ^= v >> 13;
        picture.pixels.push_back(float(values[c] * (1 + noise * (v * 0x1p-32 - 0.5))));
      }
    }
  return picture;
}

}  // namespace ajar::test
