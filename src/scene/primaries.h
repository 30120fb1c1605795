// Enters: what an image file says of the primaries and the white of its colours.
// Leaves: the matrix that makes them linear RGB of Rec. 709.
#pragma once

#include <array>
#include <optional>

#include "ajar/core/vec.h"

namespace ajar {

/// CIE x and y of red, green, blue and white.
using Chromaticities = std::array<float, 8>;

/// As nearly as OpenEXR files tell them.
bool are_rec709(const Chromaticities& c);
/// White stays the colour that it is (no adaptation). Nothing where they make no colours: not finite, in one line.
std::optional<Mat3> to_rec709(const Chromaticities& c);

}  // namespace ajar
