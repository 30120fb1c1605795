// Which regions see each other: counts, their chance, and what is forgotten.
#include "ajar/field/views.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ajar {
namespace {

Views start(uint32_t regions) { return learn_views({}, {}, regions, 1); }

Views after(const Views& views, uint32_t a, uint32_t b, int tried, int seen, float kept = 1) {
  ViewTallies tallies = start_tallies(views);
  for (int i = 0; i < tried; ++i) record_join(views, tallies, a, b, i < seen);
  return learn_views(views, tallies, views.regions, kept);
}

TEST(Views, KnowNothingToBeginWith) {
  EXPECT_EQ(chance({}, 0, 0), 1);
  const Views views = start(3);
  ASSERT_EQ(views.regions, 3u);
  for (uint32_t a = 0; a < 3; ++a)
    for (uint32_t b = 0; b < 3; ++b) EXPECT_EQ(chance(views, a, b), 1);
  EXPECT_EQ(chance(views, 0, 3), 1) << "a region that is not known";
  EXPECT_EQ(chance(views, no_region, 0), 1);
}

TEST(Views, LearnTheRootOfTheShareThatIsFree) {
  const Views views = after(start(5), 1, 3, 1599, 143);
  EXPECT_NEAR(chance(views, 1, 3), 0.3f, 0.6 / 255);
  EXPECT_EQ(chance(views, 1, 2), 1);
  EXPECT_EQ(chance(views, 1, 1), 1);
}

TEST(Views, AreTheSameBothWays) {
  Views views = start(6);
  ViewTallies tallies = start_tallies(views), swapped = start_tallies(views);
  for (uint32_t i = 0; i < 600; ++i) {
    const uint32_t a = i % 6, b = i / 6 % 6;
    const bool free = i * i % 7 < a + b;
    record_join(views, tallies, a, b, free);
    record_join(views, swapped, b, a, free);
  }
  EXPECT_EQ(tallies.counts, swapped.counts);
  for (int turn = 0; turn < 2; ++turn) views = learn_views(views, tallies, 6, 0.5f);
  float least = 1;
  for (uint32_t a = 0; a < 6; ++a)
    for (uint32_t b = 0; b < 6; ++b) {
      EXPECT_EQ(chance(views, a, b), chance(views, b, a)) << a << ' ' << b;
      least = std::min(least, chance(views, a, b));
    }
  EXPECT_LT(least, 0.8f);
}

TEST(Views, HaveAPlaceForEachPair) {
  std::vector<int> found(pair_count(7));
  for (uint32_t a = 0; a < 7; ++a)
    for (uint32_t b = 0; b <= a; ++b) ++found.at(pair_index(a, b));
  EXPECT_EQ(found, std::vector<int>(28, 1));
}

TEST(Views, RuleNothingOut) {
  Views views = start(2);
  for (int turn = 0; turn < 5; ++turn) {
    views = after(views, 0, 1, 100'000, 0);
    EXPECT_GE(chance(views, 0, 1), 0.01f);
    EXPECT_LT(chance(views, 0, 1), 0.1f);
  }
  for (int turn = 0; turn < 5; ++turn) {
    views = after(views, 0, 0, 1000, 1000);
    EXPECT_LE(chance(views, 0, 0), 1);
    EXPECT_GT(chance(views, 0, 0), 0.99f);
  }
}

TEST(Views, Forget) {
  const Views closed = after(start(2), 0, 1, 1000, 0);
  Views kept = closed, forgotten = closed;
  for (int turn = 0; turn < 8; ++turn) {
    kept = after(kept, 0, 1, 10, 10);
    forgotten = after(forgotten, 0, 1, 10, 10, 0.5f);
  }
  EXPECT_FLOAT_EQ(kept.tried[1], 1080);
  EXPECT_FLOAT_EQ(kept.seen[1], 80);
  EXPECT_LT(forgotten.tried[1], 25);
  EXPECT_LT(chance(kept, 0, 1), 0.3f);
  EXPECT_GT(chance(forgotten, 0, 1), 0.85f) << "a door that was opened";
}

TEST(Views, GrowWithTheRegions) {
  const Views grown = learn_views(after(start(3), 1, 2, 99, 0), start_tallies(start(3)), 7, 1);
  ASSERT_EQ(grown.regions, 7u);
  EXPECT_EQ(grown.tried[pair_index(1, 2)], 99);
  EXPECT_NEAR(chance(grown, 1, 2), 0.1f, 0.6 / 255);
  EXPECT_EQ(std::count(grown.chance.begin(), grown.chance.end(), 255), 27);
}

TEST(Views, AreOfSoManyRegionsAndNoMore) {
  Views views = start(most_regions + 100);
  ASSERT_EQ(views.regions, most_regions);
  ViewTallies tallies = start_tallies(views);
  record_join(views, tallies, most_regions - 1, most_regions - 1, false);
  record_join(views, tallies, most_regions, 0, false);
  record_join(views, tallies, 0, no_region, false);
  EXPECT_EQ(std::count(tallies.counts.begin(), tallies.counts.end(), 1u), 1) << "what is no region is not counted";
  views = learn_views(views, tallies, 10 * most_regions, 1);
  EXPECT_EQ(views.regions, most_regions);
  EXPECT_LT(chance(views, most_regions - 1, most_regions - 1), 1);
  EXPECT_EQ(chance(views, most_regions, 0), 1);
}

}  // namespace
}  // namespace ajar
