// Emission: starts of light subpaths follow the densities that are claimed for them, in position and in direction.
#include <gtest/gtest.h>

#include "ajar/core/frame.h"
#include "ajar/scene/light.h"
#include "kit/chisquare.h"
#include "lights.h"
#include "square.h"

namespace ajar {
namespace {

using kit::LitScene;

std::vector<LitScene> delta_scenes() {
  std::vector<LitScene> all;
  constexpr const char* names[] = {"point", "spot", "directional", "projector"};
  for (const LightKind kind : {LightKind::point, LightKind::spot, LightKind::directional, LightKind::projector}) {
    Light light;
    light.kind = kind;
    light.position = {3, 1, 2};
    light.direction = glm::normalize(Vec3(1, -2, 0.5f));
    light.radiance = Slot(Rgb(1, 2, 3));
    if (kind == LightKind::projector) {
      light.to_world = glm::rotate(Mat4(1), 1.0f, glm::normalize(Vec3(1, 2, 3)));
      light.plane = {1.5f, 0.4f};
    }
    light.cutoff = 0.7f, light.beam = 0.3f;
    all.push_back({names[all.size()], {}});
    kit::add_mesh(all.back().scene, kit::rectangle(kit::placed(0, Vec3(2), {1, 2, 3})));
    kit::add_light(all.back().scene, light);
    finish(all.back().scene);
  }
  return all;
}

std::vector<LitScene> all_scenes() {
  std::vector<LitScene> all = kit::area_scenes();
  for (LitScene& lit : kit::infinite_scenes()) all.push_back(std::move(lit));
  for (LitScene& lit : delta_scenes()) all.push_back(std::move(lit));
  return all;
}

kit::ChiOptions options(uint64_t seed) {
  kit::ChiOptions o;
  o.samples = 100'000;
  o.rows = 12, o.columns = 24;
  o.seed = seed;
  return o;
}

TEST(Emission, PositionsOnAreaLightsFollowTheirDensity) {
  uint64_t seed = 0;
  for (const LitScene& lit : kit::area_scenes()) {
    const auto r = kit::chi_square_square(
        [&](const Vec2& u) -> std::optional<Vec2> {
          EmissionSample e;
          if (!sample_emission(lit.scene, 0, u, {0.3f, 0.6f}, e)) return std::nullopt;
          return kit::to_square(lit.scene, e.point);
        },
        [&](const Vec2& at) -> double {
          const auto on = kit::from_square(lit.scene, at, {20, 30, -10});
          if (!on) return 0;
          return pdf_emission(lit.scene, light_point(lit.scene, on->at), on->at.ng).position * on->area;
        },
        options(++seed));
    EXPECT_TRUE(r.ok) << lit.name << ": " << r.message;
  }
}

TEST(Emission, DirectionsFollowTheirDensity) {
  uint64_t seed = 0;
  for (const LitScene& lit : all_scenes()) {
    if (lit.scene.lights[0].kind == LightKind::directional) continue;
    EmissionSample first;
    ASSERT_TRUE(sample_emission(lit.scene, 0, {0.4f, 0.3f}, {0.5f, 0.45f}, first)) << lit.name;
    const auto r = kit::chi_square_sphere(
        [&](const Vec2& u, float) -> std::optional<Vec3> {
          EmissionSample e;
          if (!sample_emission(lit.scene, 0, {0.4f, 0.3f}, u, e)) return std::nullopt;
          return e.direction;
        },
        [&](const Vec3& w) -> double { return pdf_emission(lit.scene, first.point, w).direction; }, options(++seed));
    EXPECT_TRUE(r.ok) << lit.name << ": " << r.message;
  }
}

TEST(Emission, PdfOfASampleIsItsOwn) {
  for (const LitScene& lit : all_scenes())
    for (uint32_t i = 0; i < 300; ++i) {
      EmissionSample e;
      if (!sample_emission(lit.scene, 0, kit::random2(i, 1), kit::random2(i, 2), e)) continue;
      const EmissionPdf pdf = pdf_emission(lit.scene, e.point, e.direction);
      ASSERT_NEAR(pdf.position / e.pdf_position, 1, 1e-4f) << lit.name;
      ASSERT_NEAR(pdf.direction / e.pdf_direction, 1, e.point.infinite ? 0.02f : 1e-3f) << lit.name;
      ASSERT_NEAR(length2(e.direction), 1, 1e-5f) << lit.name;
      ASSERT_TRUE(is_finite(e.radiance));
      if (!e.point.infinite && !e.point.delta_position) {
        ASSERT_GT(glm::dot(e.point.n, e.direction), 0);
      }
    }
}

// The mean of what is emitted over its density is the power, spectrum included; so power() is right too.
TEST(Emission, EstimatesThePower) {
  for (const LitScene& lit : all_scenes()) {
    glm::dvec3 sum(0);
    constexpr uint32_t n = 1 << 15;
    for (uint32_t i = 0; i < n; ++i) {
      Sampler s = make_sampler(SamplerKind::sobol, 1, Side::light, 0, i);
      const Vec2 u = s.next2();
      EmissionSample e;
      if (!sample_emission(lit.scene, 0, u, s.next2(), e)) continue;
      const bool place = e.point.infinite || e.point.delta_position;
      const double cosine = place ? 1.0 : double(glm::dot(e.point.n, e.direction));
      sum += glm::dvec3(e.radiance) * (cosine / (double(e.pdf_position) * e.pdf_direction * n));
    }
    const bool stretched =
        std::string(lit.name).find("stretched") != std::string::npos;  // its power is that of the map
    EXPECT_NEAR(luminance(Rgb(sum)) / power(lit.scene, 0), 1, stretched ? 0.2 : 0.01) << lit.name;
  }
}

// Rays of infinite lights start outside the scene, fly through the disk across it and miss no part of it.
TEST(Emission, InfiniteLightsCoverTheScene) {
  for (const LitScene& lit : kit::infinite_scenes()) {
    const Scene& scene = lit.scene;
    EXPECT_EQ(scene.infinite_lights, std::vector<uint32_t>{0});
    for (const Vec3& p : scene.meshes[0].positions) EXPECT_LT(glm::distance(p, scene.center), scene.radius);
    double square = 0;
    constexpr uint32_t n = 4096;
    for (uint32_t i = 0; i < n; ++i) {
      EmissionSample e;
      ASSERT_TRUE(sample_emission(scene, 0, kit::random2(i, 3), kit::random2(i, 4), e)) << lit.name;
      const Vec3 from = e.point.p - scene.center;
      ASSERT_NEAR(glm::dot(from, e.direction), -scene.radius, 1e-4f * scene.radius);
      const Vec3 across = from - e.direction * glm::dot(from, e.direction);
      ASSERT_LE(length2(across), sqr(scene.radius) * 1.0001f);
      square += double(length2(across)) / n;
      ASSERT_EQ(e.point.n, e.direction);
      ASSERT_TRUE(e.point.infinite);
    }
    EXPECT_NEAR(square / sqr(scene.radius), 0.5, 0.02);
  }
}

TEST(Emission, IsOneSided) {
  for (const LitScene& lit : kit::area_scenes()) {
    float pdf;
    const Surface at = sample_area(lit.scene, 0, {0.3f, 0.7f}, pdf);
    const Vec3 along = make_frame(at.ng).s;
    EXPECT_EQ(emitted(lit.scene, at, at.ng), Rgb(1, 2, 3)) << lit.name;
    EXPECT_EQ(emitted(lit.scene, at, glm::normalize(at.ng + along)), Rgb(1, 2, 3));
    EXPECT_EQ(emitted(lit.scene, at, -at.ng), Rgb(0));
    EXPECT_EQ(pdf_emission(lit.scene, light_point(lit.scene, at), -at.ng).direction, 0);
  }
}

// A lamp that shows one field of a checkerboard has the power of that field, and a little if it is the black one.
TEST(Emission, PowerIsOfThePartThatShows) {
  for (const bool mesh : {true, false}) {
    Scene scene;
    const Mat4 place = kit::placed(0.4f, Vec3(1), {1, 2, 3});
    const uint32_t id =
        mesh ? kit::add_mesh(scene, kit::rectangle(place)) : kit::add_shape(scene, ShapeKind::cylinder, place);
    Texture checker;
    checker.kind = TextureKind::checkerboard;
    checker.color0 = Slot(3.0f), checker.color1 = Slot(0.0f);
    checker.to_uv[0][0] = checker.to_uv[1][1] = 0.4f;
    scene.textures.push_back(checker);
    kit::light_up(scene, id, Rgb(1));
    scene.lights[0].radiance.texture = 0;
    finish(scene);
    const double all = pi * area(scene, id) * 3, one = power(scene, 0);
    scene.textures[0].to_uv[2][0] = 0.55f;
    const double other = power(scene, 0);
    EXPECT_NEAR(std::max(one, other), all, 1e-4 * all);
    EXPECT_GT(std::min(one, other), 1e-4 * all);
    EXPECT_LT(std::min(one, other), 1e-2 * all);
  }
}

// Texture on an area light: what is sent, what is seen and what is sampled agree, and the power is positive.
TEST(Emission, TexturedAreaLight) {
  Scene scene;
  const uint32_t id = kit::add_mesh(scene, kit::rectangle(kit::placed(0.4f, Vec3(1), {1, 2, 3})));
  scene.textures.emplace_back();
  scene.textures[0].kind = TextureKind::checkerboard;
  scene.textures[0].color0 = Slot(Rgb(4, 2, 1));
  scene.textures[0].color1 = Slot(0.0f);
  kit::light_up(scene, id, Rgb(1));
  scene.lights[0].radiance.texture = 0;
  finish(scene);
  const float bright = 4 * pi * luminance(Rgb(4, 2, 1));
  EXPECT_NEAR(power(scene, 0), bright / 2, 0.02f * bright);
  const Vec3 front = Vec3(1, 2, 3) + 2.0f * Vec3(kit::placed(0.4f, Vec3(1), Vec3(0))[2]);
  int lit = 0;
  for (uint32_t i = 0; i < 1000; ++i) {
    EmissionSample e;
    const bool found = sample_emission(scene, 0, kit::random2(i, 5), {0.3f, 0.4f}, e);
    lit += found;
    if (found) {
      EXPECT_EQ(e.radiance, Rgb(4, 2, 1));
    }
    DirectSample d;
    if (sample_direct(scene, 0, front, kit::random2(i, 6), d)) {
      EXPECT_EQ(d.radiance, Rgb(4, 2, 1));
      EXPECT_EQ(d.point.uv.x < 0.5f, d.point.uv.y < 0.5f);
    }
  }
  EXPECT_NEAR(lit, 500, 60);
}

}  // namespace
}  // namespace ajar
