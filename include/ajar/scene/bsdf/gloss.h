// Enters: a bsdf.
// Leaves: roughly, how much more of it goes to one direction than if it were matt: so cheap that one asks for a
// thousand directions at once. Choices are made by it, values are not.
#pragma once

#include <algorithm>
#include <cmath>

#include "ajar/scene/bsdf.h"
#include "ajar/scene/bsdf/fresnel.h"

namespace ajar {

/// A bsdf as a matt part and one isotropic GGX lobe (Walter et al. 2007), both relative to its albedo.
struct Gloss {
  float matt = 1;   ///< share of the albedo that is spread evenly
  float peak = 0;   ///< reflectance of the lobe's facets at grazing angles over the albedo; 0: matt alone
  float f0 = 1;     ///< Schlick's: reflectance at right angles over that
  float alpha = 1;  ///< roughness
};
/// wo: local, that the bsdf was resolved for. Bsdfs that let light through are taken for matt.
Gloss gloss_of(const Bsdf& bsdf, const Vec3& wo);

/// About pi f / albedo, luminance, for directions with cosines n_o and n_i to the normal and `between` to each other;
/// never less than a tenth, so that no choice rests on the lobe alone.
inline float shine(const Gloss& g, float n_o, float n_i, float between) {
  constexpr float least = 0.1f;
  const float h2 = std::max(2 + 2 * between, 1e-6f), half = std::sqrt(h2), a2 = g.alpha * g.alpha, sum = n_o + n_i;
  const float t = std::min(sum * sum, h2) * (a2 - 1) + h2;  // times h2, as its square below
  const float fresnel = g.f0 + (1 - g.f0) * schlick_weight(0.5f * half);
  // What both sides see of the facets, over 4 cos cos (Hammon 2017), is 1/2 over this.
  const float unseen = std::max(2 * n_o * n_i * (1 - g.alpha) + sum * g.alpha, 1e-6f);
  const float lobe = 0.5f * g.peak * fresnel * a2 * h2 * h2 / (unseen * std::max(t * t, 1e-14f * h2 * h2));  // (J6)
  const float front = n_o > 0 && n_i > 0 ? 1.0f : 0.0f;
  return std::max(g.matt + front * lobe, least);
}

}  // namespace ajar
