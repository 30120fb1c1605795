// How many camera samples each pixel has in a pass, and what a pass is then.
#include <algorithm>
#include <numeric>

#include "ajar/scene/load.h"
#include "kit/files.h"
#include "measure.h"

namespace ajar {
namespace {

using namespace kit;

constexpr int width = 40, height = 30;
constexpr uint32_t passes = 16;
constexpr float light = 0.2f;

// An even image, whose halves differ as samples of such a variance would have it.
Film even_film(double variance) {
  Camera camera;
  camera.width = camera.crop_width = width, camera.height = camera.crop_height = height;
  Film film = make_film(camera, make_filter(FilterKind::box), false);
  film.passes = passes;
  const double off = std::sqrt(variance / passes);
  film.camera_sum.assign(film.pixels(), glm::dvec3(passes * double(light)));
  film.half_sum.assign(film.pixels(), glm::dvec3(0.5 * passes * (double(light) + off)));
  return film;
}

PixelSpread spread_of(float variance) {
  const float n = passes;
  return {n * light, n * light * light + (n - 1) * variance, {passes / 2, passes / 2}};
}

// Noisy on the right, calm on the left.
Adaptive half_noisy(float calm, float noisy) {
  Adaptive a;
  a.passes = passes;
  for (int i = 0; i < width * height; ++i) a.spread.push_back(spread_of(i % width < width / 2 ? calm : noisy));
  return a;
}

double mean_count(const Adaptive& a, int from, int to) {
  double sum = 0;
  for (int y = 0; y < height; ++y)
    for (int x = from; x < to; ++x) sum += a.counts[size_t(y) * width + x];
  return sum / (to - from) / height;
}

TEST(Adaptive, NoisyPixelsHaveMoreByTheRootOfTheirVariance) {
  Adaptive a = half_noisy(0.001f, 0.009f);
  allot(even_film(0.005), a);
  EXPECT_NEAR(mean_count(a, 0, width / 2 - 2), 1, 0.1);
  EXPECT_NEAR(mean_count(a, width / 2 + 2, width), 3, 0.35);
  Adaptive far = half_noisy(1e-6f, 1);
  allot(even_film(0.5), far);
  EXPECT_EQ(mean_count(far, width / 2 + 2, width), Adaptive::most);
}

TEST(Adaptive, WhatMoreSamplesDoNotMendMakesThemFewer) {
  Adaptive alone = half_noisy(0.001f, 0.009f), shared = alone;
  allot(even_film(0.005), alone);
  allot(even_film(0.05), shared);
  EXPECT_LT(mean_count(shared, width / 2 + 2, width), 0.9 * mean_count(alone, width / 2 + 2, width));
}

// Its own samples would choose what comes after them. Some pixels are calm in one image and as many others in the next.
TEST(Adaptive, NoPixelHasASayInItsOwnCount) {
  Adaptive images[2] = {half_noisy(0.001f, 0.009f), half_noisy(0.001f, 0.009f)};
  std::vector<size_t> some;
  for (int y = 1; y < height; y += 4)
    for (int x = width / 2 + 2; x < width - 1; x += 3) some.push_back(size_t(y) * width + x);
  for (size_t i = 0; i < some.size(); ++i) images[i % 2].spread[some[i]] = spread_of(0);
  for (Adaptive& a : images) allot(even_film(0.005), a);
  for (const size_t pixel : some) EXPECT_EQ(images[0].counts[pixel], images[1].counts[pixel]) << pixel;
}

// Of pixels that are nearly alike eight samples a pass are as good as one, for the error times their number, to
// rounding.
TEST(Adaptive, WhereManyAreNoBetterThereAreFew) {
  Adaptive a = half_noisy(0.001f, 0.00104f);
  allot(even_film(0.0009), a);
  EXPECT_LT(mean_count(a, 0, width), 1.1);
}

TEST(Adaptive, OneFireflyIsNotWorthSamples) {
  Adaptive a = half_noisy(0.001f, 0.001f);
  a.spread[10 * width + 10] = spread_of(100);
  allot(even_film(0.001), a);
  EXPECT_NEAR(mean_count(a, 0, width), 1, 0.1);
}

// Squares of some lights have no place in a float.
TEST(Adaptive, OneThatIsBrighterThanNumbersGoDoesNoHarm) {
  Adaptive a = half_noisy(0.001f, 0.009f);
  a.spread[10 * width + 30] = {1e18f, infinity, {passes / 2, passes / 2}};
  allot(even_film(0.005), a);
  ASSERT_FALSE(a.counts.empty());
  for (const uint8_t count : a.counts) {
    EXPECT_GE(count, 1);
    EXPECT_LE(count, Adaptive::most);
  }
  EXPECT_NEAR(mean_count(a, width / 2 + 2, width), 3, 0.35);
}

TEST(Adaptive, APassAtWorkCountsByWhatIsDoneOfIt) {
  Film film = even_film(0.005);
  Adaptive a;
  a.passes = 1, a.spread.resize(film.pixels());
  for (PixelSpread& s : a.spread) s.counts[0] = 3;
  EXPECT_EQ(samples_of_pass(film, a), 3);
  film.chunks = 1;
  for (int y = 0; y < tile; ++y)
    for (int x = 0; x < tile; ++x) a.spread[size_t(y) * width + size_t(x)].counts[1] = 3;
  EXPECT_NEAR(samples_of_pass(film, a), 3, 1e-12);
}

// Who goes on from fields that the first samples of passes taught must not draw their numbers again: those are not the
// numbers of the passes.
TEST(Adaptive, NumbersThatTaughtAreDrawnByMoreThanThePasses) {
  Film film = even_film(0.005);
  film.dropped = 4, film.passes = 8;
  Adaptive a;
  EXPECT_EQ(passes_drawn(film, a), 12u);
  film.chunks = 1;
  EXPECT_EQ(passes_drawn(film, a), 13u);
  a.first = 4, a.passes = 8, a.spread.resize(film.pixels());
  EXPECT_EQ(passes_drawn(film, a), 13u);
  a.spread[7].counts[0] = 4, a.spread[7].counts[1] = 17;
  const auto number = [&](uint32_t half) { return a.first + 2 * (a.spread[7].counts[half] - 1) + half; };  // the last
  EXPECT_GT(passes_drawn(film, a), std::max(number(0), number(1)));
  EXPECT_EQ(passes_drawn(film, a), 38u);
}

TEST(Adaptive, WhereNothingIsKnownAllPixelsHaveOne) {
  Adaptive black = half_noisy(0.001f, 0.009f), still = half_noisy(0, 0);
  Film film = even_film(0.005);
  allot(film, still);
  EXPECT_EQ(count_of(&still, 5), 1u);
  film.camera_sum.assign(film.pixels(), glm::dvec3(0)), film.half_sum = film.camera_sum;
  allot(film, black);
  EXPECT_TRUE(black.counts.empty());
  EXPECT_EQ(count_of(&black, 5), 1u);
  EXPECT_EQ(count_of(nullptr, 5), 1u);
  EXPECT_EQ(samples_of_pass(film, {}), 1);
}

double light_of(const RenderState& state) {
  const std::vector<float> pixels = develop(state.film).pixels;
  return std::accumulate(pixels.begin(), pixels.end(), 0.0) / double(pixels.size());
}

struct Both {
  RenderState more, even;
};

// Of a sky that is seen as it is, and noisy things below it.
Both with_and_without(RenderOptions options) {
  LoadOptions load;
  load.defines = {{"resx", "64"}, {"resy", "36"}};
  const Scene scene = load_scene(source_path("scenes/materials/materials.xml"), load);
  const Accel accel(scene);
  Both out{rendered(scene, accel, options), {}};
  options.even = true;
  out.even = rendered(scene, accel, options);
  return out;
}

TEST(Adaptive, APassIsTheMeanOfAPixelsSamples) {
  RenderOptions options = statistical("guided-bdpt", 6);
  options.spp = 33;
  const auto [more, even] = with_and_without(options);
  EXPECT_TRUE(even.adaptive.spread.empty());
  EXPECT_NEAR(light_of(more), light_of(even), 0.03 * light_of(even));
  const auto [least, most] = std::minmax_element(more.adaptive.counts.begin(), more.adaptive.counts.end());
  EXPECT_EQ(*least, 1);
  EXPECT_GE(*most, 4);
  EXPECT_GT(samples_of_pass(more.film, more.adaptive), 1.02);
  EXPECT_LT(samples_of_pass(more.film, more.adaptive), 3);
  EXPECT_LT(estimate_error(more.film).relmse_trimmed, estimate_error(even.film).relmse_trimmed);
}

// What the samples of a pass see differs: else more of them would bring nothing.
TEST(Adaptive, FurtherSamplesHaveNumbersOfTheirOwn) {
  RenderOptions options = statistical("guided-bdpt", 2);
  options.sampler = SamplerKind::sobol;
  options.spp = 129;
  const auto [more, even] = with_and_without(options);
  double before = 0, now = 0;
  const Picture a = variance(even.film), b = variance(more.film);
  for (size_t i = 0; i < more.adaptive.counts.size(); ++i)
    if (more.adaptive.counts[i] >= 3) before += double(a.pixels[3 * i]), now += double(b.pixels[3 * i]);
  EXPECT_GT(before, 0);
  EXPECT_LT(now, 0.75 * before);
}

}  // namespace
}  // namespace ajar
