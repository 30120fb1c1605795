// Enters: linear, scene-referred values; or values encoded for a display.
// Leaves: the other of the two, by the one fixed tone curve (docs/notation.md, "Tone curve").
#pragma once

#include <algorithm>
#include <cmath>

namespace ajar {

/// Transfer curve of sRGB (IEC 61966-2-1), linear [0,1] to encoded [0,1]. No clipping.
inline double encode_srgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

/// Inverse of encode_srgb.
inline double decode_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// The tone curve: exposure in stops, clipping to [0,1], sRGB encoding. Leaves [0,1]; the value must not be NaN.
inline double tone_curve(double linear, double exposure = 0) {
  return encode_srgb(std::clamp(linear * std::exp2(exposure), 0.0, 1.0));
}

}  // namespace ajar
