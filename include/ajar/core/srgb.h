// Enters: a value that is linear in light, or one that is encoded as sRGB (IEC 61966-2-1).
// Leaves: the other of the two.
#pragma once

#include <cmath>

namespace ajar {

/// Linear [0,1] to encoded [0,1]. No clipping.
inline double encode_srgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

/// Inverse of encode_srgb.
inline double decode_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace ajar
