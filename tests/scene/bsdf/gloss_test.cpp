// The cheap likeness of a bsdf that choices among many directions go by: how much variance it leaves.
#include <gtest/gtest.h>

#include "ajar/core/warp.h"
#include "ajar/scene/bsdf/gloss.h"
#include "scene/bsdf/cases.h"

namespace ajar::test {
namespace {

float shine_of(const Gloss& g, const Vec3& wo, const Vec3& wi) { return shine(g, wo.z, wi.z, glm::dot(wo, wi)); }

// A direction by the cosine or by the bsdf, in turns, and the density of that.
bool draw(const Bsdf& bsdf, const Vec3& wo, int i, Vec3& wi, float& pdf) {
  Sampler sampler = make_sampler(SamplerKind::sobol, 3, Side::camera, 0, uint32_t(i));
  const Vec2 u = sampler.next2();
  BsdfSample s;
  if (i % 4 < 2)
    wi = to_cosine_hemisphere(u);
  else if (sample(bsdf, wo, sampler.next1(), u, Mode::radiance, s) && !s.delta)
    wi = s.wi;
  else
    return false;
  pdf = 0.5f * (wi.z * inv_pi + eval(bsdf, wo, wi, Mode::radiance).pdf);
  return wi.z > 0 && pdf > 0;
}

// E[x^2] over E[x]^2 where x = f cos / (g cos) is drawn in proportion to g cos: 1 if g is like f.
double spread(const Bsdf& bsdf, const Vec3& wo, const Gloss& gloss) {
  constexpr int n = 1 << 14;
  double f = 0, g = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    Vec3 wi;
    float pdf;
    if (!draw(bsdf, wo, i, wi, pdf)) continue;
    const double value = luminance(eval(bsdf, wo, wi, Mode::radiance).f), like = shine_of(gloss, wo, wi);
    const double weight = double(wi.z / pdf) / n;
    f += value * weight, g += like * weight, squares += value * value / like * weight;
  }
  return squares * g / (f * f);
}

// Materials with a lobe. The first angle is half way up, the second grazes, where lobes leave their mirror direction.
TEST(Gloss, IsLikeTheBsdf) {
  int glossy = 0;
  for (const Case& c : smooth_cases()) {
    if (c.transmits || c.bent) continue;
    for (const float theta : {0.8f, 1.3f}) {
      const Vec3 wo = direction(theta, 0.3f);
      const Resolved r = resolved(c.materials, wo);
      const Gloss gloss = gloss_of(r.bsdf, wo);
      if (!(gloss.peak > 0) || r.bsdf.has_delta) continue;
      ++glossy;
      const double own = spread(r.bsdf, wo, gloss), matt = spread(r.bsdf, wo, Gloss{});
      EXPECT_LT(own, 1.2 * matt + 0.1) << c << " at " << theta;
      EXPECT_LT(own, 12) << c << " at " << theta;  // lobes are taken for round: 10 where they are eight times as long
    }
  }
  EXPECT_GT(glossy, 30);
}

// What narrow lobes send is no surprise: a choice that takes them for matt is off by hundreds.
TEST(Gloss, KnowsNarrowLobes) {
  for (const char* name : {"roughconductor_ggx_10", "roughconductor_beckmann_10"}) {
    const Vec3 wo = direction(1.0f, 0.3f);
    const Resolved r = resolved(find_case(name).materials, wo);
    EXPECT_LT(4 * spread(r.bsdf, wo, gloss_of(r.bsdf, wo)), spread(r.bsdf, wo, Gloss{})) << name;
  }
}

TEST(Gloss, MattIsEven) {
  const Resolved r = resolved({material(MaterialKind::diffuse)});
  const Gloss g = gloss_of(r.bsdf, {0, 0, 1});
  EXPECT_EQ(g.peak, 0);
  EXPECT_EQ(shine_of(g, direction(0.5f, 0), direction(1.2f, 2)), 1);
}

// Whatever the directions: finite, and never so little that a choice would all but rule them out.
TEST(Gloss, IsNeverNothing) {
  for (const Case& c : smooth_cases()) {
    const Resolved r = resolved(c.materials);
    for (int i = 0; i < 500; ++i) {
      Sampler sampler = make_sampler(SamplerKind::independent, 1, Side::camera, 0, uint32_t(i));
      const Vec3 wo = to_cosine_hemisphere(sampler.next2()), wi = i % 5 == 0 ? -wo : random_direction(sampler);
      const float s = shine_of(gloss_of(r.bsdf, wo), wo, wi);
      EXPECT_GE(s, 0.1f) << c;
      EXPECT_LT(s, infinity) << c;
    }
  }
}

}  // namespace
}  // namespace ajar::test
