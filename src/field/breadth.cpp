#include "breadth.h"

#include "ajar/scene/bsdf/through.h"

namespace ajar {
namespace {

// What a boundary over a base takes of the field's part: three times what it reflects at right angles, so that its own
// lobe, which reflects more at others, is never starved. The same for both directions of a path.
float boundary(float share, float ior) {
  const float reflected = sqr((ior - 1) / (ior + 1)), s = share * reflected;
  return std::min(3 * s / std::max(s + (1 - share) * (1 - reflected), 1e-6f), 1.0f);
}

// 1 up to a roughness of 0.1, which fields of a few dozen strata cannot resolve, 0 from 0.5 on.
float narrow(float alpha) { return 1 - std::clamp((alpha - 0.1f) * 2.5f, 0.0f, 1.0f); }

// What lobe widths allow, over all that is on the base: what metal reflects, it reflects at all angles.
float breadth(const Principled& p) {
  const float base = max_component(p.base), dielectric = 1 - p.metallic;
  const float reflected = dielectric * sqr((p.eta - 1) / (p.eta + 1)), coat = 0.04f * p.clearcoat;
  const float all = dielectric * base + p.metallic * base + reflected + coat;
  const float narrow_part =
      (3 * reflected + p.metallic * base) * narrow(sqr(p.roughness) * p.aspect) + 3 * coat * narrow(p.clearcoat_alpha);
  return std::max(1 - narrow_part / std::max(all, 1e-6f), 0.0f);
}

// How good a guide the field alone is, without the bsdf: 0 for narrow lobes, 1 for diffuse ones.
float breadth(const Lobe& lobe) {
  switch (lobe.kind) {
    case LobeKind::diffuse:
    case LobeKind::roughdiffuse:
      return 1;
    case LobeKind::plastic:
      return 1 - boundary(lobe.plastic.share, lobe.plastic.ior);
    case LobeKind::roughplastic:
      return 1 - boundary(lobe.roughplastic.share, lobe.roughplastic.ior) * narrow(narrower(lobe.roughplastic.facets));
    case LobeKind::roughconductor:
      return 1 - narrow(narrower(lobe.roughconductor.facets));
    case LobeKind::phong:
      return 1 - lobe.phong.share * narrow(std::sqrt(2 / (lobe.phong.exponent + 2)));
    case LobeKind::ward:
      return 1 - lobe.ward.share * narrow(narrower(lobe.ward.facets));
    case LobeKind::principled:
      return breadth(lobe.principled);
    default:
      return 0;  // deltas
  }
}

}  // namespace

Breadth breadth_of(const Bsdf& bsdf) {
  float near = 0, through = 0;
  for (int i = 0; i < bsdf.count; ++i) {
    const Lobe& lobe = bsdf.lobes[i];
    if (lobe.kind == LobeKind::difftrans) {
      through += bsdf.choice[i];
    } else {
      if (turns_through(lobe)) return {};
      near += bsdf.choice[i] * breadth(lobe);
    }
  }
  if (!(through > 0)) return {near / bsdf.opacity, 0};
  through /= bsdf.opacity;
  return {through < 1 ? near / (bsdf.opacity * (1 - through)) : 0, through};
}

}  // namespace ajar
