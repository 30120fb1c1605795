#include "ajar/scene/bsdf/gloss.h"

#include "visit.h"

namespace ajar {
namespace {

float reflected_at_right_angles(float ior) { return sqr((ior - 1) / (ior + 1)); }
float width_of(const Facets& f) { return std::sqrt(f.alpha_u * f.alpha_v); }
float schlick(float f0, float cos) { return f0 + (1 - f0) * schlick_weight(std::max(cos, 0.0f)); }

// What a lobe of this albedo consists of, not yet relative to it.
Gloss parts_of(const Lobe& lobe, float albedo, const Vec3& wo) {
  switch (lobe.kind) {
    case LobeKind::roughconductor:
      return {0, albedo, 1, width_of(lobe.roughconductor.facets)};
    case LobeKind::roughplastic: {
      const float f0 = reflected_at_right_angles(lobe.roughplastic.ior), peak = luminance(lobe.roughplastic.specular);
      return {std::max(albedo - peak * schlick(f0, wo.z), 0.0f), peak, f0, width_of(lobe.roughplastic.facets)};
    }
    case LobeKind::phong:
      return {luminance(lobe.phong.diffuse), luminance(lobe.phong.specular), 1,
              std::min(std::sqrt(2 / (lobe.phong.exponent + 2)), 1.0f)};
    case LobeKind::ward:
      return {luminance(lobe.ward.diffuse), luminance(lobe.ward.specular), 1, width_of(lobe.ward.facets)};
    case LobeKind::principled: {
      const Principled& p = lobe.principled;
      if (p.spec_trans > 0) break;
      const float f0 = glm::mix(reflected_at_right_angles(p.eta), luminance(p.base), p.metallic);
      return {std::max(albedo - schlick(f0, wo.z), 0.0f), 1, f0, width_of(facets(p))};
    }
    default:
      break;
  }
  return {albedo, 0, 1, 1};
}

}  // namespace

Gloss gloss_of(const Bsdf& bsdf, const Vec3& wo) {
  if (bsdf.bent || least_roughness(bsdf) >= 1) return {};
  Gloss sum{0, 0, 1, 1};
  float all = 0, tallest = 0;
  for (int i = 0; i < bsdf.count; ++i) {
    const float weight = bsdf.weights[i];
    const float albedo = luminance(visit(bsdf.lobes[i], [&](const auto& lobe) { return ajar::albedo(lobe, wo); }));
    const Gloss parts = parts_of(bsdf.lobes[i], albedo, wo);
    all += weight * albedo, sum.matt += weight * parts.matt;
    const float height = weight * parts.peak * parts.f0 / sqr(parts.alpha);
    if (!(height > tallest)) continue;
    tallest = height;
    sum.peak = weight * parts.peak, sum.f0 = parts.f0, sum.alpha = parts.alpha;
  }
  if (!(all > 0) || !(tallest > 0)) return {};
  return {sum.matt / all, sum.peak / all, sum.f0, sum.alpha};
}

}  // namespace ajar
