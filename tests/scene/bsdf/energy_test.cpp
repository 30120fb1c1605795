// How much light comes back: white furnaces, limits and what the materials' definitions promise.
#include <gtest/gtest.h>

#include "ajar/scene/bsdf/fresnel.h"
#include "ajar/scene/bsdf/table.h"
#include "scene/bsdf/cases.h"

namespace ajar::test {
namespace {

struct Furnace {
  Rgb all{0}, reflected{0};
  Vec3 mean_through{0};  ///< mean direction of what was transmitted
};

// Mean sample weight: the share of light from all around that leaves towards wo (radiance), stratified.
Furnace furnace(const Bsdf& bsdf, const Vec3& wo, Mode mode, int n = 1 << 14) {
  Sampler sampler = make_sampler(SamplerKind::sobol, 5, Side::camera, 0, 0);
  Furnace sum;
  for (int i = 0; i < n; ++i) {
    sampler = make_sampler(SamplerKind::sobol, 5, Side::camera, 0, uint32_t(i));
    const Vec2 u = sampler.next2();
    BsdfSample s;
    if (!sample(bsdf, wo, sampler.next1(), u, mode, s)) continue;
    sum.all += s.weight / float(n);
    if (s.wi.z * wo.z > 0) sum.reflected += s.weight / float(n);
    if (s.wi.z * wo.z < 0) sum.mean_through += s.wi;
  }
  return sum;
}

constexpr float angles[] = {0.0f, 0.5f, 1.0f, 1.3f, 1.5f};

class Energy : public testing::TestWithParam<Case> {};

// What a white material may give of 1. Some models are fits, which overshoot.
float most(const Material& m) {
  const bool fit = m.kind == MaterialKind::roughdiffuse || (m.kind == MaterialKind::ward && m.ward == WardKind::duer);
  return m.kind == MaterialKind::principled ? 1.3f : fit ? 1.05f : 1.006f;
}

// Nothing gives more than it gets, even in white. Importance: radiance is compressed by refraction.
TEST_P(Energy, WhiteFurnaceIsNotBrighter) {
  if (GetParam().bent) return;  // the adjoint of a bent normal gives more where the others graze
  std::vector<Material> materials = GetParam().materials;
  for (Material& m : materials) {
    m.reflectance = m.specular = m.transmittance = 1.0f;
    if (m.kind == MaterialKind::phong || m.kind == MaterialKind::ward) m.reflectance = m.specular = 0.5f;
    m.sheen = 0.0f;  // sheen, clearcoat and retro-reflection of the principled model add energy by design
    m.clearcoat = 0.0f;
    m.flatness = 0.0f;
    m.eta = Rgb(0);
    m.k = Rgb(1);
  }
  const Resolved r = resolved(materials);
  for (const float theta : angles) {
    for (const float z : {1.0f, -1.0f}) {
      Vec3 wo = direction(theta, 0.3f);
      wo.z *= z;
      const Furnace f = furnace(r.bsdf, wo, Mode::importance);
      EXPECT_LE(max_component(f.all), most(materials[0])) << theta;
      if (z > 0 && theta < 1) {
        EXPECT_GT(max_component(f.all), 0.2f) << theta;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bsdf, Energy, testing::ValuesIn(cases()), [](const auto& i) { return i.param.name; });

Material white(MaterialKind kind, Microfacet distribution = Microfacet::ggx, float alpha = 0.1f) {
  Material m = microfacet(kind, distribution, alpha, alpha);
  m.reflectance = 1.0f;
  m.eta = Rgb(0);
  m.k = Rgb(1);
  return m;
}

TEST(Lossless, SmoothBsdfsReturnEverything) {
  for (const MaterialKind kind : {MaterialKind::diffuse, MaterialKind::conductor, MaterialKind::dielectric,
                                  MaterialKind::thindielectric, MaterialKind::plastic, MaterialKind::null}) {
    const Resolved r = resolved({white(kind)});
    for (const float theta : angles)
      for (const Rgb c :
           {furnace(r.bsdf, direction(theta, 1), Mode::importance, 1 << 16).all, albedo(r.bsdf, direction(theta, 1))})
        EXPECT_NEAR(c.x, 1, 2e-3f) << int(kind) << " " << theta;
  }
}

TEST(Lossless, PolishedMetalLosesLittleAndRoughMetalWhatSmithSays) {
  for (const Microfacet d : {Microfacet::beckmann, Microfacet::ggx}) {
    const Resolved fine = resolved({white(MaterialKind::roughconductor, d, 0.01f)});
    for (const float theta : {0.0f, 0.5f, 1.0f})
      EXPECT_NEAR(furnace(fine.bsdf, direction(theta, 1), Mode::radiance).all.x, 1, 2e-3f);
  }
  // GGX with alpha = 1 seen from above has D = 1 / pi: of s = sin^2 uniform, s > 1/2 mirrors below the horizon, and the
  // rest is masked by 2 c / (1 + c), c = 1 - 2 s. What single scattering leaves is 1 - ln 2.
  const Resolved rough = resolved({white(MaterialKind::roughconductor, Microfacet::ggx, 1.0f)});
  EXPECT_NEAR(furnace(rough.bsdf, {0, 0, 1}, Mode::radiance).all.x, 1 - std::log(2.0f), 1e-3f);
}

TEST(Lossless, RadianceInAndOutOfGlassIsUnchanged) {
  for (const MaterialKind kind : {MaterialKind::dielectric, MaterialKind::roughdielectric}) {
    const Resolved r = resolved({white(kind, Microfacet::ggx, 0.3f)});
    int through = 0;
    for (int i = 0; i < 1000; ++i) {
      Sampler sampler = make_sampler(SamplerKind::sobol, 5, Side::camera, 1, uint32_t(i));
      BsdfSample in, out;  // through the two faces of a slab, whose outsides look away from each other
      const Vec3 wo = direction(0.8f, 2);
      const Vec2 u = sampler.next2(), v = sampler.next2();
      if (!sample(r.bsdf, wo, sampler.next1(), u, Mode::radiance, in) || in.eta == 1) continue;
      if (!sample(r.bsdf, {-in.wi.x, -in.wi.y, in.wi.z}, sampler.next1(), v, Mode::radiance, out) || out.eta == 1)
        continue;
      ++through;
      EXPECT_NEAR(in.eta * out.eta, 1, 1e-5f);
      BsdfSample plain_in;  // the same numbers as importance: eta^2 of entry and exit cancel
      sample(r.bsdf, wo, 0.99f, u, Mode::importance, plain_in);
      EXPECT_NEAR(in.weight.x * sqr(in.eta), plain_in.weight.x, 1e-4f);
      EXPECT_LE(in.weight.x * out.weight.x, 1 + 1e-4f);
      if (kind == MaterialKind::dielectric) {
        EXPECT_NEAR(in.weight.x * out.weight.x, 1, 1e-4f);
      }
    }
    EXPECT_GT(through, 100);
  }
}

// Rough glass of vanishing roughness is smooth glass: share of reflection, and the direction of the rest.
TEST(Limits, RoughDielectricBecomesSmooth) {
  for (const Microfacet d : {Microfacet::beckmann, Microfacet::ggx}) {
    const Resolved r = resolved({white(MaterialKind::roughdielectric, d, 1e-3f)});
    for (const float theta : {0.0f, 0.6f, 1.2f, pi - 0.5f, pi - 1.2f}) {
      const Vec3 wo = direction(theta, 0.7f);
      const float eta = wo.z > 0 ? 1.5046f : 1 / 1.5046f;
      const Furnace f = furnace(r.bsdf, wo, Mode::importance);
      float cos_t;
      const float reflected = fresnel_dielectric(std::abs(wo.z), eta, cos_t);
      EXPECT_NEAR(f.reflected.x, reflected, 2e-3f) << theta;
      EXPECT_NEAR(f.all.x, 1, 2e-3f) << theta;
      if (cos_t == 0) continue;
      const Vec3 expected(-wo.x / eta, -wo.y / eta, wo.z > 0 ? -cos_t : cos_t);
      EXPECT_LT(length2(glm::normalize(f.mean_through) - expected), 1e-5f) << theta;
    }
  }
}

TEST(Limits, RoughConductorBecomesSmooth) {
  for (const Microfacet d : {Microfacet::beckmann, Microfacet::ggx}) {
    Material m = microfacet(MaterialKind::roughconductor, d, 1e-3f, 1e-3f);
    const Resolved rough = resolved({m});
    m.kind = MaterialKind::conductor;
    const Resolved smooth = resolved({m});
    for (const float theta : {0.0f, 0.6f, 1.2f}) {
      const Rgb a = furnace(rough.bsdf, direction(theta, 1), Mode::radiance).all;
      const Rgb b = furnace(smooth.bsdf, direction(theta, 1), Mode::radiance, 1).all;
      EXPECT_LT(max_abs(a - b), 2e-3f) << theta;
    }
  }
}

TEST(Limits, RoughDielectricOfEqualIndicesIsNotThere) {
  Material m = white(MaterialKind::roughdielectric);
  m.ior = 1;
  const Resolved r = resolved({m});
  EXPECT_FALSE(r.bsdf.has_smooth);
  BsdfSample s;
  ASSERT_TRUE(sample(r.bsdf, direction(1, 1), 0.5f, {0.5f, 0.5f}, Mode::radiance, s));
  EXPECT_LT(length2(s.wi + direction(1, 1)), 1e-6f);
}

// The table of roughplastic is what the transmission part of roughdielectric adds up to.
TEST(RoughBoundary, TableIsTheTransmissionOfRoughGlass) {
  for (const Microfacet d : {Microfacet::beckmann, Microfacet::ggx})
    for (const float alpha : {0.01f, 0.1f, 0.3f, 0.8f}) {
      const Resolved r = resolved({white(MaterialKind::roughdielectric, d, alpha)});
      for (const float theta : {0.0f, 0.7f, 1.3f, 1.5f}) {
        const Furnace f = furnace(r.bsdf, direction(theta, 0), Mode::importance, 1 << 16);
        EXPECT_NEAR(rough_transmittance(d, alpha, 1.5046f, std::cos(theta)), f.all.x - f.reflected.x, 3e-3f)
            << alpha << " " << theta;
      }
    }
}

// Reflectance from inside, by rough glass that light from all around meets there.
double reflected_inside(Microfacet distribution, float alpha, float ior) {
  Material m = white(MaterialKind::roughdielectric, distribution, alpha);
  m.ior = ior;
  const Resolved r = resolved({m}, {0, 0, -1});
  constexpr int n = 1 << 18;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    Sampler sampler = make_sampler(SamplerKind::sobol, 3, Side::camera, 2, uint32_t(i));
    const Vec2 u = sampler.next2(), v = sampler.next2();
    const float cos = std::sqrt(1 - u.x);
    const Vec3 wo{std::sqrt(u.x) * std::cos(2 * pi * u.y), std::sqrt(u.x) * std::sin(2 * pi * u.y), -cos};
    BsdfSample s;
    if (sample(r.bsdf, wo, sampler.next1(), v, Mode::importance, s) && s.wi.z < 0) sum += s.weight.x;
  }
  return sum / n;
}

// In Mitsuba 2 and 3 a diffuse base gets back what the boundary reflects, rho T T / (eta^2 (1 - R)), with rho R for R
// if it is not linear; in 0.6 all that does not leave.
TEST(RoughBoundary, OnlyWhatIsReflectedInsideComesBack) {
  for (const Microfacet d : {Microfacet::beckmann, Microfacet::ggx})
    for (const float alpha : {0.1f, 0.3f, 0.8f})
      for (const float ior : {1.3f, 1.49f, 0.8f}) {
        const double inside = reflected_inside(d, alpha, ior);
        for (const bool nonlinear : {false, true}) {
          Material m = white(MaterialKind::roughplastic, d, alpha);
          m.ior = ior;
          m.inner = nonlinear ? Inner::nonlinear : Inner::linear;
          m.reflectance = 0.6f;
          m.specular = 0.0f;
          m.hides = true;
          const double rho = 0.6, base = rho / (ior * ior * (1 - (nonlinear ? rho : 1) * inside));
          const Vec3 wo = direction(0.4f, 0), wi = direction(0.6f, 1);  // not near total reflection
          const double both =
              double(rough_transmittance(d, alpha, ior, wo.z)) * double(rough_transmittance(d, alpha, ior, wi.z));
          const Resolved r = resolved({m});
          const double hiding = eval(r.bsdf, wo, wi, Mode::radiance).f.x;
          EXPECT_NEAR(hiding, base * both * inv_pi, 0.003 * hiding) << alpha << " " << ior << " " << nonlinear;
          m.hides = false;
          const double all = eval(resolved({m}).bsdf, wo, wi, Mode::radiance).f.x;
          EXPECT_GE(all, hiding);
          if (alpha == 0.3f && ior > 1.4f && !nonlinear) {
            EXPECT_GT(all, 1.02 * hiding);
          }
        }
      }
}

// By reciprocity as much leaves a smooth boundary as enters it, whatever lies beyond the critical angle.
TEST(RoughBoundary, SmoothOnesOfAnyIndexLetOutWhatTheyLetIn) {
  for (const float ior : {0.6f, 1.05f, 1.49f, 2.4f, 3.5f}) {
    Material m = white(MaterialKind::roughplastic, Microfacet::beckmann, 1e-4f);
    m.ior = ior;
    m.hides = true;
    const float expected = float(1 - fresnel_diffuse(ior));
    EXPECT_NEAR(scene_of({m}).materials[0].entering_table[table_leaving], expected, 0.003f * expected) << ior;
  }
}

TEST(RoughBoundary, ColouredRoughnessIsItsLuminanceThroughout) {
  Material m = white(MaterialKind::roughplastic);
  m.reflectance = 0.6f;
  m.alpha_u = m.alpha_v = Slot(Rgb(0.9f, 0.05f, 0.3f));
  const Resolved coloured = resolved({m});
  m.alpha_u = m.alpha_v = Slot(luminance(m.alpha_u.value));
  const Resolved grey = resolved({m});
  const Vec3 wo = direction(0.4f, 0), wi = direction(0.6f, 1);
  const float expected = eval(grey.bsdf, wo, wi, Mode::radiance).f.x;
  EXPECT_NEAR(eval(coloured.bsdf, wo, wi, Mode::radiance).f.x, expected, 1e-5f * expected);
}

// What crosses a gap of air between panes of glass is reflected beyond the critical angle, all of it.
TEST(ThinDielectric, GapsReflectTotally) {
  Material m = white(MaterialKind::thindielectric);
  m.ior = 1 / 1.5f;
  m.specular = 1.0f, m.transmittance = 0.0f;
  const Resolved r = resolved({m});
  const float once = fresnel_dielectric(std::cos(0.5f), m.ior);
  EXPECT_NEAR(albedo(r.bsdf, direction(0.5f, 1)).x, 2 * once / (1 + once), 1e-5f);
  EXPECT_NEAR(albedo(r.bsdf, direction(0.8f, 1)).x, 1, 1e-6f);
  EXPECT_NEAR(furnace(r.bsdf, direction(0.8f, 1), Mode::radiance).all.x, 1, 1e-6f);
}

TEST(RoughBoundary, TexturedAlphaInterpolates) {
  for (const float alpha : {0.003f, 0.05f, 0.2f, 0.7f, 1.0f, 1.5f, 3.0f, 20.0f, 100.0f}) {
    Material m = white(MaterialKind::roughplastic, Microfacet::ggx, alpha);
    m.hides = true;
    const Scene constant = scene_of({m});
    m.alpha_u.texture = 0;  // never looked up here
    const Scene textured = scene_of({m});
    const TableRow a = table_row_of(constant.materials[0], alpha), b = table_row_of(textured.materials[0], alpha);
    ASSERT_EQ(a.between, 0);
    for (const float cos : {0.0f, 0.05f, 0.3f, 0.77f, 1.0f}) {
      const float between = table_at(b.at, cos) * (1 - b.between) + table_at(b.at + table_row, cos) * b.between;
      EXPECT_NEAR(between, table_at(a.at, cos), 8e-3f) << alpha << " " << cos;
    }
    const float leaving = b.at[table_leaving] * (1 - b.between) + b.at[table_row + table_leaving] * b.between;
    EXPECT_NEAR(leaving, a.at[table_leaving], 0.02f * a.at[table_leaving]) << alpha;
  }
}

// Directional albedo of the diffuse part by its definition: rho T(wo) for the linear plastic, the specular part is F.
TEST(Plastic, AlbedoIsSpecularPlusTransmittedDiffuse) {
  for (const bool nonlinear : {false, true})
    for (const float theta : angles) {
      Material m = white(MaterialKind::plastic);
      m.inner = nonlinear ? Inner::nonlinear : Inner::linear;
      m.reflectance = Rgb(0.8f, 0.5f, 0.2f);
      m.specular = 0.7f;
      const Resolved r = resolved({m});
      const Vec3 wo = direction(theta, 1);
      const float f = fresnel_dielectric(wo.z, m.ior);
      Rgb rho = m.reflectance.value;
      // Each round trip inside loses 1 - rho of what the boundary sends back: rho (1 - Fdr) / (1 - rho Fdr).
      const float fdr = float(fresnel_diffuse(1 / m.ior));
      if (nonlinear) rho = rho * (1 - fdr) / (Rgb(1) - rho * fdr);
      const Rgb expected = Rgb(0.7f * f) + rho * (1 - f);
      const Furnace measured = furnace(r.bsdf, wo, Mode::radiance, 1 << 16);
      EXPECT_LT(max_abs(measured.all - expected), 3e-3f) << nonlinear << " " << theta;
      EXPECT_LT(max_abs(albedo(r.bsdf, wo) - expected), 3e-3f) << nonlinear << " " << theta;
    }
}

TEST(Plastic, RoughPlasticOfVanishingRoughnessIsPlastic) {
  for (const bool nonlinear : {false, true}) {
    Material m = white(MaterialKind::roughplastic, Microfacet::beckmann, 1e-3f);
    m.inner = nonlinear ? Inner::nonlinear : Inner::linear;
    m.reflectance = Rgb(0.8f, 0.5f, 0.2f);
    const Resolved rough = resolved({m});
    m.kind = MaterialKind::plastic;
    const Resolved smooth = resolved({m});
    for (const float theta : angles) {
      const Vec3 wo = direction(theta, 1);
      EXPECT_LT(max_abs(albedo(rough.bsdf, wo) - albedo(smooth.bsdf, wo)), 4e-3f) << theta;
      EXPECT_LT(max_abs(furnace(rough.bsdf, wo, Mode::radiance).all - albedo(smooth.bsdf, wo)), 1e-2f) << theta;
      const Vec3 wi = direction(0.9f, -2);
      const Rgb a = eval(rough.bsdf, wo, wi, Mode::radiance).f, b = eval(smooth.bsdf, wo, wi, Mode::radiance).f;
      EXPECT_LT(max_abs(a - b), 5e-3f * max_component(b) + 1e-4f) << theta;
    }
  }
}

// Without internal reflections what leaves is what enters, once each way, as if the boundary were smooth (Mitsuba 3's
// pplastic).
TEST(Plastic, LostLightIsNotGivenBack) {
  for (const float alpha : {1e-3f, 0.3f, 0.8f}) {
    Material m = white(MaterialKind::roughplastic, Microfacet::beckmann, alpha);
    m.inner = Inner::lost;
    m.reflectance = Rgb(0.8f, 0.5f, 0.2f);
    m.specular = 0.0f;
    const Resolved r = resolved({m});
    for (const float theta : {0.2f, 0.9f, 1.3f}) {
      const Vec3 wo = direction(theta, 1), wi = direction(0.5f, 3);
      const float through = (1 - fresnel_dielectric(wo.z, m.ior)) * (1 - fresnel_dielectric(wi.z, m.ior));
      EXPECT_LT(max_abs(eval(r.bsdf, wo, wi, Mode::radiance).f - m.reflectance.value * (through * inv_pi)), 2e-4f);
    }
  }
}

// Its glints may be longer than wide: those of rough metal, but for what is reflected.
TEST(Plastic, LongGlints) {
  Material m = microfacet(MaterialKind::roughplastic, Microfacet::ggx, 0.1f, 0.4f);
  m.inner = Inner::lost;
  m.reflectance = 0.0f;
  const Resolved plastic = resolved({m});
  m.kind = MaterialKind::roughconductor;
  m.eta = Rgb(0), m.k = Rgb(1);
  const Resolved metal = resolved({m});
  for (const float phi : {0.0f, 1.0f, 0.5f * pi}) {
    const Vec3 wo = direction(0.3f, phi), wi = direction(0.5f, phi + 0.3f);
    const float f = fresnel_dielectric(glm::dot(wo, glm::normalize(wo + wi)), m.ior);
    const float expected = f * eval(metal.bsdf, wo, wi, Mode::radiance).f.x;
    EXPECT_NEAR(eval(plastic.bsdf, wo, wi, Mode::radiance).f.x, expected, 1e-4f * expected) << phi;
  }
  EXPECT_TRUE(wants_tangents(plastic.scene, 0));
}

TEST(Phong, IsNormalised) {
  Material m = material(MaterialKind::phong);
  m.reflectance = 0.0f;
  m.specular = 1.0f;
  for (const float n : {1.0f, 10.0f, 1000.0f}) {
    m.exponent = n;
    const Resolved r = resolved({m});
    EXPECT_NEAR(furnace(r.bsdf, {0, 0, 1}, Mode::radiance).all.x, 1, 2e-3f) << n;
    EXPECT_NEAR(eval(r.bsdf, {0, 0, 1}, {0, 0, 1}, Mode::radiance).f.x, (n + 2) * inv_pi / 2, 1e-4f * n);
  }
}

// The formulas of Oren and Nayar 1994, equations 26 to 30, word by word in angles.
double oren_nayar(double rho, double variance, double theta_o, double theta_i, double phi, bool simple) {
  const double steep = std::max(theta_o, theta_i), low = std::min(theta_o, theta_i), p = std::numbers::pi;
  const double c1 = 1 - 0.5 * variance / (variance + 0.33), v = variance / (variance + 0.09);
  if (simple) return rho / p * (c1 + 0.45 * v * std::max(std::cos(phi), 0.0) * std::sin(steep) * std::tan(low));
  const double c2 = 0.45 * v * (std::sin(steep) - (std::cos(phi) >= 0 ? 0 : std::pow(2 * low / p, 3)));
  const double c3 = 0.125 * v * std::pow(4 * steep * low / (p * p), 2);
  const double once =
      c1 + std::cos(phi) * c2 * std::tan(low) + (1 - std::abs(std::cos(phi))) * c3 * std::tan((steep + low) / 2);
  const double twice = 0.17 * variance / (variance + 0.13) * (1 - std::cos(phi) * std::pow(2 * low / p, 2));
  return rho / p * once + rho * rho / p * twice;
}

TEST(RoughDiffuse, IsOrenNayar) {
  for (const bool simple : {false, true})
    for (const float alpha : {0.0f, 0.2f, 0.7f}) {
      Material m = white(MaterialKind::roughdiffuse, Microfacet::beckmann, alpha);
      m.simple = simple;
      m.reflectance = Rgb(0.9f, 0.5f, 0.1f);
      const Resolved r = resolved({m});
      for (const float theta_o : {0.0f, 0.4f, 1.4f})
        for (const float theta_i : {0.1f, 0.9f, 1.5f})
          for (const float phi : {0.0f, 1.0f, 2.0f, pi}) {
            const Rgb f = eval(r.bsdf, direction(theta_o, 0.3f), direction(theta_i, 0.3f + phi), Mode::radiance).f;
            for (int c = 0; c < 3; ++c)  // alpha is sqrt(2) times the slope along one direction
              EXPECT_NEAR(f[c],
                          oren_nayar(m.reflectance.value[c], 0.5 * std::max(alpha, 1e-4f) * std::max(alpha, 1e-4f),
                                     theta_o, theta_i, phi, simple),
                          2e-5)
                  << simple << " " << alpha << " " << theta_o << " " << theta_i << " " << phi;
          }
    }
}

// All kinds agree at the normal, and there a narrow lobe returns what it says.
TEST(Ward, IsNormalised) {
  for (const WardKind kind : {WardKind::ward, WardKind::duer, WardKind::balanced}) {
    Material m = microfacet(MaterialKind::ward, Microfacet::beckmann, 0.05f, 0.03f);
    m.reflectance = 0.0f;
    m.specular = 1.0f;
    m.ward = kind;
    const Resolved r = resolved({m});
    EXPECT_NEAR(eval(r.bsdf, {0, 0, 1}, {0, 0, 1}, Mode::radiance).f.x, inv_pi / (4 * 0.05f * 0.03f), 0.01f);
    EXPECT_NEAR(furnace(r.bsdf, {0, 0, 1}, Mode::radiance).all.x, 1, 1e-2f);
    // Ward 1992, equation 5a, in angles of the half vector
    const Vec3 wo = direction(0.6f, 0), wi = direction(0.58f, pi + 0.05f), h = glm::normalize(wo + wi);
    const float tan2 = sqr(h.x / h.z / 0.05f) + sqr(h.y / h.z / 0.03f), c = wo.z * wi.z;
    const float lobe = std::exp(-tan2) * inv_pi / (4 * 0.05f * 0.03f);
    const float expected = kind == WardKind::ward   ? lobe / std::sqrt(c)
                           : kind == WardKind::duer ? lobe / c
                                                    : lobe / (sqr(glm::dot(wo, h)) * sqr(sqr(h.z)));
    EXPECT_NEAR(eval(r.bsdf, wo, wi, Mode::radiance).f.x, expected, 1e-3f * expected) << int(kind);
  }
}

// Variance of a sample's weight over its mean squared.
double relative_variance(const Bsdf& bsdf, const Vec3& wo) {
  constexpr int n = 1 << 14;
  double sum = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    Sampler sampler = make_sampler(SamplerKind::sobol, 7, Side::camera, 1, uint32_t(i));
    const Vec2 u = sampler.next2();
    BsdfSample s;
    if (!sample(bsdf, wo, sampler.next1(), u, Mode::radiance, s)) continue;
    sum += luminance(s.weight), squares += sqr(luminance(s.weight));
  }
  return n * squares / (sum * sum) - 1;
}

// A quarter of the Fresnel factor alone would leave up to 0.48 of it on black, where the gloss is 1.
TEST(Principled, ClearcoatIsDrawnAsItReflects) {
  for (const auto& [base, most] : {std::pair(0.02f, 0.13), {0.5f, 0.035}, {0.9f, 0.035}})
    for (const float gloss : {0.0f, 0.5f, 0.9f, 1.0f})
      for (const float theta : {0.0f, 0.6f, 1.0f}) {
        Material m = material(MaterialKind::principled);
        m.ior = 1.5f;
        m.reflectance = base;
        m.clearcoat = 1.0f;
        m.clearcoat_gloss = gloss;
        const Vec3 wo = direction(theta, 0);
        EXPECT_LT(relative_variance(resolved({m}).bsdf, wo), most) << base << " " << gloss << " " << theta;
      }
}

TEST(Principled, PlainCornersAreKnownModels) {
  Material m = material(MaterialKind::principled);
  m.ior = 1.5f;
  m.reflectance = Rgb(1);
  m.roughness = 0.5f;
  m.spec_trans = 1.0f;
  m.sheen = 0.9f;  // belongs to the diffuse part alone
  const Resolved glass = resolved({m});
  Material g = white(MaterialKind::roughdielectric, Microfacet::ggx, 0.25f);
  g.ior = 1.5f;
  const Resolved rough = resolved({g});
  Sampler sampler = make_sampler(SamplerKind::independent, 2, Side::camera, 0, 0);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 wo = random_direction(sampler), wi = random_direction(sampler);
    const Rgb a = eval(glass.bsdf, wo, wi, Mode::radiance).f, b = eval(rough.bsdf, wo, wi, Mode::radiance).f;
    EXPECT_LT(max_abs(a - b), 1e-4f * max_component(b) + 1e-6f);
  }
  // Diffuse at normal incidence is base / pi plus the dielectric's glint (Burley 2012, section 5.3).
  m.spec_trans = 0.0f;
  m.sheen = 0.0f;
  m.reflectance = Rgb(0.6f);
  const Resolved plain = resolved({m});
  const float glint = 0.04f / (4 * pi * sqr(0.25f));  // F D / 4 with D = 1 / (pi alpha^2)
  EXPECT_NEAR(eval(plain.bsdf, {0, 0, 1}, {0, 0, 1}, Mode::radiance).f.x, 0.6f * inv_pi + glint, 1e-4f);
}

}  // namespace
}  // namespace ajar::test
