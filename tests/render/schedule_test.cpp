// What is traced, recorded and dropped when, what guides, and when a render ends.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "ajar/render/sequence.h"
#include "ajar/scene/load.h"
#include "bytes.h"
#include "kit/files.h"

namespace ajar {
namespace {

using namespace kit;

// Quiet images need few light subpaths, whatever the unit of light; those that are young, or that teach, all of them.
TEST(Schedule, LightSubpathsAreAsManyAsNoiseAsksFor) {
  for (const float factor : {1.0f, 1e-6f, 1e6f}) {
    Scene scene = stage(32);
    scene.lights[0].radiance.value *= factor;
    finish(scene);
    const Accel accel(scene);
    RenderOptions o = options_of("guided-bdpt", 8);
    RenderState state = rendered(scene, accel, o);
    const double pixels = double(state.film.pixels()), young = pixels * blind_generations;
    EXPECT_EQ(state.light_rate, RenderState::noisy_light) << factor << ", not looked at yet";
    EXPECT_NEAR(double(state.stats.counters.light_paths), young + 8 * pixels / 2, 0.02 * young);
    o.spp = 9;
    render(scene, accel, o, state, {});
    EXPECT_EQ(state.light_rate, RenderState::least_light) << factor;
    EXPECT_NEAR(double(state.stats.counters.light_paths), young + 8 * pixels / 2 + pixels / 8, 0.02 * young);
    EXPECT_EQ(state.stats.ledger.caustics, 0) << factor;
  }
  const Scene rooms = two_rooms(5);
  EXPECT_EQ(rendered(rooms, Accel(rooms), options_of("guided-bdpt", 9)).light_rate, RenderState::noisy_light);
}

// What comes through glass is left to light subpaths.
TEST(Schedule, CausticsGetAllLightSubpaths) {
  const Scene scene = glass_ball();
  const RenderState state = rendered(scene, Accel(scene), options_of("guided-bdpt", 9));
  double splats = 0;
  for (const auto& row : state.stats.ledger.strategies) splats += row[1].energy;
  EXPECT_GT(state.stats.ledger.caustics, 0.02 * total_energy(state.stats.ledger));
  EXPECT_LT(state.stats.ledger.caustics, splats);
  EXPECT_EQ(state.light_rate, RenderState::caustic_light);
}

// What merges: half as many light subpaths as pixels, but as many where much of the light is caustics.
TEST(Schedule, MergingHasHalfTheLightSubpaths) {
  LoadOptions load;
  load.defines = {{"resx", "48"}, {"resy", "36"}};
  const Scene mirrors = load_scene(source_path("scenes/mirrors/mirrors.xml"), load);
  EXPECT_EQ(rendered(mirrors, Accel(mirrors), options_of("guided-vcm", 10)).light_rate, RenderState::caustic_light);
  Scene scene = stage(48);
  finish(scene);
  const RenderState state = rendered(scene, Accel(scene), options_of("guided-vcm", 20));
  EXPECT_EQ(state.light_rate, RenderState::noisy_light);
  const double light_paths = (blind_generations + 20 * double(RenderState::noisy_light)) * double(state.film.pixels());
  EXPECT_NEAR(double(state.stats.counters.light_paths), light_paths, 0.02 * light_paths);
}

// Where most of the light is caustics there are several for each pixel, and their splats count the less.
TEST(Schedule, MostlyCausticsGetMoreLightSubpathsThanPixels) {
  LoadOptions load;
  load.defines = {{"resx", "48"}, {"resy", "36"}};
  const Scene scene = load_scene(source_path("scenes/mirrors/mirrors.xml"), load);
  const Accel accel(scene);
  const RenderState state = rendered(scene, accel, options_of("guided-bdpt", 64));
  const double pixels = double(state.film.pixels());
  EXPECT_EQ(state.light_rate, RenderState::most_light);
  const double light_paths = blind_generations + 8 * double(RenderState::noisy_light) + 56 * double(state.light_rate);
  EXPECT_NEAR(double(state.stats.counters.light_paths), light_paths * pixels, 0.02 * light_paths * pixels);
  const double truth = mean_of(rendered(scene, accel, options_of("bdpt", 512)).film);
  EXPECT_NEAR(mean_of(state.film), truth, 0.25 * truth)
      << "rare and bright; splats that counted once each would make it thrice";
}

// Of a first pass whose time is over after a few tiles, splats count by the share of its pixels. A lamp in glass: all
// of its light is splatted where it comes out.
TEST(Schedule, SplatsOfAPassAtWorkAreAsManyAsItsPixels) {
  Scene scene;
  set_camera(scene, {0, 0.8f, 3.5f}, {0, -0.5f, 0}, 22, 400, 400);
  add_open_room(scene);
  Material glass;
  glass.kind = MaterialKind::dielectric;
  add_sphere(scene, {0, 0.5f, 0}, 0.4f, add_material(scene, glass));
  add_area_light(scene, add_sphere(scene, {0, 0.5f, 0}, 0.2f, add_diffuse(scene, Rgb(0))), Rgb(20));
  finish(scene);
  const Accel accel(scene);
  RenderOptions o = options_of("plain-vpl", 2);
  o.max_depth = 4;
  const auto light_of = [&](const auto& sums) {
    double sum = 0;
    for (const auto& s : sums) sum += double(luminance(s));
    return sum;
  };
  const Film whole = rendered(scene, accel, o).film;
  const double right = light_of(whole.splat_sum) / whole.passes;
  o.cpu_seconds = 1e6;  // so that the first tiles are few
  double found = 0;
  constexpr int seeds = 24;
  for (o.seed = 0; o.seed < seeds; ++o.seed) {
    RenderState state = start_render(scene, o);
    render(scene, accel, o, state, [](const RenderState&) { return false; });
    ASSERT_LE(state.film.chunks, 32u);
    const double share = double(state.film.chunks) / chunk_count(state.film);
    found += light_of(state.film.splat) / double(state.film.pixels()) / share / seeds;
  }
  EXPECT_GT(right, 0);
  EXPECT_NEAR(found / right, 1, 0.7);
}

// What young fields need is so many paths, however many pixels there are.
TEST(Schedule, LargeImagesAreTaughtByASmallShareOfTheirPixels) {
  const auto shares = [](int width, int height, uint32_t train = 0) {
    Scene scene = stage(8);
    Camera& c = scene.camera;
    c.width = c.crop_width = width, c.height = c.crop_height = height;
    finish(scene);
    LearnOptions options;
    options.train = train;
    const Film film = make_film(c, scene.filter, true);
    Learning learning = start_learning(scene, film, options);
    std::vector<std::pair<uint32_t, uint32_t>> out;
    for (uint32_t generation : {0u, 1u, 2u, 3u, 4u, 7u, 8u, 9u, 99u}) {
      learning.fields.generation = generation;
      out.emplace_back(traced_one_in(learning, film), recorded_one_in(learning, film));
    }
    return out;
  };
  // What young fields cost, in passes: those that are dropped, and recording, which takes about as long as the path
  // itself. Generations 4 to 7 are alike.
  const auto passes_lost = [&](int width, int height) {
    const auto of = shares(width, height);
    double sum = 4.0 / of[4].second;
    for (size_t generation = 0; generation < 4; ++generation) sum += 2.0 / of[generation].first;
    return sum;
  };
  using Shares = std::vector<std::pair<uint32_t, uint32_t>>;
  EXPECT_EQ(shares(64, 64), (Shares{{1, 1}, {1, 1}, {1, 1}, {1, 1}, {1, 1}, {1, 1}, {1, 8}, {1, 16}, {1, 512}}));
  // Where few pixels are traced at first, few are until the first passes are dropped: none of them is an image.
  EXPECT_EQ(shares(128, 64), (Shares{{2, 1}, {2, 1}, {2, 1}, {2, 1}, {1, 1}, {1, 1}, {1, 8}, {1, 16}, {1, 512}}));
  EXPECT_EQ(shares(256, 256), (Shares{{16, 1}, {16, 1}, {8, 1}, {8, 1}, {1, 4}, {1, 4}, {1, 8}, {1, 16}, {1, 512}}));
  EXPECT_EQ(shares(1024, 1024), (Shares{{16, 1}, {16, 1}, {8, 1}, {8, 1}, {1, 8}, {1, 8}, {1, 8}, {1, 16}, {1, 512}}));
  EXPECT_EQ(passes_lost(64, 64), 12);
  EXPECT_EQ(passes_lost(256, 256), 1.75);
  EXPECT_EQ(passes_lost(1024, 1024), 1.25);
  for (const auto& [traced, recorded] : shares(256, 256, 8)) EXPECT_EQ(traced, 1u) << "training is what it says";
}

// Half of the light subpaths there are may be fewer than what is to be recorded; where it is not, sides are alike.
// A lesson of a film is the scene's affair, not that of the number of pixels.
TEST(Schedule, FilmsAreTaughtByAsManyPathsHoweverLarge) {
  const auto one_in = [](int width, int height) {
    Scene scene = stage(8);
    Camera& c = scene.camera;
    c.width = c.crop_width = width, c.height = c.crop_height = height;
    finish(scene);
    const Film film = make_film(c, scene.filter, true);
    Learning learning = start_learning(scene, film, {});
    learning.train = 16, learning.of_film = true;
    return traced_one_in(learning, film);
  };
  EXPECT_EQ(one_in(96, 54), 1u);
  EXPECT_EQ(one_in(480, 270), 7u);
  EXPECT_EQ(one_in(1280, 720), 16u);
}

TEST(Schedule, FieldsKnowHowManyTaughtThem) {
  Scene scene = stage(8);
  const auto paths = [&](int width, int height, uint32_t generation, float rate) {
    set_size(scene.camera, width, height);
    finish(scene);
    const Film film = make_film(scene.camera, scene.filter, true);
    Learning learning = start_learning(scene, film, {});
    learning.fields.generation = generation, learning.passes = 1;
    const Recorded r = paths_recorded(learning, {}, film, rate);
    return std::pair(r.camera, r.light);
  };
  EXPECT_EQ(paths(64, 64, 1, 1), std::pair(4096.0, 4096.0));
  EXPECT_EQ(paths(64, 64, 4, 0.5f), std::pair(4096.0, 2048.0));
  EXPECT_EQ(paths(64, 64, 8, 0.5f), std::pair(512.0, 512.0));
  EXPECT_EQ(paths(256, 256, 4, 0.5f), std::pair(16384.0, 16384.0));
  EXPECT_EQ(paths(256, 256, 4, 4), std::pair(16384.0, 16384.0));
}

TEST(Schedule, StoredFieldsSpareTheYoungPasses) {
  const Scene scene = strip(false);
  const Accel accel(scene);
  const RenderOptions o = options_of("guided-bdpt", 9);
  const RenderState first = rendered(scene, accel, o);
  const File file("ajar_fields");
  save_fields(file.path, stored_fields(scene, first.learning, passes_drawn(first.film, first.adaptive)));
  RenderState second = start_render(scene, o);
  go_on_from(scene, load_fields(file.path, scene_key(scene)), o.learn, second.learning, second.film);
  expect_same_field(first.learning.fields.q, second.learning.fields.q);
  expect_same_field(first.learning.fields.w, second.learning.fields.w);
  expect_same_views(first.learning.fields, second.learning.fields);
  render(scene, accel, o, second, always);
  EXPECT_EQ(second.film.passes, 9u);
  EXPECT_EQ(dropped_passes(second.learning, second.film), 0u);
  EXPECT_EQ(dropped_passes(first.learning, first.film), blind_generations);
  EXPECT_GE(second.film.dropped, first.film.dropped + first.film.passes) << "no pass number is drawn from twice";
  EXPECT_EQ(second.film.dropped % 2, 0u);
  EXPECT_FALSE(same_bytes(develop(first.film).pixels, develop(second.film).pixels));
  // From young fields the render goes on being young, and drops what is left of it.
  RenderState young = start_render(scene, o);
  int passes = 0;
  render(scene, accel, o, young, [&](const RenderState&) { return ++passes < 3; });
  RenderState third = start_render(scene, o);
  go_on_from(scene, stored_fields(scene, young.learning, passes_drawn(young.film, young.adaptive)), o.learn,
             third.learning, third.film);
  render(scene, accel, o, third, always);
  EXPECT_EQ(dropped_passes(third.learning, third.film), blind_generations - 2);  // passes are dropped in pairs
  EXPECT_EQ(third.film.dropped % 2, 0u);
}

// What fields know of lights is of one tree of lights; a state that has another's is refused.
TEST(Schedule, StoredFieldsMayBeOfOtherLights) {
  Scene scene = many_lights(64, 1, 32);
  RenderOptions o = options_of("guided-bdpt", 40);
  const StoredFields stored = stored_fields(scene, rendered(scene, Accel(scene), o).learning, 80);
  RenderOptions whole = o;
  whole.learn.lights = false;
  const StoredFields without = stored_fields(scene, rendered(scene, Accel(scene), whole).learning, 80);
  ASSERT_GT(stored.fields.lights.entries.size(), stored.fields.lights.cuts.size());
  ASSERT_TRUE(without.fields.lights.cuts.empty() && !without.fields.cells.empty());
  for (size_t i = 0; i < 60; ++i) scene.lights[i].sampling_weight = 0;
  finish(scene);
  o.spp = 4;
  const Accel accel(scene);
  for (const StoredFields* fields : {&stored, &without}) {
    RenderState loaded = start_render(scene, o);
    go_on_from(scene, *fields, learn_options(o), loaded.learning, loaded.film);
    EXPECT_TRUE(fits(loaded.learning.fields, scene.light_tree, learn_options(o)));
    EXPECT_NO_THROW(render(scene, accel, o, loaded, always));
    RenderState frozen = start_with(scene, o, fields->fields);
    EXPECT_NO_THROW(render(scene, accel, o, frozen, always));

    RenderState put = start_render(scene, o);
    put.learning.fields = fields->fields;
    const auto said = [&] { return kit::error_of([&] { render(scene, accel, o, put, always); }); };
    EXPECT_NE(said().find("of another scene, another choice of lights"), std::string::npos) << said();
    ASSERT_TRUE(fit_lights(scene.light_tree, learn_options(o), put.learning.fields));
    EXPECT_NE(said().find("its training is of others"), std::string::npos) << said();
  }
}

TEST(Schedule, FieldsGuideTheSideThatIsAskedFor) {
  const Scene scene = strip(false);
  const Accel accel(scene);
  RenderOptions o = options_of("guided-bdpt", 9);
  const auto guides = [](const Field& f) {
    return std::any_of(f.cells.begin(), f.cells.end(), [](const FieldCell& c) { return c.mix > 0; });
  };
  const RenderState both = rendered(scene, accel, o);
  EXPECT_TRUE(guides(both.learning.fields.q) && guides(both.learning.fields.w));
  for (const Guided side : {Guided::camera, Guided::light}) {
    o.learn.guided = side;
    const RenderState one = rendered(scene, accel, o);
    EXPECT_EQ(guides(one.learning.fields.q), side == Guided::camera);
    EXPECT_EQ(guides(one.learning.fields.w), side == Guided::light);
    RenderState loaded = start_render(scene, o);
    go_on_from(scene, stored_fields(scene, both.learning, passes_drawn(both.film, both.adaptive)), o.learn,
               loaded.learning, loaded.film);
    EXPECT_EQ(guides(loaded.learning.fields.q), side == Guided::camera);
    EXPECT_EQ(guides(loaded.learning.fields.w), side == Guided::light);
  }
}

TEST(Determinism, NoiseStopsAtTheSamePassWithAnyThreads) {
  const Scene scene = strip(false);
  const Accel accel(scene);
  RenderOptions o = options_of("path", 0);
  o.noise = 0.05, o.threads = 1;
  const RenderState one = rendered(scene, accel, o);
  EXPECT_LE(estimated_error(one.film), o.noise);
  EXPECT_GE(one.film.passes, 8u);
  o.threads = 3;
  expect_same_bytes(one, rendered(scene, accel, o));
  // The pass where it stopped was the first look at which the target was reached.
  RenderOptions straight = options_of("path", one.film.passes);
  std::vector<uint32_t> reached;
  RenderState state = start_render(scene, straight);
  render(scene, accel, straight, state, [&](const RenderState& s) {
    const uint32_t n = s.film.passes, step = n < 32 ? 2 : n < 64 ? 4 : n < 128 ? 8 : 16;
    if (n >= 8 && n % step == 0 && estimated_error(s.film) <= o.noise) reached.push_back(n);
    return true;
  });
  EXPECT_EQ(reached, std::vector{one.film.passes});
  expect_same_bytes(one, state);
}

TEST(Determinism, NoiseStopsAtTheSamePassAfterStops) {
  const Scene scene = strip(false);
  const Accel accel(scene);
  RenderOptions o = options_of("bdpt", 0);
  o.noise = 0.04;
  const RenderState straight = rendered(scene, accel, o);
  const File file("ajar_noise");
  RenderState state = start_render(scene, o);
  uint32_t before = 0;
  do {  // two passes at a time, each from a checkpoint
    before = state.film.passes;
    int looks = 0;
    render(scene, accel, o, state, [&](const RenderState&) { return ++looks < 2; });
    save_checkpoint(file.path, "key", state);
    state = start_render(scene, o);
    load_checkpoint(file.path, "key", state);
  } while (state.film.passes > before);
  expect_same_bytes(straight, state);
}

TEST(Determinism, NoiseKeepsToTheLimits) {
  const Scene scene = strip(false);
  const Accel accel(scene);
  RenderOptions o = options_of("path", 5);
  o.noise = 1e-9;
  EXPECT_EQ(rendered(scene, accel, o).film.passes, 5u);
  o.seconds = 1e-6;
  EXPECT_LE(rendered(scene, accel, o).film.passes, 1u) << "time is looked at too";
  o.seconds = 1e6;
  EXPECT_EQ(rendered(scene, accel, o).film.passes, 5u);
  o.seconds = 0, o.spp = 1000, o.noise = 1e9;
  EXPECT_EQ(rendered(scene, accel, o).film.passes, 8u) << "not before 8 passes, however well it looks";
}

}  // namespace
}  // namespace ajar
