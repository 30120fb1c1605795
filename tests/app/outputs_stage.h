// Enters: options of ajar render.
// Leaves: what it makes of them, or what it says, in a folder of the test's own with the scene box.xml.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "app/command_line.h"
#include "kit/files.h"

namespace ajar {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

struct Outputs : testing::Test {
  fs::path folder, before = fs::current_path();

  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder = fs::path(testing::TempDir()) / ("ajar outputs " + std::string(info->name()) + std::to_string(::getpid()));
    fs::create_directories(folder / "there");
    for (const char* name : {"box.xml", "room.xml"})
      fs::copy_file(kit::source_path("scenes/box/" + std::string(name)), folder / name);
    fs::current_path(folder);
  }
  void TearDown() override {
    fs::current_path(before);
    fs::remove_all(folder);
  }

  static void run(Words more) {
    more.insert(more.begin(), {"render", "box.xml", "-q", "--size", "8x8"});
    for (const Words& usual :
         {Words{"--max-depth", "3"}, Words{"--integrator", "bdpt"}, Words{"--spp", "2"}, Words{"-o", "a.exr"}})
      if (std::find(more.begin(), more.end(), usual[0]) == more.end())
        more.insert(more.end(), usual.begin(), usual.end());
    run_command_line(more);
  }
  static std::string error_of(const Words& more) {
    try {
      run(more);
    } catch (const std::exception& e) {
      return e.what();
    }
    return {};
  }
  static size_t count(const std::string& path = ".") { return size_t(std::distance(fs::directory_iterator(path), {})); }
};

}  // namespace ajar
