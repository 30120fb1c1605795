// Enters: roughness of a microfacet surface, directions in its frame.
// Leaves: distribution of normals D, Smith's masking and sampling of the normals that a direction sees.
#pragma once

#include "ajar/scene/bsdf/circle.h"
#include "ajar/scene/bsdf/lobes.h"

namespace ajar {

/// D(m) [1/sr] of unit m with m.z > 0: GGX and Beckmann with elliptic slopes (Walter et al. 2007, eq. 25 and 33; Heitz
/// 2014, eq. 84 and 85). Integrates with cos to 1.
inline float facet_density(const Facets& f, const Vec3& m) {
  const float uv = f.alpha_u * f.alpha_v, z2 = m.z * m.z;
  const float r2 = sqr(m.x * f.alpha_v) + sqr(m.y * f.alpha_u), uv2z2 = uv * uv * z2;  // slopes times alpha_u alpha_v
  if (f.kind == Microfacet::ggx) return uv * uv * uv * inv_pi / sqr(r2 + uv2z2);
  if (r2 > 80 * uv2z2) return 0;  // exp(-80): also keeps 0 / 0 out
  return std::exp(-r2 / uv2z2) * inv_pi / (uv * z2 * z2);
}

/// G1(w) / (2 |cos w|), Smith's masking (Heitz 2014, section 5): finite at grazing angles, where the quotient of its
/// parts is not.
inline float facet_visibility(const Facets& f, const Vec3& w) {
  const float r2 = sqr(f.alpha_u * w.x) + sqr(f.alpha_v * w.y), z = std::abs(w.z);
  if (f.kind == Microfacet::ggx) return 1 / (z + std::sqrt(r2 + z * z));
  if (16 * r2 < z * z) return 0.5f / z;  // masks less than 1e-8
  const float r = std::sqrt(r2), a = z / r;
  return 1 / (z * (1 + std::erf(a)) + r * std::exp(-a * a) * 0.56418958f);  // 1 / sqrt(pi)
}

/// GGX by the spherical cap of Dupuy and Benyoub 2023; see sample_facet.
inline Vec3 sample_ggx(const Facets& f, const Vec3& w, const Vec2& u) {
  const Vec3 stretched{f.alpha_u * w.x, f.alpha_v * w.y, w.z};
  const Vec3 v = stretched * (1 / std::sqrt(length2(stretched)));
  const float z = (1 - u.y) * (1 + v.z) - v.z, r = safe_sqrt(1 - z * z);
  const Vec2 c = circle(u.x);
  const Vec3 m{f.alpha_u * (r * c.x + v.x), f.alpha_v * (r * c.y + v.y), std::max(z + v.z, 1e-12f)};
  return m * (1 / std::sqrt(length2(m)));
}
/// Beckmann by inverting the distribution of visible slopes (Heitz and d'Eon 2014, Jakob 2014); see sample_facet.
Vec3 sample_beckmann(const Facets& f, const Vec3& w, const Vec2& u);

/// Normal m drawn from the normals that w (w.z > 0) sees: density 2 facet_visibility(w) max(0, w.m) D(m) [1/sr].
inline Vec3 sample_facet(const Facets& f, const Vec3& w, const Vec2& u) {
  return f.kind == Microfacet::ggx ? sample_ggx(f, w, u) : sample_beckmann(f, w, u);
}

}  // namespace ajar
