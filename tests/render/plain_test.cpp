// When path tracing takes over from a guided integrator, and that nothing else of the image changes.
#include <algorithm>

#include "ajar/core/sampler.h"
#include "ajar/scene/load.h"
#include "bytes.h"
#include "kit/files.h"

namespace ajar {
namespace {

using namespace kit;

constexpr uint32_t passes = 16;
constexpr size_t square = plain_side * plain_side;

double uniform(uint64_t key) { return double(hash(key, 7) >> 11) * 0x1p-53; }

// Of mean 1: a pass brings a pixel 1 / chance with that chance, else 0.
PassHalves flicker(double chance, uint64_t key, uint32_t count = passes) {
  PassHalves h;
  h.passes = count;
  for (size_t i = 0; i < 128 * square; ++i) {
    double sum = 0, half = 0;
    for (uint32_t pass = 0; pass < count; ++pass) {
      const double x = uniform((key * count + pass) << 32 | i) < chance ? 1 / chance : 0;
      sum += x, half += pass % 2 == 0 ? x : 0;
    }
    h.sum.emplace_back(sum), h.half.emplace_back(half);
  }
  return h;
}

PassHalves times(PassHalves h, double factor, size_t squares) {
  for (size_t i = 0; i < squares * square; ++i) h.sum[i] *= factor, h.half[i] *= factor;
  return h;
}

TEST(Plain, ErrorsAreThoseOfASample) {
  const PlainLook look = compare_halves(flicker(0.5, 1), flicker(0.2, 2, 4 * passes));
  // Variance is 1 / chance - 1, and 0.01 counts at a mean of a fifth; the mean that errors are held against is a little
  // noisy.
  EXPECT_NEAR(passes * look.guided, 1 / 1.25, 0.06);
  EXPECT_NEAR(4 * passes * look.plain, 4 / 1.25, 0.3);
  EXPECT_EQ(look.missed, 0);
  EXPECT_LT(passes * look.bias, 0.02);
}

// Two squares of 128 a thousand times as bright: the others are looked at a little darker, not as next to black.
TEST(Plain, LampsInViewAreWhite) {
  const PlainLook look = compare_halves(times(flicker(0.5, 1), 1000, 2), times(flicker(0.5, 2), 1000, 2));
  EXPECT_NEAR(passes * look.guided, 1 / (1 + 0.01 / sqr((25.6 - 2) / 126)), 0.06);
}

// As relMSE has it; noise that is red here and blue there is none to the luminance.
TEST(Plain, ErrorsAreOfColours) {
  PassHalves h;
  h.passes = passes;
  const glm::dvec3 noise(0.5, -0.5 * 0.212671 / 0.715160, 0);
  for (size_t i = 0; i < 128 * square; ++i)
    h.sum.emplace_back(double(passes)), h.half.push_back(0.5 * double(passes) * (1.0 + noise));
  const double square_of_noise = (sqr(0.5) + sqr(0.5 * 0.212671 / 0.715160)) / 3;
  EXPECT_NEAR(compare_halves(h, h).guided, square_of_noise / 1.25, 1e-3);
}

TEST(Plain, WhatIsNotSeenIsAsRareAsItMustBe) {
  // One square in 128 lacks half of its light: it came in less than one of 64 * 16 samples.
  const PassHalves all = flicker(0.5, 1), some = times(flicker(0.5, 2), 0.5, 1);
  const PlainLook look = compare_halves(all, some);
  EXPECT_NEAR(look.missed, 0.25 / 1.25 * square / 128, 0.025);
  EXPECT_EQ(compare_halves(some, all).missed, 0) << "that the guided image lacks light is not path tracing's fault";
}

TEST(Plain, BiasIsSeenWhereNoiseIsNot) {
  const PlainLook look = compare_halves(times(flicker(0.9, 1), 1.1, 64), flicker(0.9, 2));
  EXPECT_NEAR(look.bias, 0.5 * 0.01 / 1.25, 0.0016);
}

TEST(Plain, BlurIsNotMissed) {
  const PlainLook blurred = compare_halves(times(flicker(0.9, 1), 1.2, 64), flicker(0.9, 2));
  EXPECT_GT(missed_by_plain(blurred, false), 0.5);
  EXPECT_LT(missed_by_plain(blurred, true), 0.15);
  const PlainLook caustic = compare_halves(flicker(0.5, 1), times(flicker(0.5, 2), 0.5, 1));
  EXPECT_NEAR(missed_by_plain(caustic, true), caustic.missed, 0.1 * caustic.missed) << "one square in 128";
}

TEST(Plain, BlackImagesSayNothing) {
  const PassHalves black{passes, std::vector(square, glm::dvec3(0)), std::vector(square, glm::dvec3(0))};
  const PlainLook look = compare_halves(black, black);
  EXPECT_EQ(look.guided, 0);
  EXPECT_EQ(look.plain, 0);
}

RenderOptions sparing(const std::string& integrator, uint32_t spp) {
  RenderOptions o = options_of(integrator, spp);
  o.leaves_out = true;
  return o;
}

TEST(Plain, TakesOverWhereLightIsEasyToFind) {
  Scene scene = stage(64);
  finish(scene);
  const Accel accel(scene);
  for (const char* integrator : {"guided-bdpt", "guided-path"}) {
    const RenderState state = rendered(scene, accel, sparing(integrator, 20));
    EXPECT_TRUE(state.plain.taken) << integrator << " " << state.plain.ratio;
    EXPECT_LE(state.plain.passes, 16u);
    EXPECT_TRUE(state.plain.seen.sum.empty());
  }
}

// In the midst of merging, too.
TEST(Plain, GoesOnWithoutLightSubpathsAndLessons) {
  Scene scene = stage(64);
  finish(scene);
  const Accel accel(scene);
  const double truth = mean_of(rendered(scene, accel, options_of("path", 256)).film);
  for (const char* integrator : {"guided-bdpt", "guided-vcm", "guided-path"}) {
    RenderOptions o = sparing(integrator, 10);
    RenderState state = rendered(scene, accel, o);
    state.plain.taken = state.plain.settled = true;
    const uint64_t light = state.stats.counters.light_paths;
    const uint32_t lessons = state.learning.fields.generation;
    o.spp = 50;
    render(scene, accel, o, state, {});
    EXPECT_EQ(state.stats.counters.light_paths, light) << integrator;
    EXPECT_EQ(state.learning.fields.generation, lessons);
    EXPECT_EQ(state.film.passes, 50u);
    EXPECT_NEAR(mean_of(state.film), truth, 0.01 * truth) << integrator;
  }
}

// Batches of chunks have another size then.
TEST(Plain, GoesOnFromManyTilesThatWereMerged) {
  const Scene scene = strip(true);
  const Accel accel(scene);
  RenderOptions o = sparing("guided-vcm", 1);
  RenderState state = rendered(scene, accel, o);
  state.plain.taken = state.plain.settled = true;
  o.spp = 3;
  render(scene, accel, o, state, {});
  EXPECT_EQ(state.film.passes, 3u);
}

// To look costs time and nothing else.
TEST(Plain, LeavesAnotherImageAsItIs) {
  const Scene scene = two_rooms(5);
  const Accel accel(scene);
  const RenderState looked = rendered(scene, accel, sparing("guided-bdpt", 20));
  EXPECT_FALSE(looked.plain.taken);
  EXPECT_GT(looked.plain.passes, 0u);
  expect_same_bytes(looked, rendered(scene, accel, options_of("guided-bdpt", 20)));
}

// Pixels of one square of 64.
std::vector<size_t> some_square(const Film& film) {
  std::vector<size_t> pixels;
  for (int i = 0; i < int(square); ++i)
    pixels.push_back(size_t((40 + i / plain_side) * film.width + 24 + i % plain_side));
  return pixels;
}

// Light that path tracing never finds.
void add_caustic(Film& film) {
  const glm::dvec3 light(film.passes * 4.0);
  for (const size_t i : some_square(film)) film.splat_sum[i] += light, film.half_sum[i] += 0.5 * light;
}

void take_over(RenderState& state) {
  state.plain.taken = state.plain.settled = true;
  state.plain.passes = state.film.passes, state.plain.guided = {state.film, state.stats.ledger};
  state.plain.adaptive = state.adaptive;
}

void expect_same_image(const RenderState& a, const RenderState& b) {
  EXPECT_EQ(a.film.passes, b.film.passes);
  EXPECT_TRUE(same_bytes(a.film.camera_sum, b.film.camera_sum));
  EXPECT_TRUE(same_bytes(a.film.splat_sum, b.film.splat_sum));
  EXPECT_TRUE(same_bytes(a.film.half_sum, b.film.half_sum));
  EXPECT_TRUE(same_bytes(a.film.square_sum, b.film.square_sum));
  expect_same_learning(a.learning, b.learning);
}

RenderState from_checkpoint(const Scene& scene, const RenderOptions& options, const RenderState& state) {
  const File file("plain");
  save_checkpoint(file.path, "key", state);
  RenderState again = start_render(scene, options);
  load_checkpoint(file.path, "key", again);
  return again;
}

RenderState resumed(const Scene& scene, const Accel& accel, const RenderOptions& options, const RenderState& state) {
  RenderState again = from_checkpoint(scene, options, state);
  render(scene, accel, options, again, {});
  return again;
}

// As if path tracing had never taken over, wherever the render was interrupted.
TEST(Plain, GivesBackWhatItDoesNotSee) {
  Scene scene = stage(64);
  finish(scene);
  const Accel accel(scene);
  RenderState state = rendered(scene, accel, sparing("guided-bdpt", 4));
  add_caustic(state.film);
  const RenderState guided = resumed(scene, accel, options_of("guided-bdpt", 12), state);
  take_over(state);
  const RenderState straight = resumed(scene, accel, sparing("guided-bdpt", 12), state);
  EXPECT_EQ(straight.plain.returned, 4u);
  EXPECT_FALSE(straight.plain.taken);
  EXPECT_EQ(straight.plain.guided.film.passes, 0u);
  expect_same_image(straight, guided);
  RenderOptions o = sparing("guided-bdpt", 6);
  render(scene, accel, o, state, {});
  EXPECT_EQ(state.film.passes, 6u);
  expect_same_bytes(resumed(scene, accel, sparing("guided-bdpt", 12), state), straight);
}

// Also where it was kept for a while, and light is so easy to find that guiding would have taken fewer light subpaths.
TEST(Plain, GivesBackWhatItDidNotSeeAtFirst) {
  Scene scene = stage(64);
  finish(scene);
  const Accel accel(scene);
  RenderState state = rendered(scene, accel, sparing("guided-bdpt", 4));
  const RenderOptions o = sparing("guided-bdpt", 20);
  RenderState doubted = from_checkpoint(scene, o, state);
  add_caustic(state.film);
  const RenderState guided = resumed(scene, accel, options_of("guided-bdpt", 20), state);
  take_over(doubted);
  doubted = resumed(scene, accel, sparing("guided-bdpt", 12), doubted);
  ASSERT_TRUE(doubted.plain.taken);
  add_caustic(doubted.plain.guided.film);
  render(scene, accel, o, doubted, {});
  EXPECT_EQ(doubted.plain.returned, 12u);
  expect_same_image(doubted, guided);
}

// However many passes of path tracing say otherwise.
TEST(Plain, KeepsWhatWasTooBrightByChance) {
  Scene scene = stage(64);
  finish(scene);
  const Accel accel(scene);
  RenderState state = rendered(scene, accel, sparing("guided-bdpt", 4));
  for (const size_t i : some_square(state.film))
    for (auto* sums : {&state.film.camera_sum, &state.film.splat_sum, &state.film.half_sum}) (*sums)[i] *= 1.25;
  take_over(state);
  render(scene, accel, sparing("guided-bdpt", 132), state, {});
  EXPECT_TRUE(state.plain.taken);
}

// A sun of four texels behind a ball of glass: 32 squares and a dozen samples do not meet its caustic, by two seeds in
// five; all the film's, later, nearly always do.
TEST(Plain, GivesBackWhatIsRare) {
  LoadOptions load;
  load.defines = {{"resx", "96"}, {"resy", "54"}};
  const Scene scene = load_scene(source_path("scenes/environment/environment.xml"), load);
  const Accel accel(scene);
  RenderOptions o = sparing("guided-bdpt", 17);
  RenderState state;
  while (state.plain.returned == 0 && o.seed < 16) {
    ++o.seed, o.spp = 17;
    state = rendered(scene, accel, o);
    o.spp = 68;
    if (state.plain.taken) render(scene, accel, o, state, {});
  }
  ASSERT_GE(state.plain.returned, 4u);
  EXPECT_FALSE(state.plain.taken);
  if (state.film.passes < o.spp) render(scene, accel, o, state, {});
  RenderOptions other = options_of("guided-bdpt", 68);
  other.seed = o.seed;
  expect_same_image(state, rendered(scene, accel, other));
}

TEST(Plain, IsLeftAloneWhereFieldsAreAskedFor) {
  RenderOptions o = sparing("guided-bdpt", 8);
  EXPECT_TRUE(may_leave_out(o));
  o.techniques = true;
  EXPECT_FALSE(may_leave_out(o));
  o = sparing("guided-bdpt", 8), o.learn.train = 8;
  EXPECT_FALSE(may_leave_out(o));
  o = sparing("guided-bdpt", 8), o.learn.guided = Guided::camera;
  EXPECT_FALSE(may_leave_out(o));
  EXPECT_FALSE(may_leave_out(sparing("vpl", 8)));
  EXPECT_FALSE(may_leave_out(sparing("bdpt", 8)));
  EXPECT_FALSE(may_leave_out(options_of("guided-bdpt", 8)));
}

// With any number of threads, stopped anywhere: before a look, at one, and after path tracing took over.
TEST(Plain, IsTheSameToTheByte) {
  Scene scene = stage(64);
  finish(scene);
  const Accel accel(scene);
  RenderOptions o = sparing("guided-bdpt", 24);
  const RenderState straight = rendered(scene, accel, o);
  ASSERT_TRUE(straight.plain.taken);
  o.threads = 1;
  expect_same_bytes(straight, rendered(scene, accel, o));
  for (const uint32_t stop : {2u, 4u, 6u, 8u, 20u}) {
    o.spp = stop;
    const RenderState stopped = rendered(scene, accel, o);
    o.spp = 24;
    const RenderState again = resumed(scene, accel, o, stopped);
    expect_same_bytes(straight, again);
    EXPECT_EQ(again.plain.passes, straight.plain.passes) << stop;
  }
}

// What merged is in no image, and what goes on is looked at in turn.
TEST(Plain, LeavesOutMergingFirst) {
  Scene scene = stage(64);
  finish(scene);
  const Accel accel(scene);
  const double truth = mean_of(rendered(scene, accel, options_of("path", 256)).film);
  RenderOptions o = sparing("guided-vcm", 40);
  const RenderState state = rendered(scene, accel, o);
  EXPECT_GE(state.plain.merged, 4u);
  EXPECT_GT(state.plain.passes, 0u);
  EXPECT_EQ(state.film.passes, 40u);
  EXPECT_EQ(state.film.dropped, state.plain.merged + blind_generations);
  EXPECT_NEAR(mean_of(state.film), truth, 0.01 * truth);
  for (const auto& row : state.stats.ledger.merges)
    for (const StrategyCost& cost : row) EXPECT_EQ(cost.joins, 0u);
  for (const uint32_t stop : {4u, 6u, 20u}) {
    o.spp = stop;
    const RenderState stopped = rendered(scene, accel, o);
    o.spp = 40;
    expect_same_bytes(state, resumed(scene, accel, o, stopped));
  }
}

// What merging passes found of their image is not held against the new one.
TEST(Plain, BalanceBeginsAnewWithTheImageThatDoesNotMerge) {
  Scene scene = stage(64);
  finish(scene);
  const RenderOptions o = sparing("guided-vcm", 40);
  RenderState state = start_render(scene, o);
  uint32_t looked = 0;
  render(scene, Accel(scene), o, state, [&](const RenderState& now) {
    if (now.plain.merged == 0) return true;
    ++looked;
    EXPECT_LE(now.balance.passes, now.film.passes);
    EXPECT_LE(now.adaptive.passes, now.film.passes);
    return now.film.passes < 3;
  });
  EXPECT_GT(looked, 0u);
}

// Whoever stops just then has the image with merging, and may go on without.
TEST(Plain, StopsShowWhatMergedUntilThereIsMore) {
  Scene scene = stage(64);
  finish(scene);
  const Accel accel(scene);
  const RenderOptions o = sparing("guided-vcm", 20);
  const RenderState straight = rendered(scene, accel, o);
  const uint32_t merged = straight.plain.merged;
  ASSERT_GE(merged, 4u);
  for (const uint32_t more : {0u, merged - 1, merged}) {
    RenderState state = start_render(scene, o);
    Film last;
    render(scene, accel, o, state, [&](const RenderState& s) {
      if (s.plain.merged == 0) last = s.film;
      return s.plain.merged == 0 || s.film.passes < more;
    });
    const RenderState stopped = state;
    if (more == merged - 1) state.plain.taken = true, state.plain.guided.film = state.film;
    show_merged(state);
    EXPECT_EQ(state.plain.merged > 0, more >= merged);
    EXPECT_EQ(state.film.passes, more < merged ? merged : more);
    EXPECT_EQ(state.film.camera_sum == last.camera_sum, more < merged) << more;
    expect_same_bytes(straight, resumed(scene, accel, o, stopped));
  }
}

TEST(Plain, WhatNeverMergedLeavesNoMergingOut) {
  Scene scene = stage(64);
  finish(scene);
  const Accel accel(scene);
  RenderOptions o = sparing("guided-vcm", 20);
  o.merge_radius = 0;
  const RenderState state = rendered(scene, accel, o);
  EXPECT_EQ(state.plain.merged, 0u);
  o.integrator = "guided-bdpt";
  expect_same_bytes(state, rendered(scene, accel, o));
}

// As who asks for nothing to be left out wants it, from a checkpoint too.
TEST(Plain, MergesAgainWhereNothingMayBeLeftOut) {
  Scene scene = stage(64);
  finish(scene);
  const Accel accel(scene);
  RenderOptions o = sparing("guided-vcm", 20);
  const RenderState without = rendered(scene, accel, o);
  ASSERT_GE(without.plain.merged, 4u);
  o.spp = 24, o.leaves_out = false;
  uint64_t merges = 0;
  for (const auto& row : resumed(scene, accel, o, without).stats.ledger.merges)
    for (const StrategyCost& cost : row) merges += cost.joins;
  EXPECT_GT(merges, 0u);
}

TEST(Plain, KeepsWhatMergedWhenItIsLate) {
  Scene scene = stage(64);
  finish(scene);
  const Accel accel(scene);
  RenderOptions o = sparing("guided-vcm", 40);
  const uint32_t merged = rendered(scene, accel, o).plain.merged;
  ASSERT_GE(merged, 4u);
  o.spp = merged;
  RenderState state = rendered(scene, accel, o);
  o.spp = merged + 8, o.seconds = 1000;
  state.stats.seconds = 0.4 * o.seconds;
  render(scene, accel, o, state, {});
  EXPECT_EQ(state.plain.merged, merged);
  EXPECT_TRUE(state.plain.settled && !state.plain.taken);
  EXPECT_EQ(state.film.passes, merged + 8);
  EXPECT_EQ(state.film.dropped, blind_generations);
}

// Images without a square are not looked at.
TEST(Plain, ImagesOfAnySize) {
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 5}, {8, 8}, {9, 23}, {300, 3}}) {
    Scene scene = stage(8);
    Camera& c = scene.camera;
    c.width = c.crop_width = width, c.height = c.crop_height = height;
    finish(scene);
    const RenderState state = rendered(scene, Accel(scene), sparing("guided-vcm", 10));
    EXPECT_EQ(state.film.passes, 10u);
    EXPECT_EQ(state.plain.passes + state.plain.merged > 0, width >= plain_side && height >= plain_side);
  }
}

}  // namespace
}  // namespace ajar
