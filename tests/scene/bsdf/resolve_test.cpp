// What resolve makes of nested materials: lobes and probabilities, sides, bent frames.
#include <gtest/gtest.h>

#include "ajar/core/error.h"
#include "scene/bsdf/cases.h"

namespace ajar::test {
namespace {

Material parent(MaterialKind kind, std::initializer_list<uint32_t> nested) {
  Material m = material(kind);
  std::copy(nested.begin(), nested.end(), m.nested.begin());
  return m;
}

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
  EXPECT_NE(problem({parent(MaterialKind::blend, {1, 2}), parent(MaterialKind::twosided, {2}), grey(1)}), "");
  EXPECT_NE(problem({parent(MaterialKind::blend, {1, 2}), parent(MaterialKind::bumpmap, {2}), grey(1)}), "");
  EXPECT_NE(problem({parent(MaterialKind::mask, {0})}), "");
  EXPECT_NE(problem({parent(MaterialKind::twosided, {})}), "");
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
