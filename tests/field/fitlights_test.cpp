// Learned lights of one tree, held against another.

#include <gtest/gtest.h>

#include "ajar/field/learn.h"
#include "kit/stage.h"

namespace ajar {
namespace {

// What was learned of other lights is forgotten, what is of these stays, and so does all else.
TEST(FitLights, CutsOfAnotherTreeAreForgotten) {
  const Scene scene = many_lights(24, 3, 24), other = many_lights(40, 3, 24);
  const LearnOptions options;
  Fields fields = start_fields(scene, 64, options);
  ASSERT_FALSE(fit_lights(scene.light_tree, options, fields)) << "nothing learned is of any tree";
  for (int i = 0; i < 3; ++i) fields.cells.emplace_back();
  for (int i = 0; i < 3; ++i) add_cut(fields.lights, none);
  LightRules rules;
  for (int lesson = 0; lesson < 4; ++lesson) {
    LightTallies t = start_tallies(fields.lights), s = start_tallies(fields.starts);
    for (uint32_t e = 0; e < fields.lights.entries.size(); ++e)
      for (int i = 0; i < 200; ++i) record(fields.lights, t, e, float(e % 3));
    for (uint32_t e = 0; e < fields.starts.entries.size(); ++e)
      for (int i = 0; i < 200; ++i) record(fields.starts, s, e, 1);
    fields.lights = learn_lights(scene.light_tree, fields.lights, t, rules);
    fields.starts = learn_lights(scene.light_tree, fields.starts, s, rules);
  }
  ASSERT_GT(fields.lights.entries.size(), 6u);
  ASSERT_GT(fields.starts.entries.size(), 1u);
  const Fields before = fields;
  EXPECT_FALSE(fit_lights(scene.light_tree, options, fields));
  EXPECT_EQ(fields.lights.entries.size(), before.lights.entries.size());

  EXPECT_TRUE(fit_lights(other.light_tree, options, fields));
  EXPECT_EQ(fields.lights.cuts.size(), 3u);
  EXPECT_EQ(fields.lights.entries.size(), 3u);
  EXPECT_EQ(fields.starts.entries.size(), 1u);
  EXPECT_EQ(fields.starts.unit, before.starts.unit);
  EXPECT_TRUE(fits(fields.lights, other.light_tree) && fits(fields.starts, other.light_tree));
  EXPECT_FALSE(fit_lights(other.light_tree, options, fields)) << "once is enough";

  Fields cells = before;  // a cell more than cuts: none of them is to be trusted
  cells.cells.emplace_back();
  EXPECT_TRUE(fit_lights(scene.light_tree, options, cells));
  EXPECT_EQ(cells.lights.cuts.size(), 4u);
  EXPECT_EQ(cells.starts.entries.size(), before.starts.entries.size());

  Fields damaged = before;  // nodes that do not follow each other
  std::swap(damaged.lights.entries[0], damaged.lights.entries[1]);
  EXPECT_TRUE(fit_lights(scene.light_tree, options, damaged));
  damaged = before;
  damaged.lights.entries[0].node = uint32_t(scene.light_tree.nodes.size());
  EXPECT_TRUE(fit_lights(scene.light_tree, options, damaged));

  LearnOptions none_learned;
  none_learned.lights = false;
  Fields dropped = before;
  EXPECT_TRUE(fit_lights(scene.light_tree, none_learned, dropped));
  EXPECT_TRUE(dropped.lights.cuts.empty());
}

TEST(FitLights, ASkyHasADiskForEachOfItsParts) {
  const Scene scene = under_sky(LightKind::constant), lamps = many_lights(24, 3, 24);
  Fields fields = start_fields(lamps, 64);
  EXPECT_TRUE(fit_lights(scene.light_tree, {}, fields));
  EXPECT_EQ(fields.disk.cells.size(), scene.light_tree.regions.size());
  EXPECT_FALSE(fit_lights(scene.light_tree, {}, fields));
  EXPECT_TRUE(fit_lights(lamps.light_tree, {}, fields));
  EXPECT_TRUE(fields.disk.cells.empty());
}

// A render of a scene without lights goes on from its checkpoint, too.
TEST(FitLights, WithoutLightsThereIsNothingToForget) {
  Scene dark = many_lights(1, 2);
  dark.lights[0].radiance = Slot(0.0f);
  finish(dark);
  ASSERT_TRUE(dark.light_tree.nodes.empty());
  Fields fields = start_fields(dark, 64);
  EXPECT_FALSE(fit_lights(dark.light_tree, {}, fields));
}

}  // namespace
}  // namespace ajar
