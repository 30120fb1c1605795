// One of all light vertices, drawn: with its weight it stands for all of them, whatever it is asked for.
#include "ajar/join/store.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "ajar/join/visibility.h"
#include "kit/stage.h"
#include "path/train.h"

namespace ajar {
namespace {

constexpr int most_edges = 6;

Scene scaled_stage(float scale) {
  Scene scene = kit::stage(8);
  Material glossy;
  glossy.kind = MaterialKind::roughplastic;
  add_mesh(scene, kit::globe({0.3f, -0.5f, 0.1f}, 0.4f, 8), add_material(scene, glossy));
  for (Mesh& mesh : scene.meshes)
    for (Vec3& p : mesh.positions) p *= scale;
  // Next-event estimation finds a ball's points by another density than emission does.
  add_area_light(scene, add_sphere(scene, Vec3(-0.5f, 0.2f, 0.1f) * scale, 0.2f * scale, add_diffuse(scene, Rgb(0.5f))),
                 Rgb(30));
  set_camera(scene, Vec3(0, 0, 4.2f) * scale, Vec3(0), 36, 8, 8);
  finish(scene);
  return scene;
}

// Each region sees some of the others always, some rarely, some never.
Views made_up_views(const Fields& fields) {
  Views views = fields.views;
  ViewTallies tallies = start_tallies(views);
  for (uint32_t a = 0; a < views.regions; ++a)
    for (uint32_t b = a; b < views.regions; ++b)
      for (uint32_t i = 0; i < 60; ++i) record_join(views, tallies, a, b, hash(a * 7919 + b, i) % 3 < hash(a, b) % 4);
  return learn_views(views, tallies, fields.regions, 1);
}

struct Room {
  Scene scene;
  Accel accel;
  Fields fields;
  WalkOptions options;

  explicit Room(float scale = 1, bool guided = false) : scene(scaled_stage(scale)), accel(scene) {
    options.light_paths = 64;
    if (!guided) return;
    fields = train(scene, accel, 3, 1000);
    fields.views = made_up_views(fields);
    options.fields = &fields;
  }
  Room(const Room&) = delete;
  Room& operator=(const Room&) = delete;

  // So many light subpaths, and of their vertices so many at most; shares are those that light walks end with.
  LightStore store(uint32_t paths, size_t most_places = ~size_t(0)) const {
    LightStore out;
    Subpath light;
    Surface surface;
    for (uint32_t i = 0; i < paths; ++i) {
      Sampler sampler = make_sampler(SamplerKind::independent, 5, Side::light, i, 0);
      Walk walk;
      light.n = 0;
      if (start_light(scene, options, sampler, light, walk))
        while (light.n < most_edges && step(scene, accel, options, light, walk, surface) &&
               scatter(options, sampler, light, walk)) {
        }
      add(out, light, walk.first_share);
    }
    out.places.resize(std::min(out.places.size(), most_places));
    finish(out, 1);
    return out;
  }

  // Camera subpaths that end at a vertex that can be joined.
  std::vector<Subpath> cameras(size_t n) const {
    std::vector<Subpath> out;
    for (uint64_t i = 0; out.size() < n && i < 1000; ++i) {
      Subpath camera;
      trace_subpath(scene, accel, options, Side::camera, i, 77, 2 + int(i % 3), camera);
      if (camera.n > 1 && connectable(camera[camera.n - 1].guide)) out.push_back(camera);
    }
    return out;
  }
};

const Vertex& end_of(const Subpath& path) { return path[path.n - 1]; }
size_t index_of(const LightStore& store, const StoreChoice& choice) {
  return size_t(choice.place - store.places.data());
}
Sampler draws(uint64_t path) { return make_sampler(SamplerKind::independent, 9, Side::camera, path, 0); }

// What a place brings to a camera subpath, but for visibility, times a factor of no meaning. Places of subpaths that
// would be too long bring nothing.
std::vector<double> brought(const LightStore& store, const Subpath& camera, int most) {
  std::vector<double> out;
  for (const LightStore::Place& at : store.places) {
    Candidate c;
    const bool joined = at.s <= most && join_vertices(store.subpath(at), at.share, camera.first(camera.n), 64, c);
    out.push_back(joined ? double(luminance(c.value)) * (0.5 + double(hash(out.size(), 3) % 1000) / 1000) : 0);
  }
  return out;
}

// The mean of weight x g over draws is the sum of g over all places, over paths; and a weight wrong by a little would
// be seen. Returns how many vertices had something to bring.
int expect_unbiased(const LightStore& store, const std::vector<Subpath>& cameras, int most = most_edges, int n = 40'000,
                    float worth = 0) {
  std::vector<StoreChoice> choices;
  int lit = 0;
  for (size_t k = 0; k < cameras.size(); ++k) {
    const std::vector<double> g = brought(store, cameras[k], most);
    double expected = 0;
    for (size_t i = 0; i < g.size(); ++i) expected += g[i] * double(store.places[i].counts) / store.paths;
    Sampler sampler = draws(k);
    double sum = 0, squares = 0;
    for (int i = 0; i < n; ++i) {
      choose(store, end_of(cameras[k]), 1, most, worth, sampler, choices);
      double x = 0;
      for (const StoreChoice& choice : choices) {
        EXPECT_TRUE(choice.weight > 0 && choice.weight < infinity);
        x += double(choice.weight) * g[index_of(store, choice)];
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

// The same of several choices at once, from all places; with chances to see them too, whatever these are.
void expect_several_unbiased(const LightStore& store, const std::vector<Subpath>& cameras, const Visibility* seen) {
  int lit = 0;
  for (const Subpath& camera : cameras) {
    const std::vector<double> g = brought(store, camera, most_edges);
    double expected = 0;
    for (size_t i = 0; i < g.size(); ++i) expected += g[i] * double(store.places[i].counts) / store.paths;
    Expectation sums;
    expect_all(store, end_of(camera), most_edges, seen, sums);
    std::vector<StoreChoice> choices;
    double sum = 0, squares = 0, drawn = 0;
    constexpr int n = 10'000;
    for (int i = 0; i < n; ++i) {
      choose_some(store, sums, 5, uint32_t(hash(7, uint64_t(i))), choices);
      double x = 0;
      for (const StoreChoice& c : choices) x += double(c.weight) * g[index_of(store, c)];
      sum += x, squares += x * x, drawn += double(choices.size());
    }
    const double mean = sum / n, error = std::sqrt(std::max(squares / n - mean * mean, 0.0) / n);
    EXPECT_NEAR(mean, expected, 5 * error + 1e-4 * expected);
    EXPECT_LE(drawn / n, 5.1);
    if (!(expected > 0)) continue;
    ++lit;
    EXPECT_LT(5 * error, 0.2 * expected) << "too noisy to see a wrong weight";
  }
  EXPECT_GT(lit, 8);
}

TEST(LightStore, SeveralStandForAllPlaces) {
  const Room room(1, true);
  LightStore store = room.store(64);
  for (size_t i = 0; i < store.places.size(); ++i) store.places[i].counts = float(1 + i % 3);
  finish(store, std::vector<float>(store.places.size(), 0.1f));
  expect_several_unbiased(store, room.cameras(12), nullptr);
  Visibility seen;
  start(store, seen);
  for (uint32_t i = 0; i < 300; ++i) learn(seen, uint32_t(hash(i, 1) % store.places.size()), hash(i, 2) % 3 == 0);
  expect_several_unbiased(store, room.cameras(12), &seen);
}

// What one camera vertex sees often is drawn more often by the next.
TEST(Visibility, TellsSeenFromHidden) {
  const Room room(1, true);
  LightStore store = room.store(64);
  finish(store, std::vector<float>(store.places.size(), 0.1f));
  Visibility v;
  start(store, v);
  for (int k = 0; k < 20; ++k) learn(v, 3, true), learn(v, 4, false), learn(v, 40, false);
  const auto chance = [&](uint32_t i) { return v.blocks[i / LightStore::width].chance[i % LightStore::width]; };
  EXPECT_GT(chance(3), 0.9f);
  EXPECT_LT(chance(4), 0.1f);
  EXPECT_GT(chance(4), 0.03f) << "never nothing";
  EXPECT_GT(chance(5), 2 * chance(41)) << "beside what was seen, beside what was hidden";
}

// As what is expected of lights changes a little, and lights come and go, nearly all choices stay.
TEST(LightStore, ChoicesStay) {
  const Room room(1, true);
  LightStore store = room.store(64);
  finish(store, std::vector<float>(store.places.size(), 0.1f));
  const std::vector<Subpath> cameras = room.cameras(12);
  const auto choices_of = [&](uint32_t key, size_t k, float count) {
    LightStore some = store;
    some.places[2].counts = count;
    if (count > 1) std::reverse(some.places.begin(), some.places.end());
    finish(some, std::vector<float>(some.places.size(), 0.1f));
    Expectation sums;
    expect_all(some, end_of(cameras[k]), most_edges, nullptr, sums);
    std::vector<StoreChoice> choices;
    choose_some(some, sums, 5, key, choices);
    std::set<std::pair<uint32_t, int>> chosen;
    for (const StoreChoice& c : choices) chosen.insert({c.place->path, c.place->s});
    return chosen;
  };
  size_t all = 0, other = 0;
  for (uint32_t i = 0; i < 500; ++i) {
    const size_t k = i % cameras.size();
    const auto a = choices_of(uint32_t(hash(3, i)), k, 1), b = choices_of(uint32_t(hash(3, i)), k, 1.2f);
    for (const auto& c : a) other += !b.contains(c);
    all += a.size();
  }
  EXPECT_GT(all, 500u);
  EXPECT_LT(double(other), 0.03 * double(all));
}

// What fields expect to bring much is there several times; the mean over draws is what all bring.
TEST(LightStore, WhatIsPreferredStandsForAllPlaces) {
  const Room room(1, true);
  const LightStore all = room.store(64);
  std::map<std::pair<uint32_t, int>, double> times;
  size_t most = 0;
  constexpr int n = 1000;
  for (int i = 0; i < n; ++i) {
    LightStore some = all;
    prefer(some, (float(i) + 0.5f) / n);
    EXPECT_NEAR(double(some.places.size()), double(all.places.size()), 1);
    std::map<std::pair<uint32_t, int>, size_t> here;
    for (const LightStore::Place& at : some.places) {
      times[{at.path, at.s}] += double(at.counts) / n;
      most = std::max(most, ++here[{at.path, at.s}]);
    }
  }
  EXPECT_GT(most, 3u);
  EXPECT_EQ(times.size(), all.places.size());
  for (const auto& [place, count] : times) EXPECT_NEAR(count, 1, 0.01);
}

TEST(LightStore, StandsForAllPlacesOfWhichSomeCountMore) {
  const Room room(1, true);
  LightStore store = room.store(64);
  prefer(store, 0.5f);
  ASSERT_GT(std::count_if(store.places.begin(), store.places.end(), [](const auto& p) { return p.counts < 0.5f; }), 4);
  finish(store, 1);
  EXPECT_GT(expect_unbiased(store, room.cameras(12)), 8);
}

TEST(LightStore, PartsAddUpToTheWhole) {
  const Room room;
  const LightStore whole = room.store(8);
  LightStore joined;
  append(joined, whole);
  append(joined, whole);
  EXPECT_EQ(joined.paths, 2 * whole.paths);
  ASSERT_EQ(joined.places.size(), 2 * whole.places.size());
  for (size_t i = 0; i < whole.places.size(); ++i) {
    const auto a = whole.subpath(whole.places[i]), b = joined.subpath(joined.places[whole.places.size() + i]);
    EXPECT_EQ(a.back().p, b.back().p);
    EXPECT_EQ(a.front().p, b.front().p);
  }
}

TEST(LightStore, StandsForAllPlaces) {
  const Room room;
  EXPECT_GT(expect_unbiased(room.store(64), room.cameras(12)), 8);
}

TEST(LightStore, StandsForAllPlacesWhateverViewsSay) {
  const Room room(1, true);
  ASSERT_GT(room.fields.views.regions, 4u);
  EXPECT_GT(expect_unbiased(room.store(64), room.cameras(12)), 8);
}

// What is worth little is joined rarely and counts for the more, what is worth much often. (J3)
TEST(LightStore, StandsForAllPlacesHoweverManyAreJoined) {
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
        choose(store, end_of(camera), 1, most_edges, 0, sampler, choices);
        vertices += choices.size();
        choose(store, end_of(camera), 1, most_edges, worth, sampler, choices);
        joins += choices.size();
      }
    const double mean = double(joins) / double(vertices);
    EXPECT_GT(mean, before) << worth;
    EXPECT_GT(mean, 0.08) << worth;
    EXPECT_LT(mean, 17) << worth;
    before = mean;
  }
  EXPECT_GT(before, 15);
}

// One place; a full block; one more, which makes two blocks of unequal number.
TEST(LightStore, StandsForFewPlaces) {
  const Room room;
  for (const size_t places : {1u, 2u, 31u, 32u, 33u}) {
    const LightStore store = room.store(64, places);
    ASSERT_EQ(store.places.size(), places);
    ASSERT_EQ(store.blocks.size(), (places + 31) / 32);
    EXPECT_GT(expect_unbiased(store, room.cameras(6), most_edges, 20'000), 0) << places;
  }
}

TEST(LightStore, StandsForPlacesOfShortSubpathsAlone) {
  const Room room;
  const LightStore store = room.store(64);
  EXPECT_GT(expect_unbiased(store, room.cameras(6), 2), 3);
  Sampler sampler = draws(0);
  std::vector<StoreChoice> choices;
  for (const Subpath& camera : room.cameras(12))
    for (int i = 0; i < 200; ++i) {
      choose(store, end_of(camera), 1, 2, 0, sampler, choices);
      for (const StoreChoice& choice : choices) ASSERT_EQ(choice.place->s, 2);
    }
}

TEST(LightStore, StandsForAllPlacesAtAnySize) {
  for (const float scale : {1e-6f, 1e6f}) {
    const Room room(scale);
    const LightStore store = room.store(64);
    ASSERT_GT(store.places.size(), 64u) << scale;
    EXPECT_GT(expect_unbiased(store, room.cameras(6), most_edges, 20'000), 3) << scale;
  }
}

// The probabilities that places ought to have, from the vertices themselves. (J1)
std::vector<double> probabilities(const LightStore& store, const Room& room, const Vertex& c) {
  const size_t n = store.blocks.size();
  std::vector<double> p, sums(n);
  for (size_t i = 0; i < store.places.size(); ++i) {
    const Vertex& a = store.subpath(store.places[i]).back();
    const glm::dvec3 w = glm::dvec3(c.p) - glm::dvec3(a.p);
    const double d2 = glm::dot(w, w), cosines = std::max(glm::dot(glm::dvec3(a.guide.frame.n), w), 0.0) *
                                                std::max(-glm::dot(glm::dvec3(c.guide.frame.n), w), 0.0) / d2;
    const double g = cosines / d2, found = g / pi * (1 / a.own + 1 / c.own);
    const double flux = luminance(a.beta) * std::max(luminance(albedo(a.guide.bsdf, a.guide.wo_local)), 0.02f);
    double sees = 1;
    if (a.guide.cell != none && c.guide.cell != none)
      sees = chance(room.fields.views, room.fields.cells[a.guide.cell].region, room.fields.cells[c.guide.cell].region);
    p.push_back(flux * g / (1 + found) * sees);
    sums[i % n] += p.back();
  }
  for (size_t i = 0; i < p.size(); ++i) p[i] /= sums[i % n] > 0 ? sums[i % n] * double(n) : 1;
  return p;
}

TEST(LightStore, ChoosesByWhatPlacesWouldBring) {
  const Room room(1, true);
  const LightStore store = room.store(40);
  ASSERT_GT(store.blocks.size(), 2u);
  constexpr int n = 100'000;
  std::vector<StoreChoice> choices;
  const std::vector<Subpath> cameras = room.cameras(5);
  for (size_t k = 0; k < cameras.size(); ++k) {
    const std::vector<double> p = probabilities(store, room, end_of(cameras[k]));
    std::vector<double> drawn(p.size());
    Sampler sampler = draws(100 + k);
    for (int i = 0; i < n; ++i) {
      choose(store, end_of(cameras[k]), 1, most_edges, 0, sampler, choices);
      ASSERT_LE(choices.size(), 1u);
      for (const StoreChoice& choice : choices) drawn[index_of(store, choice)] += 1;
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
    ASSERT_GT(dof, 20);
    EXPECT_LT((statistic - dof) / std::sqrt(2.0 * dof), 5) << "camera vertex " << k << ", " << dof << " degrees";
  }
}

TEST(LightStore, NothingIsChosenFromNothing) {
  const Room room;
  const LightStore empty = room.store(0), full = room.store(64);
  LightStore black;  // subpaths that ended at once
  add(black, {}, 1);
  finish(black, 1);
  EXPECT_EQ(black.paths, 1u);
  std::vector<StoreChoice> choices;
  const auto chooses = [&](const LightStore& store, const Vertex& c, int most, Sampler& sampler) {
    choices.resize(3);  // of the vertex before
    choose(store, c, 1, most, 1e9f, sampler, choices);
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

// Opaque surfaces receive and scatter on one side.
TEST(LightStore, NothingBehindIsChosen) {
  const Room room;
  const LightStore store = room.store(64);
  int chosen = 0, behind = 0;
  for (const Subpath& camera : room.cameras(20)) {
    const Vertex& c = end_of(camera);
    for (const LightStore::Place& at : store.places) behind += !may_scatter(c.guide, store.subpath(at).back().p - c.p);
    Sampler sampler = draws(2);
    std::vector<StoreChoice> choices;
    for (int i = 0; i < 1000; ++i) {
      choose(store, c, 1, most_edges, 0, sampler, choices);
      for (const StoreChoice& choice : choices) {
        const Vertex& a = store.subpath(*choice.place).back();
        ASSERT_TRUE(may_scatter(c.guide, a.p - c.p));
        ASSERT_TRUE(may_scatter(a.guide, c.p - a.p));
        ++chosen;
      }
    }
  }
  EXPECT_GT(chosen, 10'000);
  EXPECT_GT(behind, 100);
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
    const auto weigh = [&](std::span<const Vertex> subpath, double share) {
      Candidate c;
      return join_vertices(subpath, share, camera.first(camera.n), 64, c) ? weight(Heuristic::power, c) : -1;
    };
    const size_t before = store.places.size();
    add(store, light, walk.first_share);
    size_t place = before;
    for (int s = 2; s <= light.n; ++s) {
      if (!connectable(light[s - 1].guide) || !(luminance(light[s - 1].beta) > 0)) continue;
      ASSERT_LT(place, store.places.size());
      const LightStore::Place& at = store.places[place++];
      EXPECT_EQ(at.s, s);
      counts += std::abs(at.share - 1) > 0.1;
      EXPECT_EQ(weigh(store.subpath(at), at.share), weigh(light.first(s), walk.first_share));
    }
    EXPECT_EQ(place, store.places.size());
  }
  EXPECT_GT(counts, 20) << "places whose share is not 1";
}

}  // namespace
}  // namespace ajar
