// Enters: the inside of a <scene>.
// Leaves: the Scene that the loader makes of it, or the error it gives; files for it to read.
#pragma once

#include <gtest/gtest.h>

#include "ajar/core/error.h"
#include "ajar/scene/load.h"
#include "kit/files.h"

namespace ajar::kit {

inline const std::string camera_text = "<sensor type='perspective'/>\n";

inline std::string assets() { return source_path("tests/scene/load/assets"); }

/// The text stands on line 2 of "test.xml", after a camera.
inline Scene load_inside(const std::string& inside, const LoadOptions& options = {},
                         const std::string& version = "3.0.0") {
  return load_scene_text("<scene version='" + version + "'>" + camera_text + inside + "</scene>", assets(), "test.xml",
                         options);
}

/// What the error says; empty if there is none.
inline std::string error_of(const std::string& inside, const LoadOptions& options = {}) {
  try {
    load_inside(inside, options);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

/// Writes a file of the test that runs; returns its path.
inline std::string write_file(const std::string& name, const std::string& bytes) {
  const std::string path =
      testing::TempDir() + "ajar-" + testing::UnitTest::GetInstance()->current_test_info()->name() + "-" + name;
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

/// A row of pixels, three numbers each, as they stand.
inline std::string write_pfm(const std::string& name, const std::vector<float>& numbers, size_t rows = 1) {
  const std::string size = std::to_string(numbers.size() / rows / 3) + " " + std::to_string(rows);
  std::string bytes = "PF\n" + size + "\n-1.0\n";
  bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(float));
  return write_file(name, bytes);
}

inline bool says(const std::vector<std::string>& notes, const std::string& words) {
  for (const std::string& note : notes)
    if (note.find(words) != note.npos) return true;
  return false;
}

inline LoadOptions lenient() {
  LoadOptions options;
  options.lenient = true;
  return options;
}

}  // namespace ajar::kit

#define EXPECT_SAYS(text, words) EXPECT_NE((text).find(words), std::string::npos) << "it says: \"" << (text) << '"'
#define EXPECT_RGB(value, r, g, b, tolerance)     \
  do {                                            \
    const ajar::Rgb rgb_ = (value);               \
    EXPECT_NEAR(rgb_.x, r, tolerance) << "red";   \
    EXPECT_NEAR(rgb_.y, g, tolerance) << "green"; \
    EXPECT_NEAR(rgb_.z, b, tolerance) << "blue";  \
  } while (false)
