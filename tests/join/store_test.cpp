// One of all light vertices, drawn: with its weight it stands for all of them, whatever it is asked for.
#include "ajar/join/pool.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "ajar/scene/bsdf/gloss.h"
#include "room.h"

namespace ajar::room {
namespace {

void draw(const LightStore& store, const Joiner& joiner, Sampler& sampler, std::vector<StoreChoice>& choices) {
  Expectation storage;
  choose(store, joiner, sampler, storage, choices);
}

// The mean of weight x g over draws is the sum of g over all entries, over paths; and a weight wrong by a little would
// be seen. Returns how many vertices had something to bring.
int expect_unbiased(const LightStore& store, const std::vector<Subpath>& cameras, int most = most_edges, int n = 40'000,
                    float worth = 0, uint32_t blocks = 1) {
  std::vector<StoreChoice> choices;
  int lit = 0;
  for (size_t k = 0; k < cameras.size(); ++k) {
    const std::vector<double> g = brought(store, cameras[k], most);
    double expected = 0;
    for (size_t i = 0; i < g.size(); ++i) expected += g[i] * double(store.entries[i].counts) / store.paths;
    Sampler sampler = draws(k);
    double sum = 0, squares = 0;
    for (int i = 0; i < n; ++i) {
      Joiner joiner{&end_of(cameras[k]), most, worth};
      joiner.blocks = blocks;
      draw(store, joiner, sampler, choices);
      double x = 0;
      for (const StoreChoice& choice : choices) {
        EXPECT_TRUE(choice.weight > 0 && choice.weight < infinity);
        x += double(choice.weight) * g[choice.entry];
      }
      sum += x, squares += x * x;
    }
    const double mean = sum / n, error = std::sqrt(std::max(squares / n - mean * mean, 0.0) / n);
    EXPECT_NEAR(mean, expected, 5 * error + 1e-4 * expected) << "camera vertex " << k;
    if (!(expected > 0)) continue;
    ++lit;
    EXPECT_LT(5 * error, 0.2 * expected) << "too noisy to see a wrong weight";
  }
  return lit;
}

TEST(LightStore, StandsForAllEntriesOfWhichSomeCountMore) {
  const Room room(1, true);
  const LightStore all = room.store(64);
  LightStore some;
  subsample(some, {&all}, 0.4 * double(all.entries.size()), 0.5f);
  deal_blocks(some);
  ASSERT_GT(std::count_if(some.entries.begin(), some.entries.end(), [](const auto& p) { return p.counts > 1.5f; }), 4);
  EXPECT_GT(expect_unbiased(some, room.cameras(12)), 8);
}

TEST(LightStore, PartsAddUpToTheWhole) {
  const Room room;
  const LightStore whole = room.store(8);
  LightStore joined;
  append(joined, whole);
  append(joined, whole);
  EXPECT_EQ(joined.paths, 2 * whole.paths);
  ASSERT_EQ(joined.entries.size(), 2 * whole.entries.size());
  for (size_t i = 0; i < whole.entries.size(); ++i) {
    const LightStore::Entry &a = whole.entries[i], &b = joined.entries[whole.entries.size() + i];
    EXPECT_EQ(whole.vertex(a).p, joined.vertex(b).p);
    EXPECT_EQ(a.own_before, b.own_before);
  }
}

TEST(LightStore, StandsForAllEntries) {
  const Room room;
  EXPECT_GT(expect_unbiased(room.store(64), room.cameras(12)), 8);
}

TEST(LightStore, StandsForAllEntriesWhateverViewsSay) {
  const Room room(1, true);
  ASSERT_GT(room.fields.views.regions, 4u);
  EXPECT_GT(expect_unbiased(room.store(64), room.cameras(12)), 8);
}

TEST(LightStore, StandsForAllEntriesHoweverManyBlocksAreLookedAt) {
  const Room room(1, true);
  const LightStore store = room.store(64);
  ASSERT_GT(store.blocks.size(), 3u);
  for (const uint32_t blocks : {2u, 3u, uint32_t(store.blocks.size()), 1000u})
    for (const float worth : {0.0f, 0.3f})
      EXPECT_GT(expect_unbiased(store, room.cameras(6), most_edges, 20'000, worth, blocks), 3) << blocks;
}

// What is worth little is joined rarely and counts for the more, what is worth much often. (J3)
TEST(LightStore, StandsForAllEntriesHoweverManyAreJoined) {
  const Room room;
  const LightStore store = room.store(64);
  double before = 0;
  for (const float worth : {1e-9f, 0.003f, 0.3f, 1e9f}) {
    EXPECT_GT(expect_unbiased(store, room.cameras(6), most_edges, 40'000, worth), 3) << worth;
    std::vector<StoreChoice> choices;
    Sampler sampler = draws(3);
    size_t joins = 0, vertices = 0;
    for (const Subpath& camera : room.cameras(6))
      for (int i = 0; i < 1000; ++i) {
        draw(store, {&end_of(camera), most_edges}, sampler, choices);
        vertices += choices.size();
        draw(store, {&end_of(camera), most_edges, worth}, sampler, choices);
        joins += choices.size();
      }
    const double mean = double(joins) / double(vertices);
    EXPECT_GT(mean, before) << worth;
    EXPECT_GT(mean, 0.08) << worth;
    EXPECT_LT(mean, 33) << worth;
    before = mean;
  }
  EXPECT_GT(before, 30);
}

// One entry; a full block; one more, which makes two blocks of unequal number.
TEST(LightStore, StandsForFewEntries) {
  const Room room;
  for (const size_t entries : {1u, 2u, 31u, 32u, 33u}) {
    const LightStore store = room.store(64, entries);
    ASSERT_EQ(store.entries.size(), entries);
    ASSERT_EQ(store.blocks.size(), (entries + 31) / 32);
    EXPECT_GT(expect_unbiased(store, room.cameras(6), most_edges, 20'000), 0) << entries;
  }
}

TEST(LightStore, StandsForEntriesOfShortSubpathsAlone) {
  const Room room;
  const LightStore store = room.store(64);
  EXPECT_GT(expect_unbiased(store, room.cameras(6), 2), 3);
  Sampler sampler = draws(0);
  std::vector<StoreChoice> choices;
  for (const Subpath& camera : room.cameras(12))
    for (int i = 0; i < 200; ++i) {
      draw(store, {&end_of(camera), 2}, sampler, choices);
      for (const StoreChoice& choice : choices) ASSERT_EQ(entry_of(store, choice).s, 2);
    }
}

TEST(LightStore, StandsForAllEntriesAtAnySize) {
  for (const float scale : {1e-6f, 1e6f}) {
    const Room room(scale);
    const LightStore store = room.store(64);
    ASSERT_GT(store.entries.size(), 64u) << scale;
    EXPECT_GT(expect_unbiased(store, room.cameras(6), most_edges, 20'000), 3) << scale;
  }
}

bool is_glossy(const Vertex& v) { return gloss_of(v.guide.bsdf, v.guide.wo_local).peak > 0; }

// How much more a vertex scatters towards w than if it were matt. (J6)
double shine_of(const Vertex& v, const glm::dvec3& w) {
  const Gloss g = gloss_of(v.guide.bsdf, v.guide.wo_local);
  const Vec3 unit(glm::normalize(w)), n = v.guide.frame.n;
  return shine(g, glm::dot(n, v.guide.wo), glm::dot(n, unit), glm::dot(unit, v.guide.wo));
}

// The probabilities that entries ought to have, from the vertices themselves: choices are among one block, or all. (J1)
std::vector<double> probabilities(const LightStore& store, const Room& room, const Joiner& joiner) {
  const Vertex& c = *joiner.vertex;
  const size_t n = joiner.blocks > 1 ? 1 : store.blocks.size();
  const double lights = joiner.onwards / joiner.counts, before = joiner.before / joiner.counts;
  std::vector<double> p, sums(n);
  const auto among = [&](size_t i) {  // which of the sums
    const auto after = [](size_t entry, const LightStore::Block& b) { return entry < b.first; };
    return n == 1
               ? 0
               : size_t(std::upper_bound(store.blocks.begin(), store.blocks.end(), i, after) - store.blocks.begin()) -
                     1;
  };
  for (size_t i = 0; i < store.entries.size(); ++i) {
    const Vertex& a = store.vertex(store.entries[i]);
    const glm::dvec3 w = glm::dvec3(c.p) - glm::dvec3(a.p);
    const double d2 = glm::dot(w, w), cosines = std::max(glm::dot(glm::dvec3(a.guide.frame.n), w), 0.0) *
                                                std::max(-glm::dot(glm::dvec3(c.guide.frame.n), w), 0.0) / d2;
    const double shines_c = shine_of(c, -w), shines_a = shine_of(a, w);
    const double g = cosines / d2, found = g / pi * (lights * shines_c / a.own + before * shines_a / c.own);
    const double flux = luminance(a.beta) * std::max(luminance(albedo(a.guide.bsdf, a.guide.wo_local)), 0.02f);
    double sees = 1;
    if (a.guide.cell != none && c.guide.cell != none)
      sees = chance(room.fields.views, room.fields.cells[a.guide.cell].region, room.fields.cells[c.guide.cell].region);
    p.push_back(flux * g * shines_c * shines_a / (1 + found) * sees);
    sums[among(i)] += p.back();
  }
  for (size_t i = 0; i < p.size(); ++i) p[i] /= sums[among(i)] > 0 ? sums[among(i)] * double(n) : 1;
  return p;
}

TEST(LightStore, ChoosesByWhatEntriesWouldBring) {
  const Room room(1, true);
  const LightStore store = room.store(40);
  ASSERT_GT(store.blocks.size(), 2u);
  constexpr int n = 100'000;
  std::vector<StoreChoice> choices;
  std::vector<Subpath> cameras = room.cameras(5);
  for (const Subpath& camera : room.cameras(200))
    if (cameras.size() < 8 && is_glossy(end_of(camera))) cameras.push_back(camera);
  ASSERT_EQ(cameras.size(), 8u);
  for (size_t k = 0; k < cameras.size(); ++k) {
    Joiner joiner{&end_of(cameras[k]), most_edges};
    if (k % 2 == 1) joiner.counts = 20, joiner.onwards = 2, joiner.before = 300, joiner.blocks = 1000;
    const std::vector<double> p = probabilities(store, room, joiner);
    std::vector<double> drawn(p.size());
    Sampler sampler = draws(100 + k);
    for (int i = 0; i < n; ++i) {
      draw(store, joiner, sampler, choices);
      ASSERT_LE(choices.size(), 1u);
      for (const StoreChoice& choice : choices) drawn[choice.entry] += 1;
    }
    double statistic = 0, rare = 0, rare_drawn = 0;
    int dof = 0;
    const auto test = [&](double seen, double expected) {
      if (expected > 0) statistic += (seen - expected) * (seen - expected) / expected, ++dof;
    };
    for (size_t i = 0; i < p.size(); ++i) {
      if (p[i] * n < 10)
        rare += p[i] * n, rare_drawn += drawn[i];
      else
        test(drawn[i], p[i] * n);
      if (p[i] == 0) {
        EXPECT_EQ(drawn[i], 0) << i;
      }
    }
    test(rare_drawn, rare);
    ASSERT_GT(dof, k < 5 ? 20 : 2);
    EXPECT_LT((statistic - dof) / std::sqrt(2.0 * dof), 5) << "camera vertex " << k << ", " << dof << " degrees";
  }
}

TEST(LightStore, NothingIsChosenFromNothing) {
  const Room room;
  const LightStore empty = room.store(0), full = room.store(64);
  LightStore black;  // subpaths that ended at once
  add(black, {});
  deal_blocks(black);
  EXPECT_EQ(black.paths, 1u);
  std::vector<StoreChoice> choices;
  const auto chooses = [&](const LightStore& store, const Vertex& c, int most, Sampler& sampler) {
    choices.resize(3);  // of the vertex before
    draw(store, {&c, most, 1e9f}, sampler, choices);
    return !choices.empty();
  };
  for (const Subpath& camera : room.cameras(20)) {
    Sampler sampler = draws(1);
    EXPECT_FALSE(chooses(empty, end_of(camera), most_edges, sampler));
    EXPECT_FALSE(chooses(black, end_of(camera), most_edges, sampler));
    EXPECT_FALSE(chooses(full, end_of(camera), 1, sampler)) << "no subpath is so short";
    EXPECT_EQ(sampler.pair, 3u) << "each took one pair of numbers all the same";
  }
}

// Opaque surfaces receive and scatter on one side; choices go by the shading normal alone.
bool is_before(const Guide& guide, const Vec3& w) { return !guide.bsdf.opaque || glm::dot(guide.frame.n, w) > 0; }
TEST(LightStore, NothingBehindIsChosen) {
  const Room room;
  const LightStore store = room.store(64);
  int chosen = 0, behind = 0;
  for (const Subpath& camera : room.cameras(20)) {
    const Vertex& c = end_of(camera);
    for (const LightStore::Entry& at : store.entries) behind += !is_before(c.guide, store.vertex(at).p - c.p);
    Sampler sampler = draws(2);
    std::vector<StoreChoice> choices;
    for (int i = 0; i < 1000; ++i) {
      draw(store, {&c, most_edges}, sampler, choices);
      for (const StoreChoice& choice : choices) {
        const Vertex& a = store.vertex(entry_of(store, choice));
        ASSERT_TRUE(is_before(c.guide, a.p - c.p));
        ASSERT_TRUE(is_before(a.guide, c.p - a.p));
        ++chosen;
      }
    }
  }
  EXPECT_GT(chosen, 10'000);
  EXPECT_GT(behind, 100);
}

// Light that arrives at the black back of an opaque surface goes nowhere, however much of it there is.
TEST(LightStore, HoldsNoBlackBacks) {
  for (const bool two_sided : {false, true}) {
    Scene scene;
    Material both;
    both.kind = MaterialKind::twosided;
    both.nested[0] = add_diffuse(scene, Rgb(0.5f));
    const uint32_t material = two_sided ? add_material(scene, both) : both.nested[0];
    add_quad(scene, {-1, 0, -1}, {2, 0, 0}, {0, 0, 2}, material);  // faces down
    add_light(scene, LightKind::directional, Rgb(1));
    scene.lights[0].direction = {0, -1, 0};
    finish(scene);
    const Accel accel(scene);
    WalkOptions options;
    options.counts.light_paths = 64;
    LightStore store;
    Subpath light;
    for (uint64_t i = 0; i < 64; ++i) {
      trace_subpath(scene, accel, options, Side::light, i, 0, 3, light);
      add(store, light);
    }
    EXPECT_EQ(store.entries.empty(), !two_sided);
  }
}

// What a store keeps of a subpath is what the join of that subpath itself reads.
TEST(LightStore, JoinsAsTheSubpathItself) {
  const Room room(1, true);
  Subpath light;
  Surface surface;
  LightStore store;
  int counts = 0;
  const Subpath camera = room.cameras(1)[0];
  for (uint32_t i = 0; i < 40; ++i) {
    Sampler sampler = make_sampler(SamplerKind::independent, 5, Side::light, i, 0);
    Walk walk;
    light.n = 0;
    if (!start_light(room.scene, room.options, sampler, light, walk)) continue;
    while (light.n < most_edges && step(room.scene, room.accel, room.options, light, walk, surface) &&
           scatter(room.options, sampler, light, walk)) {
    }
    const auto weigh = [&](const LightEnd& end) {
      Candidate c;
      return join_vertices(end, camera.first(camera.n), c) ? weight(Heuristic::power, c, room.options.counts) : -1;
    };
    const size_t before = store.entries.size();
    add(store, light);
    size_t entry = before;
    for (int s = 2; s <= light.n; ++s) {
      if (!connectable(light[s - 1].guide) || !(luminance(light[s - 1].beta) > 0)) continue;
      ASSERT_LT(entry, store.entries.size());
      const LightStore::Entry& at = store.entries[entry++];
      EXPECT_EQ(at.s, s);
      counts += std::abs(at.nee_ratio - 1) > 0.1;
      EXPECT_EQ(weigh(store.end(at)), weigh(light_end(light, s)));
    }
    EXPECT_EQ(entry, store.entries.size());
  }
  EXPECT_GT(counts, 20) << "entries whose ratio is not 1";
}

}  // namespace
}  // namespace ajar::room
