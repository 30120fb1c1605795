// Enters: principled lobes, local directions.
// Leaves: their values, densities, samples and albedos: Burley 2012 and 2015, with Mitsuba 3's parameters and scales,
// so that images agree: no 1/(4 cos cos) in clearcoat, no colour on the inner reflection, square root of the colour on
// refraction.
#pragma once

#include "rough.h"

namespace ajar {

inline Facets facets(const Principled& p) {
  const float a = p.roughness * p.roughness;
  return {std::max(0.001f, a / p.aspect), std::max(0.001f, a * p.aspect), Microfacet::ggx};
}
inline float refracting(const Principled& p) { return (1 - p.metallic) * p.spec_trans; }
inline Rgb tint(const Rgb& base) {
  const float l = luminance(base);
  return l > 0 ? base / l : Rgb(1);
}
inline Rgb schlick(const Rgb& r0, float weight) { return r0 + (Rgb(1) - r0) * weight; }

/// Fresnel factor of the front: dielectric, tinted dielectric and metal blended. cos_t belongs to cos_o.
inline Rgb front_fresnel(const Principled& p, float dielectric, float cos_o, float cos_t) {
  Rgb f = Rgb((1 - p.metallic) * (1 - p.spec_tint) * dielectric);
  if (p.metallic == 0 && p.spec_tint == 0) return f;
  const float weight = schlick_weight(p.eta > 1 ? cos_o : cos_t);
  f += p.metallic * schlick(p.base, weight);
  if (p.spec_tint > 0)
    f += (1 - p.metallic) * p.spec_tint * schlick(tint(p.base) * sqr((p.eta - 1) / (p.eta + 1)), weight);
  return f;
}

/// GTR1 of Burley 2012, appendix B.2; D cos integrates to 1.
inline float clearcoat_density(float alpha, const Vec3& m) {
  const float a2 = alpha * alpha;
  return (a2 - 1) / (pi * std::log(a2) * (m.x * m.x + m.y * m.y + a2 * m.z * m.z));
}
inline float smith_ggx(float alpha, const Vec3& w) {
  return 2 * w.z * facet_visibility({alpha, alpha, Microfacet::ggx}, w);
}
inline float clearcoat_value(const Principled& p, const Vec3& wo, const Vec3& wi, float d, float weight) {
  return 0.25f * p.clearcoat * (0.04f + 0.96f * weight) * d * smith_ggx(0.25f, wo) * smith_ggx(0.25f, wi);
}

/// Diffuse, retro-reflection, fake subsurface and sheen (whole, but none where nothing is diffuse); cos_d between half
/// vector and either direction.
inline Rgb base_value(const Principled& p, float cos_o, float cos_i, float cos_d) {
  const float fo = schlick_weight(cos_o), fi = schlick_weight(cos_i);
  const float rr = 2 * p.roughness * cos_d * cos_d;
  float diffuse = (1 - 0.5f * fi) * (1 - 0.5f * fo) + rr * (fo + fi + fo * fi * (rr - 1));
  if (p.flatness > 0) {
    const float ss90 = 0.5f * rr, ss = (1 + (ss90 - 1) * fo) * (1 + (ss90 - 1) * fi);
    const float flat = 1.25f * (ss * (1 / std::max(cos_o + cos_i, 1e-5f) - 0.5f) + 0.5f);
    diffuse += (flat - diffuse) * p.flatness;
  }
  Rgb f = p.base * ((1 - p.metallic) * (1 - p.spec_trans) * inv_pi * diffuse);
  if (p.sheen > 0 && p.spec_trans < 1)
    f += glm::mix(Rgb(1), tint(p.base), p.sheen_tint) * (p.sheen * (1 - p.metallic) * schlick_weight(cos_d));
  return f;
}

/// Probabilities of the parts for w in front: their albedos, estimated. What refracts counts as specular.
struct PrincipledShares {
  float diffuse, specular, clearcoat;
};
inline PrincipledShares shares(const Principled& p, float cos) {
  float cos_t;
  const float dielectric = fresnel_dielectric(cos, p.eta, cos_t), through = refracting(p) * (1 - dielectric);
  const float s = luminance(front_fresnel(p, dielectric, cos, cos_t)) + through + 0.02f;
  const float sheen = p.spec_trans < 1 ? p.sheen : 0;
  const float d = (1 - p.metallic) * ((1 - p.spec_trans) * max_component(p.base) + 0.1f * sheen);
  // A quarter in its value, and 4 cos^2 because that is not divided by cosines; a floor where it grazes.
  const float coat = 0.04f + 0.96f * schlick_weight(p.eta > 1 ? cos : cos_t);
  const float c = p.clearcoat * std::max(coat * cos * cos, 0.02f);
  const float scale = 1 / (s + d + c);
  return {d * scale, s * scale, c * scale};
}
/// Of the specular part, the probability that a facet refracts.
inline float refraction_probability(const Principled& p, bool front, float dielectric) {
  const float through = refracting(p) * (1 - dielectric);
  if (!(through > 0)) return 0;
  const float back = front ? p.metallic + (1 - p.metallic) * dielectric : refracting(p) * dielectric;
  return through / (through + back);
}

inline BsdfEval eval_front(const Principled& p, const Vec3& wo, const Vec3& wi, const Glint& g) {
  if (!(g.cos > 0)) return {};
  float cos_t;
  const float dielectric = fresnel_dielectric(g.cos, p.eta, cos_t);
  const PrincipledShares so = shares(p, wo.z), si = shares(p, wi.z);
  const float mirrors = 1 - refraction_probability(p, true, dielectric);
  BsdfEval e{base_value(p, wo.z, wi.z, g.cos) + front_fresnel(p, dielectric, g.cos, cos_t) * g.value,
             so.specular * mirrors * g.pdf + so.diffuse * wi.z * inv_pi,
             si.specular * mirrors * g.pdf_reverse + si.diffuse * wo.z * inv_pi};
  if (p.clearcoat > 0) {
    const float d = clearcoat_density(p.clearcoat_alpha, g.m);
    e.f += clearcoat_value(p, wo, wi, d, schlick_weight(p.eta > 1 ? g.cos : cos_t));
    const float pdf = d * g.m.z / (4 * g.cos);
    e.pdf += so.clearcoat * pdf;
    e.pdf_reverse += si.clearcoat * pdf;
  }
  return e;
}

inline BsdfEval eval(const Principled& p, const Vec3& wo, const Vec3& wi, Mode mode) {
  if (in_front(wo, wi)) return eval_front(p, wo, wi, glint_between(facets(p), wo, wi));
  const float through = refracting(p);
  if (!(through > 0) || !(wo.z * wi.z != 0)) return {};
  const bool front = wo.z > 0, reflects = front == (wi.z > 0);
  const float eta = eta_across(p.eta, wo);
  const Vec3 up_o = front ? wo : -wo, up_i = front ? wi : -wi;
  const Glint g = reflects ? glint_between(facets(p), up_o, up_i) : refraction_between(facets(p), eta, up_o, up_i);
  if (!(g.cos > 0)) return {};
  const float dielectric = facet_reflectance(g, reflects, eta);
  if (reflects) {
    const float choice = 1 - refraction_probability(p, false, dielectric);
    return {Rgb(through * dielectric * g.value), choice * g.pdf, choice * g.pdf_reverse};
  }
  // One of the two directions is in front and chose the specular part among others.
  const float chosen = shares(p, std::abs(front ? wo.z : wi.z)).specular;
  const float po = refraction_probability(p, front, dielectric) * (front ? chosen : 1);
  const float pi_ = refraction_probability(p, !front, dielectric) * (front ? 1 : chosen);
  return {glm::sqrt(p.base) * (through * (1 - dielectric) * mode_scale(mode, eta) * g.value), po * g.pdf,
          pi_ * g.pdf_reverse};
}

/// Direction by one of the parts; false where it leaves the side it should be on.
inline bool sample_direction(const Principled& p, const Vec3& wo, float u_lobe, const Vec2& u, Vec3& wi) {
  const bool front = wo.z > 0;
  const Vec3 up = front ? wo : -wo;
  const PrincipledShares s = front ? shares(p, wo.z) : PrincipledShares{0, 1, 0};
  if (take_part(u_lobe, s.diffuse)) {
    wi = cosine_direction(u);
    return wi.z > 0;
  }
  if (take_part(u_lobe, s.clearcoat / (s.clearcoat + s.specular))) {
    const float a2 = sqr(p.clearcoat_alpha);
    const Vec2 c = circle(u.x);
    const float cos2 = (1 - std::pow(a2, 1 - u.y)) / (1 - a2), sin = safe_sqrt(1 - cos2);
    wi = mirrored(wo, Vec3(sin * c.x, sin * c.y, safe_sqrt(cos2)));
    return wi.z > 0;
  }
  const float eta = eta_across(p.eta, wo);
  const Vec3 m = sample_facet(facets(p), up, u);
  float cos_t;
  const float dielectric = fresnel_dielectric(std::max(glm::dot(up, m), 0.0f), eta, cos_t);
  const bool refracts = take_part(u_lobe, refraction_probability(p, front, dielectric));
  const Vec3 up_i = refracts ? refracted(up, m, eta, cos_t) : mirrored(up, m);
  wi = front ? up_i : -up_i;
  return refracts ? up_i.z < 0 : up_i.z > 0;
}
inline bool sample(const Principled& p, const Vec3& wo, float u_lobe, const Vec2& u, Mode mode, BsdfSample& out) {
  if (wo.z == 0 || (wo.z < 0 && !(refracting(p) > 0))) return false;
  if (!sample_direction(p, wo, u_lobe, u, out.wi)) return false;
  const BsdfEval e = eval(p, wo, out.wi, mode);
  if (!(e.pdf > 0)) return false;
  const float eta = (wo.z > 0) == (out.wi.z > 0) ? 1.0f : eta_across(p.eta, wo);
  set(out, out.wi, e.f * (std::abs(out.wi.z) / e.pdf), e.pdf, e.pdf_reverse, eta, false);
  return true;
}
inline Rgb albedo(const Principled& p, const Vec3& wo) {
  const float eta = eta_across(p.eta, wo), cos = std::abs(wo.z);
  float cos_t;
  const float dielectric = fresnel_dielectric(cos, eta, cos_t);
  const Rgb through = glm::sqrt(p.base) * (refracting(p) * (1 - dielectric));
  if (wo.z < 0) return through + refracting(p) * dielectric;
  const Rgb base = p.base * ((1 - p.metallic) * (1 - p.spec_trans));
  return glm::min(base + front_fresnel(p, dielectric, cos, cos_t) + through, Rgb(1));
}

}  // namespace ajar
