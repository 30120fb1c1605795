// Enters: a suite.
// Leaves: a folder with every method's error against time on every scene (docs/bench.md has its files).
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "ajar/report/suite.h"

namespace ajar {

/// What is being rendered, the share of its kind that is done, and the seconds that the rest may take (infinite: not
/// known yet).
struct BenchProgress {
  std::string what;
  double share = 0, left = infinity;
};
/// Returns false to stop. Called a few times a second at most for images that take long, off the clock.
using BenchWatch = std::function<bool(const BenchProgress&)>;

struct BenchOptions {
  std::filesystem::path folder;      ///< is made; finished runs in it are not run again
  std::filesystem::path references;  ///< folder of references that are made once
  int threads = 0;                   ///< 0: all
  std::string command, version;      ///< for the record
  std::string build;                 ///< what tells this program from others of its version
  BenchWatch watch;                  ///< may be empty
};

/// What it writes beside the folders runs, images, techniques and fields.
inline constexpr const char* bench_files[] = {"suite.json", "results.json", "results.csv", "report.html", "curves.svg"};

/// Makes the references that are missing, renders every method on every scene with every seed, the methods of a scene
/// and seed in turns, and writes results.json, results.csv, images and runs. When the watch stops it, writes what is
/// done and "interrupted": true; called again it goes on. A scene whose reference is refused is left out, and
/// "refused" lists why. Throws Error, before anything is rendered where that can be
/// known: also when the folder holds another suite's runs.
nlohmann::ordered_json run_bench(const Suite& suite, const BenchOptions& options);

/// results.csv: one row per sample.
std::string results_csv(const nlohmann::ordered_json& results);
/// For people: a line per scene and method.
std::string results_table(const nlohmann::ordered_json& results);

}  // namespace ajar
