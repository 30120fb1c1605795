// Fresnel reflectances against numbers from elsewhere, microfacet distributions against their definitions.
#include "ajar/scene/bsdf/microfacet.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <complex>

#include "ajar/scene/bsdf/fresnel.h"
#include "kit/chisquare.h"
#include "scene/bsdf/cases.h"

namespace ajar::test {
namespace {

TEST(Fresnel, DielectricMatchesKnownNumbers) {
  EXPECT_NEAR(fresnel_dielectric(1, 1.5f), 0.04f, 1e-6f);  // ((n - 1) / (n + 1))^2
  EXPECT_NEAR(fresnel_dielectric(1, 1 / 1.5f), 0.04f, 1e-6f);
  EXPECT_NEAR(fresnel_dielectric(1, 1.333f), 0.020373f, 1e-5f);   // water
  EXPECT_NEAR(fresnel_dielectric(1, 2.417f), 0.171966f, 1e-5f);   // diamond
  EXPECT_NEAR(fresnel_dielectric(0.5f, 1.5f), 0.089185f, 1e-5f);  // 60 degrees: s 0.176603, p 0.001768
  EXPECT_EQ(fresnel_dielectric(0, 1.5f), 1);
  EXPECT_EQ(fresnel_dielectric(0.5f, 1 / 1.5f), 1);       // beyond the critical angle, 41.8 degrees
  const float brewster = 1 / std::sqrt(1 + 1.5f * 1.5f);  // only s is reflected: ((n^2 - 1) / (n^2 + 1))^2 / 2
  EXPECT_NEAR(fresnel_dielectric(brewster, 1.5f), 0.5f * sqr(1.25f / 3.25f), 1e-6f);
  for (const float cos : {0.0f, 0.1f, 1.0f}) EXPECT_NEAR(fresnel_dielectric(cos, 1), cos > 0 ? 0 : 1, 1e-6f);
}

TEST(Fresnel, DielectricIsTheSameFromBothSides) {
  for (float cos = 0.01f; cos < 1; cos += 0.01f) {
    float cos_t, back;
    const float f = fresnel_dielectric(cos, 1.5f, cos_t);
    EXPECT_NEAR(fresnel_dielectric(cos_t, 1 / 1.5f, back), f, 1e-4f);
    EXPECT_NEAR(back, cos, 1e-4f);
  }
}

TEST(Fresnel, ConductorMatchesKnownNumbers) {
  const auto normal = [](float n, float k) { return (sqr(n - 1) + k * k) / (sqr(n + 1) + k * k); };
  EXPECT_NEAR(fresnel_conductor(1, 0.27105f, 3.60922f), normal(0.27105f, 3.60922f), 1e-6f);  // silver-like
  EXPECT_NEAR(fresnel_conductor(1, 1.65746f, 9.22387f), 0.928048f, 1e-5f);                   // aluminium, red
  for (const float cos : {0.0f, 0.3f, 1.0f}) EXPECT_NEAR(fresnel_conductor(cos, 0, 1), 1, 1e-6f);
  for (const float cos : {0.02f, 0.3f, 0.7f, 1.0f})  // without absorption it is the dielectric
    EXPECT_NEAR(fresnel_conductor(cos, 1.5f, 0), fresnel_dielectric(cos, 1.5f), 1e-5f);
  EXPECT_NEAR(fresnel_conductor(0, 0.2f, 3.9f), 1, 1e-6f);
  // By complex arithmetic: s = (c - N cos_t) / (c + N cos_t), N = n - ik.
  for (const float cos : {0.1f, 0.5f, 0.9f}) {
    const std::complex<double> n(0.2, 3.9), cos_t = std::sqrt(1.0 - (1.0 - cos * cos) / (n * n)), c = cos;
    const double expected =
        0.5 * (std::norm((c - n * cos_t) / (c + n * cos_t)) + std::norm((n * c - cos_t) / (n * c + cos_t)));
    EXPECT_NEAR(fresnel_conductor(cos, 0.2f, 3.9f), expected, 1e-5);
  }
}

TEST(Fresnel, DiffuseMatchesQuadrature) {
  EXPECT_NEAR(fresnel_diffuse(1.5), 0.0918, 5e-5);  // Egan and Hilgeman 1973
  EXPECT_NEAR(fresnel_diffuse(1 / 1.5), 0.5963, 1e-4);
  for (const double eta : {0.6, 1.01, 1.33, 1.5, 2.4}) {
    double sum = 0;
    const int n = 20000;
    for (int i = 0; i < n; ++i) {
      const float cos = (float(i) + 0.5f) / n;
      sum += 2 * cos * fresnel_dielectric(cos, float(eta)) / n;
    }
    EXPECT_NEAR(fresnel_diffuse(eta), sum, 1e-4) << eta;
  }
  EXPECT_NEAR(fresnel_diffuse(1), 0, 1e-12);
  EXPECT_NEAR(fresnel_diffuse(1.0001), fresnel_diffuse(1.0002), 2e-4);
}

TEST(Fresnel, RefractionObeysSnell) {
  const Vec3 m = glm::normalize(Vec3(0.2f, -0.3f, 1)), wo = glm::normalize(Vec3(0.3f, 0.2f, 0.7f));
  for (const float eta : {1.5f, 0.8f}) {
    float cos_t;
    fresnel_dielectric(glm::dot(wo, m), eta, cos_t);
    const Vec3 wi = refracted(wo, m, eta, cos_t);
    EXPECT_NEAR(length2(wi), 1, 1e-5f);
    EXPECT_LT(length2(glm::cross(wo, m) + glm::cross(wi, m) * eta), 1e-10f);
    EXPECT_LT(glm::dot(wi, m), 0);
  }
}

class Facet : public testing::TestWithParam<Facets> {};

// Integral over the hemisphere of normals, midpoints of the stretched slopes' polar coordinates tan = alpha t / (1 -
// t).
template <class F>
double over_normals(const Facets& f, const F& value) {
  const int n = 400;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double t = (i + 0.5) / n, r = t / (1 - t), phi = 2 * std::numbers::pi * (j + 0.5) / n;
      const double x = f.alpha_u * r * std::cos(phi), y = f.alpha_v * r * std::sin(phi);
      const double cos = 1 / std::sqrt(1 + x * x + y * y);
      const Vec3 m(float(x * cos), float(y * cos), float(cos));
      // dw = cos^3 dx dy, dx dy = alpha_u alpha_v r dr dphi, dr = dt / (1 - t)^2
      sum += value(m) * cos * cos * cos * f.alpha_u * f.alpha_v * r / ((1 - t) * (1 - t));
    }
  return sum * 2 * std::numbers::pi / (double(n) * n);
}

TEST_P(Facet, DensityCoversTheSurface) {
  const Facets f = GetParam();
  EXPECT_NEAR(over_normals(f, [&](const Vec3& m) { return double(facet_density(f, m)) * m.z; }), 1, 2e-3);
}

// The facets that w sees cover as much of its view as the flat surface does: cos = integral of G1 max(0, w.m) D (Heitz
// 2014, eq. 14).
TEST_P(Facet, MaskingKeepsTheProjectedArea) {
  const Facets f = GetParam();
  for (const float theta : {0.0f, 0.3f, 0.8f, 1.3f, 1.5f, 1.56f}) {
    const Vec3 w = direction(theta, 0.7f);
    const double seen =
        over_normals(f, [&](const Vec3& m) { return double(facet_density(f, m)) * std::max(glm::dot(w, m), 0.0f); });
    EXPECT_NEAR(2 * facet_visibility(f, w) * seen, 1, 4e-3) << theta;
  }
}

TEST_P(Facet, NormalsFollowVisibility) {
  const Facets f = GetParam();
  for (const float theta : {0.0f, 0.8f, 1.5f, 1.5707f}) {
    const Vec3 w = direction(theta, 0.7f);
    kit::ChiOptions options;
    options.samples = 200'000;
    options.level = 1e-5;
    const auto result = kit::chi_square_sphere(
        [&](const Vec2& u, float) { return std::optional(sample_facet(f, w, u)); },
        [&](const Vec3& m) {
          return m.z > 0 ? 2 * facet_visibility(f, w) * std::max(glm::dot(w, m), 0.0f) * facet_density(f, m) : 0;
        },
        options);
    EXPECT_TRUE(result.ok) << theta << ": " << result.message;
  }
}

INSTANTIATE_TEST_SUITE_P(Bsdf, Facet,
                         testing::Values(Facets{0.02f, 0.02f, Microfacet::ggx}, Facets{0.3f, 0.3f, Microfacet::ggx},
                                         Facets{0.1f, 0.6f, Microfacet::ggx}, Facets{1, 1, Microfacet::ggx},
                                         Facets{0.02f, 0.02f, Microfacet::beckmann},
                                         Facets{0.3f, 0.3f, Microfacet::beckmann},
                                         Facets{0.1f, 0.6f, Microfacet::beckmann}, Facets{1, 1, Microfacet::beckmann}),
                         [](const auto& i) {
                           return fmt::format("{}_{:.0f}_{:.0f}", i.param.kind == Microfacet::ggx ? "ggx" : "beckmann",
                                              100 * i.param.alpha_u, 100 * i.param.alpha_v);
                         });

TEST(Facets, TheNarrowestLobeIsThatOfTheNarrowerAxis) {
  Bsdf bsdf;
  bsdf.count = 1;
  bsdf.lobes[0].kind = LobeKind::principled;
  bsdf.lobes[0].principled = {.roughness = 0.5f, .aspect = 0.4f};
  EXPECT_FLOAT_EQ(least_roughness(bsdf), 0.25f * 0.4f);
}

TEST(Facets, FiniteAtTheSmallestRoughness) {
  for (const Microfacet kind : {Microfacet::beckmann, Microfacet::ggx}) {
    const Facets f{min_alpha, min_alpha, kind};
    for (const float z : {1.0f, 1e-3f, 1e-8f, 1e-30f}) {
      const Vec3 w{safe_sqrt(1 - z * z), 0, z};
      EXPECT_TRUE(std::isfinite(facet_density(f, w)) && std::isfinite(facet_visibility(f, w))) << z;
      for (const float u : {0.0f, 0.5f, one_minus_epsilon})
        for (const float v : {0.0f, 0.5f, one_minus_epsilon}) {
          const Vec3 m = sample_facet(f, w, {u, v});
          EXPECT_NEAR(length2(m), 1, 1e-5f);
          EXPECT_GE(m.z, 0);
        }
    }
  }
}

}  // namespace
}  // namespace ajar::test
