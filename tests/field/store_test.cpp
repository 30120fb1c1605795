// Files of fields: the same back, and whatever the file says, no fields that are not safe to use.
#include "ajar/field/store.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "ajar/core/error.h"
#include "ajar/core/sampler.h"
#include "ajar/core/warp.h"
#include "ajar/field/learn.h"
#include "ajar/field/portals.h"
#include "ajar/scene/build.h"
#include "kit/stage.h"

namespace ajar {
namespace {

Scene room() {
  Scene scene = kit::stage(8);
  finish(scene);
  return scene;
}

// Learned from made-up records: a narrow light, so that cells and strata divide.
Fields learned(const Scene& scene, int generations, Structure structure = Structure::adaptive) {
  LearnOptions options;
  options.divide_cell = 40, options.structure = structure, options.rule = Rule::returned;
  Fields fields = start_fields(scene, 64, options);
  if (structure == Structure::adaptive) fields.table.portals = {{0, 0.2f, {0.3f, 0, 0}, 3}};
  add_portals(fields);
  for (int g = 0; g < generations; ++g) {
    Training training = start_training(fields);
    Sightings sightings;
    Sampler sampler = make_sampler(SamplerKind::independent, 7, Side::camera, 0, uint32_t(g));
    for (int i = 0; i < 4000; ++i) {
      const Vec2 u = sampler.next2();
      const Vec3 p(2 * u.x - 1, i % 2 ? -1 : 1, 2 * u.y - 1), n(0, i % 2 ? 1 : -1, 0);
      const Place at = find(fields.table, p, n);
      if (at.missing) record_missing(sightings, at.missing, n);
      if (at.cell == none) continue;
      const Vec3 w = make_frame(n).to_world(to_cosine_hemisphere(sampler.next2()));
      for (const Side side : {Side::camera, Side::light}) {
        record_visit(training.of(side), at.cell);
        record(fields, fields.of(side), training.of(side), at.cell, {p, w, 2, w.x > 0.6f ? 5.0f : 0.01f, 1});
        record_direct(fields.of(side), training.of(side), at.cell, u.x);
      }
      record_join(fields.views, training.views, fields.cells[at.cell].region, uint32_t(i) % 5, i % 3 == 0);
    }
    fields = learn(fields, training, sightings, 2000, options);
  }
  return fields;
}

struct Store : testing::Test {
  const Scene scene = room();
  const std::string key = scene_key(scene);
  const std::string path =
      (std::filesystem::path(testing::TempDir()) / ("ajar_store" + std::to_string(::getpid()))).string();
  void TearDown() override { std::filesystem::remove(path); }

  std::string error() const {
    try {
      load_fields(path, key);
    } catch (const Error& e) {
      return e.what();
    }
    return {};
  }
  // What comes of a file that is well made but says something that cannot be.
  std::string error_of(const Fields& fields) const {
    save_fields(path, {fields, key, 0});
    return error();
  }
};

struct StoredStructures : Store, testing::WithParamInterface<Structure> {};

TEST_P(StoredStructures, FieldsComeBack) {
  const Fields a = learned(scene, 5, GetParam());
  ASSERT_GT(a.cells.size(), 40u);
  ASSERT_GT(a.q.nodes.size(), a.cells.size() + 20) << "divided strata are among them";
  save_fields(path, {a, key, 21});
  const StoredFields stored = load_fields(path, key);
  const Fields& b = stored.fields;
  EXPECT_EQ(stored.passes, 21u);
  EXPECT_EQ(stored.scene, key);
  EXPECT_EQ(a.generation, b.generation);
  EXPECT_EQ(b.structure, GetParam());
  EXPECT_EQ(b.rule, Rule::returned);
  EXPECT_EQ(bytes(a), bytes(b));
  EXPECT_EQ(a.table.shortcuts.leaves.size(), b.table.shortcuts.leaves.size());
  EXPECT_EQ(!b.table.shortcuts.leaves.empty(), GetParam() == Structure::adaptive);
  EXPECT_EQ(a.regions, b.regions);
  EXPECT_GT(a.views.regions, 4u);
  EXPECT_LT(*std::min_element(a.views.chance.begin(), a.views.chance.end()), 204) << "regions know something";
  EXPECT_EQ(a.views.regions, b.views.regions);
  EXPECT_EQ(a.views.tried, b.views.tried);
  EXPECT_EQ(a.views.seen, b.views.seen);
  EXPECT_EQ(a.views.chance, b.views.chance);
  for (size_t i = 0; i < a.cells.size(); ++i) EXPECT_EQ(a.cells[i].region, b.cells[i].region);
  Sampler sampler = make_sampler(SamplerKind::independent, 1, Side::camera, 0, 0);
  int divided = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec2 u = sampler.next2(), v = sampler.next2();
    const Vec3 p(2 * u.x - 1, i % 2 ? -1 : 1, 2 * u.y - 1), n(0, i % 2 ? 1 : -1, 0);
    const Place at = find(a.table, p, n), same = find(b.table, p, n);
    ASSERT_EQ(at.cell, same.cell);
    ASSERT_EQ(at.missing, same.missing);
    if (at.cell == none) continue;
    divided += at.missing != 0 || level_of(a.cells[at.cell].key) > 0;
    for (const Side side : {Side::camera, Side::light}) {
      EXPECT_EQ(a.of(side).cells[at.cell].mix, b.of(side).cells[at.cell].mix);
      EXPECT_EQ(a.of(side).cells[at.cell].total, b.of(side).cells[at.cell].total);
      float pdf_a = 0, pdf_b = 0;
      const Vec3 w = sample(a, a.of(side), at.cell, p, v, pdf_a);
      EXPECT_EQ(w, sample(b, b.of(side), at.cell, p, v, pdf_b));
      EXPECT_EQ(pdf_a, pdf_b);
    }
  }
  if (GetParam() == Structure::adaptive) {
    EXPECT_GT(divided, 100);
  }
}

INSTANTIATE_TEST_SUITE_P(All, StoredStructures,
                         testing::Values(Structure::adaptive, Structure::grid, Structure::probes),
                         [](const auto& test) { return std::string(structure_names[size_t(test.param)]); });

TEST_F(Store, SameFieldsSameBytes) {
  const auto contents = [&] {
    std::ifstream in(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  save_fields(path, {learned(scene, 3), key, 3});
  const std::string one = contents();
  save_fields(path, load_fields(path, key));
  EXPECT_EQ(one, contents());
}

TEST_F(Store, AnotherSceneIsAnError) {
  save_fields(path, {learned(scene, 1), key, 1});
  EXPECT_EQ(error(), "");
  EXPECT_NO_THROW(load_fields(path, {})) << "who asks for no scene gets any";
  Scene other = kit::stage(8);
  add_sphere(other, Vec3(0), 0.1f, 0);
  finish(other);
  try {
    load_fields(path, scene_key(other));
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find(path + ": fields of another scene"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("--save-fields"), std::string::npos) << e.what();
  }
}

TEST_F(Store, KeyTellsWhatFieldsDependOn) {
  const auto changed = [&](auto&& change) {
    Scene other = kit::stage(8);
    change(other);
    finish(other);
    return scene_key(other) != key;
  };
  EXPECT_FALSE(changed([](Scene&) {}));
  EXPECT_FALSE(changed([](Scene& s) {
    set_perspective(s.camera, 30, look_at({0, 0.5f, 3}, Vec3(0)));
  })) << "the camera may move";
  EXPECT_TRUE(changed([](Scene& s) { s.meshes[0].positions[0].x += 0.01f; })) << "a door that turns";
  EXPECT_TRUE(changed([](Scene& s) { s.lights[0].radiance = Slot{2.0f}; }));
  EXPECT_TRUE(changed([](Scene& s) { s.shapes[0].flip = !s.shapes[0].flip; }));
  EXPECT_TRUE(changed([](Scene& s) { s.lights[0].beam = 0.1f; }));
  EXPECT_TRUE(changed([](Scene& s) { s.lights[0].cutoff = 0.2f; }));
  EXPECT_TRUE(changed([](Scene& s) { s.lights[0].sampling_weight = 2; }));
  const auto spot = [](float cutoff, float beam) {
    Scene other = kit::stage(8);
    Light& light = other.lights[add_light(other, LightKind::spot, Slot{1.0f})];
    light.cutoff = cutoff, light.beam = beam;
    finish(other);
    return scene_key(other);
  };
  EXPECT_NE(spot(0.5f, 0), spot(0.4f, 0));
  EXPECT_NE(spot(0.5f, 0), spot(0.5f, 0.1f));
  EXPECT_TRUE(changed([](Scene& s) { add_light(s, LightKind::constant, Slot{0.1f}); }));
}

TEST_F(Store, DamageIsAnError) {
  save_fields(path, {learned(scene, 4), key, 4});
  const auto size = std::filesystem::file_size(path);
  for (int i = 0; i < 40; ++i) {
    std::filesystem::resize_file(path, size * uint64_t(i) / 40);
    EXPECT_NE(error(), "") << i;
    save_fields(path, {learned(scene, 1), key, 4});
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    const auto at = std::streamoff(hash(uint64_t(i), 5) % std::filesystem::file_size(path));
    file.seekg(at);
    const int was = file.get();
    file.seekp(at);
    file.put(char(was ^ 0x41));
    file.close();
    EXPECT_NE(error(), "") << "byte " << at;
    save_fields(path, {learned(scene, 1), key, 4});
  }
  EXPECT_EQ(error(), "");
}

TEST_F(Store, WhatCannotBeIsAnError) {
  const Fields good = learned(scene, 4);
  const uint32_t last = uint32_t(good.cells.size()) - 1;
  uint32_t parent = 0;
  while (good.q.nodes[parent].divided == 0) ++parent;
  EXPECT_EQ(error_of(good), "");
  struct Case {
    const char* name;
    void (*change)(Fields&, uint32_t last, uint32_t parent);
  };
  const Case cases[] = {
      {"root beyond the nodes", [](Fields& f, uint32_t i, uint32_t) { f.q.cells[i].root = none; }},
      {"shared root", [](Fields& f, uint32_t i, uint32_t) { f.w.cells[i].root = f.w.cells[0].root; }},
      {"children beyond the nodes", [](Fields& f, uint32_t, uint32_t p) { f.q.nodes[p].children = 1u << 30; }},
      {"its own child", [](Fields& f, uint32_t, uint32_t p) { f.q.nodes[p].children = p; }},
      {"more children than there are", [](Fields& f, uint32_t, uint32_t p) { f.q.nodes[p].divided = 0xffff; }},
      {"shares that fall", [](Fields& f, uint32_t, uint32_t p) { f.q.nodes[p].before[7] = 0; }},
      {"shares that do not begin at 0", [](Fields& f, uint32_t, uint32_t p) { f.q.nodes[p].before[0] = 1; }},
      {"key of no level", [](Fields& f, uint32_t i, uint32_t) { f.cells[i].key = 5; }},
      {"key of a level too deep", [](Fields& f, uint32_t i, uint32_t) { f.cells[i].key |= 15ull << 60; }},
      {"key of a normal that is none", [](Fields& f, uint32_t i, uint32_t) { f.cells[i].key |= 31ull << 51; }},
      {"key twice", [](Fields& f, uint32_t i, uint32_t) { f.cells[i].key = f.cells[0].key; }},
      {"frame that is none", [](Fields& f, uint32_t i, uint32_t) { f.cells[i].frame.s = f.cells[i].frame.n; }},
      {"frame of NaN", [](Fields& f, uint32_t i, uint32_t) { f.cells[i].frame.t = Vec3(std::nanf("")); }},
      {"mix of 1", [](Fields& f, uint32_t i, uint32_t) { f.q.cells[i].mix = 1; }},
      {"negative mix", [](Fields& f, uint32_t i, uint32_t) { f.w.cells[i].mix = -0.1f; }},
      {"infinite mean", [](Fields& f, uint32_t, uint32_t p) { f.q.mean[16 * p].bits = 0xff00; }},
      {"weight of NaN", [](Fields& f, uint32_t, uint32_t p) { f.w.weight[16 * p].bits = 0xffff; }},
      {"infinite total", [](Fields& f, uint32_t i, uint32_t) { f.q.cells[i].total = infinity; }},
      {"unit of 0", [](Fields& f, uint32_t, uint32_t) { f.q.unit = 0; }},
      {"cells out of all bounds", [](Fields& f, uint32_t, uint32_t) { f.table.width = 1e37f; }},
      {"no width", [](Fields& f, uint32_t, uint32_t) { f.table.width = 0; }},
      {"origin of NaN", [](Fields& f, uint32_t, uint32_t) { f.table.origin.y = std::nanf(""); }},
      {"region beyond the most", [](Fields& f, uint32_t i, uint32_t) { f.cells[i].region = most_regions; }},
      {"cell of no region", [](Fields& f, uint32_t i, uint32_t) { f.cells[i].region = no_region; }},
      {"views of more regions than there are", [](Fields& f, uint32_t, uint32_t) { f.regions = f.views.regions - 1; }},
      {"views of fewer regions than they say", [](Fields& f, uint32_t, uint32_t) { --f.views.regions; }},
      {"more views than there can be", [](Fields& f, uint32_t, uint32_t) { f.views.regions = ~0u; }},
      {"a distance of less than none", [](Fields& f, uint32_t cell, uint32_t) { f.q.cells[cell].near = -1; }},
      {"a distance of NaN", [](Fields& f, uint32_t cell, uint32_t) { f.w.cells[cell].near = std::nanf(""); }},
      {"cuts of no cubes",
       [](Fields& f, uint32_t, uint32_t) {
         f.table.cuts.push_back({0, 0, ~0, ~1});
       }},
      {"cubes of another number", [](Fields& f, uint32_t, uint32_t) { f.table.compartments.assign(5, ~0); }},
      {"a cut that is not there", [](Fields& f, uint32_t, uint32_t) { f.table.compartments.assign(2197, 0); }},
      {"a cut that leads back",
       [](Fields& f, uint32_t, uint32_t) {
         f.table.compartments.assign(2197, ~0);
         f.table.cuts = {{0, 0, ~0, 0}};
       }},
      {"a cut of no axis",
       [](Fields& f, uint32_t, uint32_t) {
         f.table.compartments.assign(2197, ~0);
         f.table.cuts = {{0, 3, ~0, ~1}};
       }},
      {"a compartment too many",
       [](Fields& f, uint32_t, uint32_t) {
         f.table.compartments.assign(2197, ~0);
         f.table.cuts = {{0, 0, ~0, ~16}};
       }},
      {"a portal of no axis", [](Fields& f, uint32_t, uint32_t) { f.table.portals[0].axis = 3; }},
      {"a portal of no size", [](Fields& f, uint32_t, uint32_t) { f.table.portals[0].radius = 0; }},
      {"a portal without strata", [](Fields& f, uint32_t, uint32_t) { f.w.portals.pop_back(); }},
      {"a portal that is not there", [](Fields& f, uint32_t i, uint32_t) { f.q.cells[i].portal = 1; }},
      {"evenness that is none", [](Fields& f, uint32_t i, uint32_t) { f.q.cells[i].even = 2; }},
      {"more than all drawn through it", [](Fields& f, uint32_t i, uint32_t) { f.q.cells[i].through = 1.5f; }},
      {"its strata at no place", [](Fields& f, uint32_t, uint32_t) { f.q.portals[0].root = none; }},
      {"lines of no portal", [](Fields& f, uint32_t, uint32_t) { f.lines.push_back(0); }},
      {"lines of NaN", [](Fields& f, uint32_t, uint32_t) { f.lines[0] = std::nan(""); }},
      {"joins tried less than never", [](Fields& f, uint32_t, uint32_t) { f.views.tried[1] = -1; }},
      {"infinitely many joins", [](Fields& f, uint32_t, uint32_t) { f.views.tried[1] = infinity; }},
      {"free joins of NaN", [](Fields& f, uint32_t, uint32_t) { f.views.seen[1] = std::nanf(""); }},
      {"more joins free than tried", [](Fields& f, uint32_t, uint32_t) { f.views.seen[1] = f.views.tried[1] + 1; }},
  };
  for (const Case& c : cases) {
    Fields bad = good;
    c.change(bad, last, parent);
    EXPECT_EQ(error_of(bad), path + ": file of fields is damaged; learn the fields again with --save-fields") << c.name;
  }
}

// Cuts of lights: which node of which tree they name is for fits to say, all else for the file.
TEST_F(Store, CutsOfLightsThatCannotBeAreAnError) {
  Fields good = learned(scene, 4);
  good.lights = {};
  for (size_t i = 0; i < good.cells.size(); ++i) add_cut(good.lights, none);
  good.lights.cuts.back().count = 2;
  good.lights.entries.push_back({2, 1, 1, 0.5f});
  good.lights.evidence.push_back({1, 1, 2});
  ASSERT_EQ(error_of(good), "");
  struct Case {
    const char* name;
    void (*change)(LearnedLights& v, LearnedLights& starts);
  };
  const Case cases[] = {
      {"a cut for no cell", [](LearnedLights& v, LearnedLights&) { add_cut(v, none); }},
      {"a cut that begins elsewhere", [](LearnedLights& v, LearnedLights&) { v.cuts[1].first = 0; }},
      {"a cut of nothing", [](LearnedLights& v, LearnedLights&) { v.cuts[0].count = 0; }},
      {"a cut of more than there are", [](LearnedLights& v, LearnedLights&) { v.cuts.back().count = 3; }},
      {"a cut of more than may be", [](LearnedLights& v, LearnedLights&) { v.cuts.back().count = ~0u; }},
      {"an entry of no cut",
       [](LearnedLights& v, LearnedLights&) {
         v.entries.push_back({});
         v.evidence.push_back({});
       }},
      {"never asking", [](LearnedLights& v, LearnedLights&) { v.cuts[0].asks = 0; }},
      {"asking more than always", [](LearnedLights& v, LearnedLights&) { v.cuts[0].asks = 1.5f; }},
      {"asking NaN", [](LearnedLights& v, LearnedLights&) { v.cuts[0].asks = std::nanf(""); }},
      {"plain or not, or what", [](LearnedLights& v, LearnedLights&) { v.cuts[0].plain = 2; }},
      {"weight of 0", [](LearnedLights& v, LearnedLights&) { v.entries[0].weight = 0; }},
      {"weight of NaN", [](LearnedLights& v, LearnedLights&) { v.entries[0].weight = std::nanf(""); }},
      {"infinite weight", [](LearnedLights& v, LearnedLights&) { v.entries[0].weight = infinity; }},
      {"shares that do not begin at 0", [](LearnedLights& v, LearnedLights&) { v.entries[0].before = 0.1f; }},
      {"shares that fall", [](LearnedLights& v, LearnedLights&) { v.entries.back().before = -0.5f; }},
      {"shares beyond 1", [](LearnedLights& v, LearnedLights&) { v.entries.back().before = 1.5f; }},
      {"a share of NaN", [](LearnedLights& v, LearnedLights&) { v.entries.back().before = std::nanf(""); }},
      {"less than no evidence", [](LearnedLights& v, LearnedLights&) { v.evidence[0].tried = -1; }},
      {"evidence of NaN", [](LearnedLights& v, LearnedLights&) { v.evidence[0].square = std::nanf(""); }},
      {"infinitely many hits", [](LearnedLights& v, LearnedLights&) { v.evidence[0].hits = infinity; }},
      {"unit of 0", [](LearnedLights& v, LearnedLights&) { v.unit = 0; }},
      {"starts of two cuts", [](LearnedLights&, LearnedLights& starts) { add_cut(starts, none); }},
      {"starts of weight 0", [](LearnedLights&, LearnedLights& starts) { starts.entries[0].weight = 0; }},
  };
  for (const Case& c : cases) {
    Fields bad = good;
    c.change(bad.lights, bad.starts);
    EXPECT_EQ(error_of(bad), path + ": file of fields is damaged; learn the fields again with --save-fields") << c.name;
  }
}

TEST_F(Store, PatchesThatCannotBeAreAnError) {
  const Fields good = learned(scene, 4, Structure::probes);
  ASSERT_GT(good.cells.size(), 2u);
  EXPECT_EQ(error_of(good), "");
  struct Case {
    const char* name;
    void (*change)(Fields&, StrataNode& root);
  };
  const Case cases[] = {
      {"structure of another's nodes", [](Fields& f, StrataNode&) { f.structure = Structure::adaptive; }},
      {"structure of no name", [](Fields& f, StrataNode&) { f.structure = Structure(7); }},
      {"rule of no name", [](Fields& f, StrataNode&) { f.rule = Rule(3); }},
      {"a zone less", [](Fields&, StrataNode& root) { root.divided &= uint16_t(0x7fff); }},
      {"a share in an empty place", [](Fields&, StrataNode& root) { root.before[3] = 1; }},
      {"a zone without a share", [](Fields&, StrataNode& root) { root.before[12] = root.before[11]; }},
      {"a segment without a share",
       [](Fields& f, StrataNode& root) {
         StrataNode& zone = f.q.nodes[root.child(15)];
         zone.before[9] = zone.before[8];
       }},
      {"a divided segment", [](Fields& f, StrataNode& root) { f.q.nodes[root.child(15)].divided = 1; }},
      {"a probe nowhere", [](Fields& f, StrataNode&) { f.table.probes[5].p.x = std::nanf(""); }},
      {"an axis that is none", [](Fields& f, StrataNode&) { f.table.probes[5].axis = 3; }},
      {"a portal",
       [](Fields& f, StrataNode&) {
         f.table.portals.emplace_back();
         add_portals(f);
       }},
  };
  for (const Case& c : cases) {
    Fields bad = good;
    c.change(bad, bad.q.nodes[bad.q.cells[0].root]);
    EXPECT_EQ(error_of(bad), path + ": file of fields is damaged; learn the fields again with --save-fields") << c.name;
  }
}

// A chain of single children, each the next node: most_levels of them are a tree, one more is not.
TEST_F(Store, DepthOfTreesIsBounded) {
  for (const int levels : {most_levels, most_levels + 1}) {
    Fields f = start_fields(scene, 64);
    f.cells.push_back({CellKey(1) << 60, {}, {}, 0, 0});
    for (Field* field : {&f.q, &f.w}) {
      field->cells.emplace_back().root = 0;
      for (int i = 0; i < levels; ++i) {
        StrataNode n;
        for (int j = 0; j < 16; ++j) n.before[j] = uint16_t(4096 * j);
        if (i + 1 < levels) n.divided = 1, n.children = uint32_t(i + 1);
        field->nodes.push_back(n);
      }
      field->mean.resize(16 * field->nodes.size());
      field->weight.resize(16 * field->nodes.size());
    }
    EXPECT_EQ(error_of(f).empty(), levels == most_levels) << levels;
  }
}

TEST_F(Store, TrainingMustFitTheFields) {
  constexpr FileKind kind = {"TESTtr01", "training", "", ""};
  const Fields small = learned(scene, 1), large = learned(scene, 3);
  Training training = start_training(large);
  training.q.value[17] = 5, training.w.visits[1] = 9;
  record_join(large.views, training.views, 0, 1, true);
  const Sightings sightings = {{CellKey(2) << 60, {3, {1, 2, 3}}}, {CellKey(1) << 60, {1, {0, 0, 1}}}};
  write_file(path, kind, [&](Writer& w) { write(w, training), write(w, sightings); });
  Training back;
  Sightings seen;
  Reader r(path, kind);
  read(r, large, back), read(r, seen);
  r.finish();
  EXPECT_EQ(back.q.value, training.q.value);
  EXPECT_EQ(back.w.visits, training.w.visits);
  EXPECT_EQ(back.views.counts, training.views.counts);
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen.at(CellKey(2) << 60).normal, glm::i64vec3(1, 2, 3));
  Reader again(path, kind);
  EXPECT_THROW(read(again, small, back), Error);
}

}  // namespace
}  // namespace ajar
