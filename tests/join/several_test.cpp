// Several light vertices drawn at once, each on its own, as virtual point lights are: they stand for all of them, and
// most choices stay as lights change; and the chance that a light is seen, learned by a tile.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "ajar/join/visibility.h"
#include "room.h"

namespace ajar::room {
namespace {

// Blocks of neighbours, whose entries are all as near.
void lay(LightStore& store) {
  for (LightStore::Entry& at : store.entries) at.near = 0.1f;
  lay_blocks(store);
}

// The mean of the sum of weight x g over draws is the sum of g over all entries, over paths; with chances to see them
// too, whatever these are.
void expect_several_unbiased(const LightStore& store, const std::vector<Subpath>& cameras, const Prospect& known) {
  int lit = 0;
  for (const Subpath& camera : cameras) {
    const std::vector<double> g = brought(store, camera, most_edges);
    double expected = 0;
    for (size_t i = 0; i < g.size(); ++i) expected += g[i] * double(store.entries[i].counts) / store.paths;
    Expectation sums;
    expect_all(store, end_of(camera), most_edges, known, sums);
    std::vector<StoreChoice> choices;
    double sum = 0, squares = 0, drawn = 0;
    constexpr int n = 10'000;
    for (int i = 0; i < n; ++i) {
      choose_some(store, sums, 5, uint32_t(hash(7, uint64_t(i))), choices);
      double x = 0;
      for (const StoreChoice& c : choices) x += double(c.weight) * g[c.entry];
      sum += x, squares += x * x, drawn += double(choices.size());
    }
    const double mean = sum / n, error = std::sqrt(std::max(squares / n - mean * mean, 0.0) / n);
    EXPECT_NEAR(mean, expected, 5 * error + 1e-4 * expected);
    EXPECT_LE(drawn / n, 5.1);
    if (!(expected > 0)) continue;
    ++lit;
    EXPECT_LT(5 * error, 0.2 * expected) << "too noisy to see a wrong weight";
  }
  EXPECT_GT(lit, int(cameras.size()) * 2 / 3);
}

TEST(LightStore, SeveralStandForAllEntries) {
  const Room room(1, true);
  LightStore store = room.store(64);
  for (size_t i = 0; i < store.entries.size(); ++i) store.entries[i].counts = float(1 + i % 3);
  lay(store);
  expect_several_unbiased(store, room.cameras(12), {});
  Visibility seen;
  start(store, seen);
  for (uint32_t i = 0; i < 300; ++i) learn(seen, uint32_t(hash(i, 1) % store.entries.size()), hash(i, 2) % 3 == 0);
  expect_several_unbiased(store, room.cameras(12), {&seen});
  const Views views = room.fields.views;
  for (const uint32_t region : {0u, views.regions / 2, no_region})
    expect_several_unbiased(store, room.cameras(6), {nullptr, &views, region});
}

// Regions that were never seen from one are drawn least.
TEST(LightStore, SeveralByWhatRegionsSee) {
  const Room room(1, true);
  LightStore store = room.store(64);
  lay(store);
  const Views& views = room.fields.views;
  ASSERT_GT(views.regions, 3u);
  Expectation all, seen;
  const Subpath camera = room.cameras(1)[0];
  expect_all(store, end_of(camera), most_edges, {}, all);
  expect_all(store, end_of(camera), most_edges, {nullptr, &views, 1}, seen);
  for (size_t i = 0; i < store.entries.size(); ++i) {
    const size_t block = i / LightStore::width, k = i % LightStore::width;
    EXPECT_FLOAT_EQ(seen.values[block][k], all.values[block][k] * chance(views, 1, store.entries[i].region)) << i;
  }
}

// What one camera vertex sees often is drawn more often by the next.
TEST(Visibility, TellsSeenFromHidden) {
  const Room room(1, true);
  LightStore store = room.store(64);
  lay(store);
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
  lay(store);
  const std::vector<Subpath> cameras = room.cameras(12);
  const auto choices_of = [&](uint32_t key, size_t k, float count) {
    LightStore some = store;
    some.entries[2].counts = count;
    if (count > 1) std::reverse(some.entries.begin(), some.entries.end());
    lay(some);
    Expectation sums;
    expect_all(some, end_of(cameras[k]), most_edges, {}, sums);
    std::vector<StoreChoice> choices;
    choose_some(some, sums, 5, key, choices);
    std::set<std::pair<uint32_t, int>> chosen;
    for (const StoreChoice& c : choices) chosen.insert({entry_of(some, c).path, entry_of(some, c).s});
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

}  // namespace
}  // namespace ajar::room
