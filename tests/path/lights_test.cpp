// Learned choice of lights (V), frozen mid-training: it draws what it says, its shares add up, rays become rare where
// nothing is seen, and starts of light subpaths follow their densities on the disk across the scene.
#include <gtest/gtest.h>

#include <set>

#include "kit/chisquare.h"
#include "kit/stage.h"
#include "train.h"

namespace ajar {
namespace {

struct Lit {
  Scene scene;
  Accel accel;
  Fields fields;
  explicit Lit(Scene s, int lessons = 5, int pairs = 2000)
      : scene(std::move(s)), accel(scene), fields(train(scene, accel, lessons, pairs)) {}
};

// Half of the lamps are behind a wall.
Scene divided_room() {
  Scene scene = many_lights(24, 3, 24);
  add_quad(scene, {0.1f, -1, -1}, {0, 0, 2}, {0, 2, 0}, scene.shapes[0].material);
  finish(scene);
  return scene;
}

// Guides at camera vertices.
template <class F>
void at_vertices(const Lit& t, int paths, const F& f) {
  WalkOptions options;
  options.fields = &t.fields;
  Subpath path;
  for (int i = 0; i < paths; ++i) {
    trace_subpath(t.scene, t.accel, options, Side::camera, uint64_t(i), 99, 4, path);
    for (int k = 1; k < path.n; ++k)
      if (connectable(path[k].guide)) f(path[k]);
  }
}

TEST(LearnedLights, ChoiceAddsUpAndDrawsWhatItSays) {
  for (const int lessons : {2, 6}) {
    const Lit t(divided_room(), lessons, 4000);
    ASSERT_TRUE(fits(t.fields.lights, t.scene.light_tree));
    const uint32_t n = uint32_t(t.scene.light_tree.pieces.size());
    int learned = 0, vertices = 0;
    at_vertices(t, 60, [&](const Vertex& v) {
      const LightCut* cut = v.guide.cell == none ? nullptr : &t.fields.lights.cuts[v.guide.cell];
      ++vertices, learned += cut && cut->count > 1;
      std::vector<double> p(n);
      LightChances chances;
      double sum = 0;
      for (uint32_t k = 0; k < n; ++k) sum += p[k] = double(light_pdf(t.scene, v.guide, chances, k));
      ASSERT_LT(sum, 1 + 1e-4);
      if (!(importance(t.scene.light_tree, 0, {v.p, v.guide.frame.n}) > 0) || sum == 0) return;  // above all lamps
      ASSERT_GT(sum, 0.5 * double(cut ? cut->asks : 1));
      constexpr int draws = 2000;
      std::vector<int> drawn(n);
      for (int i = 0; i < draws; ++i) {
        uint32_t place;
        float pdf;
        if (!choose_light(t.scene, v.guide, chances, (float(i) + 0.5f) / draws, place, pdf)) continue;
        ASSERT_NEAR(double(pdf) / p[place], 1, 1e-3);
        ++drawn[place];
      }
      for (uint32_t k = 0; k < n; ++k) ASSERT_NEAR(drawn[k], draws * p[k], 3 + 0.002 * draws * p[k]);
    });
    EXPECT_TRUE(lessons == 2 || learned > vertices / 5) << "hardly learned: the test means little";
  }
}

// Where no light faces a cell that leaves the choice to the tree, its shares are even, and numbers all the same.
TEST(LearnedLights, ACellThatNothingShinesAtHasShares) {
  Scene scene = under_sky(LightKind::directional);
  add_light(scene, LightKind::directional, Rgb(1));
  for (Light& light : scene.lights) light.direction = {0, -1, 0};
  finish(scene);
  ASSERT_FALSE(scene.light_tree.sky.empty());
  const Receiver below{Vec3(0), {0, -1, 0}};
  ASSERT_EQ(importance(scene.light_tree, 0, below), 0);
  LearnedLights v;
  add_cut(v, none);
  for (int lesson = 0; lesson < 2; ++lesson) {
    LightTallies t = start_tallies(v);
    for (int i = 0; i < 200; ++i) record(v, t, 0, 1);
    v.cuts[0].plain = 1;
    v = learn_lights(scene.light_tree, v, t, {}, {&below, 1});
  }
  ASSERT_EQ(v.cuts[0].count, 2u);
  EXPECT_EQ(share_of(v, v.cuts[0], 0), 0.5f);
  EXPECT_EQ(share_of(v, v.cuts[0], 1), 0.5f);
}

// A lamp that is far fainter than two others on both sides of it has its share of the starts all the same: without, its
// light would count as found by hits alone, which find no point.
TEST(LearnedLights, FaintLampsStartToo) {
  Scene scene;
  set_camera(scene, Vec3(0, 0, 3), Vec3(0), 40, 8, 8);
  for (const float x : {-1000.0f, 0.0f, 1000.0f})
    scene.lights[add_light(scene, LightKind::point, Rgb(x == 0 ? 1.0f : 1e9f))].position = {x, 0, 0};
  finish(scene);
  LearnedLights v;
  add_cut(v, none);
  LightRules rules;
  rules.by_power = true, rules.most = most_starts;
  for (int lesson = 0; lesson < 6; ++lesson) {
    LightTallies t = start_tallies(v);
    for (uint32_t e = 0; e < v.entries.size(); ++e)
      for (int i = 0; i < 200; ++i) record(v, t, e, 1);
    v = learn_lights(scene.light_tree, v, t, rules);
  }
  ASSERT_EQ(v.cuts[0].count, 3u);
  float sum = 0;
  for (uint32_t e = 0; e < 3; ++e) {
    EXPECT_GT(share_of(v, v.cuts[0], e), 0) << e;
    sum += share_of(v, v.cuts[0], e);
  }
  EXPECT_EQ(sum, 1);
}

// Entries that a cell cannot see are joined, and have a weight all the same.
TEST(LearnedLights, WhatIsJoinedUnseenHasAWeight) {
  const Scene scene = under_sky(LightKind::constant);
  const Receiver cell{Vec3(0), glm::normalize(Vec3(1))};
  LearnedLights v;
  add_cut(v, none);
  int joined = 0;
  for (int lesson = 0; lesson < 5; ++lesson) {
    std::set<uint32_t> before;
    for (const LightEntry& e : v.entries) before.insert(e.node);
    LightTallies t = start_tallies(v);
    for (uint32_t i = 0; i < 4000; ++i) {
      const uint32_t entry = entry_of(v, v.cuts[0], i % uint32_t(scene.light_tree.pieces.size()));
      record(v, t, entry, importance(scene.light_tree, v.entries[entry].node, cell) > 0 ? 1.0f : 0.0f);
    }
    v.cuts[0].plain = 1;
    v = learn_lights(scene.light_tree, v, t, {}, {&cell, 1});
    for (const LightEntry& e : v.entries) {
      EXPECT_GT(e.weight, 0) << lesson;
      joined += before.contains(scene.light_tree.nodes[e.node].left);
    }
  }
  EXPECT_GT(joined, 0) << "the test means little";
}

// What is not to be asked for is not, be it the only light.
TEST(LearnedLights, TheOnlyLampNeedNotBeAskedFor) {
  for (const LightKind kind : {LightKind::area, LightKind::constant, LightKind::envmap}) {
    Scene scene = kind == LightKind::area ? many_lights(1, 2) : under_sky(kind);
    scene.lights[0].sampling_weight = 0;
    finish(scene);
    const Lit t(std::move(scene), 1, 100);
    int vertices = 0;
    at_vertices(t, 40, [&](const Vertex& v) {
      LightChances chances;
      DirectSample s;
      EXPECT_FALSE(sample_next_event(t.scene, v.guide, chances, {0.5f, {0.5f, 0.5f}}, s));
      ++vertices;
    });
    EXPECT_GT(vertices, 10);
  }
}

// Whatever the first ray's numbers are, the choice goes round the lights in even steps; and each ray's numbers are as
// uniform as the first's.
TEST(LearnedLights, RaysOfAVertexAreUniformAndEven) {
  for (const int n : {1, 2, 5, 16}) {
    std::vector<Vec3> mean(size_t(n), Vec3(0));
    constexpr uint32_t vertices = 4096;
    for (uint32_t k = 0; k < vertices; ++k) {
      Sampler sampler(Stream{1, reverse_bits(k)});
      const LightNumbers first{sampler.at(1).x, sampler.at(2)};
      std::vector<float> choices;
      for (int i = 0; i < n; ++i) {
        const LightNumbers u = spread(first, i, n);
        const Vec3 at(u.choice, u.point);
        for (int c = 0; c < 3; ++c) ASSERT_TRUE(at[c] >= 0 && at[c] < 1) << at[c];
        mean[size_t(i)] += at / float(vertices);
        choices.push_back(u.choice);
      }
      std::sort(choices.begin(), choices.end());
      for (size_t i = 1; i < choices.size(); ++i) ASSERT_NEAR(choices[i] - choices[i - 1], 1 / float(n), 1e-5f);
    }
    for (const Vec3& m : mean)
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(m[c], 0.5f, 0.01f) << n;
  }
}

// Cells in one half give the lamps of the other half less than the tree would.
TEST(LearnedLights, LampsBehindAWallAreRare) {
  const Lit t(divided_room(), 8, 8000);
  double learned = 0, bare = 0;
  at_vertices(t, 400, [&](const Vertex& v) {
    if (v.guide.cell == none) return;
    const LightCut& cut = t.fields.lights.cuts[v.guide.cell];
    float hits = 0;
    for (uint32_t i = 0; i < cut.count; ++i) hits += t.fields.lights.evidence[cut.first + i].hits;
    if (cut.count < 2 || hits < 30) return;  // it cannot know
    const Receiver at{v.p, v.guide.frame.n};
    LightChances chances;
    for (uint32_t k = 0; k < t.scene.light_tree.pieces.size(); ++k) {
      const Light& light = t.scene.lights[t.scene.light_tree.pieces[k].light];
      const float x = t.scene.meshes[t.scene.shapes[light.shape].mesh].positions[0].x;
      if ((x < 0.1f) == (v.p.x < 0.1f)) continue;
      learned += double(light_pdf(t.scene, v.guide, chances, k));
      bare += double(choice_pdf(t.scene.light_tree, 0, at, k));
    }
  });
  EXPECT_GT(bare, 5);
  EXPECT_LT(learned, 0.8 * bare);
}

// Where next-event rays never come through they become rare, with one light too, and never impossible.
TEST(LearnedLights, DarkCellsAskRarely) {
  Fields fields;
  const Scene scene = two_rooms(0, 18);
  LearnedLights v;
  add_cut(v, none), add_cut(v, none), add_cut(v, none);
  for (int lesson = 0; lesson < 6; ++lesson) {
    LightTallies t = start_tallies(v);
    for (int i = 0; i < 400; ++i) {
      record(v, t, v.cuts[0].first, 0);
      record(v, t, v.cuts[1].first, i % 20 == 0 ? 1.0f : 0.0f);
    }
    LightRules rules;
    rules.least_asks = 1 / 8.0f;
    v = learn_lights(scene.light_tree, v, t, rules);
    ASSERT_TRUE(fits(v, scene.light_tree));
  }
  EXPECT_NEAR(v.cuts[0].asks, 1 / 8.0f, 0.02f);
  EXPECT_EQ(v.cuts[1].asks, 1);
  EXPECT_EQ(v.cuts[2].asks, 1);
}

// A sky is drawn whole or by tiles, as its cell says, and MIS knows it.
TEST(LearnedLights, SkyIsDrawnAsItsCellSays) {
  for (const LightKind kind : {LightKind::constant, LightKind::envmap}) {
    Lit t(lit_by(kind), 6, 4000);
    ASSERT_EQ(t.scene.light_tree.sky.size(), 1u);
    Subpath found;
    at_vertices(t, 200, [&](const Vertex& v) {
      if (found.n == 0 && v.guide.cell != none && t.fields.lights.cuts[v.guide.cell].count > 4) found.add() = v;
    });
    ASSERT_EQ(found.n, 1) << "hardly learned";
    const Vertex& v = found[0];
    for (const uint32_t plain : {0u, 1u}) {
      t.fields.lights.cuts[v.guide.cell].plain = plain;
      kit::ChiOptions o;
      o.rows = 8, o.columns = 16, o.samples = 30'000, o.seed = 3 + plain;
      int off = 0;
      const auto density = [&](const Vec3& w) {
        return pdf_next_event(t.scene, v.guide, light_point(t.scene, 0, w), w);
      };
      const auto r = kit::chi_square_sphere(
          [&](const Vec2& u, float extra) -> std::optional<Vec3> {
            LightChances chances;
            DirectSample d;
            if (!sample_next_event(t.scene, v.guide, chances, {extra, u}, d)) return std::nullopt;
            off += std::abs(density(d.wi) / double(d.pdf) - 1) > 1e-2;
            return d.wi;
          },
          density, o);
      EXPECT_TRUE(r.ok) << int(kind) << " plain " << plain << ": " << r.message;
      EXPECT_LE(off, o.samples / 100);
    }
  }
}

// Tiles are asked for where much of the sky is hidden, and not where all of it is seen.
TEST(LearnedLights, TilesAreForCellsThatSeeLittle) {
  const Scene scene = under_sky(LightKind::constant);
  const uint32_t pieces = uint32_t(scene.light_tree.pieces.size());
  LearnedLights v;
  add_cut(v, none), add_cut(v, none), add_cut(v, none);
  const std::vector<Receiver> cells(3);
  for (int lesson = 0; lesson < 6; ++lesson) {
    LightTallies t = start_tallies(v);
    for (uint32_t i = 0; i < 40 * pieces; ++i) {
      const uint32_t place = i % pieces;
      record(v, t, entry_of(v, v.cuts[0], place), 1);
      record(v, t, entry_of(v, v.cuts[1], place), place < pieces / 32 ? 1.0f : 0.0f);
    }
    v = learn_lights(scene.light_tree, v, t, {}, cells);
  }
  EXPECT_EQ(v.cuts[0].plain, 1u);
  EXPECT_EQ(v.cuts[1].plain, 0u);
  EXPECT_EQ(v.cuts[2].plain, 1u) << "knows nothing";
  add_cut(v, 1);
  EXPECT_EQ(v.cuts[3].plain, 0u) << "a new cell begins with its parent's";
}

// The order in which threads record does not matter.
TEST(LearnedLights, SumsDoNotDependOnOrder) {
  const Scene scene = divided_room();
  LearnedLights v;
  add_cut(v, none);
  LightTallies a = start_tallies(v), b = a;
  for (int i = 0; i < 100; ++i) {
    record(v, a, 0, 0.1f * float(i));
    record(v, b, 0, 0.1f * float(99 - i));
  }
  EXPECT_EQ(a.square, b.square);
  EXPECT_EQ(a.hits, b.hits);
}

TEST(LearnedLights, StartsFollowTheirDensity) {
  for (const LightKind kind : {LightKind::sun, LightKind::envmap, LightKind::directional}) {
    const Lit t(lit_by(kind), 5);
    const Fields* f = &t.fields;
    float most = 0;
    for (const FieldCell& c : f->disk.cells) most = std::max(most, c.mix);
    EXPECT_GT(most, 0.1f) << "hardly guided";
    // All of the disk in one direction, by its place in the square.
    EmissionSample first;
    ASSERT_TRUE(sample_emission(t.scene, f, 0.4f, {0.4f, 0.7f}, {0.3f, 0.6f}, first));
    const Frame frame = make_frame(first.direction);
    kit::ChiOptions o;
    o.rows = o.columns = 12, o.samples = 60'000;
    int off = 0;
    const auto r = kit::chi_square_square(
        [&](const Vec2& u) -> std::optional<Vec2> {
          EmissionSample e;
          if (!sample_emission(t.scene, f, 0.4f, u, {0.3f, 0.6f}, e)) return std::nullopt;
          const EmissionPdf p = pdf_emission(t.scene, f, e.point, e.direction);
          off += std::abs(p.position / e.pdf_position - 1) > 1e-2f;
          const Vec3 at = (e.point.p - t.scene.center) / t.scene.radius;
          return Vec2(glm::dot(frame.s, at), glm::dot(frame.t, at)) * 0.499f + 0.5f;
        },
        [&](const Vec2& at) -> double {
          const Vec2 on = (at - 0.5f) / 0.499f;
          if (glm::dot(on, on) >= 1) return 0;
          LightPoint point = first.point;
          point.p = t.scene.center + t.scene.radius * (frame.s * on.x + frame.t * on.y);
          return double(pdf_emission(t.scene, f, point, first.direction).position) * sqr(t.scene.radius / 0.499f);
        },
        o);
    EXPECT_TRUE(r.ok) << int(kind) << ": " << r.message;
    EXPECT_LE(off, o.samples / 100);
  }
}

}  // namespace
}  // namespace ajar
