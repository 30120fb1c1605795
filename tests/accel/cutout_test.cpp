// Masks: what they let pass is not there, for rays of all kinds, on meshes, quadrics and instances.
#include "ajar/scene/cutout.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <utility>

#include "ajar/accel/accel.h"
#include "ajar/core/sampler.h"
#include "ajar/scene/bsdf.h"
#include "ajar/scene/build.h"
#include "ajar/scene/geometry.h"

namespace ajar {
namespace {

uint32_t masked(Scene& scene, const Slot& opacity, uint32_t inner) {
  Material m;
  m.kind = MaterialKind::mask;
  m.weight = opacity, m.nested[0] = inner;
  return add_material(scene, m);
}

uint32_t nothing(Scene& scene) {
  Material m;
  m.kind = MaterialKind::null;
  return add_material(scene, m);
}

// The unit square at z = 0, seen along z.
Scene screen(const Slot& opacity) {
  Scene scene;
  add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, masked(scene, opacity, add_diffuse(scene, Rgb(0.5f))));
  finish(scene);
  return scene;
}

float uniform(uint64_t key) { return to_unit(uint32_t(hash(key, 11) >> 32)); }

// Share of parallel rays along z that are stopped; a shadow ray must agree with each of them.
double stopped(const Accel& accel, const Vec2& from, const Vec2& to, int rays = 20000) {
  int count = 0;
  for (int i = 0; i < rays; ++i) {
    const Vec2 at = from + (to - from) * Vec2(uniform(uint64_t(2 * i)), uniform(uint64_t(2 * i + 1)));
    const Vec3 o(at, 3), d(0, 0, -1);
    Hit hit;
    const bool hits = accel.intersect(o, d, 0, infinity, hit);
    EXPECT_EQ(hits, accel.occluded(o, d, 10));
    count += hits;
  }
  return double(count) / rays;
}

TEST(CutOut, HolesOfACheckerboardAreOpen) {
  Scene scene;
  const Slot board = add_checkerboard(scene, Rgb(1), Rgb(0));
  add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, masked(scene, board, add_diffuse(scene, Rgb(0.5f))));
  add_quad(scene, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}, add_diffuse(scene, Rgb(0.5f)));
  finish(scene);
  const Accel accel(scene);
  int count = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec2 at(uniform(uint64_t(2 * i)), uniform(uint64_t(2 * i + 1)));
    Hit hit;
    ASSERT_TRUE(accel.intersect(Vec3(at, 3), {0, 0, -1}, 0, infinity, hit));
    const bool solid = hit.shape == 0;
    EXPECT_FLOAT_EQ(hit.t, solid ? 3 : 4);
    if (solid) {
      EXPECT_EQ(opacity(scene, 0, hit.prim, hit.bary), 1);
    }
    count += solid;
    EXPECT_EQ(solid, accel.occluded(Vec3(at, 3), {0, 0, -1}, 3.5f));
  }
  EXPECT_NEAR(count, 500, 60);
}

TEST(CutOut, AVeilStopsItsShareAndTheSameRaysAgain) {
  for (const float share : {0.05f, 0.4f, 0.9f}) {
    const Scene scene = screen(share);
    EXPECT_NEAR(stopped(Accel(scene), {0, 0}, {1, 1}), share, 0.012) << share;
  }
  EXPECT_EQ(stopped(Accel(screen(1.0f)), {0, 0}, {1, 1}, 100), 1);
  EXPECT_EQ(stopped(Accel(screen(0.0f)), {0, 0}, {1, 1}, 100), 0);
}

TEST(CutOut, BothSidesOfASphereLetPass) {
  Scene scene;
  add_sphere(scene, Vec3(0), 1, masked(scene, 0.4f, add_diffuse(scene, Rgb(0.5f))));
  finish(scene);
  EXPECT_NEAR(stopped(Accel(scene), {-0.5f, -0.5f}, {0.5f, 0.5f}), 1 - 0.6 * 0.6, 0.012);
}

TEST(CutOut, InstancesHaveTheirMasks) {
  Scene scene = screen(0.4f);
  scene.groups = 1;
  scene.shapes[0].group = 0;
  add_instance(scene, 0, glm::translate(Mat4(1), Vec3(5, 0, 0)));
  finish(scene);
  EXPECT_NEAR(stopped(Accel(scene), {5, 0}, {6, 1}), 0.4, 0.012);
}

TEST(CutOut, QuadricsInGroupsHaveTheirMasks) {
  Scene scene;
  const uint32_t solid = add_diffuse(scene, Rgb(0.5f));
  add_sphere(scene, Vec3(0), 1, solid);
  add_sphere(scene, Vec3(0), 1, masked(scene, 0.4f, solid));
  scene.groups = 1;
  scene.shapes[1].group = 0;
  add_instance(scene, 0, glm::translate(Mat4(1), Vec3(5, 0, 0)));
  finish(scene);
  EXPECT_NEAR(stopped(Accel(scene), {4.5f, -0.5f}, {5.5f, 0.5f}), 1 - 0.6 * 0.6, 0.012);
}

TEST(CutOut, MasksOfMasksMultiply) {
  Scene scene;
  const uint32_t inner = add_diffuse(scene, Rgb(0.5f));
  add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, masked(scene, 0.5f, masked(scene, 0.6f, inner)));
  finish(scene);
  EXPECT_EQ(scene.shapes[0].material, inner);
  EXPECT_FLOAT_EQ(opacity(scene, 0, 0, {0.2f, 0.2f}), 0.3f);
  finish(scene);
  EXPECT_FLOAT_EQ(opacity(scene, 0, 0, {0.2f, 0.2f}), 0.3f) << "finished twice";
  scene.shapes[0].material = inner + 1;  // another material now
  finish(scene);
  EXPECT_FLOAT_EQ(opacity(scene, 0, 0, {0.2f, 0.2f}), 0.6f);
}

// A normal map does not know where light passes: it may be around the mask or inside.
TEST(CutOut, MasksInsideOfMapsAreMasks) {
  Scene scene;
  const uint32_t inner = add_diffuse(scene, Rgb(0.5f)), mask = masked(scene, 0.3f, inner);
  const auto around = [&](MaterialKind kind, uint32_t nested) {
    Material m;
    m.kind = kind, m.nested[0] = nested;
    m.map = Slot(Rgb(0.5f, 0.5f, 1));
    return add_material(scene, m);
  };
  for (const MaterialKind kind : {MaterialKind::bumpmap, MaterialKind::normalmap, MaterialKind::twosided})
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, around(kind, masked(scene, 0.5f, around(kind, mask))));
  add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, around(MaterialKind::bumpmap, nothing(scene)));
  for (int times = 1; times <= 2; ++times) {
    finish(scene);
    for (uint32_t i = 0; i < 3; ++i) {
      ASSERT_NE(scene.shapes[i].mask, none);
      const Material& outer = scene.materials[scene.shapes[i].material];
      EXPECT_EQ(outer.kind, scene.materials[scene.shapes[i].mask].kind);
      EXPECT_EQ(scene.materials[outer.nested[0]].kind, outer.kind);
      EXPECT_EQ(scene.materials[outer.nested[0]].nested[0], inner);
      EXPECT_FLOAT_EQ(opacity(scene, i, 0, {0.2f, 0.2f}), 0.15f) << i;
    }
    EXPECT_TRUE(is_open(scene, scene.shapes[3]));
    EXPECT_FALSE(is_open(scene, scene.shapes[0]));
  }
  scene.materials[scene.shapes[0].mask].map_scale = 7;
  finish(scene);
  EXPECT_EQ(scene.materials[scene.shapes[0].material].map_scale, 7);
}

Material sum(MaterialKind kind, std::array<uint32_t, 4> nested) {
  Material m;
  m.kind = kind, m.nested = nested;
  return m;
}
uint32_t blended(Scene& scene, uint32_t first, uint32_t second, const Slot& weight) {
  Material m = sum(MaterialKind::blend, {first, second, none, none});
  m.weight = weight;
  return add_material(scene, m);
}

// 0.75 of a mask that stops 0.4, 0.25 of nothing; 0.2 of nothing, 0.4 of a mask that stops half, 0.3 of matter.
TEST(CutOut, SumsLetPassByTheirWeights) {
  Scene scene;
  const uint32_t null = nothing(scene), grey = add_diffuse(scene, Rgb(0.5f));
  const uint32_t blend = blended(scene, masked(scene, 0.4f, grey), null, 0.25f);
  Material mixture = sum(MaterialKind::mixture, {null, masked(scene, 0.5f, grey), grey, none});
  mixture.weights = {0.2f, 0.4f, 0.3f, 0};
  const uint32_t mixed = add_material(scene, mixture);
  add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, blend);
  add_quad(scene, {2, 0, 0}, {1, 0, 0}, {0, 1, 0}, mixed);
  add_quad(scene, {4, 0, 0}, {1, 0, 0}, {0, 1, 0}, masked(scene, 0.5f, blend));
  for (int times = 1; times <= 2; ++times) {
    finish(scene);
    EXPECT_FLOAT_EQ(opacity(scene, 0, 0, {0.2f, 0.2f}), 0.3f);
    EXPECT_FLOAT_EQ(opacity(scene, 1, 0, {0.2f, 0.2f}), 0.6f);
    EXPECT_FLOAT_EQ(opacity(scene, 2, 0, {0.2f, 0.2f}), 0.15f);
  }
  const Accel accel(scene);
  EXPECT_NEAR(stopped(accel, {0, 0}, {1, 1}), 0.3, 0.012);
  EXPECT_NEAR(stopped(accel, {2, 0}, {3, 1}), 0.6, 0.012);
  EXPECT_NEAR(stopped(accel, {4, 0}, {5, 1}), 0.15, 0.012);
}

// What is stopped scatters as much as the whole did beside what passed as a delta.
TEST(CutOut, SumsKeepWhatTheyScatter) {
  Scene scene;
  const uint32_t null = nothing(scene), grey = add_diffuse(scene, Rgb(0.5f)), white = add_diffuse(scene, Rgb(0.9f));
  Material mixture = sum(MaterialKind::mixture, {null, masked(scene, 0.5f, white), grey, none});
  mixture.weights = {0.2f, 0.4f, 0.3f, 0};
  const uint32_t mixed = add_material(scene, mixture);
  const uint32_t blend =
      blended(scene, blended(scene, null, grey, 0.7f), white, add_checkerboard(scene, Rgb(1), Rgb(0)));
  for (const uint32_t material : {mixed, blend, masked(scene, 0.5f, mixed)})
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, material);
  finish(scene);
  const auto at = [&](uint32_t shape, const Vec2& bary) {
    Surface s;
    s.shape = shape, s.bary = bary, s.uv = texture_point(scene, shape, 0, bary);
    Bsdf bsdf;
    resolve(scene, s, {0, 0, 1}, s.frame, bsdf);
    return bsdf;
  };
  for (const Vec2& bary : {Vec2(0.1f, 0.2f), Vec2(0.1f, 0.7f)})
    for (uint32_t i = 0; i < 3; ++i) {
      const Bsdf cut = at(i, bary);
      EXPECT_EQ(cut.opacity, 1);
      EXPECT_EQ(cut.pass, 0);
      EXPECT_FALSE(cut.has_delta);
      const uint32_t mask = std::exchange(scene.shapes[i].mask, none), material = scene.shapes[i].material;
      scene.shapes[i].material = mask;
      const Bsdf whole = at(i, bary);
      scene.shapes[i].mask = mask, scene.shapes[i].material = material;
      const float stops = whole.opacity;
      EXPECT_NEAR(opacity(scene, i, 0, bary), stops, 1e-6f);
      const Vec3 up{0, 0, 1};
      EXPECT_NEAR(stops * eval(cut, up, up, Mode::radiance).f.x, eval(whole, up, up, Mode::radiance).f.x, 1e-6f) << i;
    }
}

// Materials may change between two frames.
TEST(CutOut, SumsThatLoseTheirHolesAreSurfaces) {
  Scene scene;
  const uint32_t grey = add_diffuse(scene, Rgb(0.5f)), blend = blended(scene, nothing(scene), grey, 0.3f);
  add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, blend);
  finish(scene);
  EXPECT_EQ(scene.shapes[0].mask, blend);
  scene.materials[blend].nested[0] = grey;
  finish(scene);
  EXPECT_EQ(scene.shapes[0].mask, none);
}

TEST(CutOut, SumsOfNothingAreNotThere) {
  Scene scene;
  const uint32_t null = nothing(scene), grey = add_diffuse(scene, Rgb(0.5f));
  add_sphere(scene, Vec3(0), 1, blended(scene, null, masked(scene, 0.0f, grey), 0.3f));
  add_sphere(scene, Vec3(0), 1, blended(scene, null, grey, 0.3f));
  finish(scene);
  EXPECT_TRUE(is_open(scene, scene.shapes[0]));
  EXPECT_FALSE(is_open(scene, scene.shapes[1]));
}

// Each side of a twosided material has holes of its own: they stay with it.
TEST(CutOut, MasksOfOneSideAreNotCutOut) {
  Scene scene;
  Material m;
  m.kind = MaterialKind::twosided;
  m.nested[0] = masked(scene, 0.3f, add_diffuse(scene, Rgb(0.5f))), m.nested[1] = add_diffuse(scene, Rgb(0.5f));
  const uint32_t sides = add_material(scene, m), blend = blended(scene, nothing(scene), sides, 0.3f);
  for (const uint32_t material : {sides, blend}) add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, material);
  finish(scene);
  for (const Shape& shape : scene.shapes) EXPECT_EQ(shape.mask, none);
  EXPECT_EQ(scene.shapes[0].material, sides);
  EXPECT_EQ(scene.shapes[1].material, blend);
}

TEST(CutOut, NothingIsNotThere) {
  Scene scene;
  const uint32_t null = nothing(scene);
  add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, null);
  add_quad(scene, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, masked(scene, 0.7f, null));
  add_sphere(scene, Vec3(0), 1, null);
  finish(scene);
  for (const Shape& shape : scene.shapes) EXPECT_TRUE(is_open(scene, shape));
  EXPECT_EQ(stopped(Accel(scene), {0, 0}, {1, 1}, 100), 0);
}

TEST(CutOut, LampsKeepTheirMasks) {
  Scene scene = screen(0.4f);
  const uint32_t material = scene.shapes[0].mask;
  scene.shapes[0].material = material, scene.shapes[0].mask = none;
  scene.shapes[0].light = add_light(scene, LightKind::area, Rgb(1));
  scene.lights[0].shape = 0;
  finish(scene);
  EXPECT_EQ(scene.shapes[0].mask, none);
  EXPECT_EQ(scene.shapes[0].material, material);
  EXPECT_EQ(stopped(Accel(scene), {0, 0}, {1, 1}, 100), 1);
}

}  // namespace
}  // namespace ajar
