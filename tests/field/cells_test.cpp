// Names of cells and their table: what is looked up, and what answers in place of cells that do not exist.
#include "ajar/field/cells.h"

#include <gtest/gtest.h>

#include <set>

#include "ajar/core/sampler.h"
#include "ajar/core/warp.h"

namespace ajar {
namespace {

const Vec3 north(0, 1, 0);

CellTable table() { return make_cell_table(Vec3(1, 2, 3), 6); }

// Centre of a cube of level 0.
Vec3 centre_of_cube(const CellTable& t, int x, int y, int z) {
  return t.origin + t.width * (float(t.first) + Vec3(float(x), float(y), float(z)) + 0.5f);
}

TEST(Cells, NoneAreKnownWhereNothingIsLearned) {
  for (const Vec3& p : {Vec3(0.3f, 0.5f, 0.2f), Vec3(-1), Vec3(0), Vec3(0, 1, -2), Vec3(1e18f)}) {
    EXPECT_EQ(find(CellTable{}, p, north).cell, none);
    EXPECT_EQ(find(CellTable{}, p, north).missing, 0u);
  }
}

TEST(Cells, JitterWithinACellDoesNotMatter) {
  const CellTable t = table();
  const Vec3 centre = centre_of_cube(t, 3, 4, 5);
  const CellKey key = find(t, centre, north).missing;
  Sampler sampler = make_sampler(SamplerKind::independent, 1, Side::camera, 0, 0);
  for (int i = 0; i < 10000; ++i) {
    const Vec2 a = sampler.next2(), b = sampler.next2(), c = sampler.next2();
    const Vec3 p = centre + t.width * 0.499f * (2.0f * Vec3(a, b.x) - 1.0f);
    const Vec3 n = glm::normalize(north + 0.2f * (2.0f * Vec3(b.y, c) - 1.0f));
    ASSERT_EQ(find(t, p, n).missing, key);
  }
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 p = centre;
    p[axis] += 0.501f * t.width;
    EXPECT_NE(find(t, p, north).missing, key) << "the next cube";
  }
}

TEST(Cells, NormalsAndPlacesHaveTheirOwn) {
  const CellTable t = table();
  std::set<CellKey> keys;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (x != 0 || y != 0 || z != 0)
          keys.insert(find(t, Vec3(1, 2, 3), glm::normalize(Vec3(float(x), float(y), float(z)))).missing);
  EXPECT_EQ(keys.size(), 26u);
  for (int i = 0; i < 1000; ++i) keys.insert(find(t, centre_of_cube(t, i % 10, i / 10 % 10, i / 100), north).missing);
  EXPECT_EQ(keys.size(), 26u + 1000 - 1) << "one of them is the cube of the first 26";
  EXPECT_FALSE(keys.contains(0));
}

TEST(Cells, DividedOnesAnswerWherePartsAreUnknown) {
  CellTable t = table();
  const Vec3 centre = centre_of_cube(t, 3, 4, 5), low = centre - 0.2f * t.width, high = centre + 0.2f * t.width;
  Place at = find(t, low, north);
  EXPECT_EQ(at.cell, none);
  const CellKey whole = at.missing;
  EXPECT_EQ(level_of(whole), 0);
  EXPECT_EQ(parent_of(whole), 0u);
  insert(t, whole, 7);
  at = find(t, low, north);
  EXPECT_EQ(at.cell, 7u);
  EXPECT_EQ(at.missing, 0u);

  set_divided(t, whole);
  at = find(t, low, north);
  EXPECT_EQ(at.cell, 7u);
  EXPECT_EQ(level_of(at.missing), 1);
  EXPECT_EQ(parent_of(at.missing), whole);
  const CellKey part = at.missing;
  insert(t, part, 8);
  EXPECT_EQ(find(t, low, north).cell, 8u);
  EXPECT_EQ(find(t, low, north).missing, 0u);
  EXPECT_EQ(find(t, high, north).cell, 7u);
  EXPECT_NE(find(t, high, north).missing, part);
  EXPECT_EQ(parent_of(find(t, high, north).missing), whole);
  EXPECT_EQ(find(t, low, -north).cell, none) << "the other side";
  EXPECT_EQ(cell_of(t, part), 8u);
  EXPECT_EQ(cell_of(t, parent_of(part)), 7u);
}

TEST(Cells, DivideDownToTheLastLevel) {
  CellTable t = table();
  const Vec3 p(1.2f, 2.3f, 3.4f);
  for (int level = 0; level <= most_cell_levels; ++level) {
    const Place at = find(t, p, north);
    ASSERT_EQ(level_of(at.missing), level);
    insert(t, at.missing, uint32_t(level));
    if (level < most_cell_levels) set_divided(t, at.missing);
  }
  EXPECT_EQ(find(t, p, north).cell, uint32_t(most_cell_levels));
  EXPECT_EQ(find(t, p, north).missing, 0u);
}

// As a file of fields may have them: parts before wholes, marks of division in any order.
TEST(Cells, AnswerTheSameInWhateverOrderTheyCame) {
  CellTable grown = table(), stored = table();
  Sampler sampler = make_sampler(SamplerKind::independent, 1, Side::camera, 0, 0);
  const Vec3 corner = centre_of_cube(grown, 3, 4, 5);
  const auto anywhere = [&] { return corner + grown.width * Vec3(sampler.next2(), sampler.next2().x); };
  std::vector<CellKey> keys;
  std::set<CellKey> divided;
  for (int i = 0; i < 3000; ++i) {
    const CellKey missing = find(grown, anywhere(), north).missing;
    if (missing == 0) continue;
    insert(grown, missing, uint32_t(keys.size()));
    if (keys.size() % 3 != 2 && level_of(missing) < 5) divided.insert(missing), set_divided(grown, missing);
    keys.push_back(missing);
  }
  ASSERT_GT(keys.size(), 500u);
  for (size_t i = keys.size(); i-- > 0;) {
    insert(stored, keys[i], uint32_t(i));
    if (i % 2 == 0 && divided.contains(keys[i])) set_divided(stored, keys[i]);
  }
  for (const CellKey key : divided) set_divided(stored, key), set_divided(stored, key);
  for (int i = 0; i < 10000; ++i) {
    const Vec3 p = anywhere();
    const Place a = find(grown, p, north), b = find(stored, p, north);
    ASSERT_EQ(a.cell, b.cell);
    ASSERT_EQ(a.missing, b.missing);
  }
}

// Four levels deep, some parts unknown, walls across some cubes: the same with shortcuts as without.
TEST(Cells, ShortcutsLeadToTheSame) {
  CellTable t = table();
  t.compartments.assign(size_t(top_cubes) * top_cubes * top_cubes, ~0);
  for (size_t i = 0; i < t.compartments.size(); i += 3) {
    const int32_t first = int32_t(t.cuts.size());
    t.cuts.push_back({float(i % 5), int32_t(i % 3), ~1, first + 1}), t.cuts.push_back({2.2f, 1, ~0, ~15});
    t.compartments[i] = first;
  }
  Sampler sampler = make_sampler(SamplerKind::independent, 1, Side::camera, 0, 0);
  const auto anywhere = [&] {
    const Vec3 u = 2.0f * Vec3(sampler.next2(), sampler.next1()) - 1.0f;
    return Vec3(1, 2, 3) + (sampler.next1() < 0.2f ? 7.0f : 1.5f) * u;  // and some beyond the cubes that walls cut
  };
  const auto any_normal = [&] { return sampler.next1() < 0.8f ? north : to_sphere(sampler.next2()); };
  uint32_t cells = 0;
  for (int i = 0; i < 60000; ++i) {
    const CellKey missing = find(t, anywhere(), any_normal()).missing;
    if (missing == 0) continue;
    insert(t, missing, cells);
    if (cells++ % 3 != 2 && level_of(missing) < 4) set_divided(t, missing);
  }
  CellTable quick = t;
  shorten(quick);
  ASSERT_GT(quick.shortcuts.leaves.size(), 1000u);
  size_t known = 0, of_level[most_cell_levels + 1] = {};
  for (int i = 0; i < 60000; ++i) {
    const Vec3 p = anywhere(), n = any_normal();
    const Place slow = find(t, p, n), fast = find(quick, p, n);
    ASSERT_EQ(slow.cell, fast.cell);
    ASSERT_EQ(slow.missing, fast.missing);
    if (slow.missing) ++of_level[level_of(slow.missing)];
    known += slow.cell != none;
  }
  EXPECT_GT(known, 30000u);
  for (int level = 0; level <= 4; ++level) EXPECT_GT(of_level[level], 10u) << level;
}

TEST(Cells, NewCellsAreFoundBesideShortcuts) {  // down to the last level
  CellTable t = table();
  const Vec3 p(1.2f, 2.3f, 3.4f);
  for (uint32_t level = 0; level < uint32_t(most_cell_levels); ++level) {
    shorten(t);
    const Place at = find(t, p, north);
    ASSERT_EQ(level_of(at.missing), int(level));
    insert(t, at.missing, level);
    EXPECT_EQ(find(t, p, north).cell, level);
    shorten(t);
    EXPECT_EQ(find(t, p, north).missing, 0u);
    set_divided(t, at.missing);
    EXPECT_EQ(level_of(find(t, p, north).missing), int(level) + 1);
  }
}

TEST(Cells, TableGrows) {
  CellTable t = table();
  std::vector<CellKey> keys;
  for (int i = 0; i < 8000; ++i) {
    keys.push_back(find(t, centre_of_cube(t, i % 20, i / 20 % 20, i / 400), north).missing);
    insert(t, keys.back(), uint32_t(i));
    if (i % 3 == 0) set_divided(t, keys.back());
  }
  for (int i = 0; i < 8000; ++i) {
    const Place at = find(t, centre_of_cube(t, i % 20, i / 20 % 20, i / 400), north);
    ASSERT_EQ(at.cell, uint32_t(i));
    ASSERT_EQ(at.missing != 0, i % 3 == 0) << "still divided";
  }
}

TEST(Cells, FarPlacesAndExtremeSizes) {
  for (const float radius : {1e-30f, 1.0f, 1e30f}) {
    CellTable t = make_cell_table(Vec3(0), radius);
    EXPECT_GT(t.width, 0) << radius;
    for (const float x : {0.0f, 1.0f, -1e10f, 1e30f, -infinity, infinity})
      for (const Vec3 p : {Vec3(x), Vec3(0, x, 0)}) {
        const Place at = find(t, p, north);
        if (std::abs(x) > 40 * radius) {
          EXPECT_EQ(at.cell, none);
          EXPECT_EQ(at.missing, 0u) << "one cell for all the rest would be none";
          continue;
        }
        ASSERT_NE(at.missing == 0, at.cell == none);
        if (at.missing) insert(t, at.missing, 1);
        EXPECT_EQ(find(t, p, north).cell, 1u);
      }
  }
}

// What moves may leave on any side.
TEST(Cells, ReachAsFarOnEverySide) {
  for (const float width : {0.0f, 0.07f, 3.0f}) {
    const CellTable t = make_cell_table(Vec3(1, 2, 3), 6, width);
    const float far = std::min(100.0f, 100 * t.width);
    for (int axis = 0; axis < 3; ++axis)
      for (const float x : {-far, far}) {
        Vec3 p(1, 2, 3);
        p[axis] += x;
        const CellKey key = find(t, p, north).missing;
        ASSERT_NE(key, 0u) << width << " " << axis << " " << x;
        const Vec3 off = glm::abs(middle_of(t, key) - p);
        EXPECT_LT(std::max({off.x, off.y, off.z}), 0.501f * t.width);
      }
  }
}

}  // namespace
}  // namespace ajar
