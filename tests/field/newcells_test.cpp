// Cells that lessons make: where they were missed, as parts of those that were visited often, as long as there is
// memory.
#include <gtest/gtest.h>

#include "lesson.h"

namespace ajar {
namespace {

TEST(Learn, CellsAreMadeWhereTheyAreMissed) {
  Fields f;
  f.table = make_cell_table(Vec3(0), 1);
  const Vec3 n = glm::normalize(Vec3(0.1f, -0.1f, 1));
  const CellKey key = find(f.table, somewhere, n).missing;
  EXPECT_TRUE(learn(f, start_training(f), seen(key, n, 3), 1, {}).cells.empty()) << "seen too rarely";
  const Fields made = learn(f, start_training(f), seen(key, n, 4), 1, {});
  ASSERT_EQ(made.cells.size(), 1u);
  EXPECT_EQ(find(made.table, somewhere, n).cell, 0u);
  EXPECT_NEAR(glm::dot(made.cells[0].frame.n, n), 1, 1e-3);
  EXPECT_EQ(made.q.cells[0].mix, 0) << "what knows nothing does not guide";
  EXPECT_EQ(made.q.cells.size(), 1u);
  EXPECT_EQ(made.w.cells.size(), 1u);
  Sightings nowhere = seen(key, n, 4);
  for (const auto& [k, s] : seen(key, -n, 4)) nowhere[k].count += s.count, nowhere[k].normal += s.normal;
  EXPECT_TRUE(learn(f, start_training(f), nowhere, 1, {}).cells.empty()) << "normals that cancel";
}

TEST(Learn, VisitedCellsDivideUnderTheMemoryLimit) {
  const Fields blank = one_cell();
  Lesson first(blank);
  first.add(towards(5), 3, 2);
  for (int i = 0; i < 300; ++i) record_visit(first.training.q, 0), record_visit(first.training.w, 0);
  const Fields a = first.learned(whole_strata());
  EXPECT_EQ(find(a.table, somewhere, up).missing, 0u) << "600 are not enough";
  Lesson second(a);
  record_visit(second.training.w, 0);
  const Fields b = second.learned(whole_strata());
  const CellKey part = find(b.table, somewhere, up).missing;
  ASSERT_NE(part, 0u);
  EXPECT_EQ(find(b.table, somewhere, up).cell, 0u) << "the whole answers until the part is known";

  LearnOptions tight = whole_strata();
  tight.memory = bytes(b) - bytes(b.views) - 1;
  const Fields full = learn(b, start_training(b), seen(part, up, 4), 1, tight);
  EXPECT_EQ(full.cells.size(), 1u);
  EXPECT_EQ(find(full.table, somewhere, up).cell, 0u);
  const Fields c = learn(b, start_training(b), seen(part, up, 4), 1, whole_strata());
  ASSERT_EQ(c.cells.size(), 2u);
  EXPECT_EQ(find(c.table, somewhere, up).cell, 1u);
  const uint32_t root = c.q.cells[1].root;
  EXPECT_FLOAT_EQ(c.q.mean[16 * root + 5], 3) << "it begins with what the whole knew";
  EXPECT_FLOAT_EQ(c.q.weight[16 * root + 5], 0.5f) << "and a quarter of the trust";
}

// What has moved to where nothing was must be guided, however full the memory is of what was there before.
TEST(Learn, CoarseCellsFindRoomWhereFineOnesDoNot) {
  Fields f = one_cell();
  CellKey part = 0;
  for (int level = 1; level <= 3; ++level) {
    if (part) f = learn(f, start_training(f), seen(part, up, 4), 1, {});
    Training visits = start_training(f);
    for (int i = 0; i < 601; ++i) record_visit(visits.q, find(f.table, somewhere, up).cell);
    f = learn(f, visits, {}, 1, {});
    part = find(f.table, somewhere, up).missing;
    ASSERT_NE(part, 0u);
    ASSERT_EQ(level_of(part), level);
  }
  LearnOptions half;
  half.memory = 2 * (bytes(f) - bytes(f.views));
  const CellKey other = find(f.table, somewhere, -up).missing;
  ASSERT_EQ(level_of(other), 0);
  EXPECT_EQ(learn(f, start_training(f), seen(part, up, 4), 1, half).cells.size(), f.cells.size());
  EXPECT_EQ(learn(f, start_training(f), seen(other, -up, 4), 1, half).cells.size(), f.cells.size() + 1);
}

TEST(Learn, PartsInheritDividedStrata) {
  const Fields blank = one_cell();
  Lesson first(blank);
  for (int i = 0; i < 16; ++i) first.add(towards(i), i == 5 || i == 12 ? 1.0f : 0.1f, 16);
  for (int i = 0; i < 700; ++i) record_visit(first.training.q, 0);
  const Fields a = first.learned();
  ASSERT_GT(a.q.nodes.size(), 2u);
  const CellKey part = find(a.table, somewhere, up).missing;
  const Fields b = learn(a, start_training(a), seen(part, up, 4), 1, {});
  ASSERT_EQ(b.cells.size(), 2u);
  for (int i = 0; i < 64; ++i)
    for (int j = 0; j < 64; ++j) {
      const Vec2 at((float(i) + 0.5f) / 64, (float(j) + 0.5f) / 64);
      ASSERT_EQ(density(b.q.nodes, b.q.cells[0].root, at), density(b.q.nodes, b.q.cells[1].root, at));
    }
}

TEST(Learn, OrderOfSightingsDoesNotMatter) {
  const auto lesson = [](bool backwards) {
    Fields f;
    f.table = make_cell_table(Vec3(0), 1);
    Sightings all, part;
    for (int k = 0; k < 200; ++k) {
      const int i = backwards ? 199 - k : k;
      const Vec3 n = glm::normalize(Vec3(float(i % 3) - 1, float(i % 5) - 1.9f, float(i % 7) - 3));
      const Vec3 p = Vec3(float(i % 4), float(i / 4 % 4), float(i / 16)) * 0.3f - 0.5f;
      for (int j = 0; j < 5; ++j) record_missing(part, find(f.table, p, n).missing, n);
      if (i % (backwards ? 7 : 50) == 0) gather(all, part);
    }
    gather(all, part);
    return learn(f, start_training(f), all, 1, {});
  };
  const Fields a = lesson(false), b = lesson(true);
  ASSERT_GT(a.cells.size(), 100u);
  ASSERT_EQ(a.cells.size(), b.cells.size());
  for (size_t i = 0; i < a.cells.size(); ++i) {
    EXPECT_EQ(a.cells[i].key, b.cells[i].key);
    EXPECT_EQ(a.cells[i].frame.n, b.cells[i].frame.n);
  }
}

}  // namespace
}  // namespace ajar
