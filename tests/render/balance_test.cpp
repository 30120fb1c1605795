// How many camera subpaths go on, by what roulette makes of the variance and spares of the work.
#include "ajar/scene/load.h"
#include "bytes.h"
#include "kit/files.h"

namespace ajar {
namespace {

using namespace kit;

constexpr uint32_t passes = 8;
constexpr double light = 0.2, off = 0.05;  // of a pixel; of its two halves

Film even_film() {
  Camera camera;
  camera.width = camera.crop_width = 40, camera.height = camera.crop_height = 30;
  Film film = make_film(camera, make_filter(FilterKind::box), false);
  film.passes = passes, film.weight = passes, film.half_weight = passes / 2;
  film.camera_sum.assign(film.pixels(), glm::dvec3(passes * light));
  film.half_sum.assign(film.pixels(), glm::dvec3(0.5 * passes * (light + off)));
  return film;
}

// Samples that bring some pixels something behind their first vertex; others vary as much in all of them.
Balance balance_of(const Film& film, double variance, double work) {
  Balance b;
  b.passes = passes;
  b.work.camera_rays = 600000, b.work.light_rays = 100000, b.work.joins = 300000;
  b.work.beyond = uint64_t(1000000 * work);
  // Half of the samples bring x, the others nothing.
  const double all = estimate_sample_error(film) * (sqr(light) + 0.01), x = std::sqrt(4 * variance * all * 7 / 8);
  b.found.assign(film.pixels(), {float(passes / 2 * x), float(passes / 2 * x * x)});
  return b;
}

float goes_on_after(double variance, double work) {
  const Film film = even_film();
  Balance b = balance_of(film, variance, work);
  rebalance(film, b);
  return b.goes_on;
}

TEST(Balance, SharesOfVarianceAndWorkAreToBeEqual) {
  EXPECT_NEAR(goes_on_after(0.3, 0.1), std::sqrt(3), 1e-3);
  EXPECT_NEAR(goes_on_after(0.12, 0.1), std::sqrt(1.2), 1e-3);
  EXPECT_EQ(goes_on_after(0.9, 0.1), 2) << "a look doubles it at most";
  EXPECT_EQ(goes_on_after(0.1, 0.3), 1) << "fields ask for no more than they did";
  EXPECT_EQ(goes_on_after(0.1, 0), 1);
}

TEST(Balance, LooksOnceAtWhatItSaw) {
  const Film film = even_film();
  Balance b = balance_of(film, 0.3, 0.1);
  rebalance(film, b);
  const float once = b.goes_on;
  rebalance(film, b);
  EXPECT_EQ(b.goes_on, once) << "stopped after a look, and gone on from there";
  for (int i = 0; i < 8; ++i) {
    const float before = b.goes_on;
    b = balance_of(film, 0.9, 0.01), b.goes_on = before;
    rebalance(film, b);
  }
  EXPECT_EQ(b.goes_on, Balance::most);
}

TEST(Balance, OneFireflySaysNothing) {
  const Film film = even_film();
  Balance b = balance_of(film, 0.2, 0.1);
  b.found[7].square = 1e6f;
  rebalance(film, b);
  EXPECT_NEAR(b.goes_on, std::sqrt(2), 1e-3);
}

TEST(Balance, BlackImagesSayNothing) {
  Film film = even_film();
  Balance b = balance_of(film, 0.3, 0.1);
  film.camera_sum.assign(film.pixels(), glm::dvec3(0)), film.half_sum = film.camera_sum;
  rebalance(film, b);
  EXPECT_EQ(b.goes_on, 1);
}

// Behind a ball of glass under a sun, what comes by way of a second vertex is rare and bright. In a closed room it is
// neither.
TEST(Balance, ByScenes) {
  LoadOptions load;
  load.defines = {{"resx", "96"}, {"resy", "54"}};
  const Scene open = load_scene(source_path("scenes/environment/environment.xml"), load);
  const Accel sky(open);
  double sum = 0;  // fireflies are what there is to see: some seeds have none
  for (uint64_t seed = 1; seed <= 8; ++seed) {
    RenderOptions o = options_of("guided-bdpt", 33);
    o.seed = seed;
    sum += double(rendered(open, sky, o).balance.goes_on);
  }
  EXPECT_GT(sum / 8, 1.2);
  Scene closed = stage(64);
  finish(closed);
  const Accel accel(closed);
  const RenderState state = rendered(closed, accel, options_of("guided-bdpt", 33));
  EXPECT_EQ(state.balance.goes_on, 1);
  EXPECT_GT(state.balance.work.beyond, 0u);
  RenderOptions direct = options_of("guided-bdpt", 33);
  direct.max_depth = 2;
  const Counters work = rendered(closed, accel, direct).balance.work;
  EXPECT_LT(work.beyond, work.camera_paths / 3) << "most go on in any case, to the lamp perhaps";
}

}  // namespace
}  // namespace ajar
