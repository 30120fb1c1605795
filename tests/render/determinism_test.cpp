// The same bytes with any number of threads, after a stop and after a checkpoint.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "ajar/core/error.h"
#include "kit/stage.h"
#include "measure.h"

namespace ajar {
namespace {

using namespace kit;

// All kinds of strategies, and more tiles than are traced at once: 4112 x 2 pixels are 257 tiles, and so many pixels
// that passes which are dropped trace a part of them.
Scene strip(bool wide) {
  Scene scene = stage(40);
  Material glass;
  glass.kind = MaterialKind::dielectric;
  add_sphere(scene, {0.3f, -0.5f, 0.3f}, 0.4f, add_material(scene, glass));
  scene.filter = make_filter(FilterKind::mitchell);
  if (wide) {
    Camera& c = scene.camera;
    c.width = 4112, c.height = 2, c.crop_width = 4112, c.crop_height = 2;
  }
  finish(scene);
  return scene;
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

void expect_same_field(const Field& a, const Field& b) {
  EXPECT_EQ(a.unit, b.unit);
  EXPECT_TRUE(same_bytes(a.cells, b.cells));
  EXPECT_TRUE(a.nodes == b.nodes);
  EXPECT_TRUE(same_bytes(a.mean, b.mean));
  EXPECT_TRUE(same_bytes(a.weight, b.weight));
}

void expect_same_tallies(const Tallies& a, const Tallies& b) {
  EXPECT_EQ(a.value, b.value);
  EXPECT_EQ(a.weight, b.weight);
  EXPECT_EQ(a.direct, b.direct);
  EXPECT_EQ(a.directs, b.directs);
  EXPECT_EQ(a.visits, b.visits);
}

void expect_same_views(const Fields& a, const Fields& b) {
  ASSERT_EQ(a.cells.size(), b.cells.size());
  for (size_t i = 0; i < a.cells.size(); ++i) EXPECT_EQ(a.cells[i].region, b.cells[i].region);
  EXPECT_EQ(a.regions, b.regions);
  EXPECT_EQ(a.views.regions, b.views.regions);
  EXPECT_EQ(a.views.tried, b.views.tried);
  EXPECT_EQ(a.views.seen, b.views.seen);
  EXPECT_EQ(a.views.chance, b.views.chance);
}

void expect_same_learning(const Learning& a, const Learning& b) {
  EXPECT_EQ(a.passes, b.passes);
  EXPECT_EQ(a.first, b.first);
  EXPECT_EQ(a.fields.generation, b.fields.generation);
  ASSERT_EQ(a.fields.cells.size(), b.fields.cells.size());
  for (size_t i = 0; i < a.fields.cells.size(); ++i) EXPECT_EQ(a.fields.cells[i].key, b.fields.cells[i].key);
  expect_same_field(a.fields.q, b.fields.q);
  expect_same_field(a.fields.w, b.fields.w);
  expect_same_views(a.fields, b.fields);
  expect_same_tallies(a.training.q, b.training.q);
  expect_same_tallies(a.training.w, b.training.w);
  EXPECT_EQ(a.training.views.counts, b.training.views.counts);
  ASSERT_EQ(a.sightings.size(), b.sightings.size());
  for (const auto& [key, seen] : a.sightings) {
    ASSERT_TRUE(b.sightings.contains(key));
    EXPECT_EQ(seen.count, b.sightings.at(key).count);
    EXPECT_EQ(seen.normal, b.sightings.at(key).normal);
  }
}

void expect_same_bytes(const RenderState& a, const RenderState& b) {
  EXPECT_EQ(a.film.passes, b.film.passes);
  EXPECT_EQ(a.film.chunks, b.film.chunks);
  EXPECT_TRUE(same_bytes(a.film.camera_sum, b.film.camera_sum));
  EXPECT_TRUE(same_bytes(a.film.splat_sum, b.film.splat_sum));
  EXPECT_TRUE(same_bytes(a.film.half_sum, b.film.half_sum));
  EXPECT_TRUE(same_bytes(a.film.square_sum, b.film.square_sum));
  EXPECT_TRUE(same_bytes(a.film.camera, b.film.camera));
  EXPECT_TRUE(same_bytes(a.film.splat, b.film.splat));
  EXPECT_TRUE(same_bytes(develop(a.film).pixels, develop(b.film).pixels));
  ASSERT_EQ(a.pyramid.layers.size(), b.pyramid.layers.size());
  for (const auto& [st, layer] : a.pyramid.layers) {
    ASSERT_TRUE(b.pyramid.layers.contains(st));
    EXPECT_TRUE(same_bytes(layer.raw, b.pyramid.layers.at(st).raw));
    EXPECT_TRUE(same_bytes(layer.weighted, b.pyramid.layers.at(st).weighted));
  }
  EXPECT_EQ(a.stats.counters.camera_rays, b.stats.counters.camera_rays);
  EXPECT_EQ(a.stats.counters.light_rays, b.stats.counters.light_rays);
  EXPECT_EQ(a.stats.counters.shadow_rays, b.stats.counters.shadow_rays);
  for (int s = 0; s <= Ledger::most; ++s)
    for (int t = 0; t <= Ledger::most; ++t) {
      const StrategyCost &x = a.stats.ledger.strategies[s][t], &y = b.stats.ledger.strategies[s][t];
      EXPECT_EQ(x.joins, y.joins);
      EXPECT_EQ(x.rays, y.rays);
      EXPECT_EQ(x.visible, y.visible);
      EXPECT_EQ(x.energy, y.energy);
      EXPECT_EQ(a.stats.ledger.merges[s][t].joins, b.stats.ledger.merges[s][t].joins);
      EXPECT_EQ(a.stats.ledger.merges[s][t].energy, b.stats.ledger.merges[s][t].energy);
    }
  EXPECT_EQ(a.film.dropped, b.film.dropped);
  expect_same_learning(a.learning, b.learning);
}

RenderOptions options_of(const std::string& integrator, uint32_t spp, uint64_t seed = 5) {
  RenderOptions o;
  o.integrator = integrator;
  o.spp = spp;
  o.seed = seed;
  return o;
}

bool always(const RenderState&) { return true; }

struct File {
  std::string path;
  explicit File(const std::string& name)
      : path((std::filesystem::temp_directory_path() / (name + std::to_string(getpid()))).string()) {}
  ~File() { std::filesystem::remove(path); }
};

TEST(Determinism, ThreadsDoNotMatter) {
  const Scene scene = strip(false);
  const Accel accel(scene);
  for (const std::string& integrator : integrator_names()) {
    RenderOptions o = options_of(integrator, 3);
    o.techniques = integrator == "bdpt" || integrator == "vcm";
    o.threads = 1;
    const RenderState one = rendered(scene, accel, o);
    for (const int threads : {2, 7}) {
      o.threads = threads;
      SCOPED_TRACE(integrator);
      expect_same_bytes(one, rendered(scene, accel, o));
    }
  }
}

TEST(Determinism, SeedsMatter) {
  const Scene scene = strip(false);
  const Accel accel(scene);
  for (const std::string& integrator : integrator_names()) {
    const RenderState a = rendered(scene, accel, options_of(integrator, 2, 1));
    const RenderState b = rendered(scene, accel, options_of(integrator, 2, 2));
    EXPECT_FALSE(same_bytes(develop(a.film).pixels, develop(b.film).pixels)) << integrator;
  }
}

TEST(Determinism, GoingOnIsTheStraightRun) {
  const Scene scene = strip(true);
  const Accel accel(scene);
  for (const std::string& integrator : integrator_names()) {
    SCOPED_TRACE(integrator);
    const RenderOptions o = options_of(integrator, 3);
    const RenderState straight = rendered(scene, accel, o);
    ASSERT_EQ(chunk_count(straight.film), 257u);
    // Stops at each look: in the middle of a pass and at its end, in turns.
    RenderState state = start_render(scene, o);
    int stops = 0, amid = 0;
    while (in_training(state.learning) || state.film.passes < o.spp) {
      render(scene, accel, o, state, [](const RenderState&) { return false; });
      ++stops;
      amid += state.film.chunks != 0;
    }
    const int passes = int(o.spp + state.film.dropped);
    EXPECT_EQ(stops, 2 * passes);
    EXPECT_EQ(amid, passes);
    expect_same_bytes(straight, state);
  }
}

// The grid of tiles lies elsewhere in every pass, round the film's edges; what a pass has not come to shows the passes
// before it.
TEST(Determinism, TilesMoveFromPassToPass) {
  Scene scene = strip(true);
  set_camera(scene, {0, 0, 2}, {0, 0, 0}, 36, 4112, 2);  // sees walls alone
  finish(scene);
  const Accel accel(scene);
  const RenderOptions o = options_of("path", 2);
  const std::vector<float> one = develop(rendered(scene, accel, options_of("path", 1)).film).pixels;
  const RenderState both = rendered(scene, accel, o);
  const std::vector<float> two = develop(both.film).pixels;
  RenderState amid = start_render(scene, o);
  render(scene, accel, o, amid, [](const RenderState& s) { return s.film.passes == 0 || s.film.chunks == 0; });
  ASSERT_EQ(amid.film.chunks, 256u);
  const std::vector<float> now = develop(amid.film).pixels;
  size_t open = 0;
  for (size_t i = 0; i < now.size(); ++i) {
    EXPECT_TRUE(now[i] == one[i] || now[i] == two[i]);
    open += now[i] == one[i] && now[i] != two[i];
  }
  EXPECT_GT(open, 3u * 16) << "some of a tile of 16x2 pixels see the same twice";
  EXPECT_LE(open, 3u * 32);
  Film film = both.film;
  std::vector<int> places;
  for (film.passes = 0; film.passes < 64; ++film.passes) places.push_back(tile_shift(film).x);
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  EXPECT_GT(places.size(), 12u) << "of 16";
}

// Time budgets cut passes into other batches: first a few tiles, then what the rest of the time suffices for.
TEST(Determinism, TimeDoesNotMatter) {
  const Scene scene = strip(true);
  const Accel accel(scene);
  RenderOptions o = options_of("bdpt", 2);
  o.techniques = true;
  RenderState straight = start_render(scene, o), timed = straight;
  render(scene, accel, o, straight, always);
  o.cpu_seconds = 2e-3;
  uint32_t begun = 0;
  render(scene, accel, o, timed, [&](const RenderState& s) {
    if (begun == 0) begun = s.film.chunks;
    return true;
  });
  EXPECT_EQ(begun, 16u) << "not a whole batch for a budget of a few tiles";
  EXPECT_EQ(timed.film.passes, 1u) << "but never less than a pass";
  EXPECT_EQ(timed.film.chunks, 0u);
  while (timed.film.passes < 2) {
    o.cpu_seconds = 1.2 * timed.stats.cpu_seconds;
    render(scene, accel, o, timed, [](const RenderState& s) { return s.film.passes < 2; });
  }
  EXPECT_EQ(timed.film.chunks, 0u);
  expect_same_bytes(straight, timed);
}

TEST(Determinism, CheckpointAmidAPassIsTheStraightRun) {
  const Scene scene = strip(true);
  const Accel accel(scene);
  for (const std::string& integrator : integrator_names()) {
    SCOPED_TRACE(integrator);
    RenderOptions o = options_of(integrator, 2);
    o.techniques = integrator == "bdpt";
    const RenderState straight = rendered(scene, accel, o);
    const File file("ajar_checkpoint");
    RenderState first = start_render(scene, o);
    int looks = 0;
    render(scene, accel, o, first, [&](const RenderState&) { return ++looks < 3; });
    ASSERT_EQ(first.film.passes, 1u);
    ASSERT_NE(first.film.chunks, 0u);
    first.stats.replay = {"pixel 3,4 pass 0 seed 5", ""};
    save_checkpoint(file.path, "key", first);
    RenderState second = start_render(scene, o);
    load_checkpoint(file.path, "key", second);
    expect_same_bytes(first, second);
    EXPECT_EQ(first.stats.replay, second.stats.replay);
    render(scene, accel, o, second, always);
    expect_same_bytes(straight, second);
    EXPECT_EQ(second.stats.rejected, 0u);
  }
}

// Stopped among the young passes, at their end and after it, amid lessons and amid passes; each time from a file.
TEST(Determinism, GuidedCheckpointsAreTheStraightRun) {
  const Scene scene = strip(true);
  const Accel accel(scene);
  const RenderOptions o = options_of("guided-bdpt", 14);
  const RenderState straight = rendered(scene, accel, o);
  EXPECT_EQ(straight.film.dropped, blind_generations);
  EXPECT_EQ(straight.learning.fields.generation, young_generations + 1) << "learned once since";
  ASSERT_GT(straight.learning.fields.cells.size(), 10u);
  const std::vector<float>& joins = straight.learning.fields.views.tried;
  EXPECT_GT(std::count_if(joins.begin(), joins.end(), [](float n) { return n > 0; }), 10) << "regions were joined";
  const File file("ajar_guided");
  RenderState state = start_render(scene, o);
  for (const int looks : {3, 2, 11, 1, 9, 1000}) {
    int seen = 0;
    render(scene, accel, o, state, [&](const RenderState&) { return ++seen < looks; });
    save_checkpoint(file.path, "key", state);
    RenderState next = start_render(scene, o);
    load_checkpoint(file.path, "key", next);
    expect_same_bytes(state, next);
    EXPECT_EQ(state.stats.learn_seconds, next.stats.learn_seconds);
    state = std::move(next);
  }
  expect_same_bytes(straight, state);
}

// Quiet images need few light subpaths, whatever the unit of light; those that are young, or that teach, all of them.
TEST(Determinism, LightSubpathsAreAsManyAsNoiseAsksFor) {
  for (const float factor : {1.0f, 1e-6f, 1e6f}) {
    Scene scene = stage(32);
    scene.lights[0].radiance.value *= factor;
    finish(scene);
    const Accel accel(scene);
    RenderOptions o = options_of("guided-bdpt", 8);
    RenderState state = rendered(scene, accel, o);
    const double pixels = double(state.film.pixels()), young = pixels * blind_generations;
    EXPECT_EQ(state.pixels_per_light, RenderState::most_light) << factor << ", not looked at yet";
    EXPECT_NEAR(double(state.stats.counters.light_paths), young + 8 * pixels / 2, 0.02 * young);
    o.spp = 9;
    render(scene, accel, o, state, {});
    EXPECT_EQ(state.pixels_per_light, RenderState::least_light) << factor;
    EXPECT_NEAR(double(state.stats.counters.light_paths), young + 8 * pixels / 2 + pixels / 4, 0.02 * young);
  }
  const Scene rooms = two_rooms(5);
  EXPECT_EQ(rendered(rooms, Accel(rooms), options_of("guided-bdpt", 9)).pixels_per_light, RenderState::most_light);
}

// What young fields need is so many paths, however many pixels there are.
TEST(Determinism, LargeImagesAreTaughtByASmallShareOfTheirPixels) {
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
    for (uint32_t generation : {0u, 1u, 2u, 3u, 4u, 7u, 8u}) {
      learning.fields.generation = generation;
      out.emplace_back(traced_one_in(learning, film), recorded_one_in(learning, film));
    }
    return out;
  };
  using Shares = std::vector<std::pair<uint32_t, uint32_t>>;
  EXPECT_EQ(shares(64, 64), (Shares{{1, 1}, {1, 1}, {1, 1}, {1, 1}, {1, 1}, {1, 1}, {1, 8}}));
  // Where few pixels are traced at first, few are until the first passes are dropped: none of them is an image.
  EXPECT_EQ(shares(128, 64), (Shares{{2, 1}, {2, 1}, {2, 1}, {2, 1}, {1, 1}, {1, 1}, {1, 8}}));
  EXPECT_EQ(shares(256, 256), (Shares{{16, 1}, {16, 1}, {8, 1}, {8, 1}, {1, 4}, {1, 4}, {1, 8}}));
  EXPECT_EQ(shares(1024, 1024), (Shares{{16, 1}, {16, 1}, {8, 1}, {8, 1}, {1, 8}, {1, 8}, {1, 8}}));
  EXPECT_EQ(passes_lost(64 * 64), 12);
  EXPECT_EQ(passes_lost(256 * 256), 1.75);
  EXPECT_EQ(passes_lost(1024 * 1024), 1.25);
  for (const auto& [traced, recorded] : shares(256, 256, 8)) EXPECT_EQ(traced, 1u) << "training is what it says";
}

TEST(Determinism, StoredFieldsSpareTheYoungPasses) {
  const Scene scene = strip(false);
  const Accel accel(scene);
  const RenderOptions o = options_of("guided-bdpt", 9);
  const RenderState first = rendered(scene, accel, o);
  const File file("ajar_fields");
  save_fields(file.path, stored_fields(scene, first.learning, first.film));
  RenderState second = start_render(scene, o);
  go_on_from(load_fields(file.path, scene_key(scene)), o.learn, second.learning, second.film);
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
  go_on_from(stored_fields(scene, young.learning, young.film), o.learn, third.learning, third.film);
  render(scene, accel, o, third, always);
  EXPECT_EQ(dropped_passes(third.learning, third.film), blind_generations - 3);
}

TEST(Determinism, FieldsGuideTheSideThatIsAskedFor) {
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
    go_on_from(stored_fields(scene, both.learning, both.film), o.learn, loaded.learning, loaded.film);
    EXPECT_EQ(guides(loaded.learning.fields.q), side == Guided::camera);
    EXPECT_EQ(guides(loaded.learning.fields.w), side == Guided::light);
  }
}

TEST(Determinism, DamagedOrForeignCheckpointsAreErrors) {
  const Scene scene = strip(false);
  const Accel accel(scene);
  const RenderOptions o = options_of("bdpt", 1);
  const File file("ajar_damaged");
  save_checkpoint(file.path, "key", rendered(scene, accel, o));
  const auto size = std::filesystem::file_size(file.path);
  RenderState state = start_render(scene, o);
  EXPECT_THROW(load_checkpoint(file.path, "other", state), Error);
  EXPECT_THROW(load_checkpoint(file.path + "no", "key", state), Error);
  RenderState camera_alone = start_render(scene, options_of("path", 1));
  EXPECT_THROW(load_checkpoint(file.path, "key", camera_alone), Error);
  for (const double part : {0.0, 0.001, 0.3, 0.9, 0.99999}) {
    std::filesystem::resize_file(file.path, uint64_t(double(size) * part));
    RenderState fresh = start_render(scene, o);
    EXPECT_THROW(load_checkpoint(file.path, "key", fresh), Error) << part;
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

TEST(Determinism, UnknownIntegratorIsAnError) {
  const Scene scene = strip(false);
  EXPECT_THROW(start_render(scene, options_of("pth", 1)), Error);
}

TEST(Determinism, WeightedTechniquesAddUpToTheImage) {
  const Scene scene = strip(false);  // its filter has negative lobes
  const Accel accel(scene);
  for (const char* integrator : {"bdpt", "guided-bdpt"}) {
    RenderOptions o = options_of(integrator, 4);
    o.techniques = true;
    o.max_depth = most_vertices - 1;  // longer paths have no image
    const RenderState state = rendered(scene, accel, o);
    const Picture image = develop(state.film);
    double worst = 0, brightest = 0;
    for (size_t i = 0; i < image.pixels.size(); ++i) {
      double sum = 0;
      for (const auto& [st, layer] : state.pyramid.layers) sum += layer.weighted[i / 3][glm::length_t(i % 3)];
      worst = std::max(worst, std::abs(sum / state.film.passes - double(image.pixels[i])));
      brightest = std::max(brightest, double(image.pixels[i]));
    }
    EXPECT_LT(worst, 1e-5 * brightest) << integrator;
  }
}

TEST(Sampler, SequenceBeatsIndependentNumbers) {
  Scene scene = stage(32);
  finish(scene);
  const Accel accel(scene);
  for (const std::string integrator : {"path", "bdpt"}) {
    RenderOptions o = options_of(integrator, 1024, 99);
    o.max_depth = 2;
    const Picture reference = develop(rendered(scene, accel, o).film);
    double error[2];
    for (const SamplerKind kind : {SamplerKind::sobol, SamplerKind::independent}) {
      o.spp = 64, o.seed = 1, o.sampler = kind;
      const Picture image = develop(rendered(scene, accel, o).film);
      double sum = 0;
      for (size_t i = 0; i < image.pixels.size(); ++i) sum += sqr(image.pixels[i] - reference.pixels[i]);
      error[int(kind)] = sum;
    }
    EXPECT_LT(error[0], 0.6 * error[1]) << integrator;
    RecordProperty(integrator + "_mse_ratio", std::to_string(error[0] / error[1]));
  }
}

}  // namespace
}  // namespace ajar
