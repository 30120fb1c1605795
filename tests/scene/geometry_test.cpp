// Surfaces at hits: position, sides, derivatives, and the offset that leaves the surface at every scale.
#include "ajar/scene/geometry.h"

#include <gtest/gtest.h>

#include "ajar/core/warp.h"
#include "ajar/scene/build.h"
#include "shapes.h"

namespace ajar {
namespace {

using kit::map;
using kit::placed;
using kit::random2;

const ShapeKind quadrics[] = {ShapeKind::sphere, ShapeKind::disk, ShapeKind::cylinder};

Vec3 scale_for(ShapeKind kind, float size, float mirror) {
  return kind == ShapeKind::sphere ? Vec3(mirror * size, size, size) : Vec3(mirror * size, 0.5f * size, 2 * size);
}

void expect_sound(const Surface& s) {
  EXPECT_NEAR(length2(s.ng), 1, 1e-5f);
  EXPECT_NEAR(length2(s.frame.n), 1, 1e-5f);
  EXPECT_GE(glm::dot(s.ng, s.frame.n), 0);
  EXPECT_GT(s.error, 0);
  EXPECT_TRUE(is_finite(s.p) && is_finite(s.dpdu) && is_finite(s.dpdv));
  EXPECT_NEAR(glm::dot(s.frame.s, s.frame.n), 0, 1e-5f);
}

void expect_parallel(const Vec3& a, const glm::dvec3& b, double tolerance) {
  EXPECT_LT(glm::length(glm::dvec3(a) - b), tolerance * std::max(glm::length(b), 1e-30));
}

// Against the definition of each unit object, instances and mirrors included; derivatives against finite differences.
TEST(Geometry, QuadricsAreWhatTheyAreDefinedToBe) {
  for (const ShapeKind kind : quadrics)
    for (const float mirror : {1.0f, -1.0f})
      for (const bool flip : {false, true})
        for (const bool instanced : {false, true}) {
          Scene scene;
          const uint32_t id = kit::add_shape(scene, kind, placed(0.7f, scale_for(kind, 2, mirror), {3, -1, 2}));
          scene.shapes[id].flip = flip;
          Mat4 m = scene.shapes[id].to_world;
          if (instanced) {
            Instance instance{0, placed(-1.1f, {-1.5f, 0.8f, 1}, {10, 0, 5}), Mat4(1)};
            instance.to_object = glm::inverse(instance.to_world);
            m = instance.to_world * m;
            scene.instances.push_back(instance);
          }
          const glm::dmat3 linear{glm::dmat4(m)}, normals = glm::transpose(glm::inverse(linear));
          for (uint32_t i = 0; i < 50; ++i) {
            const glm::dvec2 uv = 0.02 + 0.96 * glm::dvec2(random2(i, 1));
            Vec3 d;
            const Vec3 o(20, 30, -10);
            const Hit hit = kit::quadric_hit(scene, id, uv.x, uv.y, o, d, instanced ? 0 : none);
            const Surface s = make_surface(scene, hit, o, d);
            expect_sound(s);
            const kit::UnitPoint at = kit::unit_object(kind, uv.x, uv.y);
            EXPECT_LT(glm::length(glm::dvec3(s.p) - map(m, at.p)), 2e-5);
            expect_parallel(s.ng, glm::normalize(normals * at.n) * (flip ? -1.0 : 1.0), 2e-5);
            EXPECT_LT(glm::length(glm::dvec2(s.uv) - uv), 1e-6);
            const double h = 1e-5;
            const auto p = [&](double u, double v) { return map(m, kit::unit_object(kind, u, v).p); };
            expect_parallel(s.dpdu, (p(uv.x + h, uv.y) - p(uv.x - h, uv.y)) / (2 * h), 2e-4);
            expect_parallel(s.dpdv, (p(uv.x, uv.y + h) - p(uv.x, uv.y - h)) / (2 * h), 2e-4);
          }
        }
}

Mesh bent_triangle() {
  Mesh mesh;
  mesh.positions = {{1, 0, 0}, {3, 0.5f, 1}, {0.5f, 2, 0.2f}};
  mesh.uvs = {{0.1f, 0.2f}, {0.9f, 0.4f}, {0.3f, 1.5f}};
  mesh.triangles = {{0, 1, 2}};
  const Vec3 n =
      glm::normalize(glm::cross(mesh.positions[1] - mesh.positions[0], mesh.positions[2] - mesh.positions[0]));
  for (const Vec3& tilt : {Vec3(0.3f, 0, 0), Vec3(0, 0.4f, 0), Vec3(0, 0, -0.3f)})
    mesh.normals.push_back(glm::normalize(n + tilt));
  return mesh;
}

TEST(Geometry, TrianglesInterpolate) {
  for (const bool instanced : {false, true}) {
    Scene scene;
    const Mesh mesh = bent_triangle();
    const uint32_t id = kit::add_mesh(scene, mesh);
    Mat4 m(1);
    if (instanced) {
      m = placed(2, {-1, 2, 0.7f}, {1, 2, 3});
      scene.instances[add_instance(scene, 0, m)].to_object = inverse(m);
    }
    const glm::dmat3 normals = glm::transpose(glm::inverse(glm::dmat3(glm::dmat4(m))));
    const glm::dvec3 e1(mesh.positions[1] - mesh.positions[0]), e2(mesh.positions[2] - mesh.positions[0]);
    for (uint32_t i = 0; i < 50; ++i) {
      Vec2 b = random2(i, 2);
      if (b.x + b.y > 1) b = 1.0f - b;
      Hit hit;
      hit.shape = id, hit.bary = b, hit.instance = instanced ? 0 : none;
      const Surface s = make_surface(scene, hit, Vec3(0), Vec3(0, 0, 1));
      expect_sound(s);
      const glm::dvec3 p = glm::dvec3(mesh.positions[0]) + e1 * double(b.x) + e2 * double(b.y);
      EXPECT_LT(glm::length(glm::dvec3(s.p) - map(m, p)), 5e-6);
      expect_parallel(s.ng, glm::normalize(normals * glm::cross(e1, e2)), 1e-5);
      const Vec3 n = mesh.normals[0] * (1 - b.x - b.y) + mesh.normals[1] * b.x + mesh.normals[2] * b.y;
      expect_parallel(s.frame.n, glm::normalize(normals * glm::dvec3(n)), 1e-5);
      // The chain rule: each edge is dpdu, dpdv times its difference in uv.
      for (int e = 1; e <= 2; ++e) {
        const Vec2 duv = mesh.uvs[size_t(e)] - mesh.uvs[0];
        expect_parallel(s.dpdu * duv.x + s.dpdv * duv.y, glm::dmat3(glm::dmat4(m)) * (e == 1 ? e1 : e2), 1e-5);
      }
    }
  }
}

TEST(Geometry, ShadingNormalsLieOnTheSideOfNg) {
  Scene scene;
  Mesh mesh = bent_triangle();
  for (Vec3& n : mesh.normals) n = -n;
  const uint32_t id = kit::add_mesh(scene, mesh);
  Hit hit;
  hit.shape = id, hit.bary = {0.3f, 0.3f};
  const Surface s = make_surface(scene, hit, Vec3(0), Vec3(0, 0, 1));
  expect_sound(s);
  const Vec3 n = glm::cross(mesh.positions[1] - mesh.positions[0], mesh.positions[2] - mesh.positions[0]);
  EXPECT_GT(glm::dot(s.ng, n), 0);  // winding decides
}

bool is_same(const Surface& a, const Surface& b) {
  return a.p == b.p && a.error == b.error && a.ng == b.ng && a.frame.s == b.frame.s && a.frame.t == b.frame.t &&
         a.frame.n == b.frame.n && a.uv == b.uv && a.bary == b.bary && a.dpdu == b.dpdu && a.dpdv == b.dpdv &&
         a.shape == b.shape && a.prim == b.prim && a.instance == b.instance;
}

// A walk sets one Surface after another in the same place: nothing is left of the one before.
TEST(Geometry, SurfacesAreSetAnew) {
  Scene scene;
  Mesh bare = bent_triangle();
  bare.uvs.clear(), bare.normals.clear();
  std::vector<uint32_t> shapes = {kit::add_mesh(scene, bent_triangle()), kit::add_mesh(scene, bare)};
  for (const ShapeKind kind : quadrics)
    shapes.push_back(kit::add_shape(scene, kind, placed(0.7f, Vec3(2), {3, -1, 2})));
  scene.instances[add_instance(scene, 0, placed(2, {-1, 2, 0.7f}, {1, 2, 3}))].to_object =
      inverse(placed(2, {-1, 2, 0.7f}, {1, 2, 3}));
  std::vector<Hit> hits;
  for (const uint32_t shape : shapes)
    for (const uint32_t instance : {none, 0u}) {
      Hit hit;
      hit.t = 2, hit.shape = shape, hit.instance = instance, hit.bary = {0.3f, 0.2f};
      hits.push_back(hit);
    }
  const Vec3 o(0.3f, 0.2f, 2), d(0, 0, -1);
  for (const Hit& before : hits)
    for (const Hit& hit : hits) {
      Surface s = make_surface(scene, before, o, d);
      set_surface(scene, hit, o, d, s);
      EXPECT_TRUE(is_same(s, make_surface(scene, hit, o, d))) << before.shape << ' ' << hit.shape;
    }
}

TEST(Geometry, UselessTextureCoordinatesGiveZeroTangents) {
  for (const bool none_at_all : {true, false}) {
    Scene scene;
    Mesh mesh = bent_triangle();
    if (none_at_all)
      mesh.uvs.clear();
    else
      mesh.uvs = {{0.1f, 0.1f}, {0.2f, 0.2f}, {0.5f, 0.5f}};
    Hit hit;
    hit.shape = kit::add_mesh(scene, mesh);
    hit.bary = {0.25f, 0.5f};
    const Surface s = make_surface(scene, hit, Vec3(0), Vec3(0, 0, 1));
    expect_sound(s);
    EXPECT_EQ(s.dpdu, Vec3(0));
    EXPECT_EQ(s.dpdv, Vec3(0));
    if (none_at_all) {
      EXPECT_EQ(s.uv, hit.bary);
    }
  }
}

TEST(Geometry, TinyAndHugeTrianglesHaveNormals) {
  for (const float size : {1e-15f, 1e-8f, 1.0f, 1e8f, 1e14f}) {
    Scene scene;
    Mesh mesh = bent_triangle();
    for (Vec3& p : mesh.positions) p *= size;
    Hit hit;
    hit.shape = kit::add_mesh(scene, mesh);
    hit.bary = {0.2f, 0.2f};
    const Surface s = make_surface(scene, hit, Vec3(0), Vec3(0, 0, 1));
    EXPECT_NEAR(glm::dot(s.ng, glm::normalize(glm::cross(Vec3(2, 0.5f, 1), Vec3(-0.5f, 2, 0.2f)))), 1, 1e-5f) << size;
  }
}

// A point moved by its error lies clear of the surface on the right side, in exact arithmetic; and not far off it.
TEST(Geometry, OffsetsLeaveQuadricsAtEveryScale) {
  for (const ShapeKind kind : quadrics)
    for (const float size : {1e-3f, 1.0f, 1e3f, 1e5f})
      for (const float away : {0.0f, 1.0f, 1e3f}) {
        Scene scene;
        const Vec3 at = size * away * Vec3(1, -0.7f, 0.4f);
        const uint32_t id = kit::add_shape(scene, kind, placed(0.7f, scale_for(kind, size, 1), at));
        const Shape& shape = scene.shapes[id];
        for (uint32_t i = 0; i < 300; ++i) {
          const glm::dvec2 uv = 0.01 + 0.98 * glm::dvec2(random2(i, 3));
          Vec3 d;
          const Vec3 o = at + size * 50.0f * Vec3(0.3f, 0.8f, -0.6f);
          const Surface s = make_surface(scene, kit::quadric_hit(scene, id, uv.x, uv.y, o, d), o, d);
          for (const float side : {1.0f, -1.0f}) {
            const glm::dvec3 q = map(shape.to_object, glm::dvec3(offset(s.p, s.ng, s.error, side * s.ng)));
            const double height = kind == ShapeKind::disk       ? q.z
                                  : kind == ShapeKind::cylinder ? std::sqrt(q.x * q.x + q.y * q.y) - 1
                                                                : glm::length(q) - 1;
            ASSERT_GT(height * side, 0) << int(kind) << " size " << size << " away " << away;
          }
          ASSERT_LT(s.error, 1e-5f * size * (3 + away));
        }
      }
}

TEST(Geometry, OffsetsLeaveTrianglesAtEveryScale) {
  for (const float size : {1e-3f, 1.0f, 1e5f})
    for (const float away : {0.0f, 1.0f, 100.0f})
      for (const bool instanced : {false, true})
        for (uint32_t i = 0; i < 300; ++i) {
          Scene scene;
          Mesh mesh;
          for (uint32_t k = 0; k < 3; ++k)
            mesh.positions.push_back(size *
                                     (Vec3(random2(i, 10 + k), random2(i, 20 + k).x) + away * Vec3(1, -0.5f, 0.3f)));
          mesh.triangles = {{0, 1, 2}};
          Hit hit;
          hit.shape = kit::add_mesh(scene, mesh);
          Mat4 m(1);
          if (instanced) {
            m = placed(float(i), {1, 1, -1}, size * Vec3(3, 2, 1));
            scene.instances.push_back({0, m, Mat4(glm::inverse(glm::dmat4(m)))});
            hit.instance = 0;
          }
          Vec2 b = random2(i, 4);
          if (b.x + b.y > 1) b = 1.0f - b;
          hit.bary = b;
          const Surface s = make_surface(scene, hit, Vec3(0), Vec3(0, 0, 1));
          const glm::dvec3 p0 = map(m, glm::dvec3(mesh.positions[0]));
          glm::dvec3 n = glm::normalize(
              glm::cross(map(m, glm::dvec3(mesh.positions[1])) - p0, map(m, glm::dvec3(mesh.positions[2])) - p0));
          if (glm::dot(n, glm::dvec3(s.ng)) < 0) n = -n;
          for (const float side : {1.0f, -1.0f}) {
            const Vec3 o = offset(s.p, s.ng, s.error, side * s.ng);
            ASSERT_GT(side * glm::dot(glm::dvec3(o) - p0, n), 0) << size << " " << away << " " << instanced;
          }
          const float edge = glm::distance(mesh.positions[0], mesh.positions[1]);
          const bool sliver = triangle_area(mesh, 0) < 0.02f * size * size || edge < 0.1f * size;
          ASSERT_LT(s.error, (sliver ? 1e-3f : 2e-5f) * size * (1 + away));
        }
}

TEST(Geometry, AreasAreExact) {
  Scene scene;
  const uint32_t sphere = kit::add_shape(scene, ShapeKind::sphere, placed(1, Vec3(3), {1, 2, 3}));
  const uint32_t disk = kit::add_shape(scene, ShapeKind::disk, placed(1, {2, 3, 7}, {1, 2, 3}));
  const uint32_t cylinder = kit::add_shape(scene, ShapeKind::cylinder, placed(1, {2, 2, 5}, {1, 2, 3}));
  const Mesh mesh = kit::rectangle(placed(1, {2, 3, 7}, {1, 2, 3}));
  const uint32_t rect = kit::add_mesh(scene, mesh);
  EXPECT_NEAR(area(scene, sphere), 36 * pi, 1e-4);
  EXPECT_NEAR(area(scene, disk), 6 * pi, 1e-5);
  EXPECT_NEAR(area(scene, cylinder), 20 * pi, 1e-4);
  EXPECT_NEAR(area(scene, rect), 24, 1e-4);
}

// Mean of a function over samples, weighted by 1 / pdf, is its integral over the surface, also where the transform
// stretches a cylinder unevenly; and area_pdf tells the same density.
TEST(Geometry, AreaSamplesHaveTheirDensity) {
  for (const int kind : {0, 1, 2, 3}) {
    Scene scene;
    const Mat4 m = placed(0.4f, kind == 0 ? Vec3(2) : Vec3(0.5f, 2, 3), {1, 2, 3});
    const Mesh mesh = kit::rectangle(m);
    const uint32_t id = kind == 3 ? kit::add_mesh(scene, mesh) : kit::add_shape(scene, quadrics[kind], m);
    kit::light_up(scene, id, Rgb(1));
    finish(scene);
    const auto f = [](const glm::dvec3& p) { return 1 + 0.2 * p.x * p.y - 0.1 * p.z; };
    double sum = 0, exact = 0;
    constexpr uint32_t n = 1 << 14;
    for (uint32_t i = 0; i < n; ++i) {
      float pdf;
      const Surface s = sample_area(scene, id, make_sampler(SamplerKind::sobol, 1, Side::light, 0, i).next2(), pdf);
      ASSERT_GT(pdf, 0);
      ASSERT_NEAR(area_pdf(scene, id, s.prim, s.uv) / pdf, 1, 1e-4f);
      sum += f(s.p) / pdf / n;
      const glm::dvec3 q = map(scene.shapes[id].to_object, s.p);
      ASSERT_NEAR(glm::dot(s.ng, s.ng), 1, 1e-5f);
      if (kind == 0) {
        ASSERT_NEAR(glm::length(q), 1, 1e-5);
        ASSERT_LT(glm::distance(s.uv, sphere_uv(scene.shapes[id], s.p)), 2e-3f);
      }
    }
    constexpr int g = 400;
    for (int i = 0; i < g * g; ++i) {
      const double u = (i % g + 0.5) / g, v = (i / g + 0.5) / g, h = 1e-4;
      const auto p = [&](double a, double b) {
        return map(m, kind == 3 ? glm::dvec3(2 * a - 1, 2 * b - 1, 0) : kit::unit_object(quadrics[kind], a, b).p);
      };
      const double da = glm::length(glm::cross(p(u + h, v) - p(u - h, v), p(u, v + h) - p(u, v - h))) / (4 * h * h);
      exact += f(p(u, v)) * da / (double(g) * g);
    }
    EXPECT_NEAR(sum / exact, 1, 2e-3) << kind;
  }
}

TEST(Geometry, ShapesWithoutAreaAreNotSampled) {
  Scene scene;
  Mesh mesh;
  mesh.positions = {{1, 1, 1}, {1, 1, 1}, {2, 2, 2}};
  mesh.triangles = {{0, 1, 2}};
  const uint32_t id = kit::add_mesh(scene, mesh);
  kit::light_up(scene, id, Rgb(1));
  finish(scene);
  float pdf = 1;
  sample_area(scene, id, {0.5f, 0.5f}, pdf);
  EXPECT_EQ(pdf, 0);
  EXPECT_EQ(area(scene, id), 0);
  EXPECT_EQ(power(scene, 0), 0);
}

// may_light is quick and must never deny light that sample_direct finds; many normals see none of the lamp.
TEST(Geometry, NoLightIsDeniedThatShines) {
  Scene scene;
  const uint32_t lamp = kit::add_mesh(scene, kit::rectangle(placed(1.1f, {0.7f, 1.3f, 1}, {0.5f, 2, -1})));
  const uint32_t light = kit::light_up(scene, lamp, Rgb(1));
  finish(scene);
  ASSERT_GT(scene.lights[light].rectangle.area, 0);
  int denied = 0;
  constexpr int n = 20000;
  for (uint64_t i = 0; i < n; ++i) {
    const Vec3 x(4.0f * random2(i, 1) - 2.0f, 4 * random2(i, 2).x - 2), normal = to_sphere(random2(i, 3));
    const bool may = may_light(scene, light, x, normal);
    denied += !may;
    DirectSample d;
    const bool shines = sample_direct(scene, light, x, random2(i, 4), d) && glm::dot(normal, d.wi) > 0;
    EXPECT_TRUE(may || !shines) << i;
  }
  EXPECT_GT(denied, n / 3);
}

TEST(Geometry, TangentsWhereABsdfAsks) {
  Material plain, bump, coat, brushed;
  coat.kind = MaterialKind::twosided, coat.nested[0] = 0;
  bump.kind = MaterialKind::bumpmap, bump.nested[0] = 1;
  brushed.kind = MaterialKind::roughconductor, brushed.alpha_v = Slot(0.3f);
  Scene scene;
  scene.materials = {plain, coat, bump, brushed};
  const bool expected[] = {false, false, true, true};
  for (uint32_t i = 0; i < 4; ++i) scene.shapes[kit::add_mesh(scene, kit::rectangle(Mat4(1)))].material = i;
  finish(scene);
  for (uint32_t i = 0; i < 4; ++i) {
    Hit hit;
    hit.shape = i;
    hit.bary = {0.25f, 0.5f};
    const Surface s = make_surface(scene, hit, {0, 0, 5}, {0, 0, -1});
    EXPECT_EQ(s.dpdu != Vec3(0), expected[i]) << i;
    expect_sound(s);
  }
}

}  // namespace
}  // namespace ajar
