// The same bytes with any number of threads, after a stop and after a checkpoint.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "ajar/core/error.h"
#include "bytes.h"
#include "kit/files.h"

namespace ajar {
namespace {

using namespace kit;

TEST(Determinism, ThreadsDoNotMatter) {
  const Scene scene = strip(false);
  const Accel accel(scene);
  for (const std::string& integrator : tried_integrators()) {
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
  for (const std::string& integrator : tried_integrators()) {
    const RenderState a = rendered(scene, accel, options_of(integrator, 2, 1));
    const RenderState b = rendered(scene, accel, options_of(integrator, 2, 2));
    EXPECT_FALSE(same_bytes(develop(a.film).pixels, develop(b.film).pixels)) << integrator;
  }
}

TEST(Determinism, GoingOnIsTheStraightRun) {
  const Scene scene = strip(true);
  const Accel accel(scene);
  for (const std::string& integrator : tried_integrators()) {
    SCOPED_TRACE(integrator);
    const RenderOptions o = options_of(integrator, 3);
    const RenderState straight = rendered(scene, accel, o);
    ASSERT_EQ(chunk_count(straight.film), 257u);
    // Stops at each look: in the middle of a pass, where joins are made in smaller batches twice, and at its end.
    RenderState state = start_render(scene, o);
    uint32_t ends = 0, amid = 0;
    while (in_training(state.learning) || state.film.passes < o.spp) {
      render(scene, accel, o, state, [](const RenderState&) { return false; });
      ++(state.film.chunks == 0 ? ends : amid);
    }
    EXPECT_EQ(ends, o.spp + state.film.dropped);
    EXPECT_GE(amid, ends);
    EXPECT_LE(amid, 2 * ends);
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
  for (const std::string& integrator : tried_integrators()) {
    SCOPED_TRACE(integrator);
    RenderOptions o = options_of(integrator, 2);
    o.techniques = integrator == "bdpt";
    const RenderState straight = rendered(scene, accel, o);
    const File file("ajar_checkpoint");
    RenderState first = start_render(scene, o);
    render(scene, accel, o, first, [&](const RenderState& s) { return s.film.passes < 1 || s.film.chunks == 0; });
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
  RenderOptions o = options_of("guided-bdpt", 14);
  o.limit_fireflies = o.techniques = true;
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

TEST(Determinism, DamagedOrForeignCheckpointsAreErrors) {
  const Scene scene = strip(false);
  const Accel accel(scene);
  const RenderOptions o = options_of("bdpt", 1);
  const File file("ajar_damaged");
  save_checkpoint(file.path, "key", rendered(scene, accel, o));
  const auto size = std::filesystem::file_size(file.path);
  RenderState state = start_render(scene, o);
  const auto refusal = [&](const std::string& key) {
    return kit::error_of([&] { load_checkpoint(file.path, key, state); });
  };
  EXPECT_NE(refusal("other").find("other options"), std::string::npos) << refusal("other");
  constexpr std::streamoff key_at = 16;  // after magic and length
  std::fstream(file.path, std::ios::binary | std::ios::in | std::ios::out).seekp(key_at).put('K');
  EXPECT_NE(refusal("key").find("is damaged"), std::string::npos) << refusal("key");
  EXPECT_THROW(read_checkpoint_key(file.path), Error);
  save_checkpoint(file.path, "key", rendered(scene, accel, o));
  EXPECT_THROW(load_checkpoint(file.path + "no", "key", state), Error);
  for (const char* other : {"path", "light", "vcm"}) {
    RenderState another = start_render(scene, options_of(other, 1));
    const std::string said = kit::error_of([&] { load_checkpoint(file.path, "key", another); });
    EXPECT_NE(said.find(fmt::format("a checkpoint of bdpt, not of {};", other)), std::string::npos) << said;
  }
  RenderOptions with_layers = o;
  with_layers.techniques = true;
  RenderState short_layer = rendered(scene, accel, with_layers);
  short_layer.pyramid.layers.begin()->second.raw.pop_back();
  save_checkpoint(file.path + ".layers", "key", short_layer);
  RenderState layers = start_render(scene, with_layers);
  EXPECT_THROW(load_checkpoint(file.path + ".layers", "key", layers), Error);
  EXPECT_EQ(layers.film.passes, 0u) << "nothing of what was read before the error";
  EXPECT_NO_THROW(render(scene, accel, with_layers, layers, always));
  std::filesystem::remove(file.path + ".layers");
  for (const double part : {0.0, 0.001, 0.3, 0.9, 0.99999}) {
    std::filesystem::resize_file(file.path, uint64_t(double(size) * part));
    RenderState fresh = start_render(scene, o);
    EXPECT_THROW(load_checkpoint(file.path, "key", fresh), Error) << part;
  }
}

TEST(Determinism, CheckpointsOfPassesThatCountForNothingAreErrors) {
  const Scene scene = strip(false);
  const RenderOptions o = options_of("bdpt", 2);
  RenderState state = rendered(scene, Accel(scene), o);
  const File file("ajar_weights");
  for (const double weight : {0.0, 1.5, 10.0, -2.0, std::nan("")}) {  // of two passes, the even one's being 1
    state.film.weight = weight;
    save_checkpoint(file.path, "key", state);
    RenderState fresh = start_render(scene, o);
    EXPECT_THROW(load_checkpoint(file.path, "key", fresh), Error) << weight;
  }
}

// Large images would not fit otherwise: those set aside are mostly none.
TEST(Determinism, CheckpointsBringNoFilmThatIsNotThere) {
  const Scene scene = strip(false);
  const RenderOptions o = options_of("bdpt", 1);
  const RenderState saved = rendered(scene, Accel(scene), o);
  const File file("ajar_one_film");
  save_checkpoint(file.path, "key", saved);
  RenderState state = start_render(scene, o);
  load_checkpoint(file.path, "key", state);
  EXPECT_EQ(state.film.camera_sum, saved.film.camera_sum);
  for (const Film* film : {&state.plain.guided.film, &state.plain.with_merging.film})
    for (const auto* sums : {&film->camera_sum, &film->splat_sum, &film->half_sum, &film->square_sum})
      EXPECT_EQ(sums->capacity(), 0u);
}

TEST(Determinism, CheckpointsThatFailLeaveTheStateAsItWas) {
  const Scene scene = strip(true);
  const Accel accel(scene);
  RenderOptions o = options_of("guided-bdpt", 2);
  const File file("ajar_failing");
  save_checkpoint(file.path, "key", rendered(scene, accel, o));
  std::filesystem::resize_file(file.path, std::filesystem::file_size(file.path) - 1);
  o.spp = 1;
  RenderState state = rendered(scene, accel, o);
  const RenderState before = state;
  EXPECT_THROW(load_checkpoint(file.path, "key", state), Error);
  expect_same_bytes(state, before);
  EXPECT_EQ(state.film.filter.radius, before.film.filter.radius);
}

TEST(Determinism, ACheckpointOfOtherLightsIsNotGoneOnWith) {
  const Scene lamps = many_lights(64, 1, 32);
  Scene room = cornell(32);
  room.camera = lamps.camera;
  finish(room);
  RenderOptions o = options_of("guided-bdpt", 40);
  const File file("ajar_other_lights");
  save_checkpoint(file.path, "key", rendered(lamps, Accel(lamps), o));
  RenderState state = start_render(room, o);
  load_checkpoint(file.path, "key", state);
  o.spp = 60;
  const std::string said = kit::error_of([&] { render(room, Accel(room), o, state, always); });
  EXPECT_NE(said.find("lights is of another scene"), std::string::npos) << said;
}

TEST(Determinism, UnknownIntegratorIsAnError) {
  const Scene scene = strip(false);
  EXPECT_THROW(start_render(scene, options_of("pth", 1)), Error);
}

// Of whole passes, and of one that was stopped half-way.
TEST(Determinism, WeightedTechniquesAddUpToTheImage) {
  for (const bool stops : {false, true}) {
    const Scene scene = strip(stops);  // its filter has negative lobes
    const Accel accel(scene);
    for (const char* integrator : {"bdpt", "guided-bdpt", "vcm", "photon"}) {
      SCOPED_TRACE(fmt::format("{}{}", integrator, stops ? ", stopped" : ""));
      RenderOptions o = options_of(integrator, 4);
      o.techniques = true;
      o.max_depth = most_vertices - 2;  // longer paths, with the vertex that merged ones count twice, have no image
      RenderState state = start_render(scene, o);
      render(scene, accel, o, state,
             [&](const RenderState& s) { return !stops || s.film.passes < 1 || s.film.chunks == 0; });
      EXPECT_EQ(state.film.chunks > 0, stops);
      const Picture image = develop(state.film);
      std::vector<double> sums(image.pixels.size());
      for (const auto& [st, layer] : state.pyramid.layers) {
        const Picture part = average(state.film, layer.weighted, st.second == 1);
        for (size_t i = 0; i < sums.size(); ++i) sums[i] += double(part.pixels[i]);
      }
      double worst = 0, brightest = 0;
      for (size_t i = 0; i < sums.size(); ++i) {
        worst = std::max(worst, std::abs(sums[i] - double(image.pixels[i])));
        brightest = std::max(brightest, double(image.pixels[i]));
      }
      EXPECT_LT(worst, 1e-5 * brightest);
    }
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

// A normal map bends normals alone, so a mask inside of it is the mask around it.
TEST(Determinism, MasksInsideOfNormalMapsAreTheSame) {
  const auto leaves = [](bool mask_outside) {
    Scene scene = stage();
    Material mask, map;
    mask.kind = MaterialKind::mask, mask.weight = add_checkerboard(scene, Rgb(0.9f), Rgb(0.1f));
    map.kind = MaterialKind::normalmap, map.map = Slot(Rgb(0.6f, 0.4f, 0.9f));
    Material &outer = mask_outside ? mask : map, &inner = mask_outside ? map : mask;
    inner.nested[0] = add_diffuse(scene, {0.3f, 0.6f, 0.2f});
    outer.nested[0] = add_material(scene, inner);
    add_quad(scene, {-0.8f, 0.2f, -0.8f}, {1.6f, 0, 0}, {0, 0, 1.6f}, add_material(scene, outer));
    finish(scene);
    return scene;
  };
  const Scene outside = leaves(true), inside = leaves(false);
  for (const char* integrator : {"path", "bdpt"}) {
    const RenderOptions o = options_of(integrator, 4);
    const std::vector<float> a = develop(rendered(outside, Accel(outside), o).film).pixels;
    EXPECT_TRUE(same_bytes(a, develop(rendered(inside, Accel(inside), o).film).pixels)) << integrator;
  }
}

// A mask is a blend with nothing, and a mixture with it, and rays see no difference.
TEST(Determinism, MasksAreBlendsWithNothing) {
  const auto veil = [](MaterialKind kind) {
    Scene scene = stage();
    Material outer, nothing;
    nothing.kind = MaterialKind::null;
    outer.kind = kind, outer.weight = 0.5f, outer.weights = {0.5f, 0.5f, 0, 0};
    if (kind != MaterialKind::mask) outer.nested[0] = add_material(scene, nothing);
    outer.nested[kind == MaterialKind::mask ? 0 : 1] = add_diffuse(scene, {0.3f, 0.6f, 0.2f});
    add_quad(scene, {-0.8f, 0.2f, -0.8f}, {1.6f, 0, 0}, {0, 0, 1.6f}, add_material(scene, outer));
    finish(scene);
    return scene;
  };
  const Scene mask = veil(MaterialKind::mask);
  for (const char* integrator : {"path", "bdpt"}) {
    const RenderOptions o = options_of(integrator, 4);
    const std::vector<float> a = develop(rendered(mask, Accel(mask), o).film).pixels;
    for (const MaterialKind kind : {MaterialKind::blend, MaterialKind::mixture}) {
      const Scene other = veil(kind);
      EXPECT_TRUE(same_bytes(a, develop(rendered(other, Accel(other), o).film).pixels)) << integrator;
    }
  }
}

}  // namespace
}  // namespace ajar
