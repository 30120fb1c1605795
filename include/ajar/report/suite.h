// Enters: a suite file: scenes, methods, seeds and a budget (docs/bench.md).
// Leaves: the same as data, checked: every name known, every file there.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ajar/render/options.h"

namespace ajar {

/// Exactly one is set: CPU seconds of all threads, wall seconds, or samples per pixel.
struct Budget {
  double cpu_seconds = 0, seconds = 0;
  uint32_t spp = 0;
};

struct Method {
  std::string name;
  RenderOptions options;  ///< budget, seed, threads and depth are set by who renders
};

/// One of the two long renders that a reference is made of.
struct ReferencePart {
  RenderOptions options;
  Budget budget;
};

struct BenchScene {
  std::string name;
  std::string file;  ///< as the suite has it
  std::filesystem::path path;
  std::string missing;  ///< why an optional scene is left out; empty otherwise
  std::map<std::string, std::string> defines;
  int width = 0, height = 0;         ///< 0: the scene's own
  std::optional<int> max_depth;      ///< edges, -1: unlimited; nothing: the scene's own
  std::filesystem::path reference;   ///< an image that is there; empty: made from the parts
  std::vector<ReferencePart> parts;  ///< two, of different integrators
};

struct Suite {
  std::filesystem::path path;
  std::string title;
  bool quick = false, techniques = false;
  std::vector<uint64_t> seeds;
  Budget budget;
  std::vector<BenchScene> scenes;
  std::vector<Method> methods;
  std::string baseline;  ///< name of a method
};

/// Reads a suite; quick applies its overrides of that name. Files are looked for beside the suite, in the folder of
/// shared scenes (environment variable AJAR_SHARED_SCENES, else ../../shared/scenes from the suite) and beside that.
/// Throws Error that names file, element and cure.
Suite load_suite(const std::filesystem::path& path, bool quick);

/// What decides the figures, for telling whether two suites are the same: all but the title and where files lie, and
/// but the references, which records know by their bytes.
nlohmann::ordered_json to_json(const Suite& suite);
nlohmann::ordered_json to_json(const Budget& budget);
/// The options that a suite may set: all of them, or the integrator and those that differ from their defaults (which is
/// what tells requests apart, whatever options later versions add).
nlohmann::ordered_json options_json(const RenderOptions& options, bool all = true);
/// The options with a budget taken from the suite, or a part of it.
RenderOptions with_budget(RenderOptions options, const Budget& budget);

}  // namespace ajar
