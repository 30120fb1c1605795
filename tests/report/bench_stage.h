// Enters: nothing.
// Leaves: a tiny suite, a folder for it, and ways to run it.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "ajar/core/error.h"
#include "ajar/report/bench.h"
#include "kit/files.h"

namespace ajar {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

struct Bench : testing::Test {
  fs::path folder;
  BenchOptions options;

  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder = fs::path(testing::TempDir()) / ("ajar bench " + std::string(info->name()) + std::to_string(::getpid()));
    fs::create_directories(folder);
    options.folder = folder / "out";
    options.references = folder / "references";
    options.threads = 2;
    options.version = "1";
  }
  void TearDown() override { fs::remove_all(folder); }

  static Json small() {
    Json json = Json::parse(R"({
      "title": "t", "seeds": 2, "budget": {"spp": 4}, "baseline": "b",
      "methods": [{"name": "p", "integrator": "path"}, {"name": "b", "integrator": "bdpt"}],
      "scenes": [{"name": "s", "size": [16, 12], "max_depth": 3, "reference":
                  {"made_by": [{"integrator": "bdpt", "spp": 64}, {"integrator": "path", "spp": 64}]}}]})");
    json["scenes"][0]["file"] = kit::source_path("scenes/box/box.xml");
    return json;
  }
  Suite suite(const Json& json) const {
    std::ofstream(folder / "s.json") << json.dump();
    return load_suite(folder / "s.json", false);
  }
  Json run(const Json& json) const { return run_bench(suite(json), options); }
  std::string error_of(const Json& json) const {
    try {
      run(json);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }
  /// Stops when the watch has seen so many steps of runs.
  void stop_after(int steps) {
    options.watch = [steps, seen = 0](const BenchProgress& p) mutable {
      return p.what.starts_with("reference") || ++seen < steps;
    };
  }
};

}  // namespace ajar
