// Enters: roughconductor and roughdielectric lobes, local directions.
// Leaves: their values, densities, samples and albedos.
#pragma once

#include "ajar/scene/bsdf/microfacet.h"
#include "smooth.h"

namespace ajar {

/// A facet that mirrors wo into wi, both in front. Of a lobe F D G / (4 cos cos), f = F * value; the densities are
/// those of mirroring at visible normals (Heitz 2018).
struct Glint {
  Vec3 m{0, 0, 1};
  float cos = 0;  ///< between m and either direction, of a refraction that in the thinner medium; 0: no such facet
  float value = 0, pdf = 0, pdf_reverse = 0;
};
inline Glint glint_at(const Facets& f, const Vec3& m, float cos, const Vec3& wo, const Vec3& wi) {
  const float d = facet_density(f, m), see_o = facet_visibility(f, wo), see_i = facet_visibility(f, wi);
  return {m, cos, d * see_o * see_i, 0.5f * d * see_o, 0.5f * d * see_i};
}
inline Glint glint_between(const Facets& f, const Vec3& wo, const Vec3& wi) {
  const Vec3 h = wo + wi;
  const float l2 = length2(h);
  if (!(l2 > 1e-12f)) return {};  // both graze, from opposite sides: the half vector is rounding noise
  const float l = std::sqrt(l2);
  return glint_at(f, h * (1 / l), 0.5f * l, wo, wi);
}
/// False where the mirrored direction falls below the horizon.
inline bool sample_glint(const Facets& f, const Vec3& wo, const Vec2& u, Vec3& wi, Glint& out) {
  const Vec3 m = sample_facet(f, wo, u);
  wi = mirrored(wo, m);
  if (!(wi.z > 0)) return false;
  out = glint_at(f, m, glm::dot(wo, m), wo, wi);
  return out.pdf > 0;
}

inline BsdfEval eval(const RoughConductor& c, const Vec3& wo, const Vec3& wi, Mode) {
  if (!in_front(wo, wi)) return {};
  const Glint g = glint_between(c.facets, wo, wi);
  return {c.specular * fresnel_conductor(g.cos, c.eta, c.k) * g.value, g.pdf, g.pdf_reverse};
}
inline bool sample(const RoughConductor& c, const Vec3& wo, float, const Vec2& u, Mode, BsdfSample& out) {
  Glint g;
  if (!(wo.z > 0) || !sample_glint(c.facets, wo, u, out.wi, g)) return false;
  const Rgb weight =
      c.specular * fresnel_conductor(g.cos, c.eta, c.k) * (2 * facet_visibility(c.facets, out.wi) * out.wi.z);
  set(out, out.wi, weight, g.pdf, g.pdf_reverse, 1, false);
  return true;
}
inline Rgb albedo(const RoughConductor& c, const Vec3& wo) {
  return c.specular * fresnel_conductor(std::max(wo.z, 0.0f), c.eta, c.k);
}

/// A facet that refracts wo into wi (Walter et al. 2007, section 4.2 and eq. 21); h = wo + eta wi before normalising.
/// value and densities leave out the transmittance 1 - F, which all three carry as a factor, and are those of
/// importance.
inline Glint refraction_at(const Facets& f, const Vec3& m, float h2, float eta, const Vec3& wo, const Vec3& wi) {
  const float cos_o = std::abs(glm::dot(wo, m)), cos_i = std::abs(glm::dot(wi, m));
  const float d = facet_density(f, m), see_o = facet_visibility(f, wo), see_i = facet_visibility(f, wi);
  const float common = 2 * d * cos_o * cos_i / h2;
  return {m, eta > 1 ? cos_o : cos_i, 2 * common * eta * eta * see_o * see_i, common * eta * eta * see_o,
          common * see_i};
}
inline Glint refraction_between(const Facets& f, float eta, const Vec3& wo, const Vec3& wi) {
  const Vec3 h = wo + wi * eta;
  const float h2 = length2(h);
  if (!(h2 > 1e-12f)) return {};
  const Vec3 m = h * (std::copysign(1.0f, h.z) / std::sqrt(h2));
  if (!(glm::dot(wo, m) * wo.z > 0 && glm::dot(wi, m) * wi.z > 0)) return {};
  return refraction_at(f, m, h2, eta, wo, wi);
}

/// Reflectance of the facet. Of a refraction from the thinner side: from the denser one rounding is magnified without
/// bound near the critical angle.
inline float facet_reflectance(const Glint& g, bool reflects, float eta) {
  return fresnel_dielectric(g.cos, reflects ? eta : std::max(eta, 1 / eta));
}

inline BsdfEval eval(const RoughDielectric& d, const Vec3& wo, const Vec3& wi, Mode mode) {
  if (!(wo.z * wi.z != 0)) return {};
  const float eta = eta_across(d.ior, wo);
  const bool reflects = (wo.z > 0) == (wi.z > 0);
  const Vec3 up_o = wo.z > 0 ? wo : -wo, up_i = wo.z > 0 ? wi : -wi;
  const Glint g = reflects ? glint_between(d.facets, up_o, up_i) : refraction_between(d.facets, eta, up_o, up_i);
  if (!(g.cos > 0)) return {};
  const float reflected = facet_reflectance(g, reflects, eta), p = reflects ? reflected : 1 - reflected;
  const Rgb colour = reflects ? d.reflectance : d.transmittance * mode_scale(mode, eta);
  return {colour * (p * g.value), p * g.pdf, p * g.pdf_reverse};
}
inline bool sample(const RoughDielectric& d, const Vec3& wo, float u_lobe, const Vec2& u, Mode mode, BsdfSample& out) {
  if (wo.z == 0) return false;
  const float side = std::copysign(1.0f, wo.z), eta = eta_across(d.ior, wo);
  const Vec3 up_o = wo * side, m = sample_facet(d.facets, up_o, u);
  const float cos_o = glm::dot(up_o, m);
  float cos_t;
  const float reflected = fresnel_dielectric(std::max(cos_o, 0.0f), eta, cos_t);
  const bool reflects = take_part(u_lobe, reflected);
  const Vec3 wi = reflects ? mirrored(up_o, m) : refracted(up_o, m, eta, cos_t);
  if (!(reflects ? wi.z > 0 : wi.z < 0)) return false;
  const Glint g = reflects ? glint_at(d.facets, m, cos_o, up_o, wi)
                           : refraction_at(d.facets, m, sqr(cos_o - eta * cos_t), eta, up_o, wi);
  const float p = reflects ? reflected : 1 - reflected;
  const Rgb colour = reflects ? d.reflectance : d.transmittance * mode_scale(mode, eta);
  const float masking = 2 * facet_visibility(d.facets, wi) * std::abs(wi.z);
  set(out, wi * side, colour * masking, p * g.pdf, p * g.pdf_reverse, reflects ? 1 : eta, false);
  return out.pdf > 0;
}
inline Rgb albedo(const RoughDielectric& d, const Vec3& wo) {
  return glm::mix(d.transmittance, d.reflectance, fresnel_dielectric(std::abs(wo.z), eta_across(d.ior, wo)));
}

}  // namespace ajar
