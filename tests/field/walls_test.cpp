// Walls between cells: what two rooms receive is never one cell's.
#include "ajar/field/walls.h"

#include <gtest/gtest.h>

#include <set>

#include "ajar/scene/build.h"

namespace ajar {
namespace {

CellTable cut_table(const Scene& scene) {
  CellTable t = make_cell_table(scene.center, scene.radius);
  cut_along_walls(scene, Accel(scene), t);
  return t;
}

// The slab between the rooms is 0.1 m thick, cubes of level 0 are 0.8 m wide.
TEST(Walls, RoomsBesideEachOtherShareNoCell) {
  const CellTable t = cut_table(two_rooms(5));
  ASSERT_GT(t.width, 0.5f);
  for (const float x : {0.2f, 1.0f, 1.8f, 2.4f}) {
    const Place ours = find(t, {x, 0, 0.06f}, {0, 1, 0}), others = find(t, {x, 0, -0.06f}, {0, 1, 0});
    EXPECT_NE(ours.missing, others.missing) << x;
  }
}

TEST(Walls, WhatASlabHidesIsFoundWithinACube) {
  int same = 0, parted = 0;
  const CellTable t = cut_table(two_rooms(5));
  for (int i = 0; i < 24; ++i) {
    const float x = 0.05f + 0.1f * float(i);
    const Vec3 a(x, 0, 0.06f), b(x, 0, -0.06f);
    if (top_cube(t, a) != top_cube(t, b)) continue;
    ++(find(t, a, {0, 1, 0}).missing == find(t, b, {0, 1, 0}).missing ? same : parted);
  }
  EXPECT_GT(parted, 0) << "the slab should cross cubes here";
  EXPECT_EQ(same, 0);
}

// Two rooms on a lawn that is much larger: cubes are as small as they would be without it, where paths go.
TEST(Walls, AreFoundInAHouseOnALawn) {
  const float bare = cut_table(two_rooms(5)).width;
  for (const float size : {30.0f, 60.0f, 400.0f}) {
    Scene scene = two_rooms(5);
    add_quad(scene, {-size, -0.5f, size}, {2 * size, 0, 0}, {0, 0, -2 * size}, add_diffuse(scene, Rgb(0.5f)));
    finish(scene);
    const CellTable t = cut_table(scene);
    EXPECT_LT(t.width, std::max(1.5f * bare, scene.radius / 100)) << size;
    EXPECT_FALSE(t.portals.empty()) << size;
    const Vec3 n(0, 1, 0);  // the lawn has cells of its own on all sides, and its corners none that it shares
    std::set<CellKey> keys;
    for (const float x : {-1.0f, -0.5f, 0.0f, 1.0f})
      for (const float z : {-1.0f, 0.0f, 1.0f})
        keys.insert(find(t, {0.99f * size * x, -0.5f, 0.99f * size * z}, n).missing);
    EXPECT_EQ(keys.size(), 12u) << size;
  }
}

TEST(Walls, OneRoomIsNotCut) {
  Scene scene;
  set_camera(scene, {2, 1.5f, 3.5f}, {2, 1, 0}, 60, 32, 18);
  add_box(scene, {0, 0, 0}, {4, 2.5f, 4}, add_diffuse(scene, Rgb(0.7f)), true);
  finish(scene);
  EXPECT_TRUE(cut_table(scene).cuts.empty());
}

TEST(Walls, ACellBehindAWallKeepsItsCompartmentOnAllLevels) {
  CellTable t = cut_table(two_rooms(5));
  const Vec3 ours(1.8f, 0, 0.06f), others(1.8f, 0, -0.06f), n(0, 1, 0);
  for (uint32_t level = 0; level < 3; ++level) {
    const Place a = find(t, ours, n), b = find(t, others, n);
    ASSERT_NE(a.missing, b.missing) << level;
    EXPECT_EQ(level_of(a.missing), int(level));
    insert(t, a.missing, 2 * level), insert(t, b.missing, 2 * level + 1);
    set_divided(t, a.missing), set_divided(t, b.missing);
    EXPECT_EQ(cell_of(t, parent_of(b.missing)), level > 0 ? 2 * level - 1 : none);
  }
}

// Cells that were there before.
TEST(Walls, CutShortcutsOff) {
  const Scene scene = two_rooms(5);
  const Vec3 p(1.8f, 0, 0.06f), n(0, 1, 0);
  CellTable t = make_cell_table(scene.center, scene.radius);
  insert(t, find(t, p, n).missing, 0);
  shorten(t);
  ASSERT_FALSE(t.shortcuts.leaves.empty());
  cut_along_walls(scene, Accel(scene), t);
  EXPECT_TRUE(t.shortcuts.leaves.empty());
}

TEST(Walls, AreTheSameEachTime) {
  const Scene scene = two_rooms(20);
  const CellTable a = cut_table(scene), b = cut_table(scene);
  EXPECT_EQ(a.compartments, b.compartments);
  ASSERT_EQ(a.cuts.size(), b.cuts.size());
  for (size_t i = 0; i < a.cuts.size(); ++i) EXPECT_EQ(a.cuts[i].at, b.cuts[i].at);
}

TEST(Walls, NothingToSeeIsNoError) {
  Scene empty;
  finish(empty);
  EXPECT_TRUE(cut_table(empty).cuts.empty());
}

}  // namespace
}  // namespace ajar
