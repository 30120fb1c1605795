#include "kit/ztest.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace {

using namespace ajar::kit;

constexpr int width = 48, height = 32;

using Random = std::minstd_rand;
using Draw = std::function<double(Random&)>;               // one sample of mean 1
using Scale = std::function<double(int x, int y, int c)>;  // expectation of a pixel

double brightness(int x, int y) { return x < width / 2 ? 1 : 0.05 + 0.002 * y; }
double plain(int x, int y, int) { return brightness(x, y); }

// A rendering: samples per pixel, of which the three channels are multiples.
Estimate render(Random& random, const Draw& draw, int samples, const Scale& scale = plain) {
  Estimate e{width, height, {}, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double sum = 0, sum2 = 0;
      for (int i = 0; i < samples; ++i) {
        const double v = draw(random);
        sum += v, sum2 += v * v;
      }
      const double mean = sum / samples, variance = std::max(0.0, sum2 / samples - mean * mean) / (samples - 1);
      for (int c = 0; c < 3; ++c) {
        const double s = scale(x, y, c);
        e.mean.push_back(mean * s);
        e.variance.push_back(variance * s * s);
      }
    }
  return e;
}

double uniform(Random& r) { return std::uniform_real_distribution<double>()(r); }
double mild(Random& r) { return 2 * uniform(r); }
double log_normal(Random& r) { return std::lognormal_distribution<double>(-0.5, 1)(r); }
// Most samples are dim; one in 200 is a firefly that carries half of the light.
double firefly(Random& r) { return uniform(r) < 1.0 / 200 ? 100 : uniform(r) / 0.995; }
// Light tracing: a splat comes seldom; many pixels get none.
double splat(Random& r) { return uniform(r) < 0.02 ? 100 * uniform(r) : 0; }
double steady(Random& r) { return 0.96 + 0.08 * uniform(r); }

int refusals(const Draw& one, const Draw& other, int samples, int pairs) {
  Random random(7);
  int refused = 0;
  for (int i = 0; i < pairs; ++i) {
    const ZTest z = z_test(render(random, one, samples), render(random, other, samples), 1e-3);
    if (!z.ok) {
      ++refused;
      if (refused <= 3) std::cout << z.message << "\n";
    }
  }
  return refused;
}

// At a level of 1e-3 at most 3 of 300 pairs of equal expectation are refused (4 or more have a chance of 3e-4).
TEST(ZTest, equal_images_pass) { EXPECT_LE(refusals(mild, mild, 16, 300), 3); }
TEST(ZTest, equal_images_with_long_tails_pass) { EXPECT_LE(refusals(log_normal, log_normal, 16, 300), 3); }
TEST(ZTest, equal_images_with_fireflies_pass) { EXPECT_LE(refusals(firefly, firefly, 32, 150), 2); }
TEST(ZTest, fireflies_against_smooth_pass) { EXPECT_LE(refusals(firefly, mild, 64, 100), 2); }
TEST(ZTest, rare_splats_against_smooth_pass) { EXPECT_LE(refusals(splat, mild, 32, 100), 2); }

// Light tracing with a wide filter: a path comes through rarely, then leaves many splats, each over several pixels.
Estimate splatted(Random& random, int runs, int paths, double scale) {
  std::vector<std::vector<double>> images(size_t(runs), std::vector<double>(width * height * 3));
  for (auto& image : images)
    for (int i = 0; i < paths; ++i) {
      if (uniform(random) > 0.02) continue;
      for (int splat = 0; splat < 12; ++splat) {
        const int x0 = int(uniform(random) * width), y0 = int(uniform(random) * height);
        for (int k = 0; k < 27; ++k) {
          const int x = (x0 + k / 9) % width, y = (y0 + k / 3 % 3) % height;
          image[size_t((y * width + x) * 3 + k % 3)] += scale * width * height / (9 * 12 * 0.02 * paths);
        }
      }
    }
  return estimate(width, height, std::move(images));
}

TEST(ZTest, splats_that_depend_on_each_other_pass_as_runs_only) {
  Random random(13);
  int refused = 0, refused_as_pixels = 0, missed = 0;
  const Scale one = [](int, int, int) { return 1; };
  for (int i = 0; i < 50; ++i) {
    const Estimate smooth = render(random, mild, 64, one);
    Estimate light = splatted(random, 12, 4000, 1);
    refused += !z_test(light, smooth, 1e-3).ok;
    missed += z_test(splatted(random, 12, 4000, 1.25), smooth, 1e-3).ok;
    light.runs.clear();
    refused_as_pixels += !z_test(light, smooth, 1e-3).ok;
  }
  EXPECT_LE(refused, 1);
  EXPECT_EQ(missed, 0);
  EXPECT_GT(refused_as_pixels, 5);
}

TEST(ZTest, one_percent_in_a_region_is_found_and_named) {
  Random random(3);
  for (int i = 0; i < 20; ++i) {
    const Scale shifted = [](int x, int y, int) {
      return brightness(x, y) * (x >= 32 && x < 40 && y >= 16 && y < 24 ? 1.01 : 1);
    };
    const ZTest z = z_test(render(random, steady, 32, shifted), render(random, steady, 32), 1e-4);
    EXPECT_FALSE(z.ok) << z.message;
    EXPECT_TRUE(z.worst_x >= 32 && z.worst_x < 40 && z.worst_y >= 16 && z.worst_y < 24) << z.message;
    EXPECT_GT(z.worst_z, 0);
  }
}

TEST(ZTest, a_shift_of_one_channel_everywhere_is_found_by_the_mean) {
  Random random(5);
  const Scale shifted = [](int x, int y, int c) { return brightness(x, y) * (c == 2 ? 0.985 : 1); };
  const ZTest z = z_test(render(random, mild, 64, shifted), render(random, mild, 64), 1e-4);
  EXPECT_GT(z.p_max, 1e-4) << z.message;
  EXPECT_LT(z.p_mean, 1e-3) << z.message;
}

TEST(ZTest, a_shift_under_fireflies_is_found) {
  Random random(9);
  const Scale shifted = [](int x, int y, int) { return brightness(x, y) * 1.3; };
  const ZTest z = z_test(render(random, firefly, 64, shifted), render(random, firefly, 64), 1e-4);
  EXPECT_FALSE(z.ok) << z.message;
}

TEST(ZTest, a_pixel_lost_is_found) {
  Random random(11);
  Estimate a = render(random, mild, 64);
  const Estimate b = render(random, mild, 64);
  for (int y = 8; y < 12; ++y)
    for (int x = 8; x < 12; ++x)
      for (int c = 0; c < 3; ++c) a.mean[size_t((y * width + x) * 3 + c)] *= 0.8;
  const ZTest z = z_test(a, b, 1e-4);
  EXPECT_FALSE(z.ok) << z.message;
  EXPECT_EQ(z.worst_x, 8);
  EXPECT_EQ(z.worst_y, 8);
  EXPECT_LT(z.worst_z, 0);
}

TEST(ZTest, exact_images) {
  const size_t n = width * height * 3;
  const Estimate one{width, height, std::vector<double>(n, 1), std::vector<double>(n, 0)};
  Estimate rounded = one, wrong = one, nan = one,
           black{width, height, std::vector<double>(n, 0), std::vector<double>(n, 0)};
  for (double& x : rounded.mean) x += 1e-6;
  for (double& x : wrong.mean) x += 1e-3;
  nan.mean[5] = std::nan("");
  EXPECT_TRUE(z_test(one, one).ok);
  EXPECT_TRUE(z_test(one, rounded).ok);
  EXPECT_FALSE(z_test(one, wrong).ok);
  EXPECT_FALSE(z_test(one, nan).ok);
  EXPECT_TRUE(z_test(black, black).ok);
  EXPECT_FALSE(z_test(one, black).ok);
  EXPECT_FALSE(z_test(one, {width, height - 1, {}, {}}).ok);
}

}  // namespace
