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
  const Repeats plan{.batches = 16, .passes = 250};
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

double sum(const std::vector<glm::dvec3>& layer) {
  double energy = 0;
  for (const glm::dvec3& pixel : layer) energy += double(luminance(Rgb(pixel)));
  return energy;
}

// What the ledger says of a strategy is what its image holds, but for splats at the border, whose filter goes over it.
void expect_accounted(const std::string& integrator) {
  RenderOptions options = statistical(integrator, 4);
  options.spp = 12;  // the young passes of a guided render are no part of it
  options.techniques = true;
  const Scene scene = panels(Material{}, LightKind::area);
  const Accel accel(scene);
  RenderState state = start_render(scene, options);
  render(scene, accel, options, state, {});
  Ledger& ledger = state.stats.ledger;
  double energy = 0;
  for (const auto& [st, layer] : state.pyramid.layers) {
    const StrategyCost& cost = ledger.at(st.first, st.second);
    const double there = sum(layer.weighted);
    energy += there;
    EXPECT_NEAR(cost.energy, there, (st.second == 1 ? 0.05 : 1e-5) * there) << st.first << ' ' << st.second;
    EXPECT_GE(cost.joins, cost.visible);
    EXPECT_GT(cost.visible, 0u);
    EXPECT_EQ(cost.rays >= cost.visible, st.first > 0) << "only s = 0 sends no shadow rays";
  }
  EXPECT_GT(state.pyramid.layers.size(), 5u);
  EXPECT_NEAR(total_energy(ledger), energy, 0.01 * energy);
}
TEST(Ledger, HoldsWhatStrategiesBring) { expect_accounted("bdpt"); }
TEST(Ledger, ForgetsDroppedPasses) { expect_accounted("guided-bdpt"); }

// Whatever was evaluated together with others, a path tracer's two strategies are the image.
TEST(Ledger, OfOneSidedIntegrators) {
  for (const char* integrator : {"path", "light"}) {
    RenderOptions options = statistical(integrator, 4);
    options.spp = 256;
    const Scene scene = panels(Material{}, LightKind::area);
    const Accel accel(scene);
    RenderState state = start_render(scene, options);
    render(scene, accel, options, state, {});
    const Ledger& ledger = state.stats.ledger;
    std::vector<glm::dvec3> image = state.film.camera_sum;
    for (size_t i = 0; i < state.film.splat_sum.size(); ++i) image[i] += state.film.splat_sum[i];
    const double border = options.integrator == "light" ? 0.06 : 1e-5;  // the lamp is cut by it
    EXPECT_NEAR(total_energy(ledger), sum(image), border * sum(image)) << integrator;
    uint64_t rays = 0;
    for (const auto& row : ledger.strategies)
      for (const StrategyCost& c : row) rays += c.rays;
    EXPECT_EQ(rays, state.stats.counters.shadow_rays) << integrator;
    EXPECT_GT(ledger.camera_ticks + ledger.light_ticks, 0u);
    EXPECT_EQ(ledger.learn_ticks, 0u);
    EXPECT_GT(total_ticks(ledger), join_ticks(ledger));
    EXPECT_GT(join_ticks(ledger), 0u);
  }
}

}  // namespace
}  // namespace ajar
