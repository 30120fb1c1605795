// Shadow rays between surfaces that see each other: neither end may shadow itself, however far the other is.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "ajar/path/walk.h"
#include "ajar/scene/geometry.h"
#include "kit/stage.h"

namespace ajar {
namespace {

using namespace kit;

struct Convex {
  const char* name;
  uint32_t (*make)(Scene&, const Vec3& centre, float size);
};
void PrintTo(const Convex& c, std::ostream* out) { *out << c.name; }

Mat4 turned(const Vec3& centre, float size) {
  return glm::scale(glm::rotate(glm::translate(Mat4(1), centre), 1.3f, glm::normalize(Vec3(1, 2, 3))), Vec3(size));
}

const Convex shapes[] = {
    {"globe", [](Scene& s, const Vec3& c, float size) { return add_mesh(s, globe(c, size, 5), 0); }},
    {"fine_globe", [](Scene& s, const Vec3& c, float size) { return add_mesh(s, globe(c, size, 50), 0); }},
    {"quad",
     [](Scene& s, const Vec3& c, float size) {
       return add_quad(s, c, size * Vec3(0.7f, 0.3f, 0.2f), size * Vec3(-0.2f, 0.3f, 0.6f), 0);
     }},
    {"sphere", [](Scene& s, const Vec3& c, float size) { return add_sphere(s, c, size, 0); }},
    {"disk", [](Scene& s, const Vec3& c, float size) { return add_quadric(s, ShapeKind::disk, turned(c, size), 0); }},
    {"cylinder",
     [](Scene& s, const Vec3& c, float size) { return add_quadric(s, ShapeKind::cylinder, turned(c, size), 0); }},
};

class Shadow : public testing::TestWithParam<Convex> {};

// From points in front of a convex surface to points on it.
TEST_P(Shadow, NothingShadowsItself) {
  std::mt19937 random(1);
  const auto u = [&] { return std::uniform_real_distribution<float>(0, 1)(random); };
  for (const Vec3& centre : {Vec3(0.3f, 0, 0), Vec3(30, -20, 10)})
    for (const float size : {0.01f, 0.25f, 5.0f}) {
      Scene scene;
      add_diffuse(scene, Rgb(0.5f));
      const uint32_t shape = GetParam().make(scene, centre, size);
      add_area_light(scene, shape, Rgb(1));
      finish(scene);
      const Accel accel(scene);
      for (const float reach : {0.5f, 2.0f, 20.0f, 500.0f})
        for (int i = 0; i < 3000; ++i) {
          const Vec3 x = centre + size * reach * (Vec3(u(), u(), u()) * 2.0f - 1.0f);
          float pdf;
          const Surface at = sample_area(scene, shape, {u(), u()}, pdf);
          const float distance = glm::length(x - at.p);
          const Vec3 w = (x - at.p) / distance;
          if (!(glm::dot(w, at.ng) > 1e-3f)) continue;
          const Vec3 end = shadow_end(at.p, at.ng, at.error, w, distance);
          ASSERT_FALSE(accel.occluded(x, end - x, 1)) << "size " << size << ", distance " << distance;
          const Vec3 start = offset(at.p, at.ng, at.error, w);
          ASSERT_FALSE(accel.occluded(start, x - start, 1)) << "size " << size << ", distance " << distance;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Shadow, testing::ValuesIn(shapes),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace ajar
