// Each strategy (s, t) alone, unweighted: where all can sample everything, all images of one path length are the same.
#include <gtest/gtest.h>

#include "kit/stage.h"
#include "measure.h"

namespace ajar {
namespace {

using namespace kit;

// Three panels and a ball that do not touch, so that no connection is arbitrarily short; the lamp is large.
Scene panels(const Material& material, LightKind light) {
  Scene scene;
  scene.filter = make_filter(FilterKind::tent);
  set_camera(scene, {0.6f, 0.5f, 4.5f}, {0, -0.2f, 0}, 36, 18, 18);
  const uint32_t grey = add_diffuse(scene, {0.8f, 0.7f, 0.6f}), id = add_material(scene, material);
  add_quad(scene, {-1.2f, -1, 1.2f}, {2.4f, 0, 0}, {0, 0, -2.4f}, id);
  add_quad(scene, {-1.2f, -0.9f, -1.8f}, {2.4f, 0, 0}, {0, 1.8f, 0}, grey);
  const uint32_t top = add_quad(scene, {-0.9f, 1.1f, -0.9f}, {1.8f, 0, 0}, {0, 0, 1.8f}, grey);
  if (light == LightKind::area)
    add_area_light(scene, top, Rgb(2, 3, 4));
  else
    add_light(scene, light, Rgb(1));
  finish(scene);
  return scene;
}

void expect_all_equal(const Scene& scene, int longest) {
  const Plan plan{.batches = 16, .passes = 250};
  const auto images = measure_techniques(scene, statistical("bdpt", longest), plan);
  for (int n = 3; n <= longest + 1; ++n)
    for (int s = 0; s < n; ++s) {
      ASSERT_TRUE(images.contains({s, n - s})) << s << ' ' << n - s;
      if (s != 1)
        expect_same(images.at({s, n - s}), images.at({1, n - 1}),
                    "s = " + std::to_string(s) + " of " + std::to_string(n));
    }
}

TEST(Techniques, Diffuse) { expect_all_equal(panels(Material{}, LightKind::area), 4); }
TEST(Techniques, Glossy) {
  Material m;
  m.kind = MaterialKind::roughplastic;
  m.alpha_u = m.alpha_v = 0.5f;
  expect_all_equal(panels(m, LightKind::area), 3);
}
TEST(Techniques, Sky) { expect_all_equal(panels(Material{}, LightKind::constant), 3); }

}  // namespace
}  // namespace ajar
