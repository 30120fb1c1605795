// sample, eval and their reverses are one and the same function; nothing is ever negative or not finite.
#include <gtest/gtest.h>

#include "scene/bsdf/cases.h"

namespace ajar::test {
namespace {

class Agree : public testing::TestWithParam<Case> {
 protected:
  Resolved r = resolved(GetParam().materials);
  Sampler sampler = make_sampler(SamplerKind::independent, 3, Side::camera, 0, 0);

  Vec3 next_wo() {
    Vec3 wo = random_direction(sampler);
    if (!GetParam().behind) wo.z = std::abs(wo.z);
    return wo;
  }
};

class AgreeDelta : public Agree {};

Mode opposite(Mode mode) { return mode == Mode::radiance ? Mode::importance : Mode::radiance; }

// Half vectors recomputed from rounded directions shift sharp densities by some 1e-7 / alpha^2 (more where the half
// vector of a refraction is short).
void expect_close(float a, float b, const char* what, float tolerance = 0.02f) {
  EXPECT_NEAR(a, b, tolerance * std::max(std::abs(a), std::abs(b)) + 1e-6f) << what;
}
void expect_close(const Rgb& a, const Rgb& b, const char* what, float tolerance = 0.02f) {
  for (int i = 0; i < 3; ++i) expect_close(a[i], b[i], what, tolerance);
}

TEST_P(Agree, SampleIsEval) {
  int drawn = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vec3 wo = next_wo();
    const Mode mode = i % 2 ? Mode::radiance : Mode::importance;
    const Vec2 u = sampler.next2();
    BsdfSample s;
    if (!sample(r.bsdf, wo, sampler.next1(), u, mode, s)) continue;
    ++drawn;
    EXPECT_NEAR(length2(s.wi), 1, 1e-4f);
    EXPECT_TRUE(s.delta ? r.bsdf.has_delta : r.bsdf.has_smooth);
    EXPECT_TRUE(GetParam().transmits || s.wi.z * wo.z > 0);
    if (s.delta) {
      EXPECT_TRUE(s.pdf > 0 && s.pdf <= 1 + 1e-6f) << s.pdf;
      continue;
    }
    if (std::min(std::abs(wo.z), std::abs(s.wi.z)) < 1e-3f) continue;
    const BsdfEval e = eval(r.bsdf, wo, s.wi, mode);
    expect_close(s.pdf, e.pdf, "pdf");
    expect_close(s.pdf_reverse, e.pdf_reverse, "pdf_reverse");
    expect_close(s.weight * s.pdf, e.f * std::abs(s.wi.z), "weight");
    if (HasFailure())
      FAIL() << "wo " << wo.x << " " << wo.y << " " << wo.z << " wi " << s.wi.x << " " << s.wi.y << " " << s.wi.z;
  }
  EXPECT_GT(drawn, 2000);
}

// pdf_reverse(wo, wi) = pdf(wi, wo); f of one mode = f of the other with the directions swapped; between the modes lies
// eta^2.
TEST_P(Agree, ReverseIsSwapped) {
  for (int i = 0; i < 4000; ++i) {
    const Vec3 wo = next_wo();
    const Vec2 u = sampler.next2();
    BsdfSample s;
    if (!sample(r.bsdf, wo, sampler.next1(), u, Mode::radiance, s) || s.delta) continue;
    const BsdfEval forth = eval(r.bsdf, wo, s.wi, Mode::radiance), back = eval(r.bsdf, s.wi, wo, Mode::importance);
    const BsdfEval other = eval(r.bsdf, wo, s.wi, Mode::importance);
    expect_close(forth.pdf_reverse, back.pdf, "pdf", 1e-3f);
    expect_close(forth.pdf, back.pdf_reverse, "pdf_reverse", 1e-3f);
    expect_close(forth.f, back.f, "adjoint", 1e-3f);
    // between the modes lies more where normals are bent: the cosines of each part (tested with Resolve)
    if (!GetParam().bent) expect_close(other.f, forth.f * (s.eta * s.eta), "modes", 1e-4f);
    EXPECT_EQ(other.pdf, forth.pdf);
    if (HasFailure())
      FAIL() << "wo " << wo.x << " " << wo.y << " " << wo.z << " wi " << s.wi.x << " " << s.wi.y << " " << s.wi.z;
  }
}

bool near(float a, float b) { return std::abs(a - b) <= 1e-3f * std::max(a, b) + 1e-6f; }
bool near(const Rgb& a, const Rgb& b) { return near(a.x, b.x) && near(a.y, b.y) && near(a.z, b.z); }

// back undoes forth. cos dw eta^2 is the same on both sides of a refraction, so the weights, which are integrals over
// cos dw, differ by eta^2.
bool undoes(const BsdfSample& back, const BsdfSample& forth, const Vec3& wo) {
  return back.delta && length2(back.wi - wo) < 1e-5f && near(back.pdf, forth.pdf_reverse) &&
         near(back.pdf_reverse, forth.pdf) && near(back.eta * forth.eta, 1) &&
         near(back.weight * back.pdf, forth.weight * (forth.pdf * forth.eta * forth.eta));
}

// A delta event can be walked back in the opposite mode, with the probability and the weight that it announced.
TEST_P(AgreeDelta, GoesBothWays) {
  for (int i = 0; i < 500; ++i) {
    const Vec3 wo = next_wo();
    const Mode mode = i % 2 ? Mode::radiance : Mode::importance;
    const Vec2 u = sampler.next2();
    BsdfSample s, back;
    if (!sample(r.bsdf, wo, sampler.next1(), u, mode, s) || !s.delta || std::abs(wo.z) < 0.01f ||
        s.pdf_reverse < 0.005f)
      continue;
    bool found = false;
    for (int k = 0; k < 400 && !found; ++k)
      found = sample(r.bsdf, s.wi, (float(k) + 0.5f) / 400, {0.5f, 0.5f}, opposite(mode), back) && undoes(back, s, wo);
    ASSERT_TRUE(found) << "wo " << wo.x << " " << wo.y << " " << wo.z << " wi " << s.wi.x << " " << s.wi.y << " "
                       << s.wi.z;
  }
}

void expect_sane(float x) { ASSERT_TRUE(x >= 0 && std::isfinite(x)) << x; }
void expect_sane(const Rgb& c) {
  ASSERT_TRUE(is_finite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0) << c.x << " " << c.y << " " << c.z;
}

float pick(Sampler& sampler, std::initializer_list<float> values) {
  return *(values.begin() + int(sampler.next1() * float(values.size())));
}

Vec3 odd_direction(Sampler& sampler) {
  const float z = pick(sampler, {0, 1e-38f, 1e-20f, 1e-8f, 1e-4f, 0.3f, 0.99f, 1 - 1e-7f, 1}) * pick(sampler, {-1, 1});
  const float phi = pick(sampler, {0, pi / 2, pi, 1, 4}), r = safe_sqrt(1 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

void set_oddly(Material& m, Sampler& sampler) {
  const auto any = [&] { return Slot(pick(sampler, {0, 1e-6f, 0.2f, 0.9f, 1})); };
  const auto colour = [&] { return Slot(Rgb(any().value.x, any().value.x, any().value.x)); };
  m.inner = Inner(int(sampler.next1() * 3));
  m.ward = WardKind(int(sampler.next1() * 3));
  m.simple = sampler.next1() < 0.5f;
  for (Slot* slot : {&m.reflectance, &m.specular, &m.transmittance}) *slot = colour();
  m.alpha_u = pick(sampler, {0, 1e-5f, 1e-3f, 0.1f, 1, 10});
  m.alpha_v = sampler.next1() < 0.5f ? m.alpha_u : Slot(pick(sampler, {0, 1e-3f, 0.1f, 3}));
  m.exponent = pick(sampler, {0, 1, 100, 1e6f});
  for (int i = 0; i < 3; ++i) {
    m.eta[i] = pick(sampler, {0, 1e-3f, 1, 1.5f, 40});
    m.k[i] = pick(sampler, {0, 1, 5, 1e3f});
  }
  m.ior = pick(sampler, {0.3f, 0.75f, 1, 1.0005f, 1.002f, 1.33f, 1.5f, 4});
  for (Slot* slot : {&m.roughness, &m.anisotropic, &m.metallic, &m.spec_trans, &m.spec_tint, &m.sheen, &m.sheen_tint,
                     &m.clearcoat, &m.clearcoat_gloss, &m.flatness, &m.weight})
    *slot = any();
}

TEST_P(Agree, StaysFiniteAtExtremes) {
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<Material> materials = GetParam().materials;
    for (Material& m : materials) set_oddly(m, sampler);
    r = resolved(materials);
    for (int i = 0; i < 150; ++i) {
      const Vec3 wo = i % 4 ? odd_direction(sampler) : random_direction(sampler);
      const Vec3 wi = i % 7 == 0 ? Vec3(-wo.x, -wo.y, wo.z) : i % 5 == 0 ? -wo : odd_direction(sampler);
      const Mode mode = i % 2 ? Mode::radiance : Mode::importance;
      SCOPED_TRACE(testing::Message() << "wo " << wo.x << " " << wo.y << " " << wo.z << " wi " << wi.x << " " << wi.y
                                      << " " << wi.z << " trial " << trial);
      const BsdfEval e = eval(r.bsdf, wo, wi, mode);
      expect_sane(e.f);
      expect_sane(e.pdf);
      expect_sane(e.pdf_reverse);
      expect_sane(albedo(r.bsdf, wo));
      BsdfSample s;
      const Vec2 u{pick(sampler, {0, 1e-30f, 0.5f, one_minus_epsilon}), pick(sampler, {0, 0.3f, one_minus_epsilon})};
      if (!sample(r.bsdf, wo, pick(sampler, {0, 1e-8f, 0.1f, 0.5f, one_minus_epsilon}), u, mode, s)) continue;
      ASSERT_NEAR(length2(s.wi), 1, 1e-3f);
      expect_sane(s.weight);
      expect_sane(s.pdf);
      expect_sane(s.pdf_reverse);
      ASSERT_TRUE(s.pdf > 0 && s.eta > 0);
      if (HasFatalFailure()) return;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bsdf, Agree, testing::ValuesIn(cases()), [](const auto& i) { return i.param.name; });
INSTANTIATE_TEST_SUITE_P(Bsdf, AgreeDelta, testing::ValuesIn(delta_cases()),
                         [](const auto& i) { return i.param.name; });

}  // namespace
}  // namespace ajar::test
