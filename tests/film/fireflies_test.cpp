// What limits fireflies, against its definition worked out pass by pass, and what it must leave alone.
#include "ajar/film/fireflies.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "ajar/core/sampler.h"

namespace ajar {
namespace {

Film limited_film(int width, int height, bool splats = false) {
  Camera camera;
  camera.crop_width = camera.width = width, camera.crop_height = camera.height = height;
  Film film = make_film(camera, make_filter(FilterKind::box), splats);
  limit_fireflies(film);
  return film;
}

void add_pass(Film& film, const std::vector<Rgb>& camera, double weight = 1) {
  film.camera = camera;
  finish_pass(film, weight);
}

// A number in (0, 1).
double number(uint64_t& state) {
  state = hash(state, 1);
  return (double(state >> 11) + 0.5) * 0x1p-53;
}

// By Pareto's law: no variance up to an exponent of 2, no mean up to 1.
std::vector<Rgb> noise(size_t pixels, double exponent, uint64_t& state) {
  std::vector<Rgb> out;
  for (size_t i = 0; i < pixels; ++i) {
    const auto x = float(std::pow(number(state), -1 / exponent));
    out.emplace_back(x * Vec3(0.5f, 1, 2));
  }
  return out;
}

float channel(const Picture& p, int x, int y, int c = 1) { return p.pixels[size_t(3 * (y * p.width + x) + c)]; }

// (F1) of docs/notation.md, from all that the passes brought.
double by_definition(const std::vector<std::vector<Rgb>>& passes, int width, int height, int x, int y, int c) {
  std::vector<float> brightest;
  for (const std::vector<Rgb>& p : passes) {
    float most = 0;
    for (int py = std::max(0, y - 2); py <= std::min(height - 1, y + 2); ++py)
      for (int px = std::max(0, x - 2); px <= std::min(width - 1, x + 2); ++px)
        most = std::max(most, luminance(p[size_t(py * width + px)]));
    brightest.push_back(most);
  }
  std::sort(brightest.begin(), brightest.end(), std::greater<>());
  const float limit = 2 * brightest[3];
  double sum = 0;
  for (const std::vector<Rgb>& p : passes) {
    const Rgb v = p[size_t(y * width + x)];
    sum += double(v[c]) * std::min(1.0, double(limit) / double(luminance(v)));
  }
  return sum / double(passes.size());
}

TEST(Fireflies, AreLimitedByWhatFourPassesSawAround) {
  uint64_t state = 7;
  for (const auto& [width, height] : {std::pair{9, 7}, std::pair{1, 5}, std::pair{2, 1}}) {
    Film film = limited_film(width, height);
    std::vector<std::vector<Rgb>> passes;
    for (int n = 0; n < 23; ++n) {
      passes.push_back(noise(film.pixels(), 1.5, state));
      add_pass(film, passes.back());
      if (n < 3) continue;
      const Picture found = develop(film);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          for (int c = 0; c < 3; ++c) {
            const double expected = by_definition(passes, width, height, x, y, c);
            ASSERT_NEAR(channel(found, x, y, c), expected, 1e-5 * expected) << x << "," << y << " pass " << n;
          }
    }
  }
}

TEST(Fireflies, WhatComesInEveryPassStays) {
  Film film = limited_film(8, 8);
  std::vector<Rgb> image(64, Rgb(0.1f));
  image[27] = Rgb(1000, 500, 2000);  // a lamp of one pixel
  for (int n = 0; n < 4; ++n) {
    add_pass(film, image);
    EXPECT_FLOAT_EQ(channel(develop(film), 3, 3), 500) << n << ": before the fourth pass nothing is limited";
  }
  EXPECT_FLOAT_EQ(channel(develop(film), 4, 3), 0.1f);
}

// White of 8x8, and the same with a spark at (3, 3).
const std::vector<Rgb> white(64, Rgb(1)), spark = [] {
  std::vector<Rgb> out = white;
  out[27] = Rgb(1e6f);
  return out;
}();

TEST(Fireflies, OneSparkIsTakenBackToTwiceWhatIsAround) {
  Film film = limited_film(8, 8);
  for (int n = 0; n < 9; ++n) add_pass(film, white);
  add_pass(film, spark);
  const Picture found = develop(film);
  EXPECT_FLOAT_EQ(channel(found, 3, 3), 1.1f) << "nine times 1, once 2";
  EXPECT_FLOAT_EQ(channel(found, 4, 3), 1);
  film.camera = spark, film.chunks = chunk_count(film);
  EXPECT_FLOAT_EQ(channel(develop(film), 3, 3), 13 / 11.0f) << "the pass at work is limited as well";
}

TEST(Fireflies, SparksCountAsTheirPassDoes) {
  Film film = limited_film(8, 8);
  for (int n = 0; n < 8; ++n) add_pass(film, white);
  add_pass(film, spark, 4);
  add_pass(film, white, 4);
  EXPECT_NEAR(channel(develop(film), 3, 3), (8 + 4 * 2 + 4) / 16.0, 1e-4);
}

// What light subpaths bring counts with what the camera's do, in the pass at work too.
TEST(Fireflies, SplatsOfThePassAtWorkAreLimited) {
  Film film = limited_film(8, 8, true);
  for (int n = 0; n < 9; ++n) add_pass(film, white);
  film.camera = white, film.chunks = chunk_count(film);
  film.splat[27] = Rgb(1e6f * 64);
  EXPECT_FLOAT_EQ(channel(develop(film), 3, 3), 1.1f) << "nine times 1, once 2";
  EXPECT_FLOAT_EQ(channel(develop(film), 4, 3), 1);
}

// However heavy the tail, what is taken away is of three passes at most: with a mean, it is nothing in the end.
TEST(Fireflies, LimitsFadeAsPassesGoOn) {
  const auto error = [](int passes) {
    Film film = limited_film(16, 16);
    uint64_t state = 3;
    for (int n = 0; n < passes; ++n) add_pass(film, noise(film.pixels(), 2.5, state));
    const Picture found = develop(film);
    double sum = 0, limited = 0;
    for (size_t i = 0; i < film.pixels(); ++i)
      sum += film.camera_sum[i].y / passes, limited += double(found.pixels[3 * i + 1]);
    EXPECT_LT(limited, sum);
    return (sum - limited) / sum;
  };
  const double few = error(16), many = error(4096);
  EXPECT_GT(few, 0.001);
  EXPECT_LT(many, 0.25 * few);
}

TEST(Fireflies, DroppedPassesAreForgotten) {
  Film film = limited_film(4, 4);
  for (int n = 0; n < 4; ++n) add_pass(film, std::vector<Rgb>(16, Rgb(100)));
  drop_passes(film);
  for (int n = 0; n < 3; ++n) add_pass(film, std::vector<Rgb>(16, Rgb(1)));
  std::vector<Rgb> bright(16, Rgb(1));
  bright[5] = Rgb(50);
  add_pass(film, bright);
  EXPECT_FLOAT_EQ(channel(develop(film), 1, 1), 1.25f);
}

}  // namespace
}  // namespace ajar
