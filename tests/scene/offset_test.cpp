// Rays that leave a surface do not find it again: every kind of shape, slivers, instances, every scale, grazing too.
#include <gtest/gtest.h>

#include "ajar/accel/accel.h"
#include "ajar/core/frame.h"
#include "ajar/core/warp.h"
#include "shapes.h"

namespace ajar {
namespace {

using kit::random2;

struct Trial {
  ShapeKind kind = ShapeKind::mesh;
  float width = 1;  // of triangles, relative to their length
  bool instanced = false;
  float size = 1, away = 0;
};

Mesh triangle(const Trial& t, const Vec3& at, uint32_t i) {
  const Vec3 along(random2(i, 1) - 0.5f, random2(i, 2).x - 0.5f), other(random2(i, 3) - 0.5f, random2(i, 4).x - 0.5f);
  Mesh mesh;
  const Vec3 first = at + t.size * Vec3(random2(i, 5), random2(i, 6).x);
  mesh.positions = {first, first + t.size * along,
                    first + t.size * (along * (1 - t.width) * (0.3f + random2(i, 7).x) + t.width * other)};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

Scene scene_of(const Trial& t, uint32_t i) {
  Scene scene;
  const Vec3 at = t.size * t.away * Vec3(0.9f, -0.7f, 0.3f);
  const Vec3 scale = t.kind == ShapeKind::sphere ? Vec3(t.size) : t.size * Vec3(1, 0.5f, 2);
  const Mesh mesh = triangle(t, at, i);
  const bool is_mesh = t.kind == ShapeKind::mesh;
  kit::add_shape(scene, t.kind, is_mesh ? Mat4(1) : kit::placed(float(i), scale, at), is_mesh ? &mesh : nullptr);
  if (t.instanced) {
    scene.groups = 1;
    scene.shapes[0].group = 0;
    const Mat4 m = kit::placed(float(2 * i), {1.5f, 0.7f, -1}, t.size * t.away * Vec3(-1, 2, 0.5f));
    scene.instances.push_back({0, m, Mat4(glm::inverse(glm::dmat4(m)))});
  }
  finish(scene);
  return scene;
}

Vec3 point_on(const Scene& scene, uint32_t i) {
  const Shape& shape = scene.shapes[0];
  const Vec2 u = random2(i, 8);
  Vec3 p;
  if (shape.kind == ShapeKind::mesh) {
    const auto& c = scene.meshes[0].positions;
    const Vec2 b = to_triangle(u);
    p = c[0] * (1 - b.x - b.y) + c[1] * b.x + c[2] * b.y;
  } else {
    p = kit::map(shape.to_world, kit::unit_object(shape.kind, 0.9 * u.x, u.y).p);
  }
  return scene.instances.empty() ? p : Vec3(kit::map(scene.instances[0].to_world, p));
}

// Directions on both sides, a quarter of them grazing.
Vec3 leaving(const Vec3& ng, uint32_t j) {
  Vec3 w = to_cosine_hemisphere(random2(j, 9));
  if (j % 4 == 0) w = glm::normalize(Vec3(w.x, w.y, 1e-3f * w.z));
  if (j % 2 == 0) w.z = -w.z;
  return make_frame(ng).to_world(w);
}

// Hits of a convex quadric's far side by rays into it are no self hits.
bool is_far_side(const Trial& t, const Surface& s, const Vec3& w, const Hit& hit) {
  const bool hollow = t.kind == ShapeKind::sphere || t.kind == ShapeKind::cylinder;
  return hollow && glm::dot(w, s.ng) < 0 && hit.t > -1e-3f * t.size * glm::dot(w, s.ng);
}

int self_hits(const Trial& t) {
  int found = 0;
  for (uint32_t i = 0; i < 60; ++i) {
    const Scene scene = scene_of(t, i);
    const Accel accel(scene);
    for (uint32_t k = 0; k < 10; ++k) {
      const Vec3 target = point_on(scene, 100 * i + k), o = target + 3 * t.size * to_sphere(random2(100 * i + k, 10));
      const Vec3 d = glm::normalize(target - o);
      Hit hit;
      if (!accel.intersect(o, d, 0, infinity, hit)) continue;
      const Surface s = make_surface(scene, hit, o, d);
      for (uint32_t j = 0; j < 20; ++j) {
        const Vec3 w = leaving(s.ng, (i * 100 + k) * 100 + j);
        found += accel.intersect(offset(s.p, s.ng, s.error, w), w, 0, infinity, hit) && !is_far_side(t, s, w, hit);
      }
    }
  }
  return found;
}

TEST(Offset, LeavesTheSurfaceItStartsFrom) {
  for (const bool instanced : {false, true})
    for (const float size : {1e-3f, 1.0f, 1e5f})
      for (const float away : {0.0f, 1.0f, 100.0f}) {
        const auto where = [&](const char* what) {
          return testing::Message() << what << " " << instanced << " " << size << " " << away;
        };
        for (const ShapeKind kind : {ShapeKind::sphere, ShapeKind::disk, ShapeKind::cylinder})
          EXPECT_EQ(self_hits({kind, 1, instanced, size, away}), 0) << where("quadric") << " kind " << int(kind);
        for (const float width : {1.0f, 1e-2f, 1e-3f})
          EXPECT_EQ(self_hits({ShapeKind::mesh, width, instanced, size, away}), 0)
              << where("triangle") << " width " << width;
      }
}

// A ground sphere touches the origin, around which the scene is: rays there start near it however large it is. Seen
// from outside and from inside, near and far.
TEST(Offset, IsSmallOnTheTopOfALargeSphere) {
  for (const float radius : {1e2f, 1e4f, 6.4e6f, 1e7f})
    for (const float away : {0.1f, 10.0f, 1e3f, 10 * radius})
      for (const bool inside : {false, true})
        for (uint32_t i = 0; i < 300; ++i) {
          Scene scene;
          kit::add_shape(scene, ShapeKind::sphere, kit::placed(float(i), Vec3(radius), {0, -radius, 0}));
          finish(scene);
          const Accel accel(scene);
          const Vec3 up = inside ? Vec3(0, -1, 0) : Vec3(0, 1, 0);
          const Vec3 target = std::pow(10.0f, 4 * random2(i, 11).x - 3) * Vec3(random2(i, 12) - 0.5f, 0);
          const Vec3 o = Vec3(target.x, 0, target.y) +
                         std::min(away, inside ? radius / 2 : infinity) * (up + Vec3(random2(i, 13) - 0.5f, 0));
          const Vec3 d = glm::normalize(Vec3(target.x, -1e-3f * away, target.y) - o);
          Hit hit;
          if (!accel.intersect(o, d, 0, infinity, hit)) continue;
          const Surface s = make_surface(scene, hit, o, d);
          EXPECT_LE(s.error, 0x1p-20f * max_abs(s.p) + 1e-12f * (radius + hit.t)) << radius << " from " << away;
          for (uint32_t j = 0; j < 40; ++j) {
            const Vec3 w = leaving(s.ng, i * 100 + j);
            Hit next;
            if (!accel.intersect(offset(s.p, s.ng, s.error, w), w, 0, infinity, next)) continue;
            EXPECT_TRUE(glm::dot(w, s.ng) < 0 && next.t > -1e-3f * radius * glm::dot(w, s.ng))
                << radius << " from " << away << " " << inside;
          }
        }
}

}  // namespace
}  // namespace ajar
