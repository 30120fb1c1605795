// Enters: a Lobe of any kind.
// Leaves: a call with the lobe's own type.
#pragma once

#include "matte.h"
#include "plastic.h"
#include "principled.h"

namespace ajar {

template <class Act>
auto visit(const Lobe& lobe, Act&& act) {
  switch (lobe.kind) {
    case LobeKind::diffuse:
      return act(lobe.diffuse);
    case LobeKind::conductor:
      return act(lobe.conductor);
    case LobeKind::roughconductor:
      return act(lobe.roughconductor);
    case LobeKind::dielectric:
      return act(lobe.dielectric);
    case LobeKind::roughdielectric:
      return act(lobe.roughdielectric);
    case LobeKind::thindielectric:
      return act(lobe.thindielectric);
    case LobeKind::plastic:
      return act(lobe.plastic);
    case LobeKind::roughplastic:
      return act(lobe.roughplastic);
    case LobeKind::phong:
      return act(lobe.phong);
    case LobeKind::principled:
      return act(lobe.principled);
    case LobeKind::roughdiffuse:
      return act(lobe.roughdiffuse);
    case LobeKind::difftrans:
      return act(lobe.difftrans);
    case LobeKind::ward:
      return act(lobe.ward);
  }
  __builtin_unreachable();
}

}  // namespace ajar
