// Rays against brute force in double, on meshes, quadrics and instances; watertightness; nothing to hit.
#include "ajar/accel/accel.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <optional>
#include <random>

#include "accel/ids.h"

namespace ajar {
namespace {

using DVec3 = glm::dvec3;

struct Random {
  std::mt19937_64 engine;
  double uniform(double a = 0, double b = 1) { return std::uniform_real_distribution<double>(a, b)(engine); }
  Vec3 box() { return Vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)); }
  Vec3 direction() {
    for (;;)
      if (const Vec3 v = box(); length2(v) > 0.01f && length2(v) < 1) return glm::normalize(v);
  }
  Mat4 transform() {  // turned, moved, unevenly scaled, sometimes mirrored
    Mat4 m = glm::translate(Mat4(1), box());
    m = glm::rotate(m, float(uniform(0, 6)), direction());
    return glm::scale(m, Vec3(uniform(0.3, 2), uniform(0.3, 2), uniform(0.3, 2) * (uniform() < 0.5 ? -1 : 1)));
  }
};

void add_mesh(Scene& scene, Mesh mesh, uint32_t group = none) {
  Shape shape;
  shape.mesh = uint32_t(scene.meshes.size());
  shape.group = group;
  scene.meshes.push_back(std::move(mesh));
  scene.shapes.push_back(shape);
}

void add_quadric(Scene& scene, ShapeKind kind, const Mat4& to_world, uint32_t group = none) {
  Shape shape;
  shape.kind = kind;
  shape.to_world = to_world;
  shape.to_object = glm::inverse(to_world);
  shape.group = group;
  scene.shapes.push_back(shape);
}

// With a material for its shapes.
Scene& finished(Scene& scene) {
  scene.materials.resize(1);
  finish(scene);
  return scene;
}

Mesh random_triangles(Random& random, int n, float size) {
  Mesh mesh;
  for (int i = 0; i < n; ++i) {
    const Vec3 at = random.box();
    for (int k = 0; k < 3; ++k) mesh.positions.push_back(at + size * random.box());
    mesh.triangles.push_back(glm::uvec3(3 * i, 3 * i + 1, 3 * i + 2));
  }
  return mesh;
}

Mesh transformed(Mesh mesh, const Mat4& m) {
  for (Vec3& p : mesh.positions) p = Vec3(m * Vec4(p, 1));
  return mesh;
}

// Sphere of triangles: an octahedron divided n times, vertices moved at random by jitter; closed and star-shaped.
Mesh ball(int n, float jitter, Random& random) {
  Mesh mesh;
  mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < n; ++level) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [it, fresh] = middles.try_emplace(std::minmax(a, b), uint32_t(mesh.positions.size()));
      if (fresh) mesh.positions.push_back(glm::normalize(mesh.positions[a] + mesh.positions[b]));
      return it->second;
    };
    std::vector<glm::uvec3> finer;
    for (const glm::uvec3 t : mesh.triangles) {
      const uint32_t a = middle(t.x, t.y), b = middle(t.y, t.z), c = middle(t.z, t.x);
      finer.insert(finer.end(), {{t.x, a, c}, {t.y, b, a}, {t.z, c, b}, {a, b, c}});
    }
    mesh.triangles = finer;
  }
  for (Vec3& p : mesh.positions) p *= 1 + jitter * float(random.uniform(-1, 1));
  return mesh;
}

// t of the hit, weights of the 2nd and 3rd vertex (Cramer's rule); doubtful within 1e-5 of the border.
struct BruteHit {
  double t = infinity, u = 0, v = 0;
  uint32_t prim = none;
  bool doubtful = false;
};

BruteHit brute_force(const Mesh& mesh, const DVec3& o, const DVec3& d) {
  BruteHit best;
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::uvec3 k = mesh.triangles[i];
    const DVec3 a(mesh.positions[k.x]), e1 = DVec3(mesh.positions[k.y]) - a, e2 = DVec3(mesh.positions[k.z]) - a;
    const glm::dmat3 m(e1, e2, -d);
    const double det = glm::determinant(m);
    if (det == 0) continue;
    const DVec3 uvt = glm::inverse(m) * (o - a);
    const double border = std::min({uvt.x, uvt.y, 1 - uvt.x - uvt.y});
    if (!(uvt.z > -1e-5)) continue;
    if (border < -1e-5 || uvt.z > best.t) continue;
    if (border < 1e-5 || std::abs(uvt.z) < 1e-5) {
      best.doubtful = true;
      continue;
    }
    best = {uvt.z, uvt.x, uvt.y, i, best.doubtful};
  }
  return best;
}

TEST(Accel, FindsTheNearestTriangle) {
  Random random{std::mt19937_64(1)};
  Scene scene;
  add_mesh(scene, random_triangles(random, 300, 0.3f));
  const Accel accel(finished(scene));
  int hits = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 o = 2.0f * random.box(), d = random.direction() * float(random.uniform(0.1, 3));
    const BruteHit expected = brute_force(scene.meshes[0], o, d);
    if (expected.doubtful) continue;
    Hit hit;
    const bool found = accel.intersect(o, d, 0, infinity, hit);
    ASSERT_EQ(found, expected.prim != none);
    ASSERT_EQ(accel.occluded(o, d, infinity), found);
    if (!found) continue;
    ++hits;
    ASSERT_EQ(hit.prim, expected.prim);
    ASSERT_EQ(hit.shape, 0u);
    ASSERT_EQ(hit.instance, none);
    ASSERT_NEAR(hit.t, expected.t, 1e-5 * (1 + expected.t));
    ASSERT_NEAR(hit.bary.x, expected.u, 1e-3);
    ASSERT_NEAR(hit.bary.y, expected.v, 1e-3);
    ASSERT_TRUE(accel.occluded(o, d, hit.t * 1.001f));
    ASSERT_FALSE(accel.occluded(o, d, hit.t * 0.999f));
    Hit other;
    ASSERT_FALSE(accel.intersect(o, d, 0, hit.t * 0.999f, other));
    ASSERT_TRUE(!accel.intersect(o, d, hit.t * 1.001f, infinity, other) || other.t > hit.t);
  }
  EXPECT_GT(hits, 500);
}

// First sign change of the implicit surface along the ray, by steps and bisection; independent of the closed form.
std::optional<double> march(ShapeKind kind, const DVec3& o, const DVec3& d, double far) {
  const auto value = [&](double t) {
    const DVec3 p = o + d * t;
    return kind == ShapeKind::disk ? p.z : kind == ShapeKind::sphere ? glm::dot(p, p) - 1 : p.x * p.x + p.y * p.y - 1;
  };
  const auto there = [&](double t) {
    const DVec3 p = o + d * t;
    return kind == ShapeKind::disk ? p.x * p.x + p.y * p.y <= 1 : kind == ShapeKind::sphere || (p.z >= 0 && p.z <= 1);
  };
  constexpr int steps = 4000;
  for (int i = 0; i < steps; ++i) {
    double a = far * i / steps, b = far * (i + 1) / steps;
    const bool sign = value(a) > 0;
    if (sign == (value(b) > 0)) continue;
    for (int k = 0; k < 60; ++k) {
      const double m = 0.5 * (a + b);
      (value(m) > 0) == sign ? a = m : b = m;
    }
    if (there(a)) return a;
  }
  return std::nullopt;
}

void quadric_against_marching(ShapeKind kind) {
  Random random{std::mt19937_64(uint64_t(kind) + 11)};
  int hits = 0, doubtful = 0, rays = 0;
  for (int k = 0; k < 20; ++k) {
    Mat4 m = random.transform();
    if (kind == ShapeKind::sphere) m = glm::scale(glm::translate(Mat4(1), random.box()), Vec3(random.uniform(0.3, 1)));
    Scene scene;
    add_quadric(scene, kind, m);
    const Accel accel(finished(scene));
    for (int i = 0; i < 100; ++i, ++rays) {
      const Vec3 o = 2.5f * random.box(), d = random.direction();
      const glm::dmat4 inverse(glm::inverse(glm::dmat4(m)));
      const DVec3 lo(inverse * glm::dvec4(DVec3(o), 1)), ld(inverse * glm::dvec4(DVec3(d), 0));
      const auto expected = march(kind, lo, ld, 12);
      Hit hit;
      const bool found = accel.intersect(o, d, 0, infinity, hit);
      ASSERT_EQ(found, accel.occluded(o, d, infinity));
      if (found != expected.has_value()) {  // grazing, or at the rim
        ++doubtful;
        continue;
      }
      if (!found) continue;
      ++hits;
      if (std::abs(hit.t - *expected) > 1e-4 * (1 + *expected)) ++doubtful;
    }
  }
  EXPECT_GE(hits, rays / 40);
  EXPECT_LE(doubtful, rays / 200);
}

TEST(Accel, Sphere) { quadric_against_marching(ShapeKind::sphere); }
TEST(Accel, Disk) { quadric_against_marching(ShapeKind::disk); }
TEST(Accel, Cylinder) { quadric_against_marching(ShapeKind::cylinder); }

// A disk in a coordinate plane has a box without thickness.
TEST(Accel, FlatDiskIsHitEverywhere) {
  Random random{std::mt19937_64(5)};
  Scene scene;
  add_quadric(scene, ShapeKind::disk, Mat4(1));
  const Accel accel(finished(scene));
  for (int i = 0; i < 10000; ++i) {
    const float r = float(random.uniform(0, 0.999)), phi = float(random.uniform(0, 6.28));
    const Vec3 target(r * std::cos(phi), r * std::sin(phi), 0);
    const Vec3 o = target + random.direction() * float(random.uniform(0.01, 100));
    if (o.z == 0) continue;
    Hit hit;
    ASSERT_TRUE(accel.intersect(o, target - o, 0, infinity, hit)) << r;
    ASSERT_NEAR(hit.t, 1, 1e-4);
    ASSERT_NEAR(hit.bary.x, r, 1e-3);
  }
}

TEST(Accel, CornersOfTheInterval) {
  Scene scene;
  add_quadric(scene, ShapeKind::sphere, Mat4(1));
  const Accel accel(finished(scene));
  const Vec3 o(0, 0, -3), d(0, 0, 1);
  Hit hit;
  ASSERT_TRUE(accel.intersect(o, d, 0, infinity, hit));
  EXPECT_FLOAT_EQ(hit.t, 2);
  ASSERT_TRUE(accel.intersect(o, d, 2.5f, infinity, hit));
  EXPECT_FLOAT_EQ(hit.t, 4);
  hit.t = -7;
  EXPECT_FALSE(accel.intersect(o, d, 2.5f, 3.5f, hit));
  EXPECT_EQ(hit.t, -7) << "a miss must not write the hit";
  EXPECT_FALSE(accel.intersect(o, d, 4.5f, infinity, hit));
  EXPECT_FALSE(accel.occluded(o, d, 1.999f));
  EXPECT_TRUE(accel.occluded(o, d, 2.001f));
  for (const float none_of_it : {0.0f, -1.0f, -infinity, std::nanf("")}) EXPECT_FALSE(accel.occluded(o, d, none_of_it));
}

TEST(Accel, InstancesAreTheTransformedGroup) {
  Random random{std::mt19937_64(3)};
  Scene scene;
  scene.groups = 2;
  add_quadric(scene, ShapeKind::sphere, glm::scale(glm::translate(Mat4(1), Vec3(9, 0, 0)), Vec3(0.5f)));
  add_mesh(scene, random_triangles(random, 60, 0.4f), 0);
  add_mesh(scene, random_triangles(random, 60, 0.4f), 0);
  add_quadric(scene, ShapeKind::disk, Mat4(1), 1);
  std::vector<Mesh> flat;
  for (int i = 0; i < 6; ++i) {
    Instance instance;
    instance.group = 0;
    instance.to_world = random.transform();
    instance.to_object = glm::inverse(instance.to_world);
    for (uint32_t k : {0u, 1u}) flat.push_back(transformed(scene.meshes[k], instance.to_world));
    scene.instances.push_back(instance);
  }
  const Accel accel(finished(scene));
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3 o = 3.0f * random.box(), d = random.direction();
    BruteHit expected;
    size_t where = 0;
    bool doubtful = false;
    for (size_t k = 0; k < flat.size(); ++k) {
      const BruteHit one = brute_force(flat[k], o, d);
      doubtful = doubtful || one.doubtful;
      if (one.t < expected.t) expected = one, where = k;
    }
    if (doubtful) continue;
    Hit hit;
    const bool found = accel.intersect(o, d, 0, infinity, hit);
    if (found && hit.shape == 0) continue;
    ASSERT_EQ(found, expected.prim != none);
    ASSERT_EQ(accel.occluded(o, d, infinity), found);
    if (!found) continue;
    ++hits;
    ASSERT_EQ(hit.instance, where / 2);
    ASSERT_EQ(hit.shape, 1 + where % 2);
    ASSERT_EQ(hit.prim, expected.prim);
    ASSERT_NEAR(hit.t, expected.t, 1e-4 * (1 + expected.t));
  }
  EXPECT_GT(hits, 500);
}

TEST(Accel, InstancedQuadric) {
  Scene scene;
  scene.groups = 1;
  add_quadric(scene, ShapeKind::sphere, Mat4(1), 0);
  Instance instance;
  instance.to_world = glm::scale(glm::translate(Mat4(1), Vec3(5, 0, 0)), Vec3(-1, 2, 0.5f));
  instance.to_object = glm::inverse(instance.to_world);
  scene.instances = {Instance{0, instance.to_world, instance.to_object}};
  const Accel accel(finished(scene));
  Hit hit;
  ASSERT_TRUE(accel.intersect(Vec3(5, 10, 0), Vec3(0, -1, 0), 0, infinity, hit));
  EXPECT_NEAR(hit.t, 8, 1e-5);
  EXPECT_EQ(hit.instance, 0u);
  EXPECT_EQ(hit.shape, 0u);
  EXPECT_FALSE(accel.intersect(Vec3(0, 10, 0), Vec3(0, -1, 0), 0, infinity, hit));
}

// The ray tracer holds memory for every number up to a group's largest: with those of the whole scene thousands of
// groups would take gigabytes.
TEST(Accel, GroupsCountTheirShapesFromZero) {
  Scene scene;
  scene.groups = 3;
  for (const uint32_t group : {none, 2u, 0u, none, 2u, 0u, 2u}) add_quadric(scene, ShapeKind::sphere, Mat4(1), group);
  const GeometryIds ids = number_geometries(scene);
  EXPECT_EQ(ids.of_shape, (std::vector<uint32_t>{0, 0, 0, 3, 1, 1, 2}));
  EXPECT_EQ(ids.first, (std::vector<uint32_t>{0, 2, 2}));
  EXPECT_EQ(ids.shapes, (std::vector<uint32_t>{2, 5, 1, 4, 6}));
}

TEST(Accel, HitsNameTheShapesOfAnyGroup) {
  Random random{std::mt19937_64(7)};
  Scene scene;
  scene.groups = 2;
  const auto at = [](float x) { return glm::translate(Mat4(1), Vec3(x, 0, 0)); };
  add_quadric(scene, ShapeKind::sphere, at(0));
  add_quadric(scene, ShapeKind::sphere, at(0), 1);
  add_mesh(scene, transformed(ball(2, 0, random), at(0)), 0);
  add_mesh(scene, transformed(ball(2, 0, random), at(3)), 1);
  add_quadric(scene, ShapeKind::disk, at(3), 0);
  for (const uint32_t group : {0u, 1u}) scene.instances.push_back({group, at(10 - 20.0f * float(group)), Mat4(1)});
  const Accel accel(finished(scene));
  const std::pair<float, Hit> expected[] = {{0, {.shape = 0, .instance = none}},
                                            {-10, {.shape = 1, .instance = 1}},
                                            {10, {.shape = 2, .instance = 0}},
                                            {-7, {.shape = 3, .instance = 1}},
                                            {13, {.shape = 4, .instance = 0}}};
  for (const auto& [x, there] : expected) {
    Hit hit;
    ASSERT_TRUE(accel.intersect(Vec3(x + 0.1f, 0.2f, 5), Vec3(0, 0, -1), 0, infinity, hit)) << x;
    EXPECT_EQ(hit.shape, there.shape) << x;
    EXPECT_EQ(hit.instance, there.instance) << x;
  }
}

// Rays from within to points on the edges of a closed mesh: none may escape. Exactly at a vertex Embree's robust mode
// lets a few in ten thousand pass, which no random ray ever meets; more would be a change for the worse.
TEST(Accel, ClosedMeshesDoNotLeak) {
  Random random{std::mt19937_64(4)};
  for (const float size : {1e-3f, 1.0f, 1e4f}) {
    Scene scene;
    add_mesh(scene, ball(4, 0.1f, random));
    Mesh& mesh = scene.meshes[0];
    const Vec3 shift = 3.0f * size * random.box();
    for (Vec3& p : mesh.positions) p = p * size + shift;
    const Accel accel(finished(scene));
    int escaped = 0;
    constexpr int rays = 40000;
    for (int i = 0; i < rays; ++i) {
      const glm::uvec3 t = mesh.triangles[size_t(random.uniform(0, double(mesh.triangles.size())))];
      const Vec3 a = mesh.positions[t[i % 3]], b = mesh.positions[t[(i + 1) % 3]];
      const Vec3 o = shift + 0.3f * size * random.box();
      const Vec3 target = glm::mix(a, b, float(random.uniform(0.001, 0.999)));
      Hit hit;
      ASSERT_TRUE(accel.occluded(o, target - o, infinity)) << size;
      ASSERT_TRUE(accel.intersect(o, glm::normalize(target - o), 0, infinity, hit)) << size;
      escaped += !accel.occluded(o, glm::normalize(a - o), infinity);
    }
    EXPECT_LT(escaped, rays / 1000) << size;
  }
}

// The same triangles at another size, alone or in an instance that makes them as large again, are hit where they were:
// within, not at their first corner.
TEST(Accel, SmallTrianglesAreHitWithin) {
  Random random{std::mt19937_64(8)};
  const Mesh mesh = ball(4, 0.1f, random);
  for (const float size : {1.0f, 0x1p-20f, 0x1p-24f})
    for (const bool instanced : {false, true}) {
      Scene scene;
      add_mesh(scene, transformed(mesh, glm::scale(Mat4(1), Vec3(size))), instanced ? 0 : none);
      if (instanced) {
        scene.groups = 1;
        const Mat4 grown = glm::scale(Mat4(1), Vec3(1 / size));
        scene.instances = {Instance{0, grown, glm::inverse(grown)}};
      }
      const Accel accel(finished(scene));
      const float seen = instanced ? 1 : size;
      int hits = 0;
      for (int i = 0; i < 2000; ++i) {
        const uint32_t prim = uint32_t(random.uniform(0, double(mesh.triangles.size())));
        const glm::uvec3 t = mesh.triangles[prim];
        const Vec2 bary(random.uniform(0.1, 0.4), random.uniform(0.1, 0.4));
        const Vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
        const Vec3 target = a + bary.x * (b - a) + bary.y * (c - a), o = 3.0f * random.direction();
        Hit hit;
        ASSERT_TRUE(accel.intersect(seen * o, glm::normalize(target - o), 0, infinity, hit)) << size;
        if (hit.prim != prim) continue;  // another one is before it
        ++hits;
        ASSERT_NEAR(hit.bary.x, bary.x, 0.01f) << size << ' ' << instanced;
        ASSERT_NEAR(hit.bary.y, bary.y, 0.01f) << size << ' ' << instanced;
        ASSERT_NEAR(hit.t / seen, glm::length(target - o), 1e-4f) << size << ' ' << instanced;
      }
      EXPECT_GT(hits, 300);
    }
}

TEST(Accel, NothingToHit) {
  Hit hit;
  Scene empty;
  EXPECT_FALSE(Accel(finished(empty)).intersect(Vec3(0), Vec3(0, 0, 1), 0, infinity, hit));
  EXPECT_FALSE(Accel(finished(empty)).occluded(Vec3(0), Vec3(0, 0, 1), infinity));

  Scene hollow;  // a mesh without triangles, a group without shapes and an instance of it
  hollow.groups = 1;
  add_mesh(hollow, Mesh{});
  hollow.instances.push_back({});
  EXPECT_FALSE(Accel(finished(hollow)).intersect(Vec3(0), Vec3(0, 0, 1), 0, infinity, hit));

  Scene thin;  // triangles without area
  Mesh mesh;
  mesh.positions = {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {0, 0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 0, 0}, {0, 3, 1}};
  add_mesh(thin, mesh);
  const Accel accel(finished(thin));
  for (int i = -100; i <= 100; ++i)
    ASSERT_TRUE(!accel.intersect(Vec3(0.3f, 0.013f * float(i), 0), Vec3(0, 0, 1), 0, infinity, hit) || hit.t == 1);
}

TEST(Accel, MovesAndCountsItsBytes) {
  Random random{std::mt19937_64(6)};
  Scene scene;
  add_mesh(scene, ball(3, 0, random));
  add_quadric(scene, ShapeKind::sphere, glm::scale(Mat4(1), Vec3(0.5f)));
  Accel first(finished(scene));
  EXPECT_GT(first.bytes(), 512u * 12u);
  Accel second(std::move(first));
  Scene empty;
  Accel third(finished(empty));
  third = std::move(second);
  Hit hit;
  ASSERT_TRUE(third.intersect(Vec3(0, 0, -3), Vec3(0, 0.001f, 1), 0, infinity, hit));
  EXPECT_EQ(hit.shape, 0u);
  ASSERT_TRUE(third.intersect(Vec3(0), Vec3(0, 0, 1), 0, 0.9f, hit));
  EXPECT_EQ(hit.shape, 1u);
}

}  // namespace
}  // namespace ajar
