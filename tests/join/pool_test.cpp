// A few of all light vertices, kept: in the mean over what could have been drawn they stand for all.
#include "ajar/join/pool.h"

#include <gtest/gtest.h>

#include <map>

#include "room.h"

namespace ajar::room {
namespace {
using Key = std::pair<uint32_t, int>;
Key key_of(const LightStore::Entry& at) { return {at.path, at.s}; }

constexpr int pools = 1000;
float mark(int i) { return (float(i) + 0.5f) / pools; }

// Each entry counts 1 in the mean over marks, and is there at most once.
void expect_stands_for(const LightStore& all, double count, const std::function<void(LightStore&, float)>& fill) {
  std::map<Key, double> counts, squares;
  for (int i = 0; i < pools; ++i) {
    LightStore some;
    fill(some, mark(i));
    EXPECT_EQ(some.paths, all.paths);
    EXPECT_NEAR(double(some.entries.size()), count, 2);
    std::map<Key, int> here;
    for (const LightStore::Entry& at : some.entries) {
      counts[key_of(at)] += double(at.counts) / pools, squares[key_of(at)] += sqr(double(at.counts)) / pools;
      EXPECT_EQ(++here[key_of(at)], 1);
      EXPECT_GE(at.counts, 1 - 1e-6f);
    }
  }
  EXPECT_EQ(counts.size(), all.entries.size());
  for (const auto& [entry, times] : counts)
    EXPECT_NEAR(times, 1, 1e-3 + 5 * std::sqrt(std::max(squares[entry] - sqr(times), 0.0) / pools));
}

TEST(Pool, WhatIsKeptStandsForAllEntries) {
  const Room room(1, true);
  const LightStore all = room.store(64);
  ASSERT_GT(all.entries.size(), 80u);
  expect_stands_for(all, 40, [&](LightStore& some, float u) { subsample(some, {&all}, 40, u); });
}

// In two steps, by parts.
TEST(Pool, WhatIsKeptOfWhatWasKeptStandsForAllEntries) {
  const Room room(1, true);
  const LightStore all = room.store(64);
  LightStore first, second, together;
  append(together, all), append(together, all);
  expect_stands_for(together, 40, [&](LightStore& some, float u) {
    const float other = float(hash(uint64_t(double(u) * pools), 3) % pools) / pools;
    subsample(first, {&all}, 80, u), subsample(second, {&all}, 80, u);
    subsample(some, {&first, &second}, 40, other);
  });
}

// What fields expect to bring much is kept more often, in proportion.
TEST(Pool, KeepsWhatIsWorthMuch) {
  const Room room(1, true);
  const LightStore all = room.store(64);
  LightStore some;
  double worth = 0, kept = 0, mean = 0;
  for (const LightStore::Entry& at : all.entries) worth += double(at.worth) / double(all.entries.size());
  for (int i = 0; i < pools; ++i) {
    subsample(some, {&all}, 20, mark(i));
    for (const LightStore::Entry& at : some.entries)
      kept += double(at.worth), mean += double(at.counts) * double(at.worth);
  }
  ASSERT_GT(worth, 0);
  EXPECT_GT(kept / (20 * pools), 1.5 * worth);
  EXPECT_NEAR(mean / (double(pools) * double(all.entries.size())), worth, 0.02 * worth);
}

// Where fields know nothing, and where there are fewer than are asked for.
TEST(Pool, KeepsAllWhereThereAreFew) {
  const Room room;
  const LightStore all = room.store(16), empty = room.store(0);
  LightStore some;
  for (const double count : {double(all.entries.size()), 1e6}) {
    subsample(some, {&empty, &all, &empty}, count, 0.7f);
    ASSERT_EQ(some.entries.size(), all.entries.size());
    for (const LightStore::Entry& at : some.entries) EXPECT_EQ(at.counts, 1);
  }
  subsample(some, {&empty}, 10, 0.5f);
  EXPECT_TRUE(some.entries.empty());
  subsample(some, {}, 10, 0.5f);
  EXPECT_EQ(some.paths, 0u);
}

TEST(Pool, KeepsWhatJoinsRead) {
  const Room room(1, true);
  const LightStore all = room.store(64), more = room.store(32);
  LightStore some;
  subsample(some, {&all, &more}, 60, 0.3f);
  EXPECT_LT(some.vertices.size(), all.vertices.size());
  std::map<Key, const LightStore::Entry*> known;
  LightStore whole;
  append(whole, all), append(whole, more);
  for (const LightStore::Entry& at : whole.entries) known[key_of(at)] = &at;
  size_t of_more = 0;
  for (const LightStore::Entry& at : some.entries) {
    const LightStore::Entry& other = *known.at(key_of(at));
    of_more += at.path >= all.paths;
    EXPECT_EQ(some.vertex(at).p, whole.vertex(other).p);
    EXPECT_EQ(at.s, other.s);
    EXPECT_EQ(at.own_before, other.own_before);
    EXPECT_EQ(at.delta_before, other.delta_before);
    EXPECT_EQ(at.nee_ratio, other.nee_ratio);
  }
  EXPECT_GT(of_more, 5u);
}

}  // namespace
}  // namespace ajar::room
