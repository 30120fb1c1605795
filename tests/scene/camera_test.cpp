// Cameras: rays and connections are inverses; factor is the density of camera hits; the image is the right way round.
#include "ajar/scene/camera.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "ajar/core/error.h"
#include "ajar/core/sampler.h"

namespace ajar {
namespace {

Mat4 pose(const Vec3& origin, const Vec3& toward) {
  const Vec3 z = glm::normalize(toward), x = glm::normalize(glm::cross(Vec3(0, 1, 0), z)), y = glm::cross(z, x);
  return {Vec4(x, 0), Vec4(y, 0), Vec4(z, 0), Vec4(origin, 1)};
}

TEST(Camera, ImagesHavePixels) {
  Camera c;
  for (const auto& [w, h] : {std::pair{0, 0}, std::pair{0, 8}, std::pair{8, 0}, std::pair{-8, 8}})
    EXPECT_THROW(set_size(c, w, h), Error) << w << "x" << h;
  set_size(c, 1, 1);
  EXPECT_EQ(c.crop_width, 1);
}

struct Case {
  const char* name;
  Camera camera;
};

std::vector<Case> cases() {
  const Mat4 there = pose({1, 2, 3}, {0.3f, -0.4f, 1});
  const Mat4 mirror = there * glm::scale(Mat4(1), Vec3(-1, 1, 1));
  const Mat4 uneven = there * glm::scale(Mat4(1), Vec3(2, 0.5f, 1.5f));
  std::vector<Case> all;
  const auto add = [&](const char* name, CameraKind kind, const Mat4& m) -> Camera& {
    Camera c;
    c.kind = kind;
    c.width = 640, c.height = 360;
    c.crop_width = 640, c.crop_height = 360;
    if (kind == CameraKind::orthographic)
      set_orthographic(c, m);
    else
      set_perspective(c, 70, m);
    if (kind == CameraKind::thinlens) c.aperture = 0.3f, c.focus = 4;
    all.push_back({name, c});
    return all.back().camera;
  };
  add("perspective", CameraKind::perspective, there);
  add("mirrored", CameraKind::perspective, mirror);
  add("uneven", CameraKind::perspective, uneven);
  Camera& crop = add("cropped, off-centre", CameraKind::perspective, there);
  crop.crop_x = 100, crop.crop_y = 50, crop.crop_width = 200, crop.crop_height = 100;
  crop.principal = {0.1f, -0.2f};
  crop.near_clip = 0.5f, crop.far_clip = 1000;
  add("thinlens", CameraKind::thinlens, there);
  add("thinlens, mirrored", CameraKind::thinlens, mirror);
  add("orthographic", CameraKind::orthographic, there);
  add("orthographic, scaled", CameraKind::orthographic, there * glm::scale(Mat4(1), Vec3(3, 2, 1.5f)));
  add("orthographic, sheared", CameraKind::orthographic,
      there * Mat4(Vec4(2, 0, 0, 0), Vec4(0.5f, 1, 0, 0), Vec4(0.3f, 0.4f, 1, 0), Vec4(0, 0, 0, 1)));
  return all;
}

Vec2 random2(uint32_t i, uint32_t salt) {
  const uint64_t h = hash(i, salt);
  return {to_unit(uint32_t(h)), to_unit(uint32_t(h >> 32))};
}
Vec2 in_crop(const Camera& c, const Vec2& u) {
  return {float(c.crop_x) + u.x * float(c.crop_width), float(c.crop_y) + u.y * float(c.crop_height)};
}

TEST(Camera, ConnectionsInvertRays) {
  for (const auto& [name, c] : cases())
    for (uint32_t i = 0; i < 1000; ++i) {
      const Vec2 raster = in_crop(c, random2(i, 1)), lens = random2(i, 2);
      const CameraRay ray = generate(c, raster, lens);
      ASSERT_NEAR(length2(ray.d), 1, 1e-6f);
      const float t =
          std::max(ray.t_min, 0.1f) + std::pow(10.0f, (c.kind == CameraKind::orthographic ? 1 : 2) * random2(i, 3).x);
      const Vec3 x = ray.o + t * ray.d;
      CameraConnection k;
      ASSERT_TRUE(connect(c, x, lens, 0.01f, k)) << name;
      ASSERT_NEAR(k.raster.x, raster.x, 1e-3f) << name;
      ASSERT_NEAR(k.raster.y, raster.y, 1e-3f) << name;
      ASSERT_LT(std::sqrt(length2(k.w + ray.d)), 2e-5f) << name;
      ASSERT_NEAR(raster_factor(c, k.p, x) / k.factor, 1, 2e-5f) << name;
      if (c.kind != CameraKind::orthographic) {
        ASSERT_LT(std::sqrt(length2(k.p - ray.o)), 1e-5f) << name;
      }
    }
}

// The same, worked out in double.
glm::dvec2 raster_in_double(const Camera& c, const Vec3& x) {
  const glm::dvec4 local = glm::inverse(glm::dmat4(c.to_world)) * glm::dvec4(x, 1);
  const glm::dvec2 on_plane = glm::dvec2(local) / local.z / glm::dvec2(c.plane);
  return (0.5 - 0.5 * on_plane) * glm::dvec2(c.width, c.height);
}

// What is subtracted first does not cancel afterwards.
TEST(Camera, ConnectionsAreExactFarFromTheOrigin) {
  for (const float far : {0.0f, 1e4f, 1e5f}) {
    Camera c;
    c.width = c.crop_width = 640, c.height = c.crop_height = 360;
    set_perspective(c, 70, pose(Vec3(far, -0.7f * far, 0.3f * far), {0.3f, -0.4f, 1}));
    for (uint32_t i = 0; i < 1000; ++i) {
      const CameraRay ray = generate(c, in_crop(c, random2(i, 1)), {0, 0});
      const Vec3 x = ray.o + (1 + 9 * random2(i, 2).x) * ray.d;
      CameraConnection k;
      ASSERT_TRUE(connect(c, x, {0, 0}, 2, k)) << far;
      const glm::dvec2 expected = raster_in_double(c, x);
      ASSERT_NEAR(k.raster.x, expected.x, 1e-3) << far;
      ASSERT_NEAR(k.raster.y, expected.y, 1e-3) << far;
    }
  }
}

// The factor falls with the square of the distance, in rooms of any size.
TEST(Camera, FactorIsFiniteForAnySize) {
  Camera c;
  c.width = c.crop_width = 640, c.height = c.crop_height = 360;
  set_perspective(c, 70, pose({0, 0, 0}, {0.3f, -0.4f, 1}));
  const CameraRay ray = generate(c, {200, 100}, {0, 0});
  const double at_one = raster_factor(c, Vec3(0), ray.d);
  for (const double t : {1e-15, 1e-6, 1e6, 1e13, 1e15})
    EXPECT_NEAR(raster_factor(c, Vec3(0), ray.d * float(t)) / at_one * t * t, 1, 1e-5) << t;
}

// Rays through uniform raster positions hit a tilted plane with area density factor |cos| per pixel: the mean over hits
// of 1 / (factor |cos|) inside a patch of the plane is the patch's area per raster area. Both sides are computed.
TEST(Camera, FactorIsTheDensityOfHits) {
  for (const auto& [name, c] : cases()) {
    const Vec2 middle = in_crop(c, {0.5f, 0.5f});
    const CameraRay axis = generate(c, middle, {0.5f, 0.5f});
    const Vec3 n = glm::normalize(-axis.d + Vec3(0.3f, 0.5f, -0.2f)), origin = axis.o + 5.0f * axis.d;
    const Vec3 s = glm::normalize(glm::cross(n, Vec3(0.1f, 0.9f, 0.4f))), t = glm::cross(n, s);
    const double half = c.kind == CameraKind::orthographic ? 0.3 : 0.4;
    double density = 0, claimed = 0;
    constexpr int grid = 1000;
    for (int i = 0; i < grid * grid; ++i) {
      const Vec2 u((float(i % grid) + 0.5f) / grid, (float(i / grid) + 0.5f) / grid);
      const CameraRay ray = generate(c, in_crop(c, u), {0.7f, 0.2f});
      const Vec3 x = ray.o + ray.d * (glm::dot(origin - ray.o, n) / glm::dot(ray.d, n));
      const Vec3 at = x - origin;
      if (std::abs(glm::dot(at, s)) > half || std::abs(glm::dot(at, t)) > half) continue;
      density += 1.0 / (double(grid) * grid);
    }
    density *= double(c.crop_width) * c.crop_height;  // pixels that see the patch
    constexpr int cells = 64;
    for (int i = 0; i < cells * cells; ++i) {
      const double a = ((i % cells + 0.5) / cells * 2 - 1) * half, b = ((i / cells + 0.5) / cells * 2 - 1) * half;
      const Vec3 x = origin + s * float(a) + t * float(b);
      CameraConnection k;
      ASSERT_TRUE(connect(c, x, {0.7f, 0.2f}, 0, k)) << name;
      claimed += k.factor * std::abs(glm::dot(n, k.w)) * (2 * half / cells) * (2 * half / cells);
    }
    EXPECT_GT(density, 100) << name;
    EXPECT_NEAR(claimed / density, 1, 3e-3) << name;
  }
}

// The camera of Bitterli's "veach-ajar": it stands at the translation and looks along the third column; the first
// column points to the left of the image.
TEST(Camera, LooksAsMitsubaDoes) {
  const Mat4 rows(-0.137283f, -0.0319925f, -0.990015f, 4.05402f, 2.71355e-8f, 0.999478f, -0.0322983f, 1.61647f,
                  0.990532f, -0.00443408f, -0.137213f, -2.30652f, 0, 0, 0, 1);
  Camera c;
  c.width = c.crop_width = 1280, c.height = c.crop_height = 720;
  set_perspective(c, 60, glm::transpose(rows));
  const Vec3 eye(4.05402f, 1.61647f, -2.30652f), ahead(-0.990015f, -0.0322983f, -0.137213f);
  const Vec3 left(-0.137283f, 0, 0.990532f);
  const CameraRay middle = generate(c, {640, 360}, {0, 0});
  EXPECT_LT(glm::distance(middle.o, eye), 1e-6f);
  EXPECT_LT(glm::distance(middle.d, ahead), 1e-5f);
  EXPECT_GT(glm::dot(generate(c, {0, 360}, {0, 0}).d, left), 0.49f);  // sin of 30 degrees, half the field of view
  EXPECT_NEAR(glm::dot(generate(c, {0, 360}, {0, 0}).d, ahead), std::cos(pi / 6), 1e-5f);
  EXPECT_GT(generate(c, {640, 0}, {0, 0}).d.y, 0.2f);  // row 0 is on top
  CameraConnection k;
  ASSERT_TRUE(connect(c, eye + 3.0f * ahead, {0, 0}, 0, k));
  EXPECT_NEAR(k.raster.x, 640, 1e-2f);
  EXPECT_NEAR(k.raster.y, 360, 1e-2f);
  ASSERT_TRUE(connect(c, eye + 3.0f * ahead + 0.5f * left, {0, 0}, 0, k));
  EXPECT_LT(k.raster.x, 600);
  EXPECT_FALSE(connect(c, eye - 3.0f * ahead, {0, 0}, 1e6f, k));
}

TEST(Camera, RefusesWhatItDoesNotSee) {
  Camera c;
  set_perspective(c, 90, Mat4(1));
  c.near_clip = 1, c.far_clip = 10;
  CameraConnection k;
  EXPECT_TRUE(connect(c, {0, 0, 5}, {0, 0}, 0, k));
  for (const Vec3& x : {Vec3(0, 0, 0.9f), Vec3(0, 0, 10.1f), Vec3(0, 0, -5), Vec3(0), Vec3(5.1f, 0, 5)})
    EXPECT_FALSE(connect(c, x, {0, 0}, 0, k));
  const float x = 5 * (1 + 2 * 2.0f / 768);  // two pixels outside
  EXPECT_FALSE(connect(c, {x, 0, 5}, {0, 0}, 1.9f, k));
  EXPECT_TRUE(connect(c, {x, 0, 5}, {0, 0}, 2.1f, k));
  EXPECT_NEAR(k.raster.x, -2, 1e-2f);
  const CameraRay ray = generate(c, {0, 288}, {0, 0});
  EXPECT_NEAR(ray.t_min * ray.d.z, 1, 1e-5f);
  EXPECT_NEAR(ray.t_max * ray.d.z, 10, 1e-4f);
}

TEST(Camera, OrthographicStartsAtItsNearPlane) {
  Camera c;
  set_orthographic(c, glm::scale(Mat4(1), Vec3(4, 4, 2)));
  c.near_clip = -3, c.far_clip = 5;
  const CameraRay ray = generate(c, {384, 288}, {0, 0});
  EXPECT_LT(glm::distance(ray.o, Vec3(0, 0, -6)), 1e-5f);
  EXPECT_EQ(ray.t_min, 0);
  EXPECT_NEAR(ray.t_max, 16, 1e-5f);
  CameraConnection k;
  ASSERT_TRUE(connect(c, {-2, 0, -5}, {0, 0}, 0, k));
  EXPECT_NEAR(k.raster.x, 0.75f * 768, 1e-3f);  // x runs to the left
  EXPECT_NEAR(glm::distance(k.p, Vec3(-2, 0, -5)), 1, 1e-5f);
  EXPECT_NEAR(k.factor, 768 * 576 / (8.0f * 6), 0.1f);
  EXPECT_FALSE(connect(c, {0, 0, -6.1f}, {0, 0}, 0, k));
}

TEST(Camera, ThinLensIsSharpInFocusAlone) {
  Camera c;
  c.kind = CameraKind::thinlens;
  set_perspective(c, 60, Mat4(1));
  c.aperture = 0.5f, c.focus = 3;
  const CameraRay a = generate(c, {100, 100}, {0.1f, 0.9f}), b = generate(c, {100, 100}, {0.9f, 0.3f});
  const auto at_depth = [](const CameraRay& r, float z) { return r.o + r.d * ((z - r.o.z) / r.d.z); };
  EXPECT_LT(glm::distance(at_depth(a, 3), at_depth(b, 3)), 1e-6f);
  EXPECT_GT(glm::distance(at_depth(a, 6), at_depth(b, 6)), 0.5f);
  EXPECT_LE(length2(a.o), 0.25f + 1e-6f);
}

}  // namespace
}  // namespace ajar
