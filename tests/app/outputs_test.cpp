// Where ajar render writes to: names that cannot be are errors before the render, and files are not overwritten by
// others.

#include "app/outputs.h"

#include <nlohmann/json.hpp>

#include "app/progress.h"
#include "outputs_stage.h"

namespace ajar {
namespace {

TEST_F(Outputs, WrongOnesAreErrorsBeforeTheRender) {
  struct Case {
    Words words;
    std::string says;
  };
  const std::vector<Case> cases = {
      {{"-o", "there"}, "-o there: is a folder; name a file in it, there/NAME.exr"},
      {{"-o", "there/"}, "is a folder"},
      {{"-o", "box.xml/a.exr"}, "box.xml/a.exr: cannot be written (Not a directory)"},
      {{"-o", "box.xml"}, "-o box.xml: is no name for an image; write NAME.exr"},
      {{"-o", "a.jpg"}, "no name for an image"},
      {{"-o", "a.json"}, "no name for an image"},
      {{"-o", "shot.v1"}, "no name for an image"},
      {{"-o", ".png"}, "no name for an image"},
      {{"-o", "-"}, "no name for an image"},
      {{"--checkpoint", "room.xml/a"}, "room.xml/a: cannot be written"},
      {{"--log", "room.xml/a"}, "room.xml/a: cannot be written"},
      {{"--checkpoint", "there"}, "there: cannot be written"},
      {{"--log", "there"}, "there: cannot be written"},
      {{"--techniques", "box.xml"}, "box.xml: cannot be written"},
      {{"--techniques", "t", "--checkpoint", "t"}, "--techniques t: is the same file as --checkpoint t"},
      {{"--techniques", "a.exr"}, "--techniques a.exr: is the same file as -o a.exr"},
      {{"-o", "there/s0t2.exr", "--techniques", "there"}, "would take away -o there/s0t2.exr, whose name is that of a"},
      {{"-o", "none/s1t2.exr", "--techniques", "none/"}, "would take away -o none/s1t2.exr"},
      {{"--reference", "m2t2-raw.exr", "--log", "l", "--techniques", "."}, "would take away --reference m2t2-raw.exr"},
      {{"--checkpoint", "a.exr"}, "--checkpoint a.exr: is the same file as -o a.exr"},
      {{"--log", "there/../a.json"}, "is the same file as the record a.json"},
      {{"--png", "--checkpoint", "a.png"}, "is the same file as --png a.png"},
      {{"--log", "box.xml"}, "is the same file as the scene box.xml"},
      {{"--log", "room.xml"}, "is the same file as a file of the scene"},
      {{"-o", "a.png", "--half"}, "--half: is for EXR images"},
      {{"-o", "a.png", "--aov", "normal"}, "--aov: is for EXR images"},
      {{"--reference", "b.exr"}, "--reference: the error against it goes into the log"},
      {{"--time", "0x10s"}, "--time 0x10s: not a time"},
      {{"--time", "1e306h"}, "--time 1e306h: not a time"},
      {{"--max-depth", "0x10"}, "--max-depth: 0x10 is no decimal number"},
      {{"--seed", "18446744073709551616"}, "18446744073709551616 is no whole number from 0 to 18446744073709551615"},
      {{"--spp", "0"}, "0 is no whole number from 1"},
      {{"--spp", "0abc"}, "0abc is no whole number from 1"},
      {{"--integrator", "path", "--techniques", "t"}, "--techniques: path has no strategies"},
      {{"--integrator", "light", "--techniques", "t"}, "--techniques: light has no strategies"},
      {{"--plan", "auto", "--integrator", "bdpt"}, "leave out either"},
      {{"--plan", "all", "--integrator", "bdpt"}, "--plan all: bdpt leaves nothing out"},
      {{"--plan", "all", "--integrator", "vpl"}, "--plan all: vpl leaves nothing out"},
      {{"--light-choice", "learned", "--integrator", "vcm"}, "vcm learns no choice of lights; take path, bdpt or"},
      {{"--light-choice", "tree", "--integrator", "path", "--no-next-event"}, "no light is chosen; leave it out"},
      {{"--light-choice", "tree", "--integrator", "light"}, "light chooses its lights by power or uniform"},
      {{"--integrator", "path", "--no-next-event", "--versus", "bdpt"}, "bdpt finds light in more ways"},
      {{"--integrator", "path", "--light-choice", "learned", "--versus", "light"}, "by power or uniform; leave it out"},
      {{"--integrator", "path", "--light-choice", "learned", "--versus", "plain-vpl"}, "plain-vpl learns no choice"},
      {{"--max-depth", "5000"}, "--max-depth 5000: paths end at 4096 edges"},
      {{"--save-fields", "f"}, "bdpt learns no fields; take --integrator guided-bdpt, guided-path, guided-vcm or vpl"},
  };
  const std::string scene = kit::bytes_of("box.xml");
  for (const Case& c : cases) {
    const std::string said = error_of(c.words);
    EXPECT_NE(said.find(c.says), std::string::npos) << c.says << ": " << said;
    EXPECT_EQ(count(), 3u) << c.says;
  }
  EXPECT_EQ(kit::bytes_of("box.xml"), scene);
}

TEST_F(Outputs, AReferenceThatIsNoneIsNamedBeforeTheLogBegins) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  write_exr("nan.exr", {8, 8, {"R", "G", "B"}, std::vector<float>(192, nan)});
  write_exr("xyz.exr", {8, 8, {"X", "Y", "Z"}, std::vector<float>(192, 1)});
  write_exr("grey.exr", {8, 8, {"Y"}, std::vector<float>(64, 1)});
  EXPECT_NE(error_of({"--reference", "nan.exr", "--log", "log"}).find("nan.exr: channel R of pixel (0, 0)"),
            std::string::npos);
  EXPECT_NE(error_of({"--reference", "xyz.exr", "--log", "log"}).find("xyz.exr: channels R, G, B"), std::string::npos);
  EXPECT_FALSE(fs::exists("log"));
  EXPECT_EQ(error_of({"--reference", "grey.exr", "--log", "log"}), "");
}

TEST_F(Outputs, TheNameChoosesTheFormatInAnyCase) {
  run({"-o", "A.PNG"});
  EXPECT_EQ(kit::bytes_of("A.PNG").substr(1, 3), "PNG");
  run({"-o", "B.Exr", "--png", "--aov", "normal,normal"});
  EXPECT_EQ(read_picture("B.Exr").channels(), 6);
  for (const char* name : {"A.json", "B.json", "B.png"}) EXPECT_TRUE(fs::exists(name)) << name;
  run({"-o", "shot.v1.exr"});
  EXPECT_TRUE(fs::exists("shot.v1.json"));
}

// As an animation's frames have it; made when there is something to put there.
TEST_F(Outputs, FoldersThatAreMissingAreMade) {
  EXPECT_NE(error_of({"-o", "new/shot/a.exr", "--reference", "none.exr", "--log", "logs/a"}).find("none.exr"),
            std::string::npos);
  EXPECT_EQ(count(), 3u);
  run({"-o", "new/shot/a.exr", "--png", "--log", "logs/a", "--checkpoint", "states/a"});
  for (const char* name : {"new/shot/a.exr", "new/shot/a.png", "new/shot/a.json", "logs/a", "states/a"})
    EXPECT_TRUE(fs::exists(name)) << name;
}

TEST_F(Outputs, WhatIsNoRecordIsNotWrittenOver) {
  for (const char* foreign : {"{\"version\": 1}", "[1, 2]", "notes"}) {
    write_text("a.json", foreign);
    EXPECT_EQ(
        error_of({}),
        "a.json: is no record of a render, which would take its place beside a.exr; move it, or name another image");
    EXPECT_EQ(kit::bytes_of("a.json"), foreign);
    EXPECT_FALSE(fs::exists("a.exr"));
  }
  write_text("a.json", "");
  EXPECT_EQ(error_of({}), "");
  const std::string record = kit::bytes_of("a.json");
  EXPECT_EQ(error_of({"--seed", "1"}), "") << "its own";
  EXPECT_NE(kit::bytes_of("a.json"), record);
}

TEST_F(Outputs, LeadingZerosMakeNoOtherNumber) {
  for (const auto& [typed, meant] : {std::pair{"010", 10}, {"08", 8}, {"0001", 1}}) {
    run({"--spp", typed, "--seed", typed, "--max-depth", typed});
    const nlohmann::json options = nlohmann::json::parse(kit::bytes_of("a.json"))["options"];
    for (const char* name : {"spp", "seed", "max_depth"}) EXPECT_EQ(options[name], meant) << name << " " << typed;
  }
  run({"--seed", "000"});
  EXPECT_EQ(nlohmann::json::parse(kit::bytes_of("a.json"))["options"]["seed"], 0);
}

// By two names of one file, none of which is a link to the other.
TEST_F(Outputs, AHardLinkIsTheSameFile) {
  fs::create_hard_link("box.xml", "log");
  EXPECT_NE(error_of({"--log", "log"}).find("is the same file as the scene box.xml"), std::string::npos);
}

TEST_F(Outputs, ALogGoesOnWithItsRender) {
  run({"--log", "log", "--checkpoint", "state"});
  const std::string first = kit::bytes_of("log");
  ASSERT_FALSE(first.empty());
  run({"--log", "log", "--spp", "4", "--resume", "state", "--checkpoint", "state"});
  const std::string both = kit::bytes_of("log");
  EXPECT_TRUE(both.starts_with(first));
  EXPECT_GT(both.size(), first.size());
  std::ofstream("log") << first << R"({"cut": )";
  run({"--log", "log", "--spp", "4", "--resume", "state", "--checkpoint", "state"});
  EXPECT_TRUE(kit::bytes_of("log").starts_with(first + "{\"seconds\"")) << "a line that was cut is left out";
  run({"--log", "log"});
  EXPECT_LT(kit::bytes_of("log").size(), both.size()) << "a new render begins a new one";
}

TEST_F(Outputs, ALogThatCannotBeWrittenIsAnErrorOnceTheImageIsThere) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  EXPECT_NE(error_of({"--log", "/dev/full"}).find("/dev/full: cannot be written (No space left on device)"),
            std::string::npos);
  EXPECT_TRUE(fs::exists("a.exr"));
  EXPECT_TRUE(fs::exists("a.json"));
}

// Images of strategies are of all passes, or they are none.
TEST_F(Outputs, StrategiesOfAPartAreRefused) {
  run({"--checkpoint", "plain"});
  EXPECT_NE(error_of({"--resume", "plain", "--spp", "4", "--techniques", "t"}).find("plain: made without --techniques"),
            std::string::npos);
  run({"--spp", "4", "--techniques", "straight"});
  run({"--techniques", "t", "--checkpoint", "kept"});
  run({"--resume", "kept", "--spp", "4", "--techniques", "t"});
  EXPECT_EQ(kit::bytes_of("t/s1t2.exr"), kit::bytes_of("straight/s1t2.exr"));
  run({"--resume", "kept", "--spp", "4", "--checkpoint", "dropped"});
  EXPECT_NE(error_of({"--resume", "dropped", "--spp", "6", "--techniques", "t"}).find("made without"),
            std::string::npos);
}

TEST_F(Outputs, StrategiesAreOfTheLastRenderAlone) {
  fs::create_directory("t");
  for (const char* name : {"t/s9t9.exr", "t/m2t2-raw.exr", "t/mine.exr", "t/s1t2.exr.txt"}) write_text(name, "old");
  run({"--techniques", "t"});
  EXPECT_FALSE(fs::exists("t/s9t9.exr"));
  EXPECT_FALSE(fs::exists("t/m2t2-raw.exr"));
  EXPECT_TRUE(fs::exists("t/mine.exr"));
  EXPECT_TRUE(fs::exists("t/s1t2.exr.txt"));
  EXPECT_TRUE(fs::exists("t/s1t2.exr"));
}

TEST_F(Outputs, StrategiesOfLongPathsHaveNoImage) {
  run({"--max-depth", "-1", "--techniques", "t"});
  int longest = 0;
  for (const auto& entry : fs::directory_iterator("t")) {
    int s = 0, t = 0;
    ASSERT_EQ(std::sscanf(entry.path().filename().c_str(), "s%dt%d", &s, &t), 2);
    longest = std::max(longest, s + t);
  }
  EXPECT_EQ(longest, most_vertices);
}

// The scene may stand anywhere among the options.
TEST_F(Outputs, FeaturesMayStandBeforeTheScene) {
  testing::internal::CaptureStdout();
  run_command_line({"render", "--aov", "albedo", "box.xml", "-q", "--size", "8x8", "--spp", "1", "-o", "a.exr"});
  testing::internal::GetCapturedStdout();
  EXPECT_EQ(read_picture("a.exr").channels(), 6);
}

TEST_F(Outputs, NamesNeedBeNoText) {
  testing::internal::CaptureStdout();
  run({"-o", "caf\xe9.exr"});
  testing::internal::GetCapturedStdout();
  EXPECT_TRUE(fs::exists("caf\xe9.exr"));
  EXPECT_TRUE(fs::exists("caf\xe9.json"));
}

// The error of all pixels, which a single firefly may rule, stands beside that of the rest.
TEST(Progress, TellsTheErrorWithoutTheWorstPixels) {
  RenderState state;
  state.film = make_film({.width = 64, .height = 64, .crop_width = 64, .crop_height = 64}, {}, false);
  Progress p;
  p.shown = true;
  p.error = {75.8, 0.017}, p.error_next = infinity;
  testing::internal::CaptureStderr();
  show(p, {.spp = 8}, state);
  show(p, {.spp = 8}, state);
  p.terminal = true, p.last = 0, state.stats.seconds = 1;
  show(p, {.spp = 8}, state);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("relMSE ~ 0.017 (75.8 of all)"), std::string::npos) << said;
}

TEST(Versus, OfOnePassNoErrorIsTold) {
  const std::string line = describe(Versus{.integrator = "bdpt"}, RenderState{});
  EXPECT_NE(line.find("cannot be known"), std::string::npos) << line;
  EXPECT_EQ(line.find("inf"), std::string::npos) << line;
}

TEST_F(Outputs, WhatFailsDoesNotKeepTheRestFromBeingWritten) {
  testing::internal::CaptureStderr();
  const std::string thrown = kit::error_of([] {
    write_each({[] { throw Error("first"); }, [] { write_text("b", "x"); }, [] { throw Error("last"); }});
  });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "ajar: first\n");
  EXPECT_EQ(thrown, "last");
  EXPECT_TRUE(fs::exists("b"));
}

TEST_F(Outputs, ALinkToNothingIsTheFileThatItWillBe) {
  fs::create_symlink("state", "l.exr");
  EXPECT_EQ(error_of({"-o", "l.exr", "--checkpoint", "state"}).find("--checkpoint state: is the same file as -o l.exr"),
            0u);
  EXPECT_FALSE(fs::exists("state"));
}

TEST_F(Outputs, APngThatCannotBeWrittenLeavesTheRecord) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  fs::create_symlink("/dev/full", "a.png");
  EXPECT_NE(error_of({"--png"}).find("a.png: cannot be written (No space left"), std::string::npos);
  EXPECT_TRUE(fs::exists("a.exr") && fs::exists("a.json"));
}

TEST_F(Outputs, ASaveThatFailsOnTheWayIsAWarning) {
  Saver saver{"box.xml/state", "key"};
  RenderState state;
  testing::internal::CaptureStderr();
  for (const double seconds : {59.0, 61.0, 122.0}) state.stats.seconds = seconds, saver.save(state);
  const std::string said = testing::internal::GetCapturedStderr();
  const std::string warning = "ajar: warning: box.xml/state: cannot be written";
  EXPECT_NE(said.find(warning), std::string::npos) << said;
  EXPECT_EQ(said.find(warning), said.rfind(warning)) << "said twice";
  EXPECT_EQ(saver.saved, 122);
  Saver other{"state", "key"};
  other.save(state);
  EXPECT_TRUE(fs::exists("state"));
}

}  // namespace
}  // namespace ajar
