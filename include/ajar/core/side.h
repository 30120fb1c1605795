// Enters: nothing.
// Leaves: the two ends from which paths are walked.
#pragma once

#include <cstdint>

namespace ajar {

enum class Side : uint8_t { camera, light };

}  // namespace ajar
