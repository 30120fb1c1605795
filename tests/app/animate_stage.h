// Enters: the arguments of ajar animate, and a small room with a door.
// Leaves: frames in a folder of their own, and what is in them.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "ajar/film/picture.h"
#include "app/command_line.h"
#include "kit/files.h"

#define EXPECT_SAYS(text, words)                                                \
  if (const std::string said_ = (text); said_.find(words) == std::string::npos) \
  ADD_FAILURE() << "it says: \"" << said_ << "\", without " << (words)

namespace ajar {

struct Animate : testing::Test {
  std::filesystem::path folder;

  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder = std::filesystem::path(testing::TempDir()) /
             ("ajar animate " + std::string(info->name()) + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    write("room.xml", R"(<scene version="3.0.0">
      <default name="door" value="1"/>
      <sensor type="perspective"><float name="fov" value="60"/>
        <transform name="to_world"><lookat origin="0, 0, 3.5" target="0, 0, 0" up="0, 1, 0"/></transform>
        <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="12"/>
          <rfilter type="box"/></film></sensor>
      <shape type="cube"><transform name="to_world"><scale value="-4"/></transform></shape>
      <shape type="rectangle"><transform name="to_world"><scale value="0.6"/><translate x="$door"/></transform></shape>
      <shape type="sphere"><point name="center" x="-1.5" y="1.5" z="1"/><float name="radius" value="0.3"/>
        <emitter type="area"><rgb name="radiance" value="20, 18, 15"/></emitter></shape>
    </scene>)");
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(folder / name) << text; }
  std::string in(const std::string& name) const { return (folder / name).string(); }

  void run(const std::string& frames, const std::string& out, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {"animate", in("room.xml"),          "-q", "--frames",      frames,
                                          "-o",      in(out) + "/f_%02d.exr", "-D", "door=0.2..1.4", "--threads",
                                          "1"};
    const auto otherwise = [&](const char* option, const char* value) {
      if (std::find(more.begin(), more.end(), option) == more.end()) more.insert(more.end(), {option, value});
    };
    otherwise("--spp", "2"), otherwise("--integrator", "guided-bdpt");
    if (std::find(more.begin(), more.end(), "path") == more.end()) otherwise("--teach", "1");
    arguments.insert(arguments.end(), more.begin(), more.end());
    run_command_line(arguments);
  }
  std::vector<float> pixels(const std::string& name) const { return read_picture(in(name)).pixels; }
  nlohmann::json figures(const std::string& out) const {
    std::ifstream file(in(out) + "/animation.json");
    return nlohmann::json::parse(file);
  }
};

}  // namespace ajar
