// Cases of the stress suite that few samples can tell right from wrong; docs/stress.md has all of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "ajar/scene/build.h"
#include "lessons.h"
#include "run.h"

namespace ajar::stress {
namespace {

std::string label(const Case& c) {
  std::string text = c.group + "_" + c.name;
  for (char& letter : text)
    if (!std::isalnum(static_cast<unsigned char>(letter))) letter = letter == '-' ? 'm' : '_';
  return text;
}

std::vector<Case> quick() {
  constexpr const char* names[] = {"albedo 0.99",
                                   "3 rooms",
                                   "1 degrees",
                                   "shut",
                                   "x 1e-06",
                                   "x 1e+06",
                                   "100 room widths",
                                   "10000 room widths",
                                   "a second floor 1e-06 below",
                                   "box 1e-05 around the lamp",
                                   "2000 slivers 1:1000",
                                   "x 1e-12",
                                   "x 1e+12",
                                   "1e-8 beside 1e8",
                                   "none",
                                   "ball of radius 1e-06",
                                   "1 x 1",
                                   "roughness 0.0001",
                                   "box of index 1.0001",
                                   "glass and mirrors alone",
                                   "black",
                                   "seen from 1e-06 above",
                                   "no room for a cell",
                                   "one cell",
                                   "older evidence forgotten"};
  std::vector<Case> chosen;
  for (Case& c : cases())
    if (c.refused || std::find(std::begin(names), std::end(names), c.name) != std::end(names)) {
      c.passes = std::max(c.passes / 2, 1u);
      chosen.push_back(std::move(c));
    }
  return chosen;
}

// Merging blurs, and virtual point lights have long tails in extreme cases (docs/limits.md): these are held to finite
// values alone.
bool is_held_to_the_mean(const std::string& integrator) {
  return !is_merging(integrator) && !integrator.ends_with("vpl");
}

class Stress : public testing::TestWithParam<Case> {};

// Finite, not rejected, and, where that can be asked for, what it ought to be up to noise.
TEST_P(Stress, IsBorne) {
  const Case& c = GetParam();
  const Outcome right = reference(c, 16);
  for (const std::string& integrator : integrator_names()) {
    if (!can_find(c, integrator)) continue;
    if (!is_held_to_the_mean(integrator)) {
      const Outcome o = run(c, integrator, 2);
      EXPECT_EQ(o.rejected, 0u) << integrator << ": " << o.replay;
      continue;
    }
    const Verdict v = judge(c, run(c, integrator, 16), right);
    EXPECT_TRUE(v.ok) << integrator << ": " << v.message;
  }
}
INSTANTIATE_TEST_SUITE_P(Cases, Stress, testing::ValuesIn(quick()), [](const auto& test) { return label(test.param); });

// Learning is a fixed-point iteration that contracts with the albedo, from below: it must not overshoot, and come as
// far as so many lessons allow.
TEST(Lessons, ApproachTheAnswerFromBelow) {
  for (const float albedo : {0.5f, 0.9f}) {
    const double answer = 1 / (1 - double(albedo));
    double before = 0;
    const std::vector<Lesson> all = lessons(albedo, Rule::expected, 128);
    ASSERT_GE(all.size(), 10u);
    for (const Lesson& l : all) {
      EXPECT_LT(l.mean, answer * 1.02) << albedo << " after lesson " << l.number;
      EXPECT_LT(l.most, answer * 1.1) << albedo << " after lesson " << l.number;
      EXPECT_GE(l.mean, before * 0.98) << albedo << " after lesson " << l.number;
      before = l.mean;
    }
    EXPECT_GT(before, answer * (albedo < 0.6f ? 0.7 : 0.3)) << albedo;
  }
}

// Where the answer is infinite, every lesson adds what one more bounce brings, and no more.
TEST(Lessons, GrowByABounceWithoutLoss) {
  for (const Lesson& l : lessons(1, Rule::expected, 16)) EXPECT_LT(l.mean, 1.05 * l.number) << l.number;
}

// What 100 000 passes of one value sum up to: in single precision it would be off in the third digit.
TEST(LongRender, SumsDoNotDrift) {
  const Scene scene = inside_sphere(Rgb(0.1f), 2);
  const Accel accel(scene);
  RenderOptions o;
  o.integrator = "path";
  o.spp = 100000;
  RenderState state = start_render(scene, o);
  render(scene, accel, o, state, nullptr);
  for (const float v : develop(state.film).pixels) EXPECT_NEAR(v, 0.1f, 1e-7f);
}

TEST(StressSuite, GroupsBeginWithTheirOrdinaryCase) {
  std::string group;
  for (const Case& c : cases()) {
    EXPECT_FALSE(c.group != group && c.large) << c.group;
    EXPECT_TRUE(c.factor == 1 || c.twin) << c.name;
    group = c.group;
  }
}

}  // namespace
}  // namespace ajar::stress
