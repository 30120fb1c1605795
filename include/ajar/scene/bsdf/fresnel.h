// Enters: cosines and indices of refraction.
// Leaves: Fresnel reflectances of unpolarised light, mirrored and refracted directions.
#pragma once

#include "ajar/core/vec.h"

namespace ajar {

/// Reflectance of a smooth dielectric; cos_o >= 0, eta is the index behind over the index in front. cos_t receives the
/// cosine of the refracted direction, 0 at total reflection. The same value from both sides (Born and Wolf 1999,
/// section 1.5.2).
inline float fresnel_dielectric(float cos_o, float eta, float& cos_t) {
  const float cos2_t = (eta * eta - 1 + cos_o * cos_o) / (eta * eta);
  if (!(cos2_t > 1e-12f)) {  // grazing to within rounding counts too, else equal indices give 0 / 0 there
    cos_t = 0;
    return 1;
  }
  cos_t = std::sqrt(cos2_t);
  // (s^2 + p^2) / 2 over a common denominator: one division
  const float s_sum = cos_o + eta * cos_t, p_sum = eta * cos_o + cos_t;
  const float s = (cos_o - eta * cos_t) * p_sum, p = (eta * cos_o - cos_t) * s_sum;
  return 0.5f * (s * s + p * p) / sqr(s_sum * p_sum);
}
inline float fresnel_dielectric(float cos_o, float eta) {
  float cos_t;
  return fresnel_dielectric(cos_o, eta, cos_t);
}

/// Reflectance of a conductor with the complex index eta + i k relative to the outside, exact (Born and Wolf 1999,
/// section 14.2).
inline float fresnel_conductor(float cos_o, float eta, float k) {
  const float cos2 = cos_o * cos_o, sin2 = 1 - cos2;
  const float d = eta * eta - k * k - sin2;
  const float sum = std::sqrt(d * d + 4 * eta * eta * k * k);  // a^2 + b^2
  const float a = safe_sqrt(0.5f * (sum + d));
  const float s_even = sum + cos2, s_odd = 2 * a * cos_o;
  const float p_even = cos2 * sum + sin2 * sin2, p_odd = s_odd * sin2;
  // Rs = (s_even - s_odd) / (s_even + s_odd), Rp = Rs (p_even - p_odd) / (p_even + p_odd), their mean with one
  // division. The denominator vanishes only where the index does not change and light grazes: then nothing is
  // reflected.
  const float all = (s_even + s_odd) * (p_even + p_odd);
  return all > 0 ? std::clamp((s_even - s_odd) * p_even / all, 0.0f, 1.0f) : 0.0f;
}
inline Rgb fresnel_conductor(float cos_o, const Rgb& eta, const Rgb& k) {
  return {fresnel_conductor(cos_o, eta.x, k.x), fresnel_conductor(cos_o, eta.y, k.y),
          fresnel_conductor(cos_o, eta.z, k.z)};
}

/// Diffuse (cosine-weighted mean) reflectance of a smooth dielectric seen from outside: closed form of Walsh
/// 1926 as given by Egan and Hilgeman 1973. From inside, eta < 1, it is 1 - (1 - that from outside) eta^2.
inline double fresnel_diffuse(double eta) {
  if (eta < 1) return 1 - (1 - fresnel_diffuse(1 / eta)) * (eta * eta);
  if (eta < 1 + 1e-4) return 0;  // O((eta - 1)), and the closed form cancels there
  const double n2 = eta * eta, n4 = n2 * n2, plus = n2 + 1, minus = n2 - 1;
  return 0.5 + (eta - 1) * (3 * eta + 1) / (6 * (eta + 1) * (eta + 1)) +
         n2 * minus * minus / (plus * plus * plus) * std::log((eta - 1) / (eta + 1)) -
         2 * n2 * eta * (n2 + 2 * eta - 1) / (plus * (n4 - 1)) +
         8 * n4 * (n4 + 1) / (plus * (n4 - 1) * (n4 - 1)) * std::log(eta);
}

/// w mirrored about m.
inline Vec3 mirrored(const Vec3& w, const Vec3& m) { return 2 * glm::dot(w, m) * m - w; }
/// w refracted at a facet m on w's side; eta is the index behind over the index in front, cos_t from
/// fresnel_dielectric.
inline Vec3 refracted(const Vec3& w, const Vec3& m, float eta, float cos_t) {
  return m * (glm::dot(w, m) / eta - cos_t) - w / eta;
}

/// Schlick's (1 - cos)^5.
inline float schlick_weight(float cos_o) {
  const float m = std::clamp(1 - cos_o, 0.0f, 1.0f), m2 = m * m;
  return m2 * m2 * m;
}

}  // namespace ajar
