// Enters: plastic, roughplastic and phong lobes, local directions.
// Leaves: their values, densities, samples and albedos.
#pragma once

#include "ajar/scene/bsdf/table.h"
#include "rough.h"

namespace ajar {

/// Probability of the specular part: its albedo against that of the base, both estimated.
inline float specular_probability(float share, float reflected) {
  const float s = share * reflected, d = (1 - share) * (1 - reflected);
  return s + d > 0 ? s / (s + d) : 0.5f;
}

// plastic: a Lambertian base seen through a smooth boundary twice, T(wo) T(wi) base / pi (base holds what internal
// reflections make of the colour), and the boundary's own mirror image.

inline BsdfEval eval(const Plastic& p, const Vec3& wo, const Vec3& wi, Mode) {
  if (!in_front(wo, wi)) return {};
  const float fo = fresnel_dielectric(wo.z, p.ior), fi = fresnel_dielectric(wi.z, p.ior);
  return {p.base * ((1 - fo) * (1 - fi) * inv_pi), (1 - specular_probability(p.share, fo)) * wi.z * inv_pi,
          (1 - specular_probability(p.share, fi)) * wo.z * inv_pi};
}
inline bool sample(const Plastic& p, const Vec3& wo, float u_lobe, const Vec2& u, Mode mode, BsdfSample& out) {
  if (!(wo.z > 0)) return false;
  const float reflected = fresnel_dielectric(wo.z, p.ior), ps = specular_probability(p.share, reflected);
  if (take_part(u_lobe, ps)) return set_delta(out, mirrored(wo), p.specular * (reflected / ps), ps);
  const Vec3 wi = cosine_direction(u);
  const BsdfEval e = eval(p, wo, wi, mode);
  if (!(e.pdf > 0)) return false;
  set(out, wi, e.f * (wi.z / e.pdf), e.pdf, e.pdf_reverse, 1, false);
  return true;
}
inline Rgb albedo(const Plastic& p, const Vec3& wo) {
  const float reflected = fresnel_dielectric(std::max(wo.z, 0.0f), p.ior);
  return p.specular * reflected + p.base * ((1 - reflected) * p.entering);
}

// roughplastic: the same with a rough boundary, whose transmittance comes from the material's table (that of a smooth
// one where light sent back inside is lost).

inline float transmittance(const RoughPlastic& p, float cos) {
  const float t = table_at(p.table, cos);
  return p.between > 0 ? t + (table_at(p.table + table_row, cos) - t) * p.between : t;
}
inline float entry(const RoughPlastic& p, int i) {
  return p.between > 0 ? p.table[i] + (p.table[table_row + i] - p.table[i]) * p.between : p.table[i];
}
inline float entering(const RoughPlastic& p) { return entry(p, 0); }

inline BsdfEval combine(const RoughPlastic& p, const Vec3& wo, const Vec3& wi, const Glint& g, float to, float ti) {
  const float po = specular_probability(p.share, 1 - to), pi_ = specular_probability(p.share, 1 - ti);
  return {p.base * (to * ti * inv_pi) + p.specular * (fresnel_dielectric(g.cos, p.ior) * g.value),
          po * g.pdf + (1 - po) * wi.z * inv_pi, pi_ * g.pdf_reverse + (1 - pi_) * wo.z * inv_pi};
}
inline BsdfEval eval(const RoughPlastic& p, const Vec3& wo, const Vec3& wi, Mode) {
  if (!in_front(wo, wi)) return {};
  return combine(p, wo, wi, glint_between(p.facets, wo, wi), transmittance(p, wo.z), transmittance(p, wi.z));
}
inline bool sample(const RoughPlastic& p, const Vec3& wo, float u_lobe, const Vec2& u, Mode, BsdfSample& out) {
  if (!(wo.z > 0)) return false;
  const float to = transmittance(p, wo.z);
  Glint g;
  Vec3 wi;
  if (take_part(u_lobe, specular_probability(p.share, 1 - to))) {
    if (!sample_glint(p.facets, wo, u, wi, g)) return false;
  } else {
    wi = cosine_direction(u);
    if (!(wi.z > 0)) return false;
    g = glint_between(p.facets, wo, wi);
  }
  const BsdfEval e = combine(p, wo, wi, g, to, transmittance(p, wi.z));
  if (!(e.pdf > 0)) return false;
  set(out, wi, e.f * (wi.z / e.pdf), e.pdf, e.pdf_reverse, 1, false);
  return true;
}
inline Rgb albedo(const RoughPlastic& p, const Vec3& wo) {
  const float t = transmittance(p, std::max(wo.z, 0.0f));
  return p.specular * (1 - t) + p.base * (t * entering(p));
}

// phong: ks (n + 2) / (2 pi) cos^n about the mirrored direction, kd / pi.

inline BsdfEval eval(const Phong& p, const Vec3& wo, const Vec3& wi, Mode) {
  if (!in_front(wo, wi)) return {};
  const float cos = std::min(glm::dot(mirrored(wo), wi), 1.0f);
  const float lobe = cos > 0 ? std::pow(cos, p.exponent) * (0.5f * inv_pi) : 0;
  const float s = p.share * (p.exponent + 1) * lobe, d = (1 - p.share) * inv_pi;
  return {p.diffuse * inv_pi + p.specular * ((p.exponent + 2) * lobe), s + d * wi.z, s + d * wo.z};
}
inline bool sample(const Phong& p, const Vec3& wo, float u_lobe, const Vec2& u, Mode mode, BsdfSample& out) {
  if (!(wo.z > 0)) return false;
  Vec3 wi;
  if (take_part(u_lobe, p.share)) {
    // 1 - cos without cancellation: for large exponents the lobe is narrower than the rounding of cos.
    const float drop = -std::expm1(std::log1p(-u.x) / (p.exponent + 1)), sin = safe_sqrt(drop * (2 - drop));
    const Vec2 c = circle(u.y);
    wi = make_frame(mirrored(wo)).to_world({sin * c.x, sin * c.y, 1 - drop});
  } else {
    wi = cosine_direction(u);
  }
  const BsdfEval e = eval(p, wo, wi, mode);
  if (!(e.pdf > 0)) return false;
  set(out, wi, e.f * (wi.z / e.pdf), e.pdf, e.pdf_reverse, 1, false);
  return true;
}
inline Rgb albedo(const Phong& p, const Vec3&) { return p.diffuse + p.specular; }

}  // namespace ajar
