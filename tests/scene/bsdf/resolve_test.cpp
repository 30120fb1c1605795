// What resolve makes of nested materials: lobes and probabilities, sides, bent frames.
#include <gtest/gtest.h>

#include "ajar/core/error.h"
#include "scene/bsdf/cases.h"

namespace ajar::test {
namespace {

Material grey(float reflectance) {
  Material m = material(MaterialKind::diffuse);
  m.reflectance = reflectance;
  return m;
}

void expect_right_handed(const Frame& f) {
  EXPECT_LT(length2(glm::cross(f.s, f.t) - f.n), 1e-10f);
  EXPECT_NEAR(length2(f.s), 1, 1e-5f);
  EXPECT_NEAR(length2(f.n), 1, 1e-5f);
}

float diffuse_value(const Bsdf& bsdf) { return eval(bsdf, {0, 0, 1}, direction(0.5f, 0), Mode::radiance).f.x * pi; }

TEST(Resolve, TwosidedTurnsTheFrameToTheViewer) {
  const std::vector<Material> same{parent(MaterialKind::twosided, {1}), grey(0.6f)};
  const std::vector<Material> two{parent(MaterialKind::twosided, {1, 2}), grey(0.6f), grey(0.2f)};
  for (const float side : {1.0f, -1.0f}) {
    const Vec3 wo = glm::normalize(Vec3(0.3f, 0.2f, side));
    const Resolved a = resolved(same, wo), b = resolved(two, wo);
    EXPECT_EQ(a.surface.frame.n, Vec3(0, 0, side));
    EXPECT_EQ(a.surface.ng, Vec3(0, 0, 1));
    EXPECT_GT(a.surface.frame.to_local(wo).z, 0);
    expect_right_handed(a.surface.frame);
    EXPECT_NEAR(diffuse_value(a.bsdf), 0.6f, 1e-6f);
    EXPECT_NEAR(diffuse_value(b.bsdf), side > 0 ? 0.6f : 0.2f, 1e-6f);
  }
  // Without it the frame stays, and nothing diffuse is seen from behind.
  const Resolved back = resolved({grey(0.6f)}, {0, 0, -1});
  EXPECT_EQ(back.surface.frame.n, Vec3(0, 0, 1));
  BsdfSample s;
  EXPECT_FALSE(sample(back.bsdf, {0, 0, -1}, 0.5f, {0.5f, 0.5f}, Mode::radiance, s));
}

// Parts of a sum that bend or turn the normal each in their way: what they scatter, values times cosines, adds up.
TEST(Resolve, BentPartsAddUp) {
  const Material glossy = microfacet(MaterialKind::roughconductor, Microfacet::ggx, 0.2f, 0.6f);
  const Material glass = microfacet(MaterialKind::roughdielectric, Microfacet::beckmann, 0.3f, 0.3f);
  Material mix = parent(MaterialKind::mixture, {1, 2, 3});
  mix.weights = {0.5f, 0.3f, 0.2f, 0};
  const std::vector<Material> all{mix,
                                  with_normal({0.3f, 0.2f, 1}, 4),
                                  parent(MaterialKind::twosided, {5}),
                                  glass,
                                  glossy,
                                  with_normal({-0.4f, 0.1f, 1}, 6),
                                  grey(0.7f)};
  const std::vector<Material> parts[] = {
      {with_normal({0.3f, 0.2f, 1}, 1), glossy},
      {parent(MaterialKind::twosided, {1}), with_normal({-0.4f, 0.1f, 1}, 2), grey(0.7f)},
      {glass}};
  Sampler sampler = make_sampler(SamplerKind::independent, 4, Side::camera, 0, 0);
  int seen = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 wo = random_direction(sampler), wi = random_direction(sampler);
    const Mode mode = i % 2 ? Mode::radiance : Mode::importance;
    const Resolved sum = resolved(all, wo);
    EXPECT_TRUE(sum.bsdf.bent);
    EXPECT_EQ(sum.surface.frame.n, Vec3(0, 0, 1));
    const BsdfEval e = eval(sum.bsdf, wo, wi, mode);
    Rgb expected(0);
    for (int k = 0; k < 3; ++k) {
      const Resolved part = resolved(parts[k], wo);
      const Frame& f = part.surface.frame;
      const Vec3 o = f.to_local(wo), in = f.to_local(wi);
      const float side = f.n.z > 0 ? 1 : -1;
      if (!(side * wo.z * o.z > 0 && side * wi.z * in.z > 0)) continue;  // would pass the surface
      expected += eval(part.bsdf, o, in, mode).f * (mix.weights[k] * std::abs(mode == Mode::radiance ? in.z : o.z));
    }
    const Rgb got = e.f * std::abs(mode == Mode::radiance ? wi.z : wo.z);
    seen += max_component(expected) > 0;
    ASSERT_LT(max_abs(got - expected), 1e-3f * max_component(expected) + 1e-6f) << i;
    ASSERT_TRUE(max_component(expected) == 0 || (e.pdf > 0 && e.pdf_reverse > 0)) << i;
  }
  EXPECT_GT(seen, 1000);
}

// Beside what differs from side to side, the way through is as likely as the way back says.
TEST(Resolve, TheWayThroughIsAsLikelyFromBothSides) {
  Material blend = parent(MaterialKind::blend, {1, 2});
  blend.weight = Slot(0.3f);
  Sampler sampler = make_sampler(SamplerKind::independent, 9, Side::camera, 0, 0);
  for (const Material& through :
       {microfacet(MaterialKind::roughdielectric, Microfacet::ggx, 0.3f, 0.3f), material(MaterialKind::difftrans)})
    for (const float front : {0.0f, 0.02f, 0.95f}) {
      const std::vector<Material> all{blend, through, parent(MaterialKind::twosided, {3, 4}), grey(front), grey(0.95f)};
      int seen = 0;
      for (int i = 0; i < 2000; ++i) {
        const Vec3 wo = random_direction(sampler);
        const Resolved here = resolved(all, wo);
        const Vec2 u = sampler.next2();
        BsdfSample s;
        const Vec3 o = here.surface.frame.to_local(wo);
        if (!sample(here.bsdf, o, sampler.next1(), u, Mode::radiance, s)) continue;
        const Vec3 wi = here.surface.frame.to_world(s.wi);
        if (wi.z * wo.z > 0) continue;
        const Resolved there = resolved(all, wi);
        const Frame& f = there.surface.frame;
        const BsdfEval back = eval(there.bsdf, f.to_local(wi), f.to_local(wo), Mode::importance);
        ASSERT_NEAR(back.pdf, s.pdf_reverse, 0.02f * back.pdf + 1e-5f) << front;
        ASSERT_NEAR(back.pdf_reverse, s.pdf, 0.02f * s.pdf + 1e-5f) << front;
        ++seen;
      }
      EXPECT_GT(seen, 400);
    }
}

// A mirror with a normal of its own: the direction, and the weight of importance by Veach's adjoint.
TEST(Resolve, BentMirror) {
  Material mix = parent(MaterialKind::mixture, {1, 3});
  mix.weights = {1, 0, 0, 0};
  const Vec3 n = glm::normalize(Vec3(0.3f, 0, 1));
  const Resolved r = resolved({mix, with_normal(n, 2), material(MaterialKind::conductor), grey(0.5f)});
  const Vec3 wo = direction(0.4f, 1), expected = 2 * glm::dot(wo, n) * n - wo;
  BsdfSample s;
  ASSERT_TRUE(sample(r.bsdf, wo, 0.5f, {0.5f, 0.5f}, Mode::radiance, s));
  EXPECT_TRUE(s.delta);
  EXPECT_LT(length2(s.wi - expected), 1e-10f);
  EXPECT_NEAR(s.weight.x, 1, 1e-5f);
  ASSERT_TRUE(sample(r.bsdf, wo, 0.5f, {0.5f, 0.5f}, Mode::importance, s));
  EXPECT_NEAR(s.weight.x, expected.z / wo.z, 1e-5f);  // |wo.n| = |wi.n| at the mirror's own normal
  // below the surface it is lost
  EXPECT_FALSE(sample(r.bsdf, direction(1.2f, pi), 0.5f, {0.5f, 0.5f}, Mode::radiance, s) && s.wi.z < 0);
}

TEST(Resolve, TwosidedGoesByTheGeometricSide) {
  Resolved r = resolved({parent(MaterialKind::twosided, {1}), grey(0.6f)});
  r.surface.frame = make_frame(glm::normalize(Vec3(0.5f, 0, 1)));
  const Vec3 wo = glm::normalize(Vec3(-1, 0, 0.1f));  // before ng, behind the shading normal
  resolve(r.scene, r.surface, wo, r.surface.frame, r.bsdf);
  EXPECT_GT(r.surface.frame.n.z, 0);
}

TEST(Resolve, BlackDiffuseIsNothing) {
  const Resolved r = resolved({grey(0)});
  EXPECT_EQ(r.bsdf.count, 0);
  EXPECT_FALSE(r.bsdf.has_smooth || r.bsdf.has_delta);
  BsdfSample s;
  EXPECT_FALSE(sample(r.bsdf, {0, 0, 1}, 0.5f, {0.5f, 0.5f}, Mode::radiance, s));
}

TEST(Resolve, FlagsTellDeltaFromSmooth) {
  struct Expected {
    const char* name;
    bool smooth, delta;
  };
  for (const Expected& e : {Expected{"diffuse", true, false},
                            {"conductor", false, true},
                            {"dielectric", false, true},
                            {"thindielectric", false, true},
                            {"plastic", true, true},
                            {"roughplastic_ggx_10", true, false},
                            {"null", false, true},
                            {"mask", true, true},
                            {"blend", true, false},
                            {"blend_delta", true, true}}) {
    const Bsdf bsdf = resolved(find_case(e.name).materials).bsdf;
    EXPECT_EQ(bsdf.has_smooth, e.smooth) << e.name;
    EXPECT_EQ(bsdf.has_delta, e.delta) << e.name;
  }
}

// What lets no light through is lit from one side alone.
TEST(Resolve, PrincipledIsOpaqueUnlessItRefracts) {
  Material m;
  m.kind = MaterialKind::principled;
  m.roughness = 0.5f;
  for (const float through : {0.0f, 0.2f}) {
    m.spec_trans = through;
    EXPECT_EQ(resolved({m}).bsdf.opaque, through == 0) << through;
  }
}

TEST(Resolve, WeightsOfNestedMaterialsMultiply) {
  Material mask = parent(MaterialKind::mask, {1});
  mask.weight = 0.75f;
  Material blend = parent(MaterialKind::blend, {2, 3});
  blend.weight = 0.2f;
  const Resolved r = resolved({mask, blend, grey(0.5f), grey(0.9f)});
  ASSERT_EQ(r.bsdf.count, 2);
  EXPECT_NEAR(r.bsdf.opacity, 0.75f, 1e-6f);
  EXPECT_NEAR(diffuse_value(r.bsdf), 0.75f * (0.8f * 0.5f + 0.2f * 0.9f), 1e-6f);
  EXPECT_NEAR(r.bsdf.pass + r.bsdf.choice[0] + r.bsdf.choice[1], 1, 1e-6f);
  EXPECT_NEAR(albedo(r.bsdf, {0, 0, 1}).x, 0.25f + 0.75f * 0.58f, 1e-6f);
  // What passes: weight times probability is 1 - opacity, straight on.
  BsdfSample s;
  ASSERT_TRUE(sample(r.bsdf, direction(0.4f, 1), 0, {0.5f, 0.5f}, Mode::radiance, s));
  EXPECT_TRUE(s.delta);
  EXPECT_EQ(s.wi, -direction(0.4f, 1));
  EXPECT_NEAR(s.weight.x * s.pdf, 0.25f, 1e-6f);

  mask.weight = 1.0f;
  EXPECT_FALSE(resolved({mask, grey(0.5f)}).bsdf.has_delta);
  mask.weight = 0.0f;
  EXPECT_FALSE(resolved({mask, grey(0.5f)}).bsdf.has_smooth);
}

TEST(Resolve, CountsLobesAndNamesWhatCannotBe) {
  Material mixture = parent(MaterialKind::mixture, {1, 1, 1, 1});
  const Material blend = parent(MaterialKind::blend, {2, 3});
  const auto problem = [](std::vector<Material> m) {
    Scene scene;
    scene.materials = std::move(m);
    return material_problem(scene, 0);
  };
  Scene scene;
  scene.materials = {mixture, blend, grey(1), grey(1)};
  EXPECT_EQ(lobe_count(scene, 0), 8);
  EXPECT_EQ(lobe_count(scene, 1), 2);
  EXPECT_NE(problem({mixture, blend, grey(1), grey(1)}).find("8 elementary"), std::string::npos);
  EXPECT_THROW(prepare_materials(scene), Error);
  EXPECT_EQ(problem({parent(MaterialKind::blend, {1, 2}), grey(1), grey(1)}), "");
  EXPECT_EQ(
      problem({parent(MaterialKind::blend, {1, 2}), parent(MaterialKind::twosided, {2}), material(MaterialKind::null)}),
      "");
  EXPECT_EQ(problem({parent(MaterialKind::blend, {1, 2}), parent(MaterialKind::bumpmap, {2}), grey(1)}), "");
  EXPECT_NE(problem({parent(MaterialKind::mask, {0})}), "");
  EXPECT_NE(problem({parent(MaterialKind::twosided, {})}), "");
}

TEST(Resolve, SumsSplitWhereBranchesBendOrTurnDifferently) {
  const auto splits = [](const Material& a, const Material& b, const Material& third = material(MaterialKind::null)) {
    return scene_of({parent(MaterialKind::blend, {1, 2}), a, b, third, grey(1), grey(1)}).materials[0].splits;
  };
  const Material twosided = parent(MaterialKind::twosided, {4}), bump = parent(MaterialKind::bumpmap, {4});
  EXPECT_FALSE(splits(grey(1), grey(1)));
  EXPECT_FALSE(splits(twosided, twosided));
  EXPECT_FALSE(splits(twosided, material(MaterialKind::null)));
  EXPECT_TRUE(splits(twosided, grey(1)));
  EXPECT_TRUE(splits(bump, bump));
  EXPECT_TRUE(splits(grey(1), bump));
  EXPECT_TRUE(splits(parent(MaterialKind::twosided, {4, 3}), twosided, bump));  // behind
  EXPECT_TRUE(splits(parent(MaterialKind::blend, {3, 5}), grey(1), bump));
  EXPECT_FALSE(scene_of({twosided, grey(1), grey(1), grey(1), parent(MaterialKind::bumpmap, {1})}).materials[0].splits);
}

TEST(Resolve, NormalMapBendsInTheTangentSpace) {
  Material map = parent(MaterialKind::normalmap, {1});
  const Vec3 n = glm::normalize(Vec3(0.3f, -0.4f, 0.8f));
  map.map = Slot(Rgb(0.5f) + 0.5f * n);
  EXPECT_LT(length2(resolved({map, grey(1)}).surface.frame.n - n), 1e-6f);
  const Frame f = resolved({map, grey(1)}).surface.frame;
  expect_right_handed(f);
  EXPECT_NEAR(f.s.y, -n.x * n.y / std::sqrt(1 - n.x * n.x), 1e-5f);  // s is still the tangent, made orthogonal
  // Behind a two-sided surface the same relief is seen from the other side's outside, as in a mirror.
  const Resolved back = resolved({parent(MaterialKind::twosided, {1}),
                                  [&] {
                                    map.nested[0] = 2;
                                    return map;
                                  }(),
                                  grey(1)},
                                 {0, 0, -1});
  EXPECT_LT(length2(back.surface.frame.n - Vec3(n.x, n.y, -n.z)), 1e-6f);
  expect_right_handed(back.surface.frame);
}

TEST(Resolve, BentNormalStaysOutside) {
  Material map = parent(MaterialKind::normalmap, {1});
  map.map = Slot(Rgb(0.5f) + 0.5f * glm::normalize(Vec3(0.3f, -0.4f, -0.8f)));
  EXPECT_GT(resolved({map, grey(1)}).surface.frame.n.z, 0);
  map.map = Slot(Rgb(0.5f));  // zero length: no direction, so no change
  EXPECT_EQ(resolved({map, grey(1)}).surface.frame.n, Vec3(0, 0, 1));
}

// Of textures whose numbers are far beyond any roughness the diffuse part is left.
TEST(Resolve, RoughnessOfTexturesHasALimit) {
  Material m = material(MaterialKind::roughplastic);
  m.reflectance = 0.5f, m.specular = 0.0f;
  m.alpha_u.texture = m.alpha_v.texture = 0;
  Scene scene;
  Texture texture;
  texture.kind = TextureKind::scale;
  texture.color0 = Slot(1e10f), texture.color1 = Slot(1e10f);
  scene.textures = {texture};
  scene.materials = {m};
  scene.shapes.emplace_back();
  prepare_materials(scene);
  Surface at;
  at.shape = 0;
  at.frame = make_frame(Vec3(0, 0, 1));
  Frame bent = at.frame;
  Bsdf bsdf;
  resolve(scene, at, {0, 0, 1}, bent, bsdf);
  const float f = eval(bsdf, {0, 0, 1}, direction(0.5f, 1), Mode::radiance).f.x;
  EXPECT_TRUE(f > 0 && f < 0.5f * inv_pi) << f;
}

// The bent normal is the normal of the surface displaced along its normal, here by finite differences.
TEST(Resolve, BumpMapIsTheDisplacedSurface) {
  Scene scene;
  Image image;
  image.width = image.height = 8;
  image.channels = 1;
  for (int i = 0; i < 64; ++i)
    image.floats.push_back(0.5f + 0.4f * std::sin(float(i % 8)) * std::cos(0.7f * float(i / 8)));
  scene.images = {image};
  Texture texture;
  texture.image = 0;
  scene.textures = {texture};
  Material bump = parent(MaterialKind::bumpmap, {1});
  bump.map.texture = 0;
  bump.map_scale = 0.5f;
  scene.materials = {bump, grey(1)};
  scene.shapes.emplace_back();
  prepare_materials(scene);
  for (const bool mirrored : {false, true})
    for (const Vec2 uv : {Vec2(0.3f, 0.4f), Vec2(0.71f, 0.13f), Vec2(0.52f, 0.93f)}) {
      Surface at;
      at.shape = 0;
      at.uv = uv;
      at.frame = make_frame(glm::normalize(Vec3(0.1f, -0.05f, 1)));
      const Vec3 n = at.frame.n;
      at.dpdu = Vec3(2, 0, 0) - n * n.x * 2.0f;
      at.dpdv = Vec3(0.5f, mirrored ? -1.5f : 1.5f, 0);
      at.dpdv -= n * glm::dot(n, at.dpdv);
      const float e = 1e-3f;
      const auto point = [&](float du, float dv) {
        Surface moved = at;
        moved.uv += Vec2(du, dv);
        return at.dpdu * du + at.dpdv * dv + n * (bump.map_scale * eval_scalar(scene, bump.map, moved));
      };
      Vec3 expected = glm::normalize(glm::cross(point(e, 0) - point(-e, 0), point(0, e) - point(0, -e)));
      if (glm::dot(expected, n) < 0) expected = -expected;
      Bsdf bsdf;
      Frame bent = at.frame;
      resolve(scene, at, {0, 0, 1}, bent, bsdf);
      EXPECT_LT(length2(bent.n - expected), 1e-5f) << uv.x << " " << uv.y;
      EXPECT_GT(length2(bent.n - n), 1e-3f);
      expect_right_handed(bent);
    }
}

}  // namespace
}  // namespace ajar::test
