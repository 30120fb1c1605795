// Enters: names of files that come with the sources, or that may lie beside them (scenes and images of other
// renderers). Leaves: their paths and bytes; a test that needs what is not there says so and is skipped. And what a
// call says that fails.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <concepts>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "ajar/core/error.h"

namespace ajar::kit {

/// A file of the source tree, e.g. "scenes/box/box.xml".
inline std::string source_path(const std::string& name) { return std::string(AJAR_SOURCE_DIR) + "/" + name; }

/// A file outside the sources, "scenes/..." or "references/...": in the folder that the environment variable
/// AJAR_SHARED_SCENES names and its neighbour references, else in AJAR_SHARED (a CMake variable; by default the folder
/// shared beside the source tree).
inline std::string shared_path(const std::string& name) {
  const char* scenes = std::getenv("AJAR_SHARED_SCENES");
  const std::filesystem::path home = scenes ? std::filesystem::path(scenes) / ".." : AJAR_SHARED_DIR;
  return (home / name).lexically_normal().string();
}

/// All bytes of a file; empty where there is none.
inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A test with a folder of its own, whose name has a space.
struct InFolder : testing::Test {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) /
      ("ajar " + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) +
       std::to_string(::getpid()));

  InFolder() { std::filesystem::create_directories(folder); }
  ~InFolder() override { std::filesystem::remove_all(folder); }
};

/// What the call says when it throws Error; empty when it does not.
std::string error_of(const std::invocable auto& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace ajar::kit

/// First line of a test that needs a file which may be missing: skips the test and says why.
#define AJAR_NEEDS(path)                                                     \
  if (const std::string needed_ = (path); !std::filesystem::exists(needed_)) \
  GTEST_SKIP() << "needs " << needed_ << ", which is not there; AJAR_SHARED_SCENES names the folder of scenes"
