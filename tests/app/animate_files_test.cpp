// ajar animate and files: what each frame has of its own, that nothing is written over what is read, and what is told
// before the work.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "animate_stage.h"
#include "app/frames.h"
#include "app/timeline.h"

namespace ajar {
namespace {

namespace fs = std::filesystem;
using kit::error_of;
using Words = std::vector<std::string>;

struct AnimateFiles : Animate {
  /// Words after ajar animate SCENE; no other options.
  void call(Words words) const {
    words.insert(words.begin(), {"animate", in("room.xml"), "-q", "--threads", "1"});
    run_command_line(words);
  }
  std::string said(const Words& words) const {
    return error_of([&] { call(words); });
  }
  nlohmann::json record(const std::string& name) const { return nlohmann::json::parse(kit::bytes_of(in(name))); }
  /// The room's text with something put before its first sensor.
  void put(const std::string& text) const {
    std::string room = kit::bytes_of(in("room.xml"));
    write("room.xml", room.insert(room.find("<sensor"), text));
  }
};

// A scene's parameters may move what it asks for, too.
TEST_F(AnimateFiles, SamplesAndDepthAreEachFramesOwn) {
  put(R"(<default name="depth" value="9"/><default name="spp" value="1"/>
    <integrator type="guided-bdpt"><integer name="max_depth" value="$depth"/></integrator>)");
  std::string room = kit::bytes_of(in("room.xml"));
  const std::string sampler = R"(<sampler type="independent"><integer name="sample_count" value="$spp"/></sampler>)";
  write("room.xml", room.insert(room.find("<film"), sampler));
  const auto frames = [&](const std::string& range, const std::string& out) {
    call({"--frames", range, "-D", "depth=2..4", "-D", "spp=5..7", "-o", in(out) + "/f_%d.exr"});
  };
  frames("3", "whole");
  frames("2/3", "alone");
  frames("0-1/3", "parts"), frames("2/3", "parts");
  for (int f = 0; f < 3; ++f) {
    const auto options = record("whole/f_" + std::to_string(f) + ".json")["options"];
    EXPECT_EQ(options["max_depth"], 2 + f);
    EXPECT_EQ(options["spp"], 5 + f);
  }
  EXPECT_EQ(pixels("whole/f_2.exr"), pixels("alone/f_2.exr"));
  EXPECT_EQ(pixels("whole/f_2.exr"), pixels("parts/f_2.exr"));
  EXPECT_SAYS(
      said({"--frames", "3", "-D", "depth=2..4", "-D", "spp=5..7", "--max-depth", "2", "-o", in("whole/f_%d.exr")}),
      "f_1.exr: was made otherwise");
}

TEST_F(AnimateFiles, AnIntegratorIsOfAllFrames) {
  for (const char* n : {"0", "1"})
    write("integrator" + std::string(n) + ".xml",
          std::string("<integrator type=\"") + (n[0] == '0' ? "path" : "light") + "\"/>");
  put(R"(<default name="n" value="0"/><include filename="integrator$n.xml"/>)");
  EXPECT_SAYS(said({"--frames", "2", "--spp", "1", "-D", "n=0..1", "-o", in("f_%d.exr")}),
              "frame 1: the scene names the integrator light, but path in frame 0; choose with --integrator");
  EXPECT_FALSE(fs::exists(in("f_0.exr")));
}

TEST_F(AnimateFiles, WhatIsReadIsNotWrittenOver) {
  write("ffmpeg", "#!/bin/sh\nexit 1\n");
  fs::permissions(in("ffmpeg"), fs::perms::owner_all);
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", (folder.string() + ":" + path).c_str(), 1);
  fs::create_directories(in("shot"));
  const std::string keys = R"({"frames": 2, "parameters": {"door": [[0, 1], [1, 2]]}})";
  for (const char* name : {"shot/animation.json", "shot/f_1.json"}) {
    write(name, keys);
    EXPECT_SAYS(said({"--spp", "1", "--keyframes", in(name), "-o", in("shot/f_%d.exr")}),
                "is the same file as --keyframes " + in(name));
    EXPECT_EQ(kit::bytes_of(in(name)), keys);
    fs::remove(in(name));
  }
  const Words usual = {"--frames", "2", "--spp", "1", "-o", in("shot/f_%d.exr")};
  const auto with = [&](Words more) {
    more.insert(more.end(), usual.begin(), usual.end());
    return said(more);
  };
  fs::create_symlink(in("room.xml"), in("film.mp4"));
  EXPECT_SAYS(with({"--video", in("film.mp4")}), "--video " + in("film.mp4") + ": is the same file as the scene");
  EXPECT_TRUE(fs::is_empty(in("shot")));
  EXPECT_EQ(with({}), "");
  EXPECT_SAYS(with({"--reference", in("shot/f_%d.exr")}), "is the same file as --reference");
  ::setenv("PATH", path.c_str(), 1);
}

// Images of a sequence, one per frame, are files of that frame's scene alone.
TEST_F(AnimateFiles, ImagesOfASceneAreNotWrittenOver) {
  fs::create_directories(in("shot"));
  const Picture grey{2, 2, {"R", "G", "B"}, std::vector<float>(12, 0.5f)};
  for (int f = 0; f < 3; ++f) write_png(in("shot/f_" + std::to_string(f) + ".png"), grey);
  const std::string before = kit::bytes_of(in("shot/f_1.png"));
  put(R"(<default name="n" value="1"/>)");
  std::string room = kit::bytes_of(in("room.xml"));
  const std::string image = R"(<bsdf type="diffuse"><texture name="reflectance" type="bitmap">
    <string name="filename" value="shot/f_$n.png"/></texture></bsdf>)";
  write("room.xml", room.insert(room.find("<transform", room.find("<shape")), image));
  EXPECT_SAYS(said({"--frames", "3", "-D", "n=0..2", "--spp", "1", "-o", in("shot/f_%d.exr")}), "a file of the scene");
  EXPECT_EQ(kit::bytes_of(in("shot/f_1.png")), before);
}

TEST_F(AnimateFiles, WhatStandsInTheWayIsToldBeforeTheWork) {
  for (const char* name : {"f_0.json", "animation.csv", "carried_0-1.fields"}) {
    fs::create_directories(in("shot/" + std::string(name)));
    EXPECT_SAYS(said({"--frames", "2", "--spp", "1", "--integrator", "guided-path", "-o", in("shot/f_%d.exr")}),
                std::string(name) + ": cannot be written (Is a directory)");
    EXPECT_FALSE(fs::exists(in("shot/f_0.exr")));
    fs::remove(in("shot/" + std::string(name)));
  }
  const std::vector<std::string> two = {"--frames",     "2",    "--spp", "1",
                                        "--integrator", "path", "-o",    in("shot/f_%d.exr")};
  const std::string in_the_way = "f_1.png: cannot be written (Is a directory)";
  fs::create_directories(in("shot/f_1.png"));
  EXPECT_SAYS(said(two), in_the_way);
  EXPECT_FALSE(fs::exists(in("shot/f_0.exr")));
  fs::remove(in("shot/f_1.png"));
  EXPECT_EQ(said(two), "");
  fs::remove(in("shot/f_1.png")), fs::create_directories(in("shot/f_1.png"));
  EXPECT_SAYS(said(two), in_the_way);  // of a frame that is done
}

// What frames learned of a file that is another by now is learned again.
TEST_F(AnimateFiles, FieldsAreOfTheFilesThatTaughtThem) {
  const auto triangle = [](double x) { return fmt::format("v -1 -1 {0}\nv 1 -1 {0}\nv 0 1 {0}\nf 1 2 3\n", x); };
  for (int n = 0; n < 3; ++n) write(fmt::format("p{}.obj", n), triangle(0.1 * n));
  put(R"(<default name="n" value="0"/><shape type="obj"><string name="filename" value="p$n.obj"/></shape>
    <emitter type="constant"/>)");
  const auto frames = [&](const std::string& range, const std::string& shot) {
    return said({"--frames", range, "-D", "n=0..2", "--spp", "2", "--teach", "1", "--integrator", "guided-bdpt", "-o",
                 in(shot + "/f_%d.exr")});
  };
  EXPECT_EQ(frames("0-1/3", "one"), "");
  fs::copy(in("one"), in("same"));
  write("p1.obj", triangle(-1.5));
  EXPECT_EQ(frames("2/3", "one"), "");
  EXPECT_EQ(frames("2/3", "new"), "");
  EXPECT_TRUE(kit::bytes_of(in("one/f_2.png")) == kit::bytes_of(in("new/f_2.png")));
  EXPECT_TRUE(read_picture(in("one/f_2.exr")).pixels == read_picture(in("new/f_2.exr")).pixels);
  write("p1.obj", triangle(0.1));
  EXPECT_EQ(frames("2/3", "same"), "");
  EXPECT_FALSE(read_picture(in("same/f_2.exr")).pixels == read_picture(in("new/f_2.exr")).pixels);
}

TEST_F(AnimateFiles, WhyFieldsAreLearnedAgainIsTold) {
  const auto told = [&](const char* range, const std::string& shot, Words more = {}) {
    more.insert(more.begin(), {"animate", in("room.xml"), "--frames", range, "--integrator", "guided-path", "--teach",
                               "1", "-D", "door=0..1", "-o", in(shot + "/f_%d.exr")});
    testing::internal::CaptureStderr();
    run_command_line(more);
    return testing::internal::GetCapturedStderr();
  };
  const Words spp = {"--spp", "1"}, time = {"--spp", "1", "--cpu-time", "100"};
  const std::string again = "the fields of frames 0 to 1 are learned again: ";
  EXPECT_SAYS(told("2/5", "none", spp), again + "none of them left any here that go with");
  told("0-1/5", "whole", spp), told("0-1/5", "timed", time);
  fs::copy(in("whole"), in("same"));
  EXPECT_EQ(told("2/5", "same", spp).find("learned again"), std::string::npos);
  EXPECT_SAYS(told("2/5", "whole", time),
              again + "those that frame 1 left here were learned without a time limit, these are with one\n");
  EXPECT_SAYS(told("2/5", "timed", spp),
              again + "those that frame 1 left here were learned with a time limit, these are without one\n");
  EXPECT_SAYS(told("4/5", "same", spp),
              "the fields of frames 3 to 3 are learned again: none of them left any here that go with");
}

TEST_F(AnimateFiles, WhatIsNoRecordIsNotWrittenOver) {
  fs::create_directories(in("shot"));
  write("shot/f_1.json", "{}");
  EXPECT_SAYS(said({"--frames", "2", "--spp", "1", "--integrator", "path", "-o", in("shot/f_%d.exr")}),
              "shot/f_1.json: is no record of a render");
  EXPECT_EQ(kit::bytes_of(in("shot/f_1.json")), "{}");
  EXPECT_FALSE(fs::exists(in("shot/f_0.exr")));
}

// Keyframes of that natural name, a table or a drawing of the user's.
TEST_F(AnimateFiles, WhatIsNoFigureIsNotWrittenOver) {
  fs::create_directories(in("shot"));
  const Words usual = {"--frames", "1", "--spp", "1", "--integrator", "path", "-o", in("shot/f_%d.exr")};
  const auto refused = [&](const std::string& name, const std::string& text) {
    write(name, text);
    EXPECT_SAYS(said(usual), in(name) + ": holds no figures of an animation, which would take its place; move it");
    EXPECT_EQ(kit::bytes_of(in(name)), text);
  };
  for (const char* text : {R"({"frames": 3, "parameters": {}})", "no JSON", "[1, 2]"})
    refused("shot/animation.json", text);
  fs::remove(in("shot/animation.json"));
  refused("shot/animation.csv", "frame,door\n0,5\n"), fs::remove(in("shot/animation.csv"));
  refused("shot/animation.svg", "<svg xmlns=\"http://www.w3.org/2000/svg\"/>\n"), fs::remove(in("shot/animation.svg"));
  EXPECT_TRUE(fs::is_empty(in("shot")));
  write("shot/animation.json", "");
  EXPECT_EQ(said(usual), "");
  refused("shot/animation.json", "{}");  // though all frames are there
}

// Figures of an earlier command are made anew, whichever of their files are there.
TEST_F(AnimateFiles, FiguresAreMadeAnew) {
  const Words usual = {"--frames", "2", "--spp", "1", "--integrator", "path", "-o", in("shot/f_%d.exr")};
  EXPECT_EQ(said(usual), "");
  for (const char* gone : {"shot/animation.json", "shot/animation.csv", "shot/animation.svg", "shot/f_1.exr"}) {
    fs::remove(in(gone));
    EXPECT_EQ(said(usual), "") << gone;
    EXPECT_TRUE(fs::exists(in(gone)));
  }
  write("shot/animation.csv", "changed by hand");
  EXPECT_EQ(said(usual), "");
  EXPECT_EQ(kit::bytes_of(in("shot/animation.csv")).substr(0, 14), "frame,seconds,");
}

// Both ends of a sweep may be what the scene takes; between them it need not be.
TEST_F(AnimateFiles, ErrorsInTheMiddleAreToldBeforeTheWork) {
  put(R"(<default name="depth" value="9"/><default name="size" value="1"/>
    <integrator type="path"><integer name="max_depth" value="$depth"/></integrator>
    <shape type="cube"><transform name="to_world"><scale value="$size"/></transform></shape>)");
  write("keys.json", R"({"frames": 6, "parameters": {"depth": [[0, 2], [3, 2], [5, 3]]}})");
  EXPECT_SAYS(said({"--spp", "1", "--keyframes", in("keys.json"), "-o", in("shot/f_%d.exr")}), " (frame 4: depth=2.5)");
  const auto sweep = [&](const char* frames, const char* what) {
    return said({"--spp", "1", "--frames", frames, "-D", what, "-o", in("shot/f_%d.exr")});
  };
  EXPECT_SAYS(sweep("7", "size=0.3..-0.3"), "its to_world is singular");
  EXPECT_SAYS(sweep("7", "size=0.3..-0.3"), " (frame 3: size=0)");
  EXPECT_SAYS(sweep("5", "depth=-1..3"), " (frame 1: depth=0)");
  EXPECT_FALSE(fs::exists(in("shot")));
  EXPECT_EQ(sweep("4-6/7", "size=0.3..-0.3"), "") << "frames of the range alone";
  put(R"(<shape type="cube"><animation name="to_world"><transform time="0"><scale x="0.5"/></transform>
    <transform time="2"><scale x="-0.5"/></transform></animation></shape>)");
  EXPECT_SAYS(said({"--spp", "1", "--frames", "5", "-o", in("moves/f_%d.exr")}), " (frame 2: time=1)");
  EXPECT_FALSE(fs::exists(in("moves")));
}

// Where a disk is full, say.
TEST_F(AnimateFiles, AnErrorInTheMiddleLeavesFigures) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  fs::create_directories(in("shot"));
  fs::create_symlink("/dev/full", in("shot/f_3.png"));
  EXPECT_SAYS(said({"--spp", "1", "--frames", "5", "--integrator", "path", "-o", in("shot/f_%d.exr")}),
              "f_3.png: cannot be written (No space left");
  EXPECT_EQ(record("shot/animation.json")["frames_done"], 3);
}

TEST_F(AnimateFiles, RecordsTellWhatWasLeftOut) {
  put("<foo/>");
  EXPECT_EQ(said({"--frames", "1", "--spp", "1", "--lenient", "-o", in("shot/f_%d.exr")}), "");
  EXPECT_EQ(record("shot/f_0.json")["options"]["lenient"], true);
}

// A reflectance above 1 in the later half of a sweep.
TEST_F(AnimateFiles, NotesOfLaterFramesAreToldOnce) {
  put(R"(<default name="white" value="1"/>)");
  std::string room = kit::bytes_of(in("room.xml"));
  const std::string wall = R"(<bsdf type="diffuse"><rgb name="reflectance" value="$white"/></bsdf>)";
  write("room.xml", room.insert(room.find("<transform", room.find("<shape")), wall));
  const auto notes = [&](const char* frames) {
    testing::internal::CaptureStderr();
    run_command_line({"animate", in("room.xml"), "--spp", "1", "--integrator", "path", "-D", "white=0.5..2", "--frames",
                      frames, "-o", in("shot/f_%d.exr")});
    const std::string told = testing::internal::GetCapturedStderr();
    Words out;
    for (size_t at = 0; (at = told.find("note: ", at)) != told.npos; ++at)
      out.push_back(told.substr(at, told.find('\n', at) - at));
    return out;
  };
  const Words some = notes("0-2/4");
  ASSERT_EQ(some.size(), 1u);
  EXPECT_SAYS(some[0], "note: frame 2: " + in("room.xml") + ":");
  EXPECT_SAYS(some[0], "above 1");
  fs::remove_all(in("shot"));
  EXPECT_EQ(notes("4"), some);
  fs::remove_all(in("shot"));
  ASSERT_EQ(notes("2-3/4").size(), 1u) << "of the first frame";
}

TEST_F(AnimateFiles, ReferencesMayBeOfAPart) {
  run("4", "reference", {"--integrator", "path", "--spp", "16"});
  fs::remove(in("reference/f_01.exr"));
  run("4", "out", {"--integrator", "path"});
  run("2-3/4", "out", {"--integrator", "path", "--reference", in("reference/f_%02d.exr")});
  const auto frames = figures("out")["frames"];
  ASSERT_EQ(frames.size(), 4u);
  EXPECT_FALSE(frames[0]["relmse"].is_null());
  EXPECT_TRUE(frames[1]["relmse"].is_null());
  EXPECT_FALSE(frames[2]["relmse"].is_null());
  EXPECT_TRUE(frames[1]["flicker"].is_null());
  EXPECT_TRUE(frames[2]["flicker"].is_null()) << "the reference before it is missing";
  EXPECT_FALSE(frames[3]["flicker"].is_null());
}

TEST_F(AnimateFiles, UnfitReferencesAreToldBeforeTheWork) {
  run("2", "reference", {"--integrator", "path"});
  const auto with = [&](Words more) {
    more.insert(more.end(), {"--integrator", "path", "--reference", in("reference/f_%02d.exr")});
    return error_of([&] { run("2", "out", more); });
  };
  EXPECT_SAYS(with({"--size", "8x8"}), "f_00.exr: is 16x12, the render 8x8; use --size");
  const std::string whole = kit::bytes_of(in("reference/f_01.exr"));
  std::ofstream(in("reference/f_01.exr")) << whole.substr(0, whole.size() / 2);
  EXPECT_SAYS(with({}), "reference/f_01.exr");
  EXPECT_FALSE(fs::exists(in("out/f_00.exr")));
}

TEST_F(AnimateFiles, DamagedFramesAreToBeRemoved) {
  run("2", "out", {"--integrator", "path"});
  const std::string whole = kit::bytes_of(in("out/f_01.exr"));
  std::ofstream(in("out/f_01.exr")) << whole.substr(0, whole.size() - 100);
  EXPECT_SAYS(error_of([&] {
                run("2", "out", {"--integrator", "path"});
              }),
              in("out/f_01.exr") + ": is no frame, or a damaged one; remove it");
}

// One that can be read all the same: blocks that do not shrink have no checksum in the file.
TEST_F(AnimateFiles, FramesOfOtherPixelsAreDamaged) {
  for (const bool half : {false, true}) {
    Words words = {"--integrator", "path"};
    if (half) words.push_back("--half");
    const std::string to = half ? "half" : "float", path = in(to + "/f_01.exr");
    run("2", to, words), run("2", to, words);
    Picture image = read_picture(path);
    image.pixels[7] += 10;
    write_exr(path, image, read_metadata(path), half ? PixelType::half : PixelType::float32);
    EXPECT_SAYS(error_of([&] { run("2", to, words); }), path + ": is no frame, or a damaged one; remove it");
  }
}

TEST_F(AnimateFiles, RecordsTellTimeAndChoiceOfLights) {
  std::string room = kit::bytes_of(in("room.xml"));
  const std::string still = R"(<transform name="to_world"><scale value="0.6"/><translate x="$door"/></transform>)";
  room.replace(room.find(still), still.size(), R"(<animation name="to_world">
    <transform time="1"><scale value="0.6"/></transform><transform time="3"><scale value="0.7"/></transform>
    </animation>)");
  write("room.xml", room);
  for (const auto& [integrator, choice] : {std::pair{"path", "tree"}, {"guided-bdpt", "learned"}}) {
    call({"--frames", "3", "--spp", "1", "--integrator", integrator, "-o", in(integrator) + "/f_%d.exr"});
    const auto options = record(std::string(integrator) + "/f_1.json")["options"];
    EXPECT_EQ(options["at"], 2);
    EXPECT_EQ(options["light_choice"], choice);
  }
}

TEST_F(AnimateFiles, ParametersOfKeyframesAreNotBlamedOnTheUser) {
  write("keys.json", R"({"frames": 2, "parameters": {"wind": [[0, 1], [1, 2]]}})");
  const std::string what = said({"--spp", "1", "--keyframes", in("keys.json"), "-o", in("f_%d.exr")});
  EXPECT_SAYS(what, in("keys.json") + ": parameter \"wind\": the scene has no parameter of this name");
  EXPECT_EQ(what.find("-D"), what.npos) << what;
}

// A film is of one scene: whatever file of it changes between two frames ends the work.
TEST_F(AnimateFiles, FilesThatChangeEndTheAnimation) {
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n";
  write("moving.obj", triangle), write("still.obj", triangle), write("light.spd", "400 1\n700 1\n");
  write("lamp0.xml", R"(<scene version="3.0.0"><include filename="lamp.xml"/></scene>)");
  write("lamp1.xml", R"(<scene version="3.0.0"><include filename="lamp.xml"/><!-- another --></scene>)");
  write("lamp.xml", R"(<scene version="3.0.0"><emitter type="constant">
    <spectrum name="radiance" filename="light.spd"/></emitter></scene>)");
  write_png(in("image.png"), Picture{1, 1, {"R", "G", "B"}, {0.5f, 0.5f, 0.5f}});
  put(R"(<default name="n" value="0"/><include filename="lamp$n.xml"/>
    <shape type="obj"><string name="filename" value="moving.obj"/>
      <transform name="to_world"><translate x="$n"/></transform></shape>
    <shape type="obj"><string name="filename" value="still.obj"/><bsdf type="diffuse">
      <texture name="reflectance" type="bitmap"><string name="filename" value="image.png"/></texture></bsdf></shape>)");
  Shooting shooting{in("room.xml"), "", false, make_timeline("2", {"n=0..1"}, "", ""), {}};
  const auto loaded = [&](int frame) { return error_of([&] { load_frame(shooting, frame); }); };
  EXPECT_EQ(loaded(0), "");
  EXPECT_EQ(loaded(1), "");  // lamp1.xml is another file, not a change
  for (const char* name : {"room.xml", "lamp.xml", "moving.obj", "still.obj", "light.spd", "image.png"}) {
    const std::string before = kit::bytes_of(in(name));
    write(name, before + "\n");
    EXPECT_EQ(loaded(1), in(name) + ": has changed since the animation began; give the command again (frame 1: n=1)");
    write(name, before);
    EXPECT_EQ(loaded(1), "") << name;
  }
}

// Fields for a later command are a help: a full disk takes them, not the frames.
TEST_F(AnimateFiles, AFullDiskForFieldsEndsNothing) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  fs::create_directories(in("shot"));
  fs::create_symlink("/dev/full", in("shot/carried_0-1.fields"));
  testing::internal::CaptureStderr();
  const std::string error =
      said({"--frames", "2", "--spp", "1", "--teach", "1", "--integrator", "guided-path", "-o", in("shot/f_%d.exr")});
  const std::string told = testing::internal::GetCapturedStderr();
  EXPECT_EQ(error, "");
  EXPECT_TRUE(fs::exists(in("shot/f_1.exr")));
  const size_t first = told.find("warning: " + in("shot/carried_0-1.fields") + ": cannot be written (No space left");
  ASSERT_NE(first, told.npos) << told;
  EXPECT_SAYS(told, "the animation goes on");
  EXPECT_EQ(told.find("warning", first + 1), told.npos) << "once is enough: " << told;
}

// A film beside its frames, in a folder to be made; names of folders that ffmpeg would take for its own signs.
TEST_F(AnimateFiles, FilmsMayLieBesideTheirFrames) {
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", folder.c_str(), 1);
  const fs::path there = fs::current_path();
  EXPECT_SAYS(said({"--frames", "2", "--spp", "1", "-o", in("f_%d.exr"), "--video", in("none/film.mp4")}),
              "ffmpeg is not installed");
  write("ffmpeg", "#!/bin/sh\nfor last; do :; done\necho \"$@\" > \"$last\"\n");
  fs::permissions(in("ffmpeg"), fs::perms::owner_all);
  EXPECT_EQ(said({"--frames", "2", "--spp", "1", "-o", in("shot/f_%d.exr"), "--video", in("shot/film.mp4")}), "");
  EXPECT_TRUE(fs::exists(in("shot/film.mp4")));
  fs::create_symlink("far/film.mp4", in("link.mp4"));
  EXPECT_EQ(said({"--frames", "2", "--spp", "1", "-o", in("shot/f_%d.exr"), "--video", in("link.mp4")}), "");
  EXPECT_TRUE(fs::is_symlink(in("link.mp4")));
  EXPECT_TRUE(fs::exists(in("far/film.mp4")));
  fs::create_directories(in("100%d of it"));
  fs::current_path(in("100%d of it"));
  EXPECT_EQ(said({"--frames", "2", "--spp", "1", "-o", "f_%d.exr", "--video", "film.mp4"}), "");
  fs::current_path(there);
  EXPECT_SAYS(kit::bytes_of(in("100%d of it/film.mp4")), "-i " + in("100%%d of it/f_%01d.png") + " ");
  ::setenv("PATH", path.c_str(), 1);
}

TEST_F(AnimateFiles, FramesOfAFilmHaveOneSize) {
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", folder.c_str(), 1);
  write("ffmpeg", "#!/bin/sh\nfor last; do :; done\necho \"$@\" > \"$last\"\n");
  fs::permissions(in("ffmpeg"), fs::perms::owner_all);
  put(R"(<default name="wide" value="16"/>)");
  std::string room = kit::bytes_of(in("room.xml"));
  const std::string width = R"(name="width" value="16")";
  write("room.xml", room.replace(room.find(width), width.size(), R"(name="width" value="$wide")"));
  write("keys.json", R"({"frames": 6, "parameters": {"wide": [[0, 8], [1, 16], [2, 16], [3, 18], [4, 16], [5, 16]]}})");
  const auto film = [&](const char* frames, Words more = {}) {
    more.insert(more.end(), {"--frames", frames, "--keyframes", in("keys.json"), "--spp", "1", "--integrator", "path",
                             "-o", in("shot/f_%d.exr"), "--video", in("film.mp4")});
    return said(more);
  };
  EXPECT_EQ(film("1-4"), "--video " + in("film.mp4") + ": frame 1 is 16x12, frame 3 18x12, and frames of a film have " +
                             "one size; add --size, or leave --video out");
  EXPECT_FALSE(fs::exists(in("shot"))) << "told before the work";
  EXPECT_EQ(film("1-2"), "") << "another size than frame 0 has";
  EXPECT_EQ(film("4-5"), "");
  EXPECT_SAYS(film("0-2"), "frame 0 is 8x12, frame 2 16x12");
  fs::remove_all(in("shot"));
  EXPECT_EQ(film("1-4", {"--size", "10x8"}), "");
  ::setenv("PATH", path.c_str(), 1);
}

TEST_F(AnimateFiles, FilmsHaveKnownNames) {
  for (const char* name : {"film", "film.exr", "film.mp3"})
    EXPECT_SAYS(said({"--frames", "2", "--spp", "1", "-o", in("f_%d.exr"), "--video", in(name)}),
                "is no name for a film; write NAME.mp4");
  EXPECT_FALSE(fs::exists(in("f_0.exr")));
}

}  // namespace
}  // namespace ajar
