// ajar render, as a user calls it: the target for the error and what is recorded of it.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "ajar/core/error.h"
#include "ajar/film/picture.h"
#include "app/command_line.h"
#include "app/planning.h"
#include "kit/files.h"

namespace ajar {
namespace {

struct Render : testing::Test {
  std::filesystem::path folder;
  std::string out, log, state;

  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder = std::filesystem::path(testing::TempDir()) /
             ("ajar render " + std::string(info->name()) + " " + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    out = (folder / "image.exr").string(), log = (folder / "log").string(), state = (folder / "state").string();
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  /// Renders the box scene, small; the record.
  nlohmann::json run(std::vector<std::string> arguments) const {
    const std::string box = AJAR_SOURCE_DIR "/scenes/box/box.xml";
    std::vector<std::string> all = {"render", box, "-q", "--max-depth", "4", "-o", out};
    const auto usual = [&](const char* option, const char* value) {
      if (std::find(arguments.begin(), arguments.end(), option) == arguments.end())
        all.insert(all.end(), {option, value});
    };
    usual("--size", "24x16"), usual("--integrator", "path");
    arguments.insert(arguments.begin(), all.begin(), all.end());
    run_command_line(arguments);
    std::ifstream record(folder / "image.json");
    return nlohmann::json::parse(record);
  }

  std::string error_of(const std::string& noise) const {
    try {
      run({"--noise", noise});
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }
};

TEST_F(Render, NoiseStopsAndIsRecorded) {
  const auto json = run({"--noise", "0.02", "--log", log});
  EXPECT_EQ(json["noise"]["target"], 0.02);
  EXPECT_EQ(json["noise"]["reached"], true);
  EXPECT_EQ(json["options"]["noise"], 0.02);
  EXPECT_LE(json["estimated_relmse"].get<double>(), 0.02);
  EXPECT_LE(json["estimated_relmse_trimmed"].get<double>(), json["estimated_relmse"].get<double>());
  EXPECT_EQ(json["interrupted"], false);
  EXPECT_GE(json["spp"].get<double>(), 8);
  std::ifstream lines(log);
  std::string line, last;
  while (std::getline(lines, line)) last = line;
  EXPECT_EQ(nlohmann::json::parse(last)["estimated_relmse"], json["estimated_relmse"]);
}

// The account of the image and of the last line of its log are one and the same.
TEST_F(Render, AccountIsRecorded) {
  const auto json = run({"--spp", "64", "--log", log});
  std::ifstream lines(log);
  std::string line, last;
  while (std::getline(lines, line)) last = line;
  const auto logged = nlohmann::json::parse(last);
  for (const char* key :
       {"mean_path_edges", "light_subpaths_per_sample", "goes_on", "zero_contribution_paths", "tracing", "strategies"})
    EXPECT_EQ(json[key], logged[key]) << key;
  EXPECT_FALSE(json.contains("fields"));
  EXPECT_GT(json["mean_path_edges"]["camera"], 1);
  EXPECT_EQ(json["mean_path_edges"]["light"], 0);
  double energy = 0, time = 0;
  for (const auto& row : json["strategies"]) {
    energy += row["energy"].get<double>(), time += row["time"].get<double>();
    EXPECT_LE(row["s"], 1);
    EXPECT_LE(row["s"].get<int>() + row["t"].get<int>(), 5) << "of at most 4 edges";
  }
  EXPECT_NEAR(energy, 1, 1e-9);
  const auto& tracing = json["tracing"];
  EXPECT_NEAR(time, tracing["joins"].get<double>(), 1e-9);
  double all = 0;
  for (const auto& [part, share] : tracing.items()) all += share.get<double>();
  EXPECT_NEAR(all, 1, 1e-9);
  EXPECT_GT(tracing["camera"], 0.01);
  EXPECT_EQ(tracing["light"], 0);
  EXPECT_GT(tracing["joins"], 0.01);
  EXPECT_EQ(json["cpu_seconds"]["learn"], 0);
  EXPECT_EQ(logged["phases_cpu"]["rebuild"], 0);
}

// Also the time of passes that are not in the image.
TEST_F(Render, RecordsTellOfTheTimeOfLessons) {
  const auto json = run({"--integrator", "guided-path", "--train", "32", "--spp", "1", "--size", "32x32"});
  EXPECT_GT(json["cpu_seconds"]["learn"], 0);
}

TEST_F(Render, WhatGoesOnWithoutLearningTellsOfNoFields) {
  run({"--spp", "2", "--checkpoint", state});
  EXPECT_FALSE(run({"--spp", "4", "--resume", state}).contains("fields"));
  run({"--integrator", "guided-path", "--spp", "2", "--checkpoint", state});
  EXPECT_TRUE(run({"--integrator", "guided-path", "--spp", "4", "--resume", state}).contains("fields"));
}

// The other integrator gets a ninth of the time; what is expected of it scales with the time.
TEST_F(Render, VersusTellsWhatAnotherLeaves) {
  EXPECT_FALSE(run({"--spp", "1"}).contains("versus"));
  const auto json = run({"--cpu-time", "0.6s", "--versus", "bdpt"});
  const auto& v = json["versus"];
  EXPECT_EQ(v["integrator"], "bdpt");
  const double spent = json["cpu_seconds"]["trace"], other = v["cpu_seconds"];
  EXPECT_GE(spent, 0.5);
  EXPECT_GE(other, spent / 9);
  EXPECT_LT(other, spent / 4);
  EXPECT_LT(spent + other, 0.9) << "both together take the budget, and a batch";
  EXPECT_GE(v["spp"].get<double>(), 2);
  const double found = v["estimated_relmse_trimmed"], expected = v["expected_relmse_trimmed"];
  EXPECT_NEAR(expected, found * other / spent, 1e-9 * found);
  EXPECT_NEAR(v["error_ratio"].get<double>(), expected / json["estimated_relmse_trimmed"].get<double>(), 1e-9 * found);
}

// The comparison costs the image nothing but time, and is no part of it.
TEST_F(Render, VersusLeavesTheImageAlone) {
  run({"--spp", "9"});
  std::ifstream first(out, std::ios::binary);
  const std::string plain{std::istreambuf_iterator<char>(first), {}};
  const auto json = run({"--spp", "9", "--versus", "light"});
  EXPECT_EQ(json["spp"], 9);
  std::ifstream second(out, std::ios::binary);
  const std::string held{std::istreambuf_iterator<char>(second), {}};
  const auto pixels = [](const std::string& exr) { return exr.substr(exr.size() / 2); };  // times stand in the header
  EXPECT_EQ(pixels(plain), pixels(held));
}

// A single pass has no second half to compare with: that is said, not made up.
TEST_F(Render, VersusMayHaveTooLittleTime) {
  // The system may pause the pass, which gives the comparison more time: not every time.
  const auto tells = [&] {
    return !run({"--spp", "1", "--versus", "bdpt", "--threads", "1"})["versus"]["error_ratio"].is_null();
  };
  int told = 0;
  while (told < 12 && tells()) ++told;
  EXPECT_LT(told, 12);
}

TEST_F(Render, WhatCannotBeHeldAgainstIsAnError) {
  for (const char* other : {"path", "guided-bdpt", "vcm", "metropolis"}) {
    try {
      run({"--spp", "1", "--versus", other});
      ADD_FAILURE() << other << " is no error";
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find("--versus " + std::string(other) + ": cannot be held against path"), 0u)
          << error.what();
    }
  }
}

// Black has no relative error: the only limit would never be reached.
TEST_F(Render, NoiseAloneEndsWhereAllIsBlack) {
  const auto passes = [&](const std::string& light, const std::string& integrator) {
    const std::string scene = (folder / "scene.xml").string();
    std::ofstream(scene) << "<scene version='3.0.0'><shape type='rectangle'/>" << light << "</scene>";
    testing::internal::CaptureStdout(), testing::internal::CaptureStderr();
    run_command_line({"render", scene, "--noise", "0.01", "--size", "4x4", "--integrator", integrator, "-o", out});
    testing::internal::GetCapturedStdout();
    EXPECT_NE(testing::internal::GetCapturedStderr().find("note: the image is black after"), std::string::npos);
    return nlohmann::json::parse(std::ifstream(folder / "image.json"))["spp"].get<double>();
  };
  EXPECT_EQ(passes("", "path"), 8);
  const std::string aside =
      "<emitter type='spot'><transform name='to_world'><lookat origin='0, 0, 9' target='0, 0, 10' up='0, 1, 0'/>"
      "</transform></emitter>";
  for (const char* integrator : {"path", "bdpt"}) EXPECT_EQ(passes(aside, integrator), 1024) << integrator;
}

TEST_F(Render, NoiseOutOfReachEndsAtTheLimit) {
  const auto counted = run({"--noise", "1e-12", "--spp", "3"});
  EXPECT_EQ(counted["spp"], 3);
  EXPECT_EQ(counted["noise"]["reached"], false);
  const auto timed = run({"--noise", "1e-12", "--time", "0.05s"});
  EXPECT_EQ(timed["noise"]["reached"], false);
  EXPECT_LT(timed["seconds"]["trace"].get<double>(), 2);
  EXPECT_FALSE(run({"--spp", "2"}).contains("noise")) << "no target, nothing to say about it";
}

TEST_F(Render, EndsAtTheFirstLimit) {
  EXPECT_EQ(run({"--spp", "3", "--time", "1h"})["spp"], 3);
  EXPECT_EQ(run({"--spp", "3", "--cpu-time", "1h"})["spp"], 3);
  const auto timed = run({"--spp", "1000000", "--cpu-time", "0.05s"});
  EXPECT_LT(timed["spp"].get<double>(), 1000000);
  EXPECT_EQ(timed["options"]["light_choice"], "tree");
}

// The target is a budget: a render may go on from a state that was made for another. The first is met at the first
// look, after 8 passes; the second cannot be.
TEST_F(Render, ResumeMayAimLower) {
  const double error = run({"--spp", "8"})["estimated_relmse"];
  const std::string low = std::to_string(error / 4);
  const auto straight = run({"--noise", low});
  EXPECT_EQ(run({"--noise", std::to_string(2 * error), "--checkpoint", state})["spp"], 8);
  const auto second = run({"--noise", low, "--resume", state});
  EXPECT_GT(second["spp"].get<double>(), 8);
  EXPECT_EQ(second["spp"], straight["spp"]);
  EXPECT_EQ(second["estimated_relmse"], straight["estimated_relmse"]);
}

// However short the time: an image has a sample in every pixel, and training leaves time for it.
TEST_F(Render, TimeSufficesForAWholePass) {
  const auto spp = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"--size", "160x96", "--cpu-time", "0.0001s"});
    return run(more)["spp"].get<double>();
  };
  EXPECT_EQ(spp({}), 1);
  EXPECT_EQ(spp({"--integrator", "guided-bdpt", "--train", "64"}), 1);
  EXPECT_EQ(spp({"--integrator", "guided-bdpt"}), 1) << "not a pass that only teaches, of a few pixels";
  const auto trained = run({"--integrator", "guided-bdpt", "--train", "64", "--cpu-time", "0.0001s"});
  EXPECT_EQ(trained["fields"]["generation"], 4) << "training ends as soon as it may";
  EXPECT_EQ(run({"--integrator", "guided-bdpt", "--train", "6", "--cpu-time", "1h", "--spp", "1"})["spp"], 1);
}

TEST_F(Render, FirefliesAreLimitedOnRequest) {
  const auto plain = run({"--integrator", "path", "--spp", "4"});
  EXPECT_FALSE(plain["options"].contains("limit_fireflies"));
  const Picture as_it_is = read_picture(out);
  const auto limited = run({"--integrator", "path", "--spp", "4", "--limit-fireflies", "--checkpoint", state});
  EXPECT_EQ(limited["options"]["limit_fireflies"], true);
  const Picture darker = read_picture(out);
  size_t changed = 0;
  for (size_t i = 0; i < darker.pixels.size(); ++i) {
    EXPECT_LE(darker.pixels[i], as_it_is.pixels[i] * 1.0001f);
    changed += darker.pixels[i] < as_it_is.pixels[i] * 0.999f;
  }
  EXPECT_GT(changed, 0u);
  EXPECT_LT(changed, darker.pixels.size() / 2);
  EXPECT_NE(kit::error_of([&] {
              run({"--integrator", "path", "--spp", "8", "--resume", state});
            }).find("other options"),
            std::string::npos);
}

// A checkpoint is of the files that it was made from, wherever they lie.
TEST_F(Render, ResumeKnowsTheFilesOfTheScene) {
  namespace fs = std::filesystem;
  const auto render = [&](const std::string& scene, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"render", scene, "-q", "--size", "8x8", "--integrator", "path", "-o", out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    run_command_line(arguments);
  };
  const auto error = [&](const std::string& scene) {
    return kit::error_of([&] { render(scene, {"--spp", "2", "--resume", state}); });
  };
  for (const char* name : {"here", "there"}) fs::copy(AJAR_SOURCE_DIR "/scenes/box", folder / name);
  render((folder / "here/box.xml").string(), {"--spp", "1", "--checkpoint", state});
  EXPECT_EQ(error((folder / "there/box.xml").string()), "");
  std::ofstream(folder / "there/room.xml", std::ios::app) << " ";
  EXPECT_NE(error((folder / "there/box.xml").string()).find("other options: there files with checksum "),
            std::string::npos);
  EXPECT_NE(error((folder / "here/box.xml").string() + "x"), "");
}

TEST_F(Render, ResumeKnowsTheTimeOfTheScene) {
  const std::string scene = (folder / "moves.xml").string();
  std::ofstream(scene) << R"(<scene version="3.0.0"><sensor type="perspective"/><shape type="sphere">
    <animation name="to_world">
      <transform time="0"><translate z="4"/></transform><transform time="1"><translate z="5"/></transform>
    </animation><emitter type="area"/></shape></scene>)";
  const auto render_at = [&](const char* time, std::vector<std::string> more) {
    more.insert(more.begin(),
                {"render", scene, "-q", "--size", "8x8", "--integrator", "path", "-o", out, "--at", time});
    return kit::error_of([&] { run_command_line(more); });
  };
  EXPECT_EQ(render_at("0", {"--spp", "1", "--checkpoint", state}), "");
  EXPECT_EQ(render_at("0", {"--spp", "2", "--resume", state}), "");
  EXPECT_NE(render_at("1", {"--spp", "2", "--resume", state}).find("\"at\":1"), std::string::npos);
}

TEST_F(Render, TimesAreOfScenesThatMove) {
  EXPECT_NE(kit::error_of([&] {
              run({"--at", "1"});
            }).find("--at 1: nothing in the scene has an <anim"),
            std::string::npos);
  EXPECT_EQ(kit::error_of([&] { run({"--at", "nan"}); }), "--at nan: not a time; write a number");
}

TEST(PlanCommand, SaysWhatItKnows) {
  const auto plan = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"plan", AJAR_SOURCE_DIR "/scenes/box/box.xml"});
    testing::internal::CaptureStderr();
    const std::string error = kit::error_of([&] { run_command_line(arguments); });
    return testing::internal::GetCapturedStderr() + error;
  };
  EXPECT_EQ(plan({"--max-depth", "-7"}), "--max-depth -7: -1 for unlimited, 1 or more edges otherwise");
  EXPECT_EQ(plan({"--max-depth", "0"}), "--max-depth 0: -1 for unlimited, 1 or more edges otherwise");
  EXPECT_EQ(plan({"--max-depth", "4097"}), "--max-depth 4097: paths end at 4096 edges; write that or less, or -1");
  EXPECT_EQ(plan({"--at", "1"}), "--at 1: nothing in the scene has an <animation>; leave it out");
  EXPECT_EQ(plan({"--cpu-time", "1s"}), "ajar: note: --cpu-time 1s is too short to learn anything; give 10s or more\n");
  Plan black;
  black.pilot.emplace();
  EXPECT_EQ(describe(black).find("inf"), std::string::npos);
  EXPECT_NE(describe(black).find("no light was seen"), std::string::npos);
}

TEST_F(Render, WhatIsNoTargetIsAnError) {
  for (const char* noise : {"0", "-0.1", "nan", "inf", "low", "0.1%", "0x1p-3", "1e999"}) {
    const std::string error = error_of(noise);
    EXPECT_EQ(error.find("--noise " + std::string(noise) + ": not a target"), 0u) << noise << ": " << error;
    EXPECT_NE(error.find("0.01"), std::string::npos) << "an example";
  }
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace ajar
