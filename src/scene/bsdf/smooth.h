// Enters: diffuse, conductor, dielectric and thindielectric lobes, local directions.
// Leaves: their values, densities, samples and albedos.
#pragma once

#include "ajar/core/warp.h"
#include "ajar/scene/bsdf.h"
#include "ajar/scene/bsdf/circle.h"
#include "ajar/scene/bsdf/fresnel.h"

namespace ajar {

/// What only reflects does so where both directions are in front.
inline bool in_front(const Vec3& wo, const Vec3& wi) { return wo.z > 0 && wi.z > 0; }
inline Vec3 mirrored(const Vec3& w) { return {-w.x, -w.y, w.z}; }

/// Member by member: a whole BsdfSample would be built aside and copied, and the copy would wait for the stores.
inline void set(BsdfSample& out, const Vec3& wi, const Rgb& weight, float pdf, float pdf_reverse, float eta,
                bool delta) {
  out.wi = wi;
  out.weight = weight;
  out.pdf = pdf;
  out.pdf_reverse = pdf_reverse;
  out.eta = eta;
  out.delta = delta;
}
inline bool set_delta(BsdfSample& out, const Vec3& wi, const Rgb& weight, float probability, float eta = 1) {
  set(out, wi, weight, probability, probability, eta, true);
  return probability > 0;
}

inline BsdfEval eval(const Diffuse& d, const Vec3& wo, const Vec3& wi, Mode) {
  if (!in_front(wo, wi)) return {};
  return {d.reflectance * inv_pi, wi.z * inv_pi, wo.z * inv_pi};
}
inline bool sample(const Diffuse& d, const Vec3& wo, float, const Vec2& u, Mode, BsdfSample& out) {
  if (!(wo.z > 0)) return false;
  const Vec3 wi = cosine_direction(u);
  set(out, wi, d.reflectance, wi.z * inv_pi, wo.z * inv_pi, 1, false);
  return wi.z > 0;
}
inline Rgb albedo(const Diffuse& d, const Vec3&) { return d.reflectance; }

inline BsdfEval eval(const Conductor&, const Vec3&, const Vec3&, Mode) { return {}; }
inline Rgb albedo(const Conductor& c, const Vec3& wo) {
  return c.specular * fresnel_conductor(std::max(wo.z, 0.0f), c.eta, c.k);
}
inline bool sample(const Conductor& c, const Vec3& wo, float, const Vec2&, Mode, BsdfSample& out) {
  return wo.z > 0 && set_delta(out, mirrored(wo), albedo(c, wo), 1);
}

/// Index on the other side of wo over that on wo's side.
inline float eta_across(float ior, const Vec3& wo) { return wo.z > 0 ? ior : 1 / ior; }
/// Radiance is per basic solid angle, it changes with n^2; importance does not (Veach 1997, section 5.2).
inline float mode_scale(Mode mode, float eta) { return mode == Mode::radiance ? 1 / (eta * eta) : 1.0f; }

inline BsdfEval eval(const Dielectric&, const Vec3&, const Vec3&, Mode) { return {}; }
inline bool sample(const Dielectric& d, const Vec3& wo, float u_lobe, const Vec2&, Mode mode, BsdfSample& out) {
  if (wo.z == 0) return false;
  const float eta = eta_across(d.ior, wo);
  float cos_t;
  const float reflected = fresnel_dielectric(std::abs(wo.z), eta, cos_t);
  if (take_part(u_lobe, reflected)) return set_delta(out, mirrored(wo), d.reflectance, reflected);
  const Vec3 wi{-wo.x / eta, -wo.y / eta, std::copysign(cos_t, -wo.z)};
  return set_delta(out, wi, d.transmittance * mode_scale(mode, eta), 1 - reflected, eta);
}
inline Rgb albedo(const Dielectric& d, const Vec3& wo) {
  return glm::mix(d.transmittance, d.reflectance, fresnel_dielectric(std::abs(wo.z), eta_across(d.ior, wo)));
}

/// Reflectance of a pane: R + T^2 R / (1 - R^2) = 2 R / (1 + R); all of it beyond the critical angle of a gap of air.
inline float pane_reflectance(const ThinDielectric& d, const Vec3& wo) {
  const float once = fresnel_dielectric(std::abs(wo.z), d.ior);
  return 2 * once / (1 + once);
}
inline BsdfEval eval(const ThinDielectric&, const Vec3&, const Vec3&, Mode) { return {}; }
inline bool sample(const ThinDielectric& d, const Vec3& wo, float u_lobe, const Vec2&, Mode, BsdfSample& out) {
  if (wo.z == 0) return false;
  const float reflected = pane_reflectance(d, wo);
  if (take_part(u_lobe, reflected)) return set_delta(out, mirrored(wo), d.reflectance, reflected);
  return set_delta(out, -wo, d.transmittance, 1 - reflected);
}
inline Rgb albedo(const ThinDielectric& d, const Vec3& wo) {
  return glm::mix(d.transmittance, d.reflectance, pane_reflectance(d, wo));
}

}  // namespace ajar
