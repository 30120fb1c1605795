// What cannot be rendered, or gone on with, and is refused before anything is traced.
#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "bytes.h"
#include "kit/files.h"

namespace ajar {
namespace {

using namespace kit;

// A state that was started otherwise cannot be gone on with.
TEST(Refused, StatesAreOfTheirRenders) {
  Scene scene = stage(16);
  finish(scene);
  const Accel accel(scene);
  const auto said = [&](const RenderOptions& started, const RenderOptions& rendered, const Scene& of) {
    RenderState state = start_render(of, started);
    return kit::error_of([&] { render(scene, accel, rendered, state, {}); });
  };
  const auto of = [&](const char* a, const char* b) { return said(options_of(a, 1), options_of(b, 1), scene); };
  const auto has = [](const std::string& text, const char* words) { EXPECT_NE(text.find(words), text.npos) << text; };
  Scene large = scene;
  set_size(large.camera, 32, 16);
  has(said(options_of("path", 1), options_of("path", 1), large), "of 32x16 pixels from 0,0 on, the camera's are 16x16");
  Scene aside = scene;
  aside.camera.width = 17, aside.camera.crop_x = 1;
  has(said(options_of("path", 1), options_of("path", 1), aside), "of 16x16 pixels from 1,0 on");
  for (const auto& [one, other] : {std::pair{"path", "bdpt"},
                                   {"bdpt", "path"},
                                   {"bdpt", "light"},
                                   {"light", "bdpt"},
                                   {"path", "guided-path"},
                                   {"guided-bdpt", "guided-vcm"}})
    has(of(one, other), fmt::format("started for {}, and is asked to go on with {};", one, other).c_str());
  RenderOptions lights = options_of("path", 1), blind = options_of("path", 1);
  lights.learn_lights = true, blind.next_event = false;
  has(said(options_of("path", 1), lights, scene), "fields");
  EXPECT_EQ(said(blind, blind, scene), "");
  for (const char* integrator : {"bdpt", "light", "guided-bdpt", "vcm", "photon", "vpl", "plain-vpl"}) {
    blind = options_of(integrator, 1), blind.next_event = false;
    has(said(blind, blind, scene), "next_event false is for path and guided-path");
  }
  EXPECT_EQ(of("guided-path", "guided-path"), "");
}

// What is not finished, or has no film, is not rendered, nor through another scene's accelerator.
TEST(Refused, ScenesAreFinishedAndHaveTheirAccelerator) {
  const RenderOptions o = options_of("path", 1);
  Scene scene = stage(16);
  const auto begin = [&](const Scene& of) { return kit::error_of([&] { start_render(of, o); }); };
  const auto has = [](const std::string& text, const char* words) { EXPECT_NE(text.find(words), text.npos) << text; };
  has(begin(scene), "call finish");
  has(kit::error_of([&] { Accel{scene}; }), "call finish");
  finish(scene);
  EXPECT_EQ(begin(scene), "");
  for (const int width : {0, -4}) {
    Scene none_seen = scene;
    none_seen.camera.crop_width = width;
    has(begin(none_seen), "crop window that is not inside its film");
  }
  Scene blurred = scene;
  blurred.filter = {};
  blurred.filter.kind = FilterKind::gaussian;
  has(begin(blurred), "make_filter");
  RenderState state = start_render(scene, o);
  const Scene other = glass_ball(1.5f, 16), copy = scene;
  has(kit::error_of([&] { render(scene, Accel(other), o, state, {}); }), "accelerator is of another scene");
  EXPECT_EQ(kit::error_of([&] { render(scene, Accel(copy), o, state, {}); }), "") << "nothing moved";
  const Scene shut = two_rooms(20, 16), open = two_rooms(60, 16);
  RenderState of_door = start_render(open, o);
  has(kit::error_of([&] { render(open, Accel(shut), o, of_door, {}); }), "accelerator is of another scene");
  has(kit::error_of([&] { render_features(open, Accel(shut), 1); }), "accelerator is of another scene");
  has(kit::error_of([&] { render_features(open, Accel(open), 1, 0); }), "0 samples are none");
}

// What the passes of a film were made with goes for those to come.
TEST(Refused, AStateGoesOnAsItBegan) {
  Scene scene = stage(8);
  finish(scene);
  const Accel accel(scene);
  const RenderOptions o = options_of("bdpt", 1);
  const auto refusal = [&](const RenderOptions& changed) {
    RenderState state = start_render(scene, o);
    return kit::error_of([&] { render(scene, accel, changed, state, {}); });
  };
  EXPECT_EQ(refusal(o), "");
  RenderOptions other = o;
  other.techniques = true;
  EXPECT_NE(refusal(other).find("started with techniques false"), std::string::npos) << refusal(other);
  other = o, other.limit_fireflies = true;
  EXPECT_NE(refusal(other).find("started with limit_fireflies false"), std::string::npos) << refusal(other);
  RenderState state = start_render(scene, o);
  scene.filter = make_filter(FilterKind::box, 2);
  EXPECT_NE(kit::error_of([&] { render(scene, accel, o, state, {}); }).find("another filter"), std::string::npos);
}

TEST(Refused, OptionsThatCannotBeMeantAreErrors) {
  Scene scene = stage(8);
  finish(scene);
  EXPECT_NO_THROW(check(RenderOptions{}));
  const auto expect = [&](const char* name, const std::function<void(RenderOptions&)>& change) {
    RenderOptions o = options_of("guided-vcm", 1);
    change(o);
    const std::string said = kit::error_of([&] { start_render(scene, o); });
    EXPECT_EQ(said.find(fmt::format("options: {} is ", name)), 0u) << name << ": " << said;
    RenderState state = start_render(scene, options_of("guided-vcm", 1));
    EXPECT_EQ(kit::error_of([&] { render(scene, Accel(scene), o, state, {}); }), said);
  };
  const float nan = std::nanf("");
  expect("seconds", [](RenderOptions& o) { o.seconds = -1; });
  expect("seconds", [&](RenderOptions& o) { o.seconds = double(nan); });
  expect("cpu_seconds", [](RenderOptions& o) { o.cpu_seconds = -1; });
  expect("noise", [](RenderOptions& o) { o.noise = -0.1; });
  for (const int threads : {-1, 100'000}) expect("threads", [=](RenderOptions& o) { o.threads = threads; });
  for (const int depth : {0, -2}) expect("max_depth", [=](RenderOptions& o) { o.max_depth = depth; });
  expect("roulette_depth", [](RenderOptions& o) { o.roulette_depth = -3; });
  for (const float radius : {nan, -1.0f, infinity})
    expect("merge_radius", [=](RenderOptions& o) { o.merge_radius = radius; });
  expect("final_gather", [](RenderOptions& o) { o.final_gather = -1; });
  for (const float mix : {2.0f, 1.0f, -0.1f, nan}) expect("learn.mix", [=](RenderOptions& o) { o.learn.mix = mix; });
  expect("learn.forget", [](RenderOptions& o) { o.learn.forget = 1.5f; });
  expect("learn.trust", [](RenderOptions& o) { o.learn.trust = 0; });
  expect("learn.divide_cell", [](RenderOptions& o) { o.learn.divide_cell = 0; });
  expect("learn.divide_stratum", [](RenderOptions& o) { o.learn.divide_stratum = 0; });
  expect("learn.least_contrast", [&](RenderOptions& o) { o.learn.least_contrast = nan; });
  RenderOptions photon = options_of("photon", 1);
  photon.merge_radius = 0;
  EXPECT_NE(kit::error_of([&] { start_render(scene, photon); }), "") << "it finds nothing";
}

}  // namespace
}  // namespace ajar
