#include "ajar/scene/bsdf/microfacet.h"

namespace ajar {
namespace {

// Inverse error function, relative error below 4e-7 (Giles 2010, Approximating the erfinv function, table 5).
float erf_inverse(float y) {
  float w = -std::log(std::max((1 - y) * (1 + y), 1e-38f));
  float p;
  if (w < 5) {
    w -= 2.5f;
    p = 2.81022636e-08f;
    for (const float c : {3.43273939e-07f, -3.5233877e-06f, -4.39150654e-06f, 0.00021858087f, -0.00125372503f,
                          -0.00417768164f, 0.246640727f, 1.50140941f})
      p = p * w + c;
  } else {
    w = std::sqrt(w) - 3;
    p = -0.000200214257f;
    for (const float c : {0.000100950558f, 0.00134934322f, -0.00367342844f, 0.00573950773f, -0.0076224613f,
                          0.00943887047f, 1.00167406f, 2.83297682f})
      p = p * w + c;
  }
  return p * y;
}

constexpr float inv_sqrt_pi = 0.56418958f;
constexpr float erf_end = 0x1.fffffep-1f;  // largest argument of erf_inverse

// Slope x seen at the angle (cos, sin) on a surface of unit roughness: solves for b = erf(x)
//   C(b) = cos (1 + b) / 2 + sin exp(-x^2) / (2 sqrt(pi)) = u C(erf(cot)),   C' = (cos - x sin) / 2,
// by Newton's method kept between brackets; C is concave, three or four steps do.
float visible_slope(float cos, float sin, float u) {
  float high = std::min(std::erf(cos / sin), erf_end), low = -erf_end;
  const float cot = std::min(cos / sin, 9.0f);
  const float target = u * (0.5f * cos * (1 + high) + 0.5f * sin * inv_sqrt_pi * std::exp(-cot * cot));
  // Exact at normal incidence; at grazing 1 + b = erfc(sqrt(-ln u)), close to u^2.
  const float guess = glm::mix(u * u, u, cos);
  float b = guess * (1 + high) - 1, x = 0;
  for (int i = 0; i < 12; ++i) {
    if (!(b > low && b < high)) b = 0.5f * (low + high);
    x = erf_inverse(b);
    const float error = 0.5f * cos * (1 + b) + 0.5f * sin * inv_sqrt_pi * std::exp(-x * x) - target;
    if (std::abs(error) < 1e-6f * (cos + sin * 0.1f)) break;
    (error > 0 ? high : low) = b;
    b -= error / std::max(0.5f * (cos - x * sin), 1e-6f);
  }
  return x;
}

}  // namespace

Vec3 sample_beckmann(const Facets& f, const Vec3& w, const Vec2& u) {
  const Vec3 v = glm::normalize(Vec3(f.alpha_u * w.x, f.alpha_v * w.y, w.z));
  const float sin = std::sqrt(v.x * v.x + v.y * v.y);
  Vec2 slope;
  if (sin < 1e-5f) {
    const float r = std::sqrt(-std::log1p(-u.x)), phi = 2 * pi * u.y;
    slope = {r * std::cos(phi), r * std::sin(phi)};
  } else {
    const float x = visible_slope(v.z, sin, u.x), y = erf_inverse(std::clamp(2 * u.y - 1, -erf_end, erf_end));
    const Vec2 along = Vec2(v.x, v.y) / sin;
    slope = {along.x * x - along.y * y, along.y * x + along.x * y};
  }
  return glm::normalize(Vec3(-f.alpha_u * slope.x, -f.alpha_v * slope.y, 1));
}

}  // namespace ajar
