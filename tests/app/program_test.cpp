// The program itself: exit codes and what it says on stderr.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "kit/files.h"

namespace ajar {
namespace {

namespace fs = std::filesystem;

struct Program : kit::InFolder {
  void SetUp() override {
    fs::create_directories(folder / "there");
    fs::permissions(folder, fs::perms::all);
    for (const char* name : {"box.xml", "room.xml"})
      fs::copy_file(kit::source_path("scenes/box/" + std::string(name)), folder / name);
  }

  /// Exit code of a line of the shell, in the folder; $ajar is the program.
  int run(const std::string& line) const {
    const std::string all =
        "cd '" + folder.string() + "' && ajar='" AJAR_PROGRAM "' && exec 2>said && rm -f out && { " + line + "; } >out";
    const int status = std::system(all.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string said() const { return kit::bytes_of(folder / "said"); }
  bool is_there(const std::string& name) const { return fs::exists(folder / name); }
};

const std::string small = " --size 8x8 --max-depth 3 -q ";
// What follows gets a signal once a file is there.
std::string stopped(const std::string& command, const std::string& file, const std::string& signal,
                    const std::string& first = ":") {
  return command + " & p=$!; while [ ! -s " + file + " ] && kill -0 $p 2>&-; do sleep 0.02; done; " + first +
         "; kill -" + signal + " $p; wait $p";
}

TEST_F(Program, InterruptedRendersSaySoAndKeepWhatIsDone) {
  const std::string endless = "\"$ajar\" render box.xml --integrator path --spp 1000000000 --log log -o a.exr" + small;
  for (const auto& [signal, code] : {std::pair{"INT", 130}, {"TERM", 143}, {"HUP", 129}}) {
    for (const char* old : {"a.exr", "log"}) fs::remove(folder / old);
    EXPECT_EQ(run(stopped(endless, "log", signal)), code) << said();
    EXPECT_TRUE(is_there("a.exr")) << signal;
    EXPECT_TRUE(is_there("a.json")) << signal;
    EXPECT_NE(said().find("ajar: interrupted after "), std::string::npos) << said();
  }
}

// A checkpoint in the first minute, an image in the first pass: what an earlier render left is worth more.
TEST_F(Program, WhatIsStoppedEarlyReplacesNoEarlierWork) {
  const std::string render = "\"$ajar\" render box.xml --integrator bdpt -o a.exr --checkpoint ck --techniques layers ";
  ASSERT_EQ(run(render + "--spp 4" + small), 0) << said();
  const auto layers = [&] { return std::distance(fs::directory_iterator(folder / "layers"), {}); };
  const std::string image = kit::bytes_of(folder / "a.exr"), state = kit::bytes_of(folder / "ck");
  const auto count = layers();
  ASSERT_GT(count, 0);
  const std::string large = render + "--spp 1000000000 --size 512x512 --max-depth 3";
  EXPECT_EQ(run(stopped(large, "said", "INT")), 130) << said();
  EXPECT_NE(said().find("ajar: interrupted in the first pass"), std::string::npos) << said();
  EXPECT_NE(said().find("; a.exr and ck are left as they were\n"), std::string::npos) << said();
  EXPECT_TRUE(kit::bytes_of(folder / "a.exr") == image);
  EXPECT_TRUE(kit::bytes_of(folder / "ck") == state);
  EXPECT_EQ(layers(), count);
  EXPECT_EQ(run(stopped(render + "--spp 1000000000 --log log" + small, "log", "INT")), 130) << said();
  EXPECT_NE(said().find("; a.exr has what was done; ck is left as it was\n"), std::string::npos) << said();
  EXPECT_FALSE(kit::bytes_of(folder / "a.exr") == image);
  EXPECT_TRUE(kit::bytes_of(folder / "ck") == state);
  const std::string log = kit::bytes_of(folder / "log");
  EXPECT_EQ(run(stopped(large + " --log log", "said", "INT")), 130) << said();
  EXPECT_NE(said().find("; a.exr, ck and log are left as they were\n"), std::string::npos) << said();
  EXPECT_TRUE(kit::bytes_of(folder / "log") == log);
  ASSERT_GT(log.size(), 0u);
  ASSERT_EQ(run("\"$ajar\" render box.xml --integrator bdpt -o b.exr --spp 4 --log log" + small), 0) << said();
  EXPECT_LT(kit::bytes_of(folder / "log").size(), log.size()) << "begun anew";
  fs::remove(folder / "log");
  EXPECT_EQ(run(stopped(render + "--resume ck --spp 1000000000 --log log" + small, "log", "INT")), 130) << said();
  EXPECT_FALSE(kit::bytes_of(folder / "ck") == state) << "which it goes on from";
}

// Going on from one thing is no leave to replace another.
TEST_F(Program, WhatIsStoppedEarlyReplacesNothingThatItDoesNotGoOnFrom) {
  const std::string render = "\"$ajar\" render box.xml --integrator guided-bdpt --plan all --threads 1 -o a.exr ";
  ASSERT_EQ(run(render + "--spp 4 --checkpoint ck --save-fields learned" + small), 0) << said();
  fs::copy_file(folder / "ck", folder / "other");
  const std::string state = kit::bytes_of(folder / "other"), fields = kit::bytes_of(folder / "learned");
  const std::string on = render + "--spp 1000000000 --log log" + small;
  EXPECT_EQ(run(stopped(on + "--resume ck --checkpoint other", "log", "INT")), 130) << said();
  EXPECT_NE(said().find("; other is left as it was\n"), std::string::npos) << said();
  EXPECT_TRUE(kit::bytes_of(folder / "other") == state);
  fs::remove(folder / "log");
  EXPECT_EQ(run(stopped(on + "--save-fields learned", "log", "INT")), 130) << said();
  EXPECT_NE(said().find("; learned is left as it was\n"), std::string::npos) << said();
  EXPECT_TRUE(kit::bytes_of(folder / "learned") == fields);
  fs::remove(folder / "log");
  EXPECT_EQ(run(stopped(on + "--load-fields learned --save-fields learned", "log", "INT")), 130) << said();
  EXPECT_FALSE(kit::bytes_of(folder / "learned") == fields) << "which it goes on from";
}

// What a checkpoint does not read does not stand in its way.
TEST_F(Program, CheckpointsOfWhatLearnsNothingGoOn) {
  const std::string render = "\"$ajar\" render box.xml -o a.exr --checkpoint ck ";
  ASSERT_EQ(run(render + "--plan auto --even --spp 2" + small), 0) << said();
  EXPECT_EQ(run(render + "--resume ck --spp 4" + small), 0) << said();
  EXPECT_EQ(run(render + "--resume ck --plan all --spp 6" + small), 0) << said();
}

TEST_F(Program, PinnedProgramsCountTheProcessorsThatAreTheirs) {
  const std::string mine = "$(taskset -cp $$ | sed 's/.*: //; s/[-,].*//')";
  ASSERT_EQ(run("taskset -c " + mine + " \"$ajar\" render box.xml --spp 1 -o a.exr" + small), 0) << said();
  EXPECT_NE(kit::bytes_of(folder / "a.json").find("\"threads\": 1,"), std::string::npos);
}

TEST_F(Program, NohupHoldsOffTheEndOfTheTerminalAndATrapTheEndOfAService) {
  const std::string render = "\"$ajar\" render box.xml --integrator path --time 1s --log log -o a.exr" + small;
  EXPECT_EQ(run("trap '' HUP; " + stopped(render, "log", "HUP")), 0) << said();
  fs::remove(folder / "log");
  EXPECT_EQ(run("trap '' TERM; " + stopped(render, "log", "TERM")), 0) << said();
}

TEST_F(Program, InterruptedBenchesGoOn) {
  std::ofstream(folder / "s.json") << R"({"title": "t", "seeds": 1, "budget": {"spp": 100000000}, "baseline": "b",
    "methods": [{"name": "b", "integrator": "path"}], "scenes": [{"name": "s", "file": "box.xml", "size": [8, 8],
    "reference": {"made_by": [{"integrator": "bdpt", "spp": 100000000}, {"integrator": "path", "spp": 100000000}]}}]})";
  EXPECT_EQ(run(stopped("\"$ajar\" bench s.json -q -o b", "b/suite.json", "TERM")), 143) << said();
  EXPECT_NE(said().find("ajar: interrupted; the same command goes on"), std::string::npos) << said();
}

TEST_F(Program, InterruptedPilotsPlanNothing) {
  const auto after_a_while = [](const std::string& command) {
    return command + " & p=$!; sleep 0.7; kill -TERM $p; wait $p";
  };
  EXPECT_EQ(run(after_a_while("\"$ajar\" plan box.xml --cpu-time 10h")), 143) << said();
  EXPECT_EQ(kit::bytes_of(folder / "out"), "");
  EXPECT_EQ(run(after_a_while("\"$ajar\" animate box.xml --frames 2 --spp 100000000 -q -o f/f_%d.exr")), 143) << said();
}

// Ctrl-C in a pipe ends the reader first.
TEST_F(Program, WhatIsDoneIsKeptWhereNobodyReads) {
  const std::string endless =
      "\"$ajar\" render box.xml --integrator path --spp 1000000000 --log log -o a.exr --checkpoint ck --size 8x8";
  run("{ " + stopped(endless, "log", "INT") + "; echo $? >code; } 2>&1 | true");
  EXPECT_EQ(kit::bytes_of(folder / "code"), "130\n");
  for (const char* name : {"a.exr", "a.json", "ck"}) EXPECT_TRUE(is_there(name)) << name;
  EXPECT_EQ(run("{ sleep 0.2; \"$ajar\" render --help; echo $? >code; } | true"), 0);
  EXPECT_EQ(kit::bytes_of(folder / "code"), "141\n") << "as shells have it, without a word";
  EXPECT_EQ(said(), "");
}

TEST_F(Program, AStreamThatIsClosedIsNoFile) {
  const std::string render = "\"$ajar\" render box.xml --integrator path --spp 4 --log log -o a.exr --size 8x8 ";
  for (const char* closed : {"2>&-", ">&- 2>&-", "<&- >&- 2>&-"}) {
    EXPECT_EQ(run(render + closed), 0) << closed;
    const std::string log = kit::bytes_of(folder / "log");
    EXPECT_EQ(log[0], '{') << log;
    EXPECT_EQ(log.find("spp  "), log.npos) << log;
    EXPECT_TRUE(log.ends_with("}\n")) << log;
  }
}

TEST_F(Program, AFileThatGrowsTooLargeIsAnError) {
  const std::string render = "\"$ajar\" render box.xml --integrator path --spp 1 -q -o there/a.exr --size 64x64";
  EXPECT_EQ(run("(ulimit -f 4; " + render + ")"), 2) << said();
  EXPECT_NE(said().find("there/a.exr: cannot be written (File too large); free some space, raise the limit"),
            std::string::npos)
      << said();
  EXPECT_TRUE(fs::is_empty(folder / "there"));
}

TEST_F(Program, FilmsThatAreInterruptedSaySo) {
  std::ofstream(folder / "ffmpeg") << "#!/bin/sh\nfor last; do :; done; echo >$last; kill -INT $PPID; exec sleep 60\n";
  fs::permissions(folder / "ffmpeg", fs::perms::all);
  const std::string animate = "PATH=$PWD:$PATH \"$ajar\" animate box.xml --integrator path --frames 2 --spp 1 ";
  EXPECT_EQ(run(animate + "-o there/f_%d.exr --video film.mp4" + small), 130);
  EXPECT_NE(said().find("ajar: interrupted; film.mp4 is not made"), std::string::npos) << said();
  EXPECT_TRUE(is_there("there/animation.json"));
  for (const auto& entry : fs::directory_iterator(folder)) EXPECT_NE(entry.path().extension(), ".mp4") << entry.path();
}

TEST_F(Program, InterruptedAnimationsTellOfTheFramesThatAreThere) {
  const std::string frames = "\"$ajar\" animate box.xml --frames 2000 -D back=-1..-2 --spp 1 --size 8x8 -q ";
  EXPECT_EQ(run(stopped(frames + "--integrator path -o f/f_%d.exr", "f/f_0.exr", "INT")), 130) << said();
  EXPECT_NE(said().find("the same command goes on from there"), std::string::npos) << said();
  for (const char* name : {"f/animation.json", "f/animation.csv", "f/animation.svg"})
    EXPECT_TRUE(is_there(name)) << name;
  EXPECT_EQ(run(stopped(frames + "--integrator path -o g/f_%d.exr", "g/f_0.exr", "INT", "mkdir g/animation.json")), 130)
      << said();
  EXPECT_NE(said().find("ajar: warning: g/animation.json"), std::string::npos) << said();
  EXPECT_NE(said().find("the same command goes on from there"), std::string::npos) << said();
}

TEST_F(Program, MistypedOptionsAreToldFirst) {
  for (const auto& [words, says] : {std::pair{"render --foo", "ajar: --foo: there is no such option; see ajar render"},
                                    {"--foo", "ajar: --foo: there is no such option; see ajar --help"},
                                    {"render --fo box.xml", "ajar: --fo: there is no such option"},
                                    {"render box.xml -o a.exr -D x=1 -D x=2", "ajar: -D x=2: x is given twice"},
                                    {"plan box.xml -D x=1 -D x=2", "ajar: -D x=2: x is given twice"},
                                    {"render box.xml -o a.exr --integrator light --heuristic balance",
                                     "ajar: --heuristic balance: light has one way to each path"},
                                    {"render box.xml --time 5s --time 6s", "ajar: --time: given twice; leave one"}}) {
    EXPECT_EQ(run("\"$ajar\" " + std::string(words)), 2) << words;
    EXPECT_EQ(said().find(says), 0u) << words << ": " << said();
  }
}

TEST_F(Program, WhatIsNoValueIsToldWithTheCure) {
  for (const auto& [words, says] :
       {std::pair{"render box.xml --max-depth x", "--max-depth x: is no number that fits here; write one"},
        {"render box.xml -D", "-D: has no value; write one after it"},
        {"compare a b --crop 1", "--crop: takes 4 values, not 1; write them all"},
        {"compare a b c", "c: more words than are asked for; leave them out"},
        {"render box.xml --heuristic best", "--heuristic best: is none of balance,power; write one"},
        {"animate box.xml -o f_%d.exr --forget 1", "--forget: 1 is no number from 0 to 0.999"}}) {
    EXPECT_EQ(run("\"$ajar\" " + std::string(words)), 2) << words;
    EXPECT_EQ(said().find("ajar: " + std::string(says)), 0u) << words << ": " << said();
  }
  EXPECT_EQ(run("\"$ajar\" compare a b $(head -c 100000 /dev/zero | tr '\\0' x)"), 2) << "however long it is";
}

TEST_F(Program, WordsThatAreNoCommandAreNamed) {
  EXPECT_EQ(run("\"$ajar\" rendr box.xml"), 2);
  EXPECT_EQ(said().find("ajar: rendr: there is no such command; known are render, "), 0u) << said();
  EXPECT_EQ(run("\"$ajar\" render --nope box.xml"), 2);
  EXPECT_NE(said().find("; see ajar render --help\n"), std::string::npos) << said();
  EXPECT_EQ(run("\"$ajar\""), 2);
  EXPECT_NE(said().find("; see ajar --help\n"), std::string::npos) << said();
}

TEST_F(Program, EmptyValuesAreErrors) {
  for (const auto& [words, cure] : {std::pair{"render box.xml -o ''", "leave it out"},
                                    {"render box.xml --plan ''", "leave it out"},
                                    {"plan box.xml --cpu-time ''", "leave it out"},
                                    {"animate box.xml -o ''", "give it a value"}}) {
    EXPECT_EQ(run("\"$ajar\" " + std::string(words)), 2) << words;
    EXPECT_NE(said().find("is empty; " + std::string(cure)), std::string::npos) << words << ": " << said();
  }
}

TEST_F(Program, AFullStandardOutputIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  for (const char* words : {"--help", "render --help", "plan box.xml --cpu-time 1s --size 8x8"}) {
    EXPECT_EQ(run("\"$ajar\" " + std::string(words) + " >/dev/full"), 2) << words;
    EXPECT_EQ(said().find("ajar: "), 0u) << said();
  }
}

// Whatever lies in the way: a line that begins with the program's name, and no abort.
TEST_F(Program, FoldersThatMayNotBeReadAreErrors) {
  const std::string nobody = ::geteuid() == 0 ? "setpriv --reuid=65534 --regid=65534 --clear-groups " : "";
  const std::string program = nobody + "\"$ajar\" ";
  if (run(program + "--version") != 0) GTEST_SKIP() << "nobody may run the program: " << said();
  fs::create_directories(folder / "secret/deep");
  fs::permissions(folder / "secret", fs::perms::none);
  std::ofstream(folder / "s.json") << R"({"title": "t", "seeds": 1, "budget": {"spp": 1}, "baseline": "b",
    "methods": [{"name": "b", "integrator": "path"}], "scenes": [{"name": "s", "file": "box.xml", "size": [8, 8],
    "reference": {"made_by": [{"integrator": "bdpt", "spp": 96}, {"integrator": "path", "spp": 96}]}}]})";
  const std::string render = "render box.xml --spp 1 --integrator guided-bdpt" + small;
  for (const std::string& words :
       {render + "-o secret/deep/a.exr", render + "-o a.exr --save-fields secret/x/f",
        render + "-o a.exr --resume secret/s", render + "-o a.exr --load-fields secret/s",
        render + "-o a.exr --techniques secret/t", std::string("fields secret/learned"), std::string("report secret"),
        std::string("bench s.json -q -o secret/b"), std::string("bench there -o b"),
        std::string("animate box.xml --frames 2 --keyframes there -o f/f_%d.exr"),
        std::string("animate box.xml --frames 2 --spp 1 -o secret/x/f_%d.exr")}) {
    EXPECT_EQ(run(program + words), 2) << words << ": " << said();
    EXPECT_EQ(said().find("ajar: "), 0u) << words << ": " << said();
    EXPECT_FALSE(is_there("a.exr")) << words;
  }
  fs::permissions(folder / "secret", fs::perms::owner_all);
}

}  // namespace
}  // namespace ajar
