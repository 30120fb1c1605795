// Next-event estimation: directions follow the density that is claimed for them, and estimates are right.
#include <gtest/gtest.h>

#include "ajar/core/warp.h"
#include "ajar/scene/light.h"
#include "kit/chisquare.h"
#include "lights.h"
#include "square.h"

namespace ajar {
namespace {

using kit::LitScene;
using kit::placed;

void expect_area_chi_square(const LitScene& lit, const Vec3& x, uint64_t seed) {
  const Scene& scene = lit.scene;
  kit::ChiOptions o;
  o.samples = 50'000;
  o.rows = 8, o.columns = 16;
  if (scene.shapes[0].kind == ShapeKind::cylinder) o.rows = 4, o.columns = 64;  // what faces x ends at columns
  o.seed = seed;
  const auto r = kit::chi_square_square(
      [&](const Vec2& u) -> std::optional<Vec2> {
        DirectSample d;
        if (!sample_direct(scene, 0, x, u, d)) return std::nullopt;
        return kit::to_square(scene, d.point);
      },
      [&](const Vec2& at) -> double {
        const auto on = kit::from_square(scene, at, x);
        if (!on) return 0;
        const glm::dvec3 between = glm::dvec3(on->at.p) - glm::dvec3(x);
        const double d2 = glm::dot(between, between);
        const Vec3 wi(between / std::sqrt(d2));
        return pdf_direct(scene, light_point(scene, on->at), x, wi) * std::abs(glm::dot(on->at.ng, wi)) / d2 * on->area;
      },
      o);
  EXPECT_TRUE(r.ok) << lit.name << " from " << x.x << " " << x.y << " " << x.z << ": " << r.message;
}

class DirectArea : public testing::TestWithParam<size_t> {};
TEST_P(DirectArea, FollowsItsDensity) {
  const LitScene lit = kit::area_scenes()[GetParam()];
  uint64_t seed = 100 * GetParam();
  for (const Vec3& x : kit::view_points()) expect_area_chi_square(lit, x, ++seed);
}
INSTANTIATE_TEST_SUITE_P(Lights, DirectArea, testing::Range(size_t(0), kit::area_scenes().size()));

TEST(Direct, InfiniteLightsFollowTheirDensity) {
  kit::ChiOptions o;
  o.samples = 100'000;
  o.rows = 12, o.columns = 24;
  for (const LitScene& lit : kit::infinite_scenes()) {
    ++o.seed;
    const auto r = kit::chi_square_sphere(
        [&](const Vec2& u, float) -> std::optional<Vec3> {
          DirectSample d;
          if (!sample_direct(lit.scene, 0, Vec3(0), u, d)) return std::nullopt;
          return d.wi;
        },
        [&](const Vec3& w) { return pdf_direct(lit.scene, light_point(lit.scene, 0, w), Vec3(0), w); }, o);
    EXPECT_TRUE(r.ok) << lit.name << ": " << r.message;
  }
}

// Samples agree with themselves: the density that pdf_direct gives for a sample is the sample's own.
TEST(Direct, PdfOfASampleIsItsOwn) {
  std::vector<LitScene> all = kit::area_scenes();
  for (LitScene& lit : kit::infinite_scenes()) all.push_back(std::move(lit));
  for (const LitScene& lit : all)
    for (const Vec3& x : kit::view_points())
      for (uint32_t i = 0; i < 300; ++i) {
        DirectSample d;
        if (!sample_direct(lit.scene, 0, x, kit::random2(i, 7), d)) continue;
        ASSERT_NEAR(length2(d.wi), 1, 1e-5f);
        const float pdf = pdf_direct(lit.scene, d.point, x, d.wi);
        ASSERT_NEAR(pdf / d.pdf, 1, d.point.infinite ? 0.02f : 1e-3f) << lit.name;
        if (d.point.infinite) continue;
        ASSERT_NEAR(glm::distance(d.point.p, x) / d.distance, 1, 1e-4f) << lit.name;
        ASSERT_LT(glm::distance(glm::normalize(d.point.p - x), d.wi), 1e-4f) << lit.name;
        ASSERT_GT(glm::dot(d.point.n, -d.wi), 0);
        ASSERT_GT(d.point.error, 0);
      }
}

// Irradiance on a plane at x with normal n, unoccluded.
Rgb irradiance(const Scene& scene, const Vec3& x, const Vec3& n, uint32_t samples = 1 << 14) {
  glm::dvec3 sum(0);
  for (uint32_t i = 0; i < samples; ++i) {
    DirectSample d;
    const Vec2 u = make_sampler(SamplerKind::sobol, 1, Side::camera, 0, i).next2();
    if (!sample_direct(scene, 0, x, u, d)) continue;
    sum += glm::dvec3(d.radiance * (std::max(glm::dot(n, d.wi), 0.0f) / d.pdf));
  }
  return sum / double(samples);
}

// Lambert's formula for a polygon that lies above the horizon (Arvo 1995, equation 2.8).
double polygon_factor(const std::vector<glm::dvec3>& corners, const glm::dvec3& x, const glm::dvec3& n) {
  double sum = 0;
  for (size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 a = glm::normalize(corners[i] - x), b = glm::normalize(corners[(i + 1) % corners.size()] - x);
    sum += std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)) * glm::dot(glm::normalize(glm::cross(a, b)), n);
  }
  return std::abs(sum) / 2;
}

TEST(Direct, PolygonGivesLambertsIrradiance) {
  const Mat4 down = glm::translate(Mat4(1), Vec3(0.3f, 0.2f, 2)) * glm::rotate(Mat4(1), pi, Vec3(1, 0, 0));
  const Mesh rect = kit::rectangle(down);
  const LitScene lit = kit::area_scene("rectangle", ShapeKind::mesh, Mat4(1), false, &rect);
  for (const Vec3& x : {Vec3(0, 0, 0), Vec3(5, 1, 0.5f), Vec3(0.2f, 0.3f, 1.8f), Vec3(0.5f, 0.1f, 1.99f)}) {
    std::vector<glm::dvec3> corners;
    for (const Vec3& p : rect.positions) corners.emplace_back(p);
    const Rgb e = irradiance(lit.scene, x, {0, 0, 1});
    EXPECT_NEAR(e.y / (2 * polygon_factor(corners, x, {0, 0, 1})), 1, 4e-3) << x.x << " " << x.z;
    EXPECT_NEAR(e.z / e.x, 3, 1e-4);
    EXPECT_EQ(irradiance(lit.scene, x + Vec3(0, 0, 4), {0, 0, -1}, 64), Rgb(0));  // from behind: dark
  }
}

TEST(Direct, SphereGivesItsIrradiance) {
  for (const float distance : {1.001f, 1.5f, 10.0f, 1e4f, 1e6f}) {
    const LitScene lit = kit::area_scene("sphere", ShapeKind::sphere, placed(1, Vec3(0.25f), {0, 0, 0.25f * distance}));
    const Rgb e = irradiance(lit.scene, Vec3(0), {0, 0, 1}, 1 << 12);
    EXPECT_NEAR(e.x / (pi / (double(distance) * distance)), 1, 2e-3) << distance;
  }
  // Inside a sphere that shines inwards every irradiance is pi L.
  const LitScene inside = kit::area_scene("sphere", ShapeKind::sphere, placed(1, Vec3(2), {0, 0, 0}), true);
  for (const Vec3& x : {Vec3(0), Vec3(1, 0.5f, -1), Vec3(0, 0, 1.9f)})
    EXPECT_NEAR(irradiance(inside.scene, x, glm::normalize(Vec3(1, 2, 3)), 1 << 16).x / pi, 1, 0.02) << x.z;
  const LitScene outwards = kit::area_scene("sphere", ShapeKind::sphere, placed(1, Vec3(2), {0, 0, 0}));
  EXPECT_EQ(irradiance(outwards.scene, {0.5f, 0, 0}, {0, 0, 1}, 256), Rgb(0));
}

TEST(Direct, DiskGivesItsIrradiance) {
  const Mat4 down = glm::translate(Mat4(1), Vec3(0, 0, 2)) * glm::rotate(Mat4(1), pi, Vec3(1, 0, 0)) *
                    glm::scale(Mat4(1), Vec3(1.5f));
  const LitScene lit = kit::area_scene("disk", ShapeKind::disk, down);
  EXPECT_NEAR(irradiance(lit.scene, Vec3(0), {0, 0, 1}).x, pi * 2.25 / (2.25 + 4), 5e-3);
}

TEST(Direct, InfiniteLightsGiveTheirIrradiance) {
  for (const LitScene& lit : kit::infinite_scenes()) {
    const Vec3 n = glm::normalize(Vec3(0.3f, 1, 0.2f));
    glm::dvec3 exact(0);
    constexpr int g = 700;
    for (int i = 0; i < g * g; ++i) {
      const Vec3 w = to_sphere({(float(i % g) + 0.5f) / g, (float(i / g) + 0.5f) / g});
      exact += glm::dvec3(environment(lit.scene, 0, w)) * double(std::max(glm::dot(n, w), 0.0f)) /
               (double(g) * g * sphere_pdf);
    }
    const Rgb e = irradiance(lit.scene, Vec3(3, 4, 5), n, 1 << 15);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(e[c] / exact[c], 1, 5e-3) << lit.name;
  }
}

// What each row of a map of five rows says is seen at its own height: the first and last at the poles, or half a row
// from them.
TEST(Direct, RowsOfAMapStandAtTheirHeights) {
  const Image rows = kit::float_image(4, 5, [](int, int y) { return float(1 << y); });
  for (const bool polar : {false, true}) {
    const LitScene lit = kit::map_scene("rows", Mat4(1), rows, polar);
    for (int y = 0; y < 5; ++y) {
      const float theta = pi * (polar ? float(y) / 4 : (float(y) + 0.5f) / 5);
      const Vec3 w(0.6f * std::sin(theta), std::cos(theta), 0.8f * std::sin(theta));
      EXPECT_NEAR(environment(lit.scene, 0, w).x, 2 * float(1 << y), 1e-4) << polar << y;
    }
  }
}

Scene delta_scene(const Light& light) {
  Scene scene;
  kit::add_mesh(scene, kit::rectangle(Mat4(1)));
  kit::add_light(scene, light);
  finish(scene);
  return scene;
}

TEST(Direct, PointSpotAndDirectional) {
  Light light;
  light.kind = LightKind::point;
  light.position = {0, 0, 3};
  light.radiance = Slot(Rgb(9, 18, 27));
  DirectSample d;
  ASSERT_TRUE(sample_direct(delta_scene(light), 0, Vec3(0), {0.5f, 0.5f}, d));
  EXPECT_EQ(d.radiance, Rgb(1, 2, 3));
  EXPECT_EQ(d.pdf, 1);
  EXPECT_TRUE(d.point.delta_position);
  EXPECT_FALSE(sample_direct(delta_scene(light), 0, light.position, {0.5f, 0.5f}, d));

  light.kind = LightKind::spot;
  light.direction = {0, 0, -1};
  light.cutoff = 0.6f, light.beam = 0.2f;
  const Scene spot = delta_scene(light);
  for (const float angle : {0.0f, 0.1f, 0.3f, 0.4f, 0.59f}) {
    ASSERT_TRUE(sample_direct(spot, 0, {3 * std::tan(angle), 0, 0}, {0.5f, 0.5f}, d)) << angle;
    const float share = angle < 0.2f ? 1 : (0.6f - angle) / 0.4f;
    EXPECT_NEAR(d.radiance.x, share * sqr(std::cos(angle)), 1e-4) << angle;
  }
  EXPECT_FALSE(sample_direct(spot, 0, {3 * std::tan(0.61f), 0, 0}, {0.5f, 0.5f}, d));
  EXPECT_FALSE(sample_direct(spot, 0, {0, 0, 6}, {0.5f, 0.5f}, d));

  light.kind = LightKind::directional;
  light.direction = glm::normalize(Vec3(1, 0, -1));
  const Scene sun = delta_scene(light);
  ASSERT_TRUE(sample_direct(sun, 0, {5, 6, 7}, {0.5f, 0.5f}, d));
  EXPECT_EQ(d.radiance, Rgb(9, 18, 27));
  EXPECT_EQ(d.wi, -light.direction);
  EXPECT_TRUE(d.point.infinite && d.point.delta_direction);
  EXPECT_EQ(environment(sun, 0, d.wi), Rgb(0));
  EXPECT_TRUE(sun.infinite_lights.empty());
}

// Of a cylinder a point beside it sees less than half: no sample is of the rest.
TEST(Direct, CylindersAreSampledWhereTheyFaceThePoint) {
  const LitScene lit = kit::area_scene("cylinder", ShapeKind::cylinder, placed(0.4f, {0.5f, 1, 2}, {1, 2, 3}));
  const Vec3 axis = glm::normalize(Vec3(lit.scene.shapes[0].to_world[2]));
  const Vec3 across = Vec3(lit.scene.shapes[0].to_world[0]), end = Vec3(lit.scene.shapes[0].to_world[3]);
  for (const float distance : {1.001f, 1.1f, 2.0f, 30.0f})
    for (const float along : {-3.0f, 0.5f, 10.0f}) {
      int missed = 0;
      for (uint32_t i = 0; i < 1000; ++i) {
        DirectSample d;
        missed += !sample_direct(lit.scene, 0, end + across * distance + axis * along, kit::random2(i, 3), d);
      }
      EXPECT_LE(missed, 2) << distance << " " << along;
    }
}

// However narrow: single precision tells cosines of small angles from 1 no more.
TEST(Direct, NarrowSpot) {
  for (const float degrees : {1.0f, 0.05f, 0.01f, 1e-3f}) {
    Light light;
    light.kind = LightKind::spot;
    light.position = {0, 0, 1};
    light.direction = {0, 0, -1};
    light.cutoff = degrees * pi / 180, light.beam = 0.5f * light.cutoff;
    const Scene scene = delta_scene(light);
    DirectSample d;
    for (const float part : {0.1f, 0.45f, 0.6f, 0.77f, 0.98f}) {
      ASSERT_TRUE(sample_direct(scene, 0, {std::tan(part * light.cutoff), 0, 0}, {0.5f, 0.5f}, d)) << degrees;
      EXPECT_NEAR(d.radiance.x, std::min(2 - 2 * part, 1.0f), 0.01) << degrees << " " << part;
    }
    EXPECT_FALSE(sample_direct(scene, 0, {std::tan(1.02f * light.cutoff), 0, 0}, {0.5f, 0.5f}, d)) << degrees;
    EmissionSample e;
    double mean = 0;
    constexpr int n = 256;
    for (int i = 0; i < n; ++i) {
      if (!sample_emission(scene, 0, Vec2(0), {(float(i) + 0.5f) / n, 0.3f}, e)) continue;
      mean += e.radiance.x / e.pdf_direction / n;
      EXPECT_EQ(pdf_emission(scene, e.point, e.direction).direction, e.pdf_direction) << degrees;
    }
    const double c = light.cutoff, b = light.beam, expected = pi * (c * c + c * b + b * b) / 3;
    EXPECT_NEAR(mean, expected, 0.01 * expected) << degrees;
    EXPECT_NEAR(power(scene, 0), expected, 1e-3 * expected) << degrees;
  }
}

// Dark, flat and singular lights give nothing rather than NaN.
TEST(Direct, NothingComesOfNothing) {
  DirectSample d;
  const LitScene black = kit::map_scene("black", Mat4(1), kit::float_image(4, 2, [](int, int) { return 0.0f; }));
  EXPECT_EQ(power(black.scene, 0), 0);
  EXPECT_FALSE(sample_direct(black.scene, 0, Vec3(0), {0.3f, 0.4f}, d));
  EXPECT_EQ(pdf_direct(black.scene, light_point(black.scene, 0, {0, 1, 0}), Vec3(0), {0, 1, 0}), 0);
  Mesh flat = kit::rectangle(glm::scale(Mat4(1), Vec3(1, 0, 1)));
  const LitScene line = kit::area_scene("line", ShapeKind::mesh, Mat4(1), false, &flat);
  EXPECT_FALSE(sample_direct(line.scene, 0, {1, 1, 1}, {0.3f, 0.4f}, d));
  const LitScene sphere = kit::area_scene("sphere", ShapeKind::sphere, placed(1, Vec3(1), {0, 0, 0}));
  for (uint32_t i = 0; i < 1000; ++i) {
    const Vec3 x = to_sphere(kit::random2(i, 1));  // on the surface itself
    if (sample_direct(sphere.scene, 0, x, kit::random2(i, 2), d)) {
      ASSERT_TRUE(d.pdf > 0 && d.pdf < infinity && is_finite(d.wi));
    }
  }
}

}  // namespace
}  // namespace ajar
