// Cases of the stress suite that few samples can tell right from wrong; docs/stress.md has all of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "ajar/scene/build.h"
#include "lessons.h"
#include "run.h"

namespace ajar::stress {
namespace {

// Sanitizers ask whether a case is borne at all, and take their time: a short render, and no verdict on what is noise.
#ifdef AJAR_SANITIZED
constexpr bool judged = false;
constexpr int batches = 1;
constexpr uint32_t part = 8;  // of the passes, one in so many
#else
constexpr bool judged = true;
constexpr int batches = 16;
constexpr uint32_t part = 2;
#endif

std::string label(const Case& c) {
  std::string text = c.group + "_" + c.name;
  for (char& letter : text)
    if (!std::isalnum(static_cast<unsigned char>(letter))) letter = letter == '-' ? 'm' : '_';
  return text;
}

// The scene seen with half as many pixels a side: a quarter of the time, and as much noise in each.
std::function<Scene()> halved(const std::function<Scene()>& make) {
  if (!make) return nullptr;
  return [make] {
    Scene scene = make();
    Camera& c = scene.camera;
    set_size(c, std::max(c.width / 2, 1), std::max(c.height / 2, 1));
    return scene;
  };
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
                                   "1e-8 and 1e8 in one image",
                                   "none",
                                   "ball of radius 1e-06",
                                   "1 x 1",
                                   "roughness 0.0001",
                                   "box of index 1.0001",
                                   "65 total reflections",
                                   "glass and mirrors alone",
                                   "black",
                                   "seen from 1e-06 above",
                                   "no room for a cell",
                                   "one cell",
                                   "older evidence forgotten",
                                   "of another scene",
                                   "upside down",
                                   "lying by 1e6"};
  std::vector<Case> chosen;
  for (Case& c : cases())
    if (!c.refused.empty() || std::find(std::begin(names), std::end(names), c.name) != std::end(names)) {
      c.passes = std::max(c.passes / part, 1u);
      if (!judged && c.answer != 0) c.answer = -1, c.judge.clear();
      c.make = halved(c.make), c.twin = halved(c.twin);
      chosen.push_back(std::move(c));
    }
  return chosen;
}

class Stress : public testing::TestWithParam<Case> {};

// Finite, not rejected, and what it ought to be up to noise; with merging, up to a small bias too.
TEST_P(Stress, IsBorne) {
  const Case& c = GetParam();
  const Outcome right = reference(c, batches);
  CellTable walls;
  for (const std::string& integrator : integrator_names()) {
    if (!can_find(c, integrator) || (c.fields && !is_guided(integrator))) continue;
    const double passes = integrator.ends_with("vpl") && c.passes > 8 ? 0.25 : 1;  // 256 light subpaths each
    const Verdict v = judge(c, integrator, run(c, integrator, batches, passes, &walls), right);
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
    const std::vector<Lesson> all = lessons(albedo, {}, 256);
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
  for (const Lesson& l : lessons(1, {}, 16)) EXPECT_LT(l.mean, 1.05 * l.number) << l.number;
}

// A fixed-point iteration that contracts with the albedo has 1 - 1/e of its answer after -1/ln(a) lessons, where each
// is of all paths and keeps no older evidence. Strata that no path of a lesson met wait for the next: a few times as
// many.
TEST(Lessons, ComeAsFastAsTheAlbedoAllows) {
  LearnOptions learn;
  learn.train = 40, learn.forget = 0;
  const double expected = -1 / std::log(0.9);
  const uint32_t n = lesson_of_convergence(lessons(0.9f, learn, 0), 0.9f, 1 - std::exp(-1.0));
  EXPECT_GT(n, 0.8 * expected);
  EXPECT_LT(n, 4 * expected);
}

// With cells few enough to be met by every lesson it comes to the answer itself: areas of strata that add up to less
// than pi would let a share of the light leak at every bounce.
TEST(Lessons, ComeToTheAnswer) {
  LearnOptions learn;
  learn.train = 100, learn.forget = 0, learn.divide_cell = 1e30f, learn.divide_stratum = 2;
  EXPECT_NEAR(lessons(0.9f, learn, 0, 16, 8).back().mean, 10, 1.2);
}

// What mirrors and glass pass on is light that Q knows: behind a mirror, what the fields expect at the screen is what
// the image shows.
TEST(Lessons, KnowWhatAMirrorPassesOn) {
  const Scene scene = mirror_chain(1);
  const Accel accel(scene);
  const auto rendered = [&](const char* integrator, uint32_t passes, uint32_t train) {
    RenderOptions o;
    o.integrator = integrator, o.sampler = SamplerKind::independent, o.spp = passes;
    o.learn.train = train, o.learn.forget = 1;
    RenderState state = start_render(scene, o);
    render(scene, accel, o, state, nullptr);
    return state;
  };
  const Fields fields = rendered("guided-path", 0, 128).learning.fields;
  double expected = 0, seen = 0;
  WalkOptions options;
  options.fields = &fields;
  constexpr int n = 4000;
  for (int i = 0; i < n; ++i) {
    Sampler sampler = make_sampler(SamplerKind::independent, 9, Side::camera, uint64_t(i), 0);
    Subpath path;
    Walk walk;
    Surface surface;
    start_camera(scene, sampler.next2() * 24.0f, Vec2(0.5f), path, walk);
    while (step(scene, accel, options, path, walk, surface))
      if (connectable(path[path.n - 1].guide)) {
        expected += promise(path[path.n - 1].guide, path[path.n - 1].beta).all / n;
        break;
      } else if (!scatter(options, sampler, path, walk)) {
        break;
      }
  }
  const Picture image = develop(rendered("path", 256, 0).film);
  for (size_t i = 0; i < image.pixels.size(); i += 3)
    seen += luminance(Rgb(image.pixels[i], image.pixels[i + 1], image.pixels[i + 2])) / (24.0 * 24);
  EXPECT_GT(expected / seen, 0.95);  // 0.85 is what next-event estimation and hits find without the mirror
  EXPECT_LT(expected / seen, 1.25);
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
