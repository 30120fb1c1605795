// ajar bench, as a user calls it.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "ajar/core/error.h"
#include "app/command_line.h"
#include "kit/files.h"

namespace ajar {
namespace {

namespace fs = std::filesystem;

struct BenchCommand : testing::Test {
  fs::path folder;
  std::string suite, out;

  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder = fs::path(testing::TempDir()) / ("ajar command " + std::string(info->name()) + std::to_string(::getpid()));
    fs::create_directories(folder);
    suite = (folder / "s.json").string();
    out = (folder / "out").string();
    nlohmann::json json = nlohmann::json::parse(R"({
      "title": "t", "seeds": 2, "budget": {"spp": 2}, "baseline": "b", "methods": [{"name": "b", "integrator": "path"}],
      "scenes": [{"name": "s", "size": [8, 8], "max_depth": 2, "reference":
                  {"made_by": [{"integrator": "bdpt", "spp": 96}, {"integrator": "path", "spp": 96}]}}],
      "quick": {"seeds": 1}})");
    json["scenes"][0]["file"] = kit::source_path("scenes/box/box.xml");
    std::ofstream(suite) << json.dump();
  }
  void TearDown() override { fs::remove_all(folder); }

  /// Standard output of a run; throws what the command throws.
  static std::string run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "bench");
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    try {
      run_command_line(arguments);
    } catch (...) {
      testing::internal::GetCapturedStdout();
      testing::internal::GetCapturedStderr();
      throw;
    }
    testing::internal::GetCapturedStderr();
    return testing::internal::GetCapturedStdout();
  }
  nlohmann::json results() const { return nlohmann::json::parse(std::ifstream(out + "/results.json")); }
};

// The suite that code builds: another program's, which does not stand beside this one.
TEST_F(BenchCommand, StressSuiteNamesTheProgramThatItNeeds) {
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--threads", "2"}}) {
    std::vector<std::string> arguments = {kit::source_path("benchmarks/stress.json"), "-o", out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    try {
      run(arguments);
      ADD_FAILURE() << "was not refused";
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(more.empty() ? "build it" : "leave them out"), std::string::npos)
          << e.what();
    }
  }
  EXPECT_FALSE(fs::exists(out));
}

TEST_F(BenchCommand, WritesResultsAndPrintsATable) {
  const std::string table = run({suite, "-o", out, "--threads", "1"});
  EXPECT_NE(table.find("baseline"), std::string::npos);
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4) << table;
  EXPECT_TRUE(table.ends_with(out + "/report.html\n")) << table;
  EXPECT_TRUE(fs::exists(out + "/report.html"));
  const auto json = results();
  EXPECT_EQ(json["command"], "ajar bench '" + suite + "' -o '" + out + "' --threads 1");
  EXPECT_EQ(json["machine"]["threads"], 1);
  EXPECT_EQ(json["quick"], false);
  EXPECT_EQ(json["seeds"].size(), 2u);
  EXPECT_TRUE(fs::exists(folder / "references" / "s-8x8-depth2.exr")) << "beside the suite";
}

TEST_F(BenchCommand, QuickAndReferences) {
  run({suite, "-o", out, "--quick", "--references", (folder / "elsewhere").string()});
  EXPECT_EQ(results()["quick"], true);
  EXPECT_EQ(results()["seeds"].size(), 1u);
  EXPECT_TRUE(fs::exists(folder / "elsewhere" / "s-8x8-depth2.exr"));
  EXPECT_THROW(run({suite, "-o", out}), Error) << "the folder holds the quick version's runs";
  const std::string unclaimed = (folder / "unclaimed").string();
  EXPECT_THROW(run({suite, "-o", unclaimed, "--references", suite}), Error) << "is a file";
  EXPECT_FALSE(fs::exists(unclaimed));
}

TEST_F(BenchCommand, ARefusedReferenceIsAnErrorAtTheEnd) {
  auto json = nlohmann::json::parse(std::ifstream(suite));
  json["scenes"].push_back(json["scenes"][0]);
  json["scenes"][1]["name"] = "black";
  json["scenes"][1]["file"] = kit::source_path("scenes/mirrors/mirrors.xml");
  std::ofstream(suite) << json.dump();
  try {
    run({suite, "-o", out});
    ADD_FAILURE() << "was not refused";
  } catch (const Error& e) {
    EXPECT_TRUE(std::string(e.what()).ends_with("does light reach the camera within max_depth?")) << e.what();
  }
  EXPECT_EQ(results()["scenes"][0]["methods"].size(), 1u);
  EXPECT_TRUE(fs::exists(out + "/report.html"));
}

TEST_F(BenchCommand, CommandsAreForAShell) {
  const std::string place = out + " it's\xe9";  // nor is it UTF-8
  run({suite, "-o", place});
  const auto json = nlohmann::json::parse(std::ifstream(place + "/results.json"));
  EXPECT_EQ(json["command"], "ajar bench '" + suite + "' -o '" + out + " it'\\''s\xef\xbf\xbd'");
  EXPECT_NO_THROW(run({suite, "-o", place})) << "the same runs";
}

TEST_F(BenchCommand, ASuiteIsNotWrittenOver) {
  fs::create_directories(out);
  fs::rename(suite, out + "/results.json");
  const std::string before = kit::bytes_of(out + "/results.json");
  EXPECT_THROW(run({out + "/results.json", "-o", out}), Error);
  EXPECT_EQ(kit::bytes_of(out + "/results.json"), before);
}

// The first seed's image would take its place.
TEST_F(BenchCommand, AReferenceIsNotWrittenOver) {
  const fs::path image = fs::path(out) / "images/s/b.exr";
  fs::create_directories(image.parent_path());
  std::ofstream(image) << "mine";
  nlohmann::json json = nlohmann::json::parse(std::ifstream(suite));
  json["scenes"][0]["reference"] = {{"image", "out/images/s/b.exr"}};
  std::ofstream(suite) << json.dump();
  const std::string error = kit::error_of([&] { run({suite, "-o", out}); });
  EXPECT_NE(error.find("b.exr lies where bench writes its own"), std::string::npos) << error;
  EXPECT_EQ(kit::bytes_of(image), "mine");
}

// Names may hold anything.
TEST_F(BenchCommand, ErrorsAreOneLine) {
  nlohmann::json json = nlohmann::json::parse(std::ifstream(suite));
  json["methods"][0]["name"] = std::string("a\nb\0c", 5);
  std::ofstream(suite) << json.dump();
  const std::string error = kit::error_of([&] { run({suite, "-o", out}); });
  EXPECT_NE(error.find("a b c"), std::string::npos) << error;
  EXPECT_EQ(error.find('\n'), std::string::npos);
}

TEST_F(BenchCommand, ErrorsComeBeforeAnythingIsWritten) {
  std::ofstream(suite) << R"({"title": "t"})";
  EXPECT_THROW(run({suite, "-o", out}), Error);
  EXPECT_FALSE(fs::exists(out));
  EXPECT_THROW(run({suite}), Error);
}

}  // namespace
}  // namespace ajar
