// Enters: names of files that come with the sources, or that may lie beside them (scenes and images of other
// renderers). Leaves: their paths; a test that needs what is not there says so and is skipped.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace ajar::kit {

/// A file of the source tree, e.g. "scenes/box/box.xml".
inline std::string source_path(const std::string& name) { return std::string(AJAR_SOURCE_DIR) + "/" + name; }

/// A file of the folder AJAR_SHARED (a CMake variable; by default "shared" beside the source tree), which holds scenes/
/// and references/ that are not part of the sources.
inline std::string shared_path(const std::string& name) { return std::string(AJAR_SHARED_DIR) + "/" + name; }

}  // namespace ajar::kit

/// First line of a test that needs a file which may be missing: skips the test and says why.
#define AJAR_NEEDS(path)                                                     \
  if (const std::string needed_ = (path); !std::filesystem::exists(needed_)) \
  GTEST_SKIP() << "needs " << needed_ << ", which is not there; cmake -DAJAR_SHARED=FOLDER names its home"
