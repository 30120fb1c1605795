// Enters: linear, scene-referred values; or values encoded for a display.
// Leaves: the other of the two, by the one fixed tone curve (docs/notation.md, "Tone curve").
#pragma once

#include <algorithm>
#include <cmath>

#include "ajar/core/srgb.h"

namespace ajar {

/// The tone curve: exposure in stops, clipping to [0,1], sRGB encoding. Leaves [0,1]; the value must not be NaN.
inline double tone_curve(double linear, double exposure = 0) {
  return encode_srgb(std::clamp(linear * std::exp2(exposure), 0.0, 1.0));
}

}  // namespace ajar
