// ajar animate, as a user calls it: which frames it makes, that they do not depend on how the work was split, and what
// it says where it cannot.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "animate_stage.h"
#include "app/frames.h"
#include "app/timeline.h"

namespace ajar {
namespace {

namespace fs = std::filesystem;
using kit::error_of;

using Numbers = std::vector<double>;

TEST(Timeline, SweepsGoFromEndToEnd) {
  const Timeline t = make_timeline("5", {"door=10..50", "sun=0 4..1 0..2 4", "tint=red", "there=0..1..0"}, "", "");
  EXPECT_EQ(t.frames.first, 0);
  EXPECT_EQ(t.frames.last, 4);
  EXPECT_EQ(values_at(t.tracks.at("door"), 0), Numbers({10}));
  EXPECT_EQ(values_at(t.tracks.at("door"), 1), Numbers({20}));
  EXPECT_EQ(values_at(t.tracks.at("door"), 4), Numbers({50}));
  EXPECT_EQ(values_at(t.tracks.at("sun"), 1), Numbers({0.5, 2}));
  EXPECT_EQ(values_at(t.tracks.at("there"), 2), Numbers({1}));
  const auto parameters = parameters_at(t, 3);
  EXPECT_EQ(parameters.at("door"), "40");
  EXPECT_EQ(parameters.at("sun"), "1.5, 2");
  EXPECT_EQ(parameters.at("tint"), "red");
}

// On processors that fuse products and sums, too.
TEST(Timeline, SweepsThroughZeroAreZeroThere) {
  for (const char* sweep : {"x=-1..4", "x=-0.3..1.2", "x=-1..4:smooth"})
    for (int frames = 2; frames <= 200; ++frames) {
      const Timeline t = make_timeline(std::to_string(frames), {sweep}, "", "");
      for (int f = 0; f < frames; ++f) {
        const double x = std::stod(parameters_at(t, f).at("x"));
        EXPECT_TRUE(x == 0 || std::abs(x) > 1e-9) << sweep << " " << frames << " " << f << ": " << x;
      }
    }
}

TEST(Timeline, SmoothOnesEaseInAndOut) {
  const Track t = make_timeline("9", {"x=0..8:smooth"}, "", "").tracks.at("x");
  EXPECT_EQ(values_at(t, 0), Numbers({0}));
  EXPECT_NEAR(values_at(t, 2)[0], 8 * (3 * 0.0625 - 2 * 0.015625), 1e-12);
  EXPECT_NEAR(values_at(t, 4)[0], 4, 1e-12);
  // Three keys: nothing overshoots, and where it does not turn it does not stop.
  const Track rising{{{0, {0}}, {4, {1}}, {8, {8}}}, true};
  double before = 0;
  for (double f = 0; f <= 8; f += 0.25) {
    const double x = values_at(rising, f)[0];
    EXPECT_GE(x, before - 1e-12) << f;
    EXPECT_LE(x, 8);
    before = x;
  }
  EXPECT_GT(values_at(rising, 4.1)[0] - values_at(rising, 3.9)[0], 0.05);
}

TEST(Timeline, FramesAtKeysAndAtZeroAreMarked) {
  const auto marked = [](const Timeline& t) {
    std::vector<int> out;
    for (int f = 0; f < t.frames.count; ++f)
      if (is_marked(t, f)) out.push_back(f);
    return out;
  };
  EXPECT_EQ(marked(make_timeline("11", {"x=1..9", "y=a"}, "", "")), std::vector<int>({0, 10}));
  EXPECT_EQ(marked(make_timeline("11", {"x=5..-5:smooth"}, "", "")), std::vector<int>({0, 4, 5, 6, 10}));
  EXPECT_EQ(marked(make_timeline("10", {"x=5 1..-5 1"}, "", "")), std::vector<int>({0, 4, 5, 9}));
  EXPECT_EQ(marked(make_timeline("12", {"x=1..2..1"}, "", "")), std::vector<int>({0, 5, 6, 11}));
}

TEST(Timeline, RangesArePartsOfTheWhole) {
  const Timeline part = make_timeline("10-20/48", {"x=0..47"}, "", "");
  EXPECT_EQ(part.frames.first, 10);
  EXPECT_EQ(part.frames.last, 20);
  EXPECT_EQ(parameters_at(part, 13).at("x"), "13");
  const Timeline one = make_timeline("7/48", {}, "", "");
  EXPECT_EQ(one.frames.first, 7);
  EXPECT_EQ(one.frames.last, 7);
  EXPECT_EQ(parameters_at(make_timeline("1", {"x=3..9"}, "", ""), 0).at("x"), "3");
}

TEST(Timeline, ValuesWithDotsAreNotAllSweeps) {
  EXPECT_EQ(make_timeline("4", {"folder=../models"}, "", "").constant.at("folder"), "../models");
}

TEST(Timeline, ColonsOfPathsAreNoKindsOfSweep) {
  EXPECT_EQ(make_timeline("4", {"x=../a:b/tex.png"}, "", "").constant.at("x"), "../a:b/tex.png");
  EXPECT_SAYS(error_of([&] { make_timeline("4", {"x=1..2:b"}, "", ""); }), "\"b\" is neither linear nor smooth");
}

TEST(Timeline, WrongOnesAreErrors) {
  const auto frames = [](const std::string& text) { return error_of([&] { make_timeline(text, {}, "", ""); }); };
  EXPECT_SAYS(frames(""), "--frames is missing");
  EXPECT_SAYS(frames("0"), "from 1 to");
  EXPECT_SAYS(frames("-3"), "not a range");
  EXPECT_SAYS(frames("many"), "not a range");
  EXPECT_SAYS(frames("10-20"), "10-20/48");
  EXPECT_SAYS(frames("20-10/48"), "after the last");
  EXPECT_SAYS(frames("10-48/48"), "numbered from 0 to 47");
  EXPECT_SAYS(frames("3/48x"), "not a range");
  const auto sweep = [](const std::string& text) { return error_of([&] { make_timeline("4", {text}, "", ""); }); };
  EXPECT_SAYS(sweep("door"), "name=FROM..TO");
  EXPECT_SAYS(sweep("door=5..wide"), "from number to number");
  EXPECT_SAYS(sweep("door=5..60:quick"), "neither linear nor smooth");
  EXPECT_SAYS(sweep("door=5...60"), "three dots may be two and a point");
  EXPECT_SAYS(sweep("sun=1 2..3"), "the same number of numbers");
  EXPECT_SAYS(error_of([] { make_timeline("4", {"x=1..2", "x=3"}, "", ""); }), "given twice");
  for (const char* at : {"soon", "x..1", "0..", "0..1..2", "0 1..2 3", "0..1:smooth", "0...1"})
    EXPECT_SAYS(error_of([&] { make_timeline("4", {}, "", at); }), "--at " + std::string(at) + ": write FROM..TO, ");
}

TEST_F(Animate, FramesDoNotDependOnHowTheWorkIsSplit) {
  run("4", "whole");
  run("0-1/4", "parts");
  run("2-3/4", "parts");  // goes on from what the first part left
  run("3/4", "alone");    // learns all that comes before again
  for (const char* f : {"/f_00.exr", "/f_01.exr", "/f_02.exr", "/f_03.exr"})
    EXPECT_EQ(pixels(std::string("whole") + f), pixels(std::string("parts") + f)) << f;
  EXPECT_EQ(pixels("whole/f_03.exr"), pixels("alone/f_03.exr"));
  EXPECT_NE(pixels("whole/f_02.exr"), pixels("whole/f_03.exr"));
  EXPECT_TRUE(fs::exists(in("whole/f_03.png")));
  EXPECT_TRUE(fs::exists(in("whole/f_03.json")));
  EXPECT_EQ(figures("whole")["frames"].size(), 4u);
  EXPECT_EQ(figures("whole")["frames"][3]["parameters"]["door"], "1.4");
}

// Nothing moves, but rays ask the frame's own scene for opacities.
TEST_F(Animate, MasksOpenAndClose) {
  write("room.xml", R"(<scene version="3.0.0">
    <default name="door" value="1"/>
    <sensor type="perspective">
      <transform name="to_world"><lookat origin="0, 0, 3.5" target="0, 0, 0" up="0, 1, 0"/></transform>
      <film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/></film></sensor>
    <shape type="rectangle"><bsdf type="mask"><float name="opacity" value="$door"/><bsdf type="diffuse"/></bsdf></shape>
    <emitter type="constant"/>
  </scene>)");
  run("2", "whole", {"--integrator", "path"});
  run("1/2", "alone", {"--integrator", "path"});
  EXPECT_EQ(pixels("whole/f_01.exr"), pixels("alone/f_01.exr"));
  EXPECT_NE(pixels("whole/f_00.exr"), pixels("whole/f_01.exr"));
}

TEST_F(Animate, FinishedFramesAreNotRenderedAgain) {
  run("3", "out");
  const std::vector<float> last = pixels("out/f_02.exr");
  const auto kept = fs::last_write_time(in("out/f_01.exr"));
  fs::remove(in("out/f_02.exr"));
  std::ifstream picture(in("out/f_01.png"), std::ios::binary);
  const std::string png{std::istreambuf_iterator<char>(picture), {}};
  fs::remove(in("out/f_01.png"));
  run("3", "out");
  EXPECT_EQ(fs::last_write_time(in("out/f_01.exr")), kept);
  std::ifstream again(in("out/f_01.png"), std::ios::binary);
  EXPECT_EQ(png, std::string(std::istreambuf_iterator<char>(again), {})) << "made again from the EXR";
  EXPECT_EQ(pixels("out/f_02.exr"), last);
  EXPECT_SAYS(error_of([&] { run("3", "out", {"--seed", "7"}); }), "other options; remove it");
  EXPECT_SAYS(error_of([&] { run("4", "out"); }), "of another animation");
  EXPECT_SAYS(error_of([&] { run("3", "out", {"--half"}); }), "f_00.exr: was made otherwise");
}

// What time cut short teaches no frame whose samples are counted.
TEST_F(Animate, LessonsInTimeAreNotGoneOnWithoutIt) {
  run("0-1/3", "parts", {"--cpu-time", "0.0001"});
  run("2/3", "parts");
  run("2/3", "alone");
  EXPECT_EQ(pixels("parts/f_02.exr"), pixels("alone/f_02.exr"));
}

// Frames of two scenes never stand in one film: neither of the scene's own file nor of one that it names.
TEST_F(Animate, FramesOfAChangedSceneAreAnError) {
  std::ifstream file(in("room.xml"));
  std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::string lamp = R"(<emitter type="area"><rgb name="radiance" value="20, 18, 15"/></emitter>)";
  text.replace(text.find(lamp), lamp.size(), R"(<include filename="lamp.xml"/>)");
  write("room.xml", text), write("lamp.xml", lamp);
  run("3", "out");
  fs::remove(in("out/f_01.exr"));
  write("lamp.xml", R"(<emitter type="area"><rgb name="radiance" value="90, 18, 15"/></emitter>)");
  const std::string said = error_of([&] { run("3", "out"); });
  EXPECT_SAYS(said, "f_00.exr: was made otherwise: there files with checksum");
  EXPECT_SAYS(said, "remove it, or write elsewhere");
  EXPECT_FALSE(fs::exists(in("out/f_01.exr")));
  fs::remove_all(in("out/f_00.exr")), fs::remove_all(in("out/f_02.exr"));
  run("3", "out");  // what the fields of the other scene knew is learned anew
  run("3", "fresh");
  EXPECT_EQ(pixels("out/f_02.exr"), pixels("fresh/f_02.exr"));
}

// However short the time, a frame has a whole pass, and fields that had a lesson.
TEST_F(Animate, FramesAreWholeHoweverShortTheirTime) {
  for (const char* integrator : {"guided-bdpt", "vpl", "path"}) {
    run_command_line({"animate", in("room.xml"), "-q", "--time", "0.001s", "--size", "80x80", "--frames", "2", "-D",
                      "door=0.2..1.4", "--integrator", integrator, "-o", in(integrator) + "_%d.exr"});
    for (const char* frame : {"_0.exr", "_1.exr"})
      EXPECT_EQ(std::get<double>(read_metadata(in(integrator) + frame).at("ajar:spp")), 1) << integrator;
  }
}

// What teaches a frame's fields is in its time, and so in its rays: else rays per second would be too few.
TEST_F(Animate, RaysOfLessonsCount) {
  const auto rays = [&](const std::string& teach) {
    run("2", "taught" + teach, {"--integrator", "guided-bdpt", "--teach", teach});
    std::ifstream record(in("taught" + teach + "/f_01.json"));
    return nlohmann::json::parse(record)["rays"]["camera"].get<double>();
  };
  EXPECT_GT(rays("16"), 2 * rays("1"));
}

// What a frame was made with, as it was typed: its image's seed is another.
TEST_F(Animate, RecordsHoldWhatTheCommandAskedFor) {
  run("2", "out",
      {"--integrator", "guided-bdpt", "--coherent", "fields", "--seed", "7", "--teach", "2", "--forget", "0.5"});
  std::ifstream file(in("out/f_01.json"));
  const nlohmann::json record = nlohmann::json::parse(file), options = record["options"];
  EXPECT_EQ(options["seed"], 7);
  EXPECT_EQ(options["teach"], 2);
  EXPECT_EQ(options["forget"], 0.5);
  EXPECT_NE(record["image_seed"], 7) << "each frame has numbers of its own";
  EXPECT_EQ(std::get<std::string>(read_metadata(in("out/f_01.exr")).at("ajar:seed")), "7");
}

TEST_F(Animate, ADamagedFileOfFieldsIsLearnedAgain) {
  run("3", "out");
  const std::vector<float> last = pixels("out/f_02.exr");
  fs::remove(in("out/f_02.exr"));
  for (const auto& entry : fs::directory_iterator(in("out")))
    if (entry.path().extension() == ".fields") std::ofstream(entry.path()) << "rubbish";
  run("3", "out");
  EXPECT_EQ(pixels("out/f_02.exr"), last);
}

// Numbers in common: what does not move looks the same in every frame. Else it does not.
TEST_F(Animate, CoherenceIsOfNumbersAndFields) {
  const auto same = [&](const std::string& coherent, const std::string& integrator) {
    const std::string out = coherent + integrator;
    run_command_line({"animate", in("room.xml"), "-q", "--spp", "2", "--frames", "2", "--coherent", coherent,
                      "--integrator", integrator, "-o", in(out) + "/f_%d.exr"});
    return pixels(out + "/f_0.exr") == pixels(out + "/f_1.exr");
  };
  EXPECT_TRUE(same("on", "path"));
  EXPECT_TRUE(same("numbers", "path"));
  EXPECT_FALSE(same("off", "path"));
  EXPECT_FALSE(same("fields", "path"));
  EXPECT_FALSE(same("on", "guided-bdpt"));  // fields that have learned more
}

TEST_F(Animate, MeasuresErrorAndFlicker) {
  run("3", "reference", {"--integrator", "path", "--spp", "64"});
  run("3", "out", {"--integrator", "path", "--reference", in("reference/f_%02d.exr")});
  const auto j = figures("out");
  EXPECT_GT(j["mean"]["relmse"].get<double>(), 0);
  EXPECT_GT(j["mean"]["flicker"].get<double>(), 0);
  EXPECT_TRUE(j["frames"][0]["flicker"].is_null());
  EXPECT_FALSE(j["frames"][1]["flicker"].is_null());
  fs::copy(in("reference"), in("copy"));
  run("3", "copy", {"--integrator", "path", "--spp", "64", "--reference", in("reference/f_%02d.exr")});
  EXPECT_EQ(figures("copy")["mean"]["flicker"], 0);
  EXPECT_TRUE(fs::exists(in("out/animation.csv")));
  EXPECT_TRUE(fs::exists(in("out/animation.svg")));
  EXPECT_SAYS(error_of([&] { run("4", "more", {"--reference", in("reference/f_%02d.exr")}); }), "there is no");
}

TEST_F(Animate, FiguresAreOfNoOtherAnimation) {
  run("0/4", "out", {"--integrator", "path", "--seed", "7"});
  run("1/4", "out", {"--integrator", "path"});
  run("3/4", "out", {"--integrator", "path"});
  const auto j = figures("out");
  ASSERT_EQ(j["frames"].size(), 2u);
  EXPECT_EQ(j["frames"][0]["frame"], 1);
  EXPECT_EQ(j["frames_done"], 2);
}

// Of frames that others render only their metadata are read.
TEST_F(Animate, FiguresNeedNoPixels) {
  run("3", "out", {"--integrator", "path"});
  const auto before = figures("out");
  const Picture image = read_picture(in("out/f_00.exr"));
  double sum = 0;
  for (const float x : image.pixels) sum += x;
  EXPECT_NEAR(before["frames"][0]["mean"].get<double>(), sum / double(image.pixels.size()), 1e-12);
  std::string bytes = kit::bytes_of(in("out/f_00.exr"));
  std::fill(bytes.end() - 400, bytes.end(), '\0');
  write("out/f_00.exr", bytes);
  EXPECT_ANY_THROW(read_picture(in("out/f_00.exr")));
  run("2/3", "out", {"--integrator", "path"});
  EXPECT_EQ(figures("out")["frames"][0], before["frames"][0]);
}

// Sizes may change from frame to frame; flicker is not of such frames.
TEST_F(Animate, FlickerIsOfFramesOfOneSize) {
  run("1", "out", {"--integrator", "path", "--size", "8x8"});
  fs::create_directories(in("film"));
  fs::copy(in("out/f_00.exr"), in("film/f_00.exr"));
  run("1", "wide", {"--integrator", "path", "--size", "9x8"});
  fs::copy(in("wide/f_00.exr"), in("film/f_01.exr"));
  const FramePattern film = parse_pattern("-o", in("film/f_%02d.exr"));
  const Timeline two = make_timeline("2", {}, "", "");
  EXPECT_EQ(measure(film, two, {}).size(), 2u);
  const std::vector<FrameFigures> both = measure(film, two, film);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[1].relmse, 0);
  EXPECT_TRUE(std::isnan(both[1].flicker));
}

TEST_F(Animate, KeyframesComeFromAFile) {
  write("keys.json", R"({"frames": 3, "parameters": {"door": {"smooth": true, "keys": [[0, 0.5], [2, 1.5]]}}})");
  run_command_line({"animate", in("room.xml"), "-q", "--spp", "1", "--keyframes", in("keys.json"), "--integrator",
                    "path", "--frames", "1-2", "-o", in("k_%d.exr")});
  EXPECT_FALSE(fs::exists(in("k_0.exr")));
  EXPECT_TRUE(fs::exists(in("k_2.exr")));
  const auto wrong = [&](const std::string& text) {
    write("keys.json", text);
    return error_of([&] { make_timeline("", {}, in("keys.json"), ""); });
  };
  EXPECT_SAYS(wrong("{"), "not JSON");
  EXPECT_SAYS(wrong("[]"), "write {\"frames\"");
  EXPECT_SAYS(wrong(R"({"frames": 0})"), "from 1 to");
  EXPECT_SAYS(wrong(R"({"frame": 3})"), "\"frame\" is unknown");
  EXPECT_SAYS(wrong(R"({"frames": 3, "parameters": {"x": []}})"), "parameter \"x\": needs a list of keys");
  EXPECT_SAYS(wrong(R"({"frames": 3, "parameters": {"x": [[0, "a"]]}})"), "a key is [FRAME, VALUE]");
  EXPECT_SAYS(wrong(R"({"frames": 3, "parameters": {"x": [[2, 1], [1, 1]]}})"), "in the order");
  EXPECT_SAYS(error_of([&] { make_timeline("", {}, in("none.json"), ""); }), "cannot be read");
  write("keys.json", R"({"frames": 3})");
  const auto frames = [&](const char* text) { return error_of([&] { make_timeline(text, {}, in("keys.json"), ""); }); };
  EXPECT_EQ(frames("5"), "--frames 5: the keyframes say 3; leave it out");
  EXPECT_EQ(frames("2"), "--frames 2: the keyframes say 3; leave it out, or write 2/3 for that frame alone");
  EXPECT_EQ(frames("2/3"), "");
  EXPECT_EQ(frames("1-2/5"), "--frames 1-2/5: the keyframes say 3; write that, or leave it out");
}

TEST_F(Animate, KeysThatNoFrameReachesAreTold) {
  const auto notes = [&](const std::string& keys) {
    write("keys.json", R"({"frames": 3, "parameters": {"door": )" + keys + "}}");
    return make_timeline("", {"x=1..2"}, in("keys.json"), "").notes;
  };
  EXPECT_TRUE(notes("[[0, 1], [2, 2]]").empty());
  EXPECT_TRUE(notes("[[0.5, 1], [1.5, 2]]").empty());
  ASSERT_EQ(notes("[[-1, 1], [2, 2]]").size(), 1u);
  const std::vector<std::string> one = notes("[[0, 1], [3.5, 2], [9, 3]]");
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0], in("keys.json") + ": parameter \"door\": no frame reaches its key at 3.5; they go from 0 to 2");
  testing::internal::CaptureStderr();
  run_command_line({"animate", in("room.xml"), "--spp", "1", "--keyframes", in("keys.json"), "--integrator", "path",
                    "-o", in("k_%d.exr")});
  EXPECT_SAYS(testing::internal::GetCapturedStderr(), "ajar: note: " + one[0] + "\n");
}

// The scene's own animation: the whole of it, unless the user wants a part.
TEST_F(Animate, ScenesMoveByThemselves) {
  write("room.xml", R"(<scene version="3.0.0">
    <sensor type="perspective">
      <animation name="to_world">
        <transform time="1"><lookat origin="0, 0, 4" target="0, 0, 0" up="0, 1, 0"/></transform>
        <transform time="3"><lookat origin="2, 0, 4" target="2, 0, 0" up="0, 1, 0"/></transform></animation>
      <film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/></film></sensor>
    <shape type="sphere"><emitter type="area"/></shape></scene>)");
  const auto animate = [&](const std::string& out, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"animate", in("room.xml"),      "-q",           "--spp", "4", "--frames", "3",
                                          "-o",      in(out) + "_%d.exr", "--integrator", "path"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    run_command_line(arguments);
  };
  animate("all", {});
  fs::create_directories(in("part"));
  animate("part/p", {"--at", "2..3"});
  EXPECT_NE(pixels("all_0.exr"), pixels("all_1.exr"));
  EXPECT_EQ(pixels("all_1.exr"), pixels("part/p_0.exr"));
  EXPECT_EQ(pixels("all_2.exr"), pixels("part/p_2.exr"));
  EXPECT_SAYS(error_of([&] { animate("part/p", {"--at", "2..3.0001"}); }), "p_0.exr: is of another animation");
}

// Frame 0 and the last have whole numbers, what is between has not: that is told before any of them is rendered.
TEST_F(Animate, WholeNumbersAreWholeInEveryFrame) {
  write("deep.xml", R"(<scene version="3.0.0"><default name="depth" value="2"/>
    <integrator type="path"><integer name="max_depth" value="$depth"/></integrator>
    <sensor type="perspective"><film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/>
      </film></sensor><shape type="sphere"><emitter type="area"/></shape></scene>)");
  const auto animate = [&](const char* frames) {
    run_command_line({"animate", in("deep.xml"), "-q", "--spp", "1", "--frames", frames, "-D", "depth=2..4", "-o",
                      in("d/d_%d.exr")});
  };
  EXPECT_SAYS(error_of([&] { animate("5"); }), "2.5 should be a whole number");
  EXPECT_SAYS(error_of([&] { animate("5"); }), " (frame 1: ");
  EXPECT_FALSE(fs::exists(in("d")));
  animate("3");
  EXPECT_TRUE(fs::exists(in("d/d_2.exr")));
}

TEST_F(Animate, SaysWhatIsWrong) {
  const auto wrong = [&](std::vector<std::string> more) { return error_of([&] { run("2", "out", std::move(more)); }); };
  EXPECT_SAYS(wrong({"-D", "window=1..2"}), "-D window: the scene has no parameter of this name");
  EXPECT_SAYS(wrong({"--integrator", "pathh"}), "--integrator pathh: unknown");
  EXPECT_SAYS(wrong({"--integrator", "path", "--guide", "light"}), "learns no fields");
  EXPECT_SAYS(wrong({"--integrator", "guided-path", "--guide", "light"}), "guided-path has no light subpaths");
  EXPECT_SAYS(wrong({"--integrator", "vpl", "--guide", "camera"}), "vpl guides light subpaths alone");
  EXPECT_SAYS(wrong({"--integrator", "path", "--teach", "1"}), "--teach: the integrator path learns no fields");
  EXPECT_SAYS(wrong({"--integrator", "path", "--forget", "0.5"}), "--forget: the integrator path learns no fields");
  EXPECT_SAYS(wrong({"--forget", "nan"}), "--forget: nan is no number from 0 to 0.999");
  EXPECT_SAYS(wrong({"--fps", "12"}), "--fps: is of a film; add --video");
  EXPECT_SAYS(wrong({"--fps", "1000"}), "--fps: 1000 is no number from 1 to 240");
  EXPECT_SAYS(wrong({"--reference", in("none_%d.exr")}), "none_0.exr; make it, or take a part of the --frames");
  EXPECT_SAYS(wrong({"--coherent", "off"}), "--teach: with --coherent off");
  EXPECT_SAYS(wrong({"--coherent", "numbers", "--forget", "0.5"}), "--forget: with --coherent numbers");
  EXPECT_SAYS(wrong({"--at", "nan"}), "--at nan: write FROM..TO");
  EXPECT_SAYS(wrong({"--at", "0..1"}), "--at 0..1: nothing in the scene has an <animation>");
  EXPECT_SAYS(wrong({"--time", "soon"}), "--time soon");
  EXPECT_SAYS(wrong({"--size", "4294967312x8"}), "--size 4294967312x8: write WIDTHxHEIGHT");
  const auto pattern = [&](const std::string& out) {
    return error_of([&] { run_command_line({"animate", in("room.xml"), "--frames", "2", "-o", out}); });
  };
  EXPECT_SAYS(pattern(in("frame.exr")), "needs a place for the number");
  EXPECT_SAYS(pattern(in("f_%d_%d.exr")), "once");
  EXPECT_SAYS(pattern(in("f_%s.exr")), "%d or %04d");
  EXPECT_SAYS(pattern(in("f_%d.png")), "EXR");
  EXPECT_SAYS(pattern(in("f_%d/x.exr")), "one folder");
  EXPECT_TRUE(!fs::exists(in("out")) || fs::is_empty(in("out")));
}

// A stand-in for ffmpeg, which writes down what it was asked for.
TEST_F(Animate, VideosAreMadeByFfmpeg) {
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", folder.c_str(), 1);
  EXPECT_SAYS(error_of([&] { run("2", "out", {"--video", in("film.mp4")}); }), "ffmpeg is not installed");
  EXPECT_FALSE(fs::exists(in("out/f_00.exr")));  // told before the work, not after it
  write("ffmpeg", "#!/bin/sh\nfor last; do :; done\necho \"$@\" > \"$last\"\n");
  fs::permissions(in("ffmpeg"), fs::perms::owner_all);
  run("1-2/3", "out", {"--video", in("film.mp4"), "--fps", "12"});
  std::ifstream film(in("film.mp4"));
  const std::string said{std::istreambuf_iterator<char>(film), {}};
  EXPECT_SAYS(said, "-framerate 12 -start_number 1 -i " + in("out/f_%02d.png") + " -frames:v 2");
  write("ffmpeg", "#!/bin/sh\nexit 1\n");
  fs::remove(in("film.mp4"));
  EXPECT_SAYS(error_of([&] { run("1-2/3", "out", {"--video", in("film.mp4")}); }), "ffmpeg failed");
  EXPECT_FALSE(fs::exists(in("film.mp4")));
  ::setenv("PATH", path.c_str(), 1);
}

}  // namespace
}  // namespace ajar
