// How many camera samples each pixel has in a pass, and what a pass is then.
#include <algorithm>
#include <numeric>
#include <tuple>

#include "ajar/core/sampler.h"
#include "ajar/scene/load.h"
#include "kit/files.h"
#include "measure.h"

namespace ajar {
namespace {

using namespace kit;

constexpr int width = 40, height = 30;
constexpr uint32_t passes = 16;
constexpr float light = 0.2f;

// An image of one light.
Film lit_film() {
  Camera camera;
  camera.width = camera.crop_width = width, camera.height = camera.crop_height = height;
  Film film = make_film(camera, make_filter(FilterKind::box), false);
  film.passes = passes, film.weight = passes, film.half_weight = passes / 2;
  film.camera_sum.assign(film.pixels(), glm::dvec3(passes * double(light)));
  film.half_sum.assign(film.pixels(), glm::dvec3(0.5 * passes * double(light)));
  return film;
}

PixelSpread spread_of(double variance, uint32_t each = 1) {
  const uint32_t all = passes * each;
  const float n = float(all);
  return {n * light, n * light * light + (n - 1) * float(variance), all, {all / 2, all / 2}};
}

struct Look {
  Film film = lit_film();
  Adaptive adaptive;
};

// Lets samples of a pixel vary so much, and the image's halves differ by that and by what samples do not bring.
void set(Look& look, int pixel, double variance, double found, uint32_t each = 1) {
  look.adaptive.spread[size_t(pixel)] = spread_of(variance, each);
  look.film.half_sum[size_t(pixel)] = glm::dvec3(0.5 * (passes * double(light) + std::sqrt(passes * found)));
}

constexpr int strip = 8;  // columns that are noisy, on the right

// Calm but for the strip; `rest` is noise of the image that is not the samples'.
Look noisy_strip(double calm, double noisy, double rest = 0) {
  Look look;
  look.adaptive.passes = passes;
  look.adaptive.spread.resize(look.film.pixels());
  for (int i = 0; i < width * height; ++i) {
    const double variance = i % width < width - strip ? calm : noisy;
    set(look, i, variance, variance + rest);
  }
  return look;
}

double mean_count(const Adaptive& a, int from, int to) {
  double sum = 0;
  for (int y = 0; y < height; ++y)
    for (int x = from; x < to; ++x) sum += count_of(&a, uint64_t(y) * width + x);
  return sum / (to - from) / height;
}

double calm_count(const Look& look) { return mean_count(look.adaptive, strip, width - strip - 2); }
double noisy_count(const Look& look) { return mean_count(look.adaptive, width - strip + 2, width); }

void allot(Look& look) { allot(look.film, look.adaptive); }

TEST(Adaptive, NoisyPixelsHaveMoreByTheRootOfTheirVariance) {
  Look look = noisy_strip(0.001, 0.009), far = noisy_strip(1e-6, 1);
  allot(look), allot(far);
  EXPECT_NEAR(calm_count(look), 1, 0.1);
  EXPECT_NEAR(noisy_count(look), 2.8, 0.5);
  EXPECT_EQ(noisy_count(far), Adaptive::most);
}

TEST(Adaptive, WhatMoreSamplesDoNotMendMakesThemFewer) {
  Look alone = noisy_strip(0.001, 0.025), splats = noisy_strip(0.001, 0.025, 0.001);
  allot(alone), allot(splats);
  EXPECT_GT(noisy_count(splats), 1.5);
  EXPECT_LT(noisy_count(splats), 0.85 * noisy_count(alone));
}

// Passes by which neighbours are too bright together, or too dark, by so much.
void share_noise(Look& look, double variance) {
  const float swing = std::sqrt(float(variance * (passes - 1) / passes));
  for (PixelSpread& s : look.adaptive.spread) s.mean = passes * light, s.beside = passes * (sqr(light) + sqr(swing));
}

TEST(Adaptive, NoiseThatNeighboursShareIsNotMended) {
  Look alone = noisy_strip(0.001, 0.025), some = noisy_strip(0.001, 0.025), all = noisy_strip(0.001, 0.025);
  share_noise(alone, 0), share_noise(some, 0.001), share_noise(all, 0.1);
  allot(alone), allot(some), allot(all);
  EXPECT_GT(noisy_count(some), 1.5);
  EXPECT_LT(noisy_count(some), 0.85 * noisy_count(alone));
  EXPECT_TRUE(all.adaptive.counts.empty());
}

// A part of it is in what samples vary by, but divided by their number.
TEST(Adaptive, NoiseThatNeighboursShareIsTheSameWithMoreSamples) {
  Look one = noisy_strip(0.001, 0.025), four = one;
  constexpr double common = 0.001;
  for (int i = 0; i < width * height; ++i) {
    const double own = i % width < width - strip ? 0.001 : 0.025;
    set(one, i, own + common, own + common);
    set(four, i, own + common, own / 4 + common, 4);
  }
  share_noise(one, common), share_noise(four, common);
  allot(one), allot(four);
  EXPECT_GT(noisy_count(one), 1.5);
  EXPECT_NEAR(noisy_count(four), noisy_count(one), 0.05 * noisy_count(one));
}

// The noise of a pixel's own samples is not its neighbour's.
TEST(Adaptive, PassesShowWhatNeighboursShare) {
  Look own = noisy_strip(0.001, 0.025), shared = own;
  for (Look* look : {&own, &shared})
    for (look->adaptive.passes = 0; look->adaptive.passes < passes;) {
      const uint32_t pass = look->adaptive.passes;
      for (size_t i = 0; i < look->film.pixels(); ++i) {
        const float u = to_unit(uint32_t(hash(pass, look == &own ? i : 0) >> 32)) - 0.5f;
        look->film.camera[i] = Rgb(light * (1 + u));
      }
      note_pass(look->film, look->adaptive);
    }
  allot(own), allot(shared);
  EXPECT_GT(noisy_count(own), 3);
  EXPECT_TRUE(shared.adaptive.counts.empty());
}

// What chooses the counts is not what they are judged by: pixels that are noisy alone are not those with samples.
TEST(Adaptive, CountsAreJudgedByThePixelsOwnSamples) {
  Look look = noisy_strip(0.001, 0.025);
  allot(look);
  ASSERT_FALSE(look.adaptive.counts.empty());
  for (int i = 0; i < width * height; ++i)
    if (i % width % 3 == 1 && i / width % 3 == 1) set(look, i, 0.3, 0.3);
  allot(look);
  EXPECT_TRUE(look.adaptive.counts.empty()) << "those around noisy pixels are calm";
}

// Where points of a sequence lie evenly samples vary and the image does not.
TEST(Adaptive, SamplesThatErrLessTogetherAreNotWorthMore) {
  Look look = noisy_strip(0.001, 0.025);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < strip; ++x) set(look, y * width + x, 0.025, 0.0005);
  allot(look);
  EXPECT_GT(noisy_count(look), 3);
  EXPECT_NEAR(mean_count(look.adaptive, 0, strip - 4), 1, 0.1);
}

TEST(Adaptive, SmallGainsAreNotWorthUnevenSamples) {
  Look look = noisy_strip(0.001, 0.004);
  look.adaptive.counts.assign(look.film.pixels(), 2);
  allot(look);
  EXPECT_TRUE(look.adaptive.counts.empty());
  // An image that errs by more than its samples say, here by colours of the same luminance: no sequence converges.
  for (glm::dvec3& half : look.film.half_sum) half += glm::dvec3(0.7152, -0.2126, 0) * 0.5;
  allot(look);
  EXPECT_FALSE(look.adaptive.counts.empty());
}

// Its own samples would choose what comes after them. Some pixels are calm in one image and as many others in the next.
TEST(Adaptive, NoPixelHasASayInItsOwnCount) {
  Look looks[2] = {noisy_strip(0.001, 0.025), noisy_strip(0.001, 0.025)};
  std::vector<int> some;
  for (int y = 1; y < height - 1; y += 4)
    for (const int x : {width - 5, width - 1}) some.push_back(y * width + x);
  for (size_t i = 0; i < some.size(); ++i) set(looks[i % 2], some[i], 0, 0);
  for (Look& look : looks) allot(look);
  ASSERT_FALSE(looks[0].adaptive.counts.empty());
  for (const int pixel : some)
    EXPECT_EQ(looks[0].adaptive.counts[size_t(pixel)], looks[1].adaptive.counts[size_t(pixel)]) << pixel;
}

TEST(Adaptive, OneFireflyIsNotWorthSamples) {
  Look look = noisy_strip(0.001, 0.001);
  set(look, 10 * width + 10, 100, 100);
  allot(look);
  EXPECT_NEAR(mean_count(look.adaptive, 0, width), 1, 0.1);
}

// Squares of some lights have no place in a float.
TEST(Adaptive, OneThatIsBrighterThanNumbersGoDoesNoHarm) {
  Look look = noisy_strip(0.001, 0.009);
  for (const size_t pixel : {10 * width + 36, 15 * width + 36, 20 * width + 36})
    look.adaptive.spread[pixel] = {1e18f, infinity, passes, {passes / 2, passes / 2}, 1e18f, infinity};
  allot(look);
  ASSERT_FALSE(look.adaptive.counts.empty());
  for (const uint8_t count : look.adaptive.counts) {
    EXPECT_GE(count, 1);
    EXPECT_LE(count, Adaptive::most);
  }
  EXPECT_NEAR(noisy_count(look), 2.8, 0.5);
}

TEST(Adaptive, AnotherImageHasNumbersOfItsOwn) {
  Look look = noisy_strip(0.001, 0.025);
  allot(look);
  const auto counts = look.adaptive.counts;
  const uint32_t drawn = passes_drawn(look.film, look.adaptive);
  forget_sums(look.adaptive);
  EXPECT_EQ(passes_drawn(look.film, look.adaptive), drawn);
  EXPECT_EQ(look.adaptive.passes, 0u);
  for (const PixelSpread& s : look.adaptive.spread) EXPECT_EQ(std::tie(s.samples, s.sum, s.mean), std::tuple(0u, 0, 0));
  allot(look);
  EXPECT_EQ(look.adaptive.counts, counts) << "nothing is known of it";
}

TEST(Adaptive, APassAtWorkCountsByWhatIsDoneOfIt) {
  Film film = lit_film();
  Adaptive a;
  a.passes = 1, a.spread.resize(film.pixels());
  for (PixelSpread& s : a.spread) s.samples = 3;
  EXPECT_EQ(samples_of_pass(film, a), 3);
  film.chunks = 1;
  for (int y = 0; y < tile; ++y)
    for (int x = 0; x < tile; ++x) a.spread[size_t(y) * width + size_t(x)].samples += 3;
  EXPECT_NEAR(samples_of_pass(film, a), 3, 1e-12);
}

// Who goes on from fields that the first samples of passes taught must not draw their numbers again: those are not the
// numbers of the passes.
TEST(Adaptive, NumbersThatTaughtAreDrawnByMoreThanThePasses) {
  Film film = lit_film();
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
  Look black = noisy_strip(0.001, 0.009), still = noisy_strip(0, 0);
  allot(still);
  EXPECT_EQ(count_of(&still.adaptive, 5), 1u);
  black.film.camera_sum.assign(black.film.pixels(), glm::dvec3(0)), black.film.half_sum = black.film.camera_sum;
  allot(black);
  EXPECT_TRUE(black.adaptive.counts.empty());
  EXPECT_EQ(count_of(&black.adaptive, 5), 1u);
  EXPECT_EQ(count_of(nullptr, 5), 1u);
  EXPECT_EQ(samples_of_pass(black.film, {}), 1);
}

double light_of(const RenderState& state) {
  const std::vector<float> pixels = develop(state.film).pixels;
  return std::accumulate(pixels.begin(), pixels.end(), 0.0) / double(pixels.size());
}

struct Both {
  RenderState more, even;
};

// Of a box that is lit from behind a shelf: few pixels have most of the noise.
Both with_and_without(RenderOptions options) {
  LoadOptions load;
  load.defines = {{"resx", "40"}, {"resy", "40"}};
  const Scene scene = load_scene(source_path("scenes/sunrise/sunrise.xml"), load);
  const Accel accel(scene);
  Both out{rendered(scene, accel, options), {}};
  options.even = true;
  out.even = rendered(scene, accel, options);
  return out;
}

TEST(Adaptive, APassIsTheMeanOfAPixelsSamples) {
  RenderOptions options = statistical("guided-bdpt", 4);
  options.spp = 129;
  const auto [more, even] = with_and_without(options);
  EXPECT_TRUE(even.adaptive.spread.empty());
  EXPECT_NEAR(light_of(more), light_of(even), 0.03 * light_of(even));
  ASSERT_FALSE(more.adaptive.counts.empty());
  const auto [least, most] = std::minmax_element(more.adaptive.counts.begin(), more.adaptive.counts.end());
  EXPECT_EQ(*least, 1);
  EXPECT_GE(*most, 4);
  EXPECT_GT(samples_of_pass(more.film, more.adaptive), 1.02);
  EXPECT_LT(samples_of_pass(more.film, more.adaptive), 3);
  EXPECT_LT(estimate_error(more.film).relmse_trimmed, estimate_error(even.film).relmse_trimmed);
}

TEST(Adaptive, PassesCountByTheirSamples) {
  RenderOptions options = statistical("guided-bdpt", 4);
  options.spp = 129;
  const auto [more, even] = with_and_without(options);
  EXPECT_EQ(even.film.weight, 129);
  const double each = mean_count(more.adaptive);
  ASSERT_GT(each, 1.05);
  EXPECT_GT(more.film.weight, 129 + 0.9 * (each - 1)) << "the last one does";
  EXPECT_LT(more.film.weight, 8 * 129);
  options.techniques = true;
  EXPECT_EQ(with_and_without(options).more.film.weight, 129) << "images of strategies take all passes alike";
}

// What the samples of a pass see differs: else more of them would bring nothing.
TEST(Adaptive, FurtherSamplesHaveNumbersOfTheirOwn) {
  RenderOptions options = statistical("guided-bdpt", 2);
  options.sampler = SamplerKind::sobol;
  options.spp = 129;
  const auto [more, even] = with_and_without(options);
  double before = 0, now = 0;
  ASSERT_FALSE(more.adaptive.counts.empty());
  const Picture a = variance(even.film), b = variance(more.film);
  for (size_t i = 0; i < more.adaptive.counts.size(); ++i)
    if (more.adaptive.counts[i] >= 3) before += double(a.pixels[3 * i]), now += double(b.pixels[3 * i]);
  EXPECT_GT(before, 0);
  EXPECT_LT(now, 0.75 * before);
}

}  // namespace
}  // namespace ajar
