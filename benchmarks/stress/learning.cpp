// Cases of learned fields that are odd, wrong or hostile: the image must be right all the same.
#include <fmt/format.h>

#include <unistd.h>
#include <algorithm>
#include <filesystem>
#include <numeric>

#include "ajar/core/sampler.h"
#include "ajar/film/picture.h"
#include "ajar/scene/build.h"
#include "cases.h"

namespace ajar::stress {
namespace {

constexpr int usual_height = 14;

Scene usual() { return two_rooms(40, usual_height); }

Scene with_radiance(const Rgb& radiance) {
  Scene scene = usual();
  scene.lights[0].radiance.value = radiance;
  finish(scene);
  return scene;
}

// What guided-bdpt learns of a scene.
StoredFields learned(const Scene& scene, uint32_t passes, const LearnOptions& learn = {}) {
  RenderOptions o;
  o.integrator = "guided-bdpt";
  o.sampler = SamplerKind::independent;
  o.seed = 77;
  o.spp = passes;
  o.learn = learn, o.learn.least_contrast = 2;
  const Accel accel(scene);
  RenderState state = start_render(scene, o);
  render(scene, accel, o, state, nullptr);
  return stored_fields(scene, state.learning, passes_drawn(state.film, state.adaptive));
}

// Gives what the strongest stratum of a node has to the weakest, and so on, and trusts that as far as anything is
// trusted.
StoredFields upside_down() {
  StoredFields stored = learned(usual(), 32);
  for (Field* field : {&stored.fields.q, &stored.fields.w}) {
    for (StrataNode& node : field->nodes) {
      std::array<int, 16> order;
      std::array<uint32_t, 16> steps;
      std::iota(order.begin(), order.end(), 0);
      for (int i = 0; i < 16; ++i) steps[size_t(i)] = node.steps(i);
      std::sort(order.begin(), order.end(), [&](int a, int b) { return steps[size_t(a)] < steps[size_t(b)]; });
      std::array<uint32_t, 16> next{};
      for (size_t i = 0; i < 16; ++i) next[size_t(order[i])] = steps[size_t(order[15 - i])];
      uint32_t before = 0;
      for (size_t i = 0; i < 16; ++i) node.before[i] = uint16_t(before), before += next[i];
    }
    for (FieldCell& cell : field->cells) cell.mix = 0.8f, cell.even = 0;
  }
  return stored;
}

// What roulette is told to expect is wrong by up to a million, another factor in every cell.
StoredFields lying() {
  StoredFields stored = learned(usual(), 32);
  for (Field* field : {&stored.fields.q, &stored.fields.w})
    for (size_t i = 0; i < field->cells.size(); ++i) {
      const float lie = std::pow(10.0f, 12 * to_unit(uint32_t(hash(i, 5) >> 32)) - 6);
      field->cells[i].direct *= lie, field->cells[i].total *= lie;
    }
  return stored;
}

// Bytes in which the usual scene's fields find room for one cell: the least with which they learn any, in steps far
// smaller than a cell.
size_t room_for_one() {
  static const size_t room = [] {
    const double none = double(bytes(start_fields(usual(), 1)));
    for (double memory = none; memory < 4 * none; memory *= 1.01) {
      LearnOptions o;
      o.memory = size_t(memory);
      if (!learned(usual(), 8, o).fields.cells.empty()) return o.memory;
    }
    return size_t(0);
  }();
  return room;
}

void with_room_for_a_million(LearnOptions& o) {
  o.structure = Structure::probes, o.memory = size_t(2) << 30;
  o.train = 2;
}

// Each probe's cell is there from the beginning, and knows nothing.
StoredFields million_cells() {
  const Scene scene = usual();
  LearnOptions o;
  with_room_for_a_million(o);
  const Camera& c = scene.camera;
  const Fields none = start_fields(scene, double(c.crop_width) * c.crop_height, o);
  Sightings sightings;
  for (const Probe& probe : none.table.probes)
    if (const CellKey key = find(none.table, probe.p, probe.n).missing)
      for (int i = 0; i < 4; ++i) record_missing(sightings, key, probe.n);
  const Training nothing = start_training(none);
  return {learn(none, nothing, sightings, {0, 0}, o, &scene.light_tree), scene_key(scene), 0};
}

void freeze(LearnOptions& o) { o.train = 2; }

std::string scratch(const char* name) {
  return (std::filesystem::temp_directory_path() / fmt::format("ajar-stress-{}-{}", getpid(), name)).string();
}

// Through a file, which must be refused.
void load_back(const StoredFields& stored, const Scene& scene) {
  const std::string path = scratch("fields");
  save_fields(path, stored);
  try {
    load_fields(path, scene_key(scene));
  } catch (...) {
    std::filesystem::remove(path);
    throw;
  }
}

// A scene whose fields come from a file with a value in the wrong place.
Scene poisoned(float value) {
  const Scene scene = usual();
  StoredFields stored = learned(scene, 8);
  stored.fields.q.cells[stored.fields.q.cells.size() / 2].total = value;
  load_back(stored, scene);
  return scene;
}

Scene with_fields_of(const Scene& other) {
  Scene scene = usual();
  load_back(learned(other, 8), scene);
  return scene;
}

Scene with_texel(float value) {
  const std::string path = scratch("texture.exr");
  Picture picture{4, 4, {"R", "G", "B"}, std::vector<float>(48, 0.5f)};
  picture.pixels[20] = value;
  write_exr(path, picture);
  Scene scene = usual();
  try {
    scene.images.push_back(load_image(path));
  } catch (...) {
    std::filesystem::remove(path);
    throw;
  }
  return scene;
}

// Learning as such, in a scene that needs it a little.
void add_rates(std::vector<Case>& all) {
  const auto add = [&](std::string name, std::function<void(LearnOptions&)> tune) {
    all.push_back({"learning", std::move(name), usual});
    all.back().judge = "bdpt";
    all.back().tune = std::move(tune);
  };
  add("as usual", nullptr);
  add("no room for a cell", [](LearnOptions& o) { o.memory = 1; });
  all.back().most_cells = 0;
  add("one cell", [](LearnOptions& o) { o.memory = room_for_one(); });
  all.back().least_cells = all.back().most_cells = 1;
  add("cells divided at once, 1 GB", [](LearnOptions& o) { o.divide_cell = 1, o.memory = size_t(1) << 30; });
  add("a million cells", with_room_for_a_million);
  all.back().fields = million_cells;
  all.back().large = true, all.back().passes = 4, all.back().least_cells = 1000000;
  add("strata divided at once", [](LearnOptions& o) { o.divide_stratum = 1e-6f; });
  add("older evidence forgotten", [](LearnOptions& o) { o.forget = 0; });
  add("older evidence kept", [](LearnOptions& o) { o.forget = 1; });
  add("one record is trusted", [](LearnOptions& o) { o.trust = 1e-6f; });
  all.back().tails = true, all.back().passes = 32;
  add("nothing is trusted", [](LearnOptions& o) { o.trust = 1e30f; });
  for (const float mix : {0.99f, 0.9999f}) {
    add(fmt::format("mix {:g}", mix), [mix](LearnOptions& o) { o.mix = mix, o.trust = 1e-6f; });
    all.back().tails = true, all.back().passes = 32;
    all.back().limit = mix > 0.999f;
  }
  add("grid", [](LearnOptions& o) { o.structure = Structure::grid; });
  add("probes", [](LearnOptions& o) { o.structure = Structure::probes; });
  add("max rule", [](LearnOptions& o) { o.rule = Rule::max; });
  add("returns", [](LearnOptions& o) { o.rule = Rule::returned; });
}

void add_wrong_fields(std::vector<Case>& all) {
  const auto add = [&](std::string name, std::function<StoredFields()> fields) {
    all.push_back({"wrong fields", std::move(name), usual});
    all.back().judge = "bdpt";
    all.back().fields = std::move(fields);
    all.back().tails = true, all.back().passes = 32;
    all.back().tune = freeze;
  };
  add("the scene's own", [] { return learned(usual(), 32); });
  add("of a million paths in the dark", [] { return learned(with_radiance(Rgb(0)), 2900); });
  all.back().tune = nullptr;
  add("of a lamp a billion times as dim", [] { return learned(with_radiance(Rgb(1e-9f)), 32); });
  add("of another scene", [] { return learned(cornell(24), 32); });
  add("upside down", upside_down);
  add("lying by 1e6", lying);
}

void add_refused(std::vector<Case>& all) {
  const auto add = [&](std::string name, std::string refused, std::function<Scene()> make) {
    all.push_back({"bad input", std::move(name), std::move(make)});
    all.back().refused = std::move(refused);
    if (all.back().refused.empty()) all.back().judge.clear();
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  add("fields that are sound", "", [] { return with_fields_of(usual()); });
  add("fields with NaN", "damaged", [nan] { return poisoned(nan); });
  add("fields with infinity", "damaged", [] { return poisoned(infinity); });
  add("fields below zero", "damaged", [] { return poisoned(-1); });
  add("fields of another scene", "another scene", [] { return with_fields_of(cornell(8)); });
  add("texture that is sound", "", [] { return with_texel(0.25f); });
  add("texture with NaN", "holds nan", [nan] { return with_texel(nan); });
  add("texture with infinity", "holds inf", [] { return with_texel(infinity); });
}

}  // namespace

std::vector<Case> learning_cases() {
  std::vector<Case> all;
  add_rates(all);
  add_wrong_fields(all);
  add_refused(all);
  return all;
}

}  // namespace ajar::stress
