// Enters: a lobe.
// Leaves: whether it turns light to the other side, scattered or by a delta event that is not straight on.
#pragma once

#include "ajar/scene/bsdf.h"

namespace ajar {

inline bool turns_through(const Lobe& lobe) {
  const bool trans =
      lobe.kind == LobeKind::principled && lobe.principled.spec_trans > 0 && lobe.principled.metallic < 1;
  return trans || lobe.kind == LobeKind::dielectric || lobe.kind == LobeKind::thindielectric ||
         lobe.kind == LobeKind::roughdielectric || lobe.kind == LobeKind::difftrans;
}

}  // namespace ajar
