// Learned fields, as a user meets them: the options of ajar render that have to do with them, and ajar fields.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "ajar/core/error.h"
#include "ajar/film/picture.h"
#include "app/arguments.h"
#include "app/command_line.h"

namespace ajar {
namespace {

const std::string box = AJAR_SOURCE_DIR "/scenes/box/box.xml";

struct FieldsUsed : testing::Test {
  std::filesystem::path folder;
  std::string out, fields, state;

  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder = std::filesystem::path(testing::TempDir()) /
             ("ajar fields " + std::string(info->name()) + " " + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    out = (folder / "image.exr").string(), fields = (folder / "fields").string(), state = (folder / "state").string();
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  /// Renders the box, small; the record.
  nlohmann::json render(const std::vector<std::string>& more, const std::string& integrator = "guided-bdpt") const {
    std::vector<std::string> arguments = {"render",       box,        "-q", "--size", "24x16", "--max-depth", "4",
                                          "--integrator", integrator, "-o", out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    run_command_line(arguments);
    std::ifstream record(folder / "image.json");
    return nlohmann::json::parse(record);
  }
  template <class Call>
  static std::string error(const Call& call) {
    try {
      call();
    } catch (const std::exception& e) {
      return e.what();
    }
    return {};
  }
  std::string told(std::vector<std::string> more) const {
    more.insert(more.begin(), {"fields", fields});
    testing::internal::CaptureStdout();
    const std::string wrong = error([&] { run_command_line(more); });
    const std::string text = testing::internal::GetCapturedStdout();
    EXPECT_EQ(wrong, "");
    return text;
  }
};

TEST_F(FieldsUsed, AreRecorded) {
  const auto json = render({"--spp", "9", "--save-fields", fields});
  EXPECT_EQ(json["spp"], 9);
  EXPECT_EQ(json["options"]["guide"], "both");
  EXPECT_EQ(json["options"]["field_memory"], 8 << 20);
  EXPECT_EQ(json["options"]["save_fields"], fields);
  EXPECT_EQ(json["fields"]["dropped_passes"], 4);
  EXPECT_GE(json["fields"]["generation"], 8);
  EXPECT_GT(json["fields"]["cells"], 10);
  EXPECT_GE(json["fields"]["nodes"]["q"], json["fields"]["cells"]);
  EXPECT_GE(json["fields"]["nodes"]["w"], json["fields"]["cells"]);
  EXPECT_GT(json["fields"]["bytes"], 1000);
  for (const char* clock : {"seconds", "cpu_seconds"}) {
    EXPECT_GE(json[clock]["learn"], 0) << clock;
    EXPECT_GT(json[clock]["rebuild"], 0) << clock;
    EXPECT_GT(json[clock]["trace"], 0) << clock;
  }
  const auto plain = render({"--spp", "1"}, "bdpt");
  EXPECT_FALSE(plain.contains("fields"));
  EXPECT_FALSE(plain["options"].contains("guide"));
  EXPECT_EQ(plain["seconds"]["rebuild"], 0);
}

TEST_F(FieldsUsed, LoadedFieldsSpareTheYoungPasses) {
  const auto first = render({"--spp", "9", "--save-fields", fields});
  const auto second = render({"--spp", "16", "--load-fields", fields, "--plan", "all"});
  EXPECT_EQ(second["spp"], 16);
  EXPECT_EQ(second["options"]["load_fields"], fields);
  EXPECT_EQ(second["fields"]["dropped_passes"], 0);
  EXPECT_GT(second["fields"]["generation"], first["fields"]["generation"]);
}

TEST_F(FieldsUsed, LoadedFieldsThatTakeTooMuchDoNotGrow) {
  const auto first = render({"--spp", "9", "--save-fields", fields});
  const std::vector<std::string> more = {"--spp", "16", "--load-fields", fields, "--plan", "all"};
  EXPECT_GT(render(more)["fields"]["cells"], first["fields"]["cells"]);
  std::vector<std::string> little = more;
  little.insert(little.end(), {"--field-memory", "64K"});
  EXPECT_EQ(render(little)["fields"]["cells"], first["fields"]["cells"]);
}

TEST_F(FieldsUsed, GuideAndMemoryAreObeyed) {
  const auto both = render({"--spp", "9"});
  const Picture image = read_picture(out);
  for (const char* side : {"camera", "light"}) {
    EXPECT_EQ(render({"--spp", "9", "--guide", side})["options"]["guide"], side);
    EXPECT_NE(read_picture(out).pixels, image.pixels) << side;
  }
  const auto small = render({"--spp", "9", "--field-memory", "64K"});
  EXPECT_EQ(small["options"]["field_memory"], 64 << 10);
  EXPECT_LT(small["fields"]["cells"], both["fields"]["cells"]);
  for (const char* structure : {"adaptive", "grid", "probes"}) {
    const auto json =
        render({"--spp", "32", "--plan", "all", "--field-memory", "128K", "--field-structure", structure});
    EXPECT_LT(json["fields"]["bytes"], 210'000) << structure;
  }
}

TEST_F(FieldsUsed, StructuresAndTrainingAreRecorded) {
  const auto json = render({"--spp", "3", "--train", "4", "--field-structure", "probes", "--field-rule", "max",
                            "--field-rate", "visits", "--save-fields", fields});
  EXPECT_EQ(json["spp"], 3) << "after the training";
  EXPECT_EQ(json["options"]["field_structure"], "probes");
  EXPECT_EQ(json["options"]["field_rule"], "max");
  EXPECT_EQ(json["options"]["field_rate"], "visits");
  EXPECT_EQ(json["options"]["train"], 4);
  EXPECT_EQ(json["fields"]["structure"], "probes");
  EXPECT_EQ(json["fields"]["generation"], 4);
  EXPECT_EQ(json["fields"]["dropped_passes"], 4);
  const auto again = render({"--spp", "3", "--train", "4", "--load-fields", fields});
  EXPECT_EQ(again["fields"]["structure"], "probes") << "the file's";
  EXPECT_EQ(again["fields"]["generation"], 4) << "trained";
  EXPECT_NE(told({}).find("probes"), std::string::npos);
}

// What a render started from is its own affair: the file of fields is not needed again.
TEST_F(FieldsUsed, ResumeIsTheStraightRun) {
  render({"--spp", "9", "--save-fields", fields});
  for (const bool loaded : {false, true}) {
    const std::vector<std::string> from =
        loaded ? std::vector<std::string>{"--load-fields", fields} : std::vector<std::string>{};
    const auto with = [&](std::vector<std::string> more) {
      more.insert(more.end(), from.begin(), from.end());
      return more;
    };
    const auto straight = render(with({"--spp", "14"}));
    const Picture image = read_picture(out);
    render(with({"--spp", "5", "--checkpoint", state}));
    const auto resumed = render({"--spp", "14", "--resume", state});
    EXPECT_EQ(read_picture(out).pixels, image.pixels);
    EXPECT_EQ(resumed["fields"], straight["fields"]);
  }
}

TEST_F(FieldsUsed, WhatMakesNoSenseIsAnError) {
  render({"--spp", "1", "--save-fields", fields});
  std::filesystem::remove(out);
  const std::string none_such = (folder / "none").string();
  struct Case {
    std::vector<std::string> more;
    std::string integrator, says;
  };
  const std::vector<Case> cases = {
      {{"--save-fields", state}, "path", "--save-fields: the integrator path learns no fields"},
      {{"--load-fields", fields}, "bdpt", "--load-fields: the integrator bdpt learns no fields"},
      {{"--guide", "light"}, "light", "--guide: the integrator light learns no fields"},
      {{"--field-memory", "8M"}, "bdpt", "--field-memory: the integrator bdpt learns no fields"},
      {{"--guide", "neither"}, "guided-bdpt", "--guide neither: is none of both"},
      {{"--guide", "light"}, "guided-path", "--guide light: guided-path has no light subpaths"},
      {{"--field-structure", "grid"}, "bdpt", "--field-structure: the integrator bdpt learns no fields"},
      {{"--field-structure", "octree"}, "guided-bdpt", "--field-structure octree: is none of adaptive"},
      {{"--field-rule", "mean"}, "guided-bdpt", "--field-rule mean: is none of"},
      {{"--field-rate", "fast"}, "guided-bdpt", "--field-rate fast: is none of"},
      {{"--train", "3"}, "guided-bdpt", "--train 3: passes come in pairs"},
      {{"--train", "4"}, "path", "--train: the integrator path learns no fields"},
      {{"--no-next-event"}, "guided-bdpt", "guided-bdpt finds light in more ways"},
      {{"--load-fields", fields, "--field-structure", "grid"}, "guided-bdpt", "stored fields bring their structure"},
      {{"--load-fields", none_such}, "guided-bdpt", none_such + ": no such file of fields"},
      {{"--load-fields", box}, "guided-bdpt", box + ": not a file of fields of this version"},
      {{"--load-fields", fields, "--resume", state}, "guided-bdpt", "leave out either this or --resume"},
      {{"--save-fields", box + "/f"}, "guided-bdpt", "cannot be written (Not a directory); name another folder"},
      {{"--save-fields", folder.string()}, "guided-bdpt", "name a file, not a folder"},
  };
  for (const Case& c : cases) {
    const std::string what = error([&] { render(c.more, c.integrator); });
    EXPECT_NE(what.find(c.says), std::string::npos) << c.says << ": " << what;
    EXPECT_FALSE(std::filesystem::exists(out)) << c.says;
  }
  EXPECT_FALSE(std::filesystem::exists(state));
}

// Where the plan chooses, fields that are there choose guided-bdpt, however little time there is.
TEST_F(FieldsUsed, FieldsToStartFromArePlannedWith) {
  render({"--spp", "1", "--save-fields", fields});
  const auto planned = [&](const std::string& from) {
    return error([&] {
      run_command_line(
          {"render", box, "-q", "--size", "8x8", "--spp", "1", "--plan", "auto", "--load-fields", from, "-o", out});
    });
  };
  EXPECT_EQ(planned(fields), "");
  std::ifstream record(folder / "image.json");
  const auto json = nlohmann::json::parse(record);
  EXPECT_EQ(json["options"]["integrator"], "guided-bdpt");
  EXPECT_EQ(json["options"]["load_fields"], fields);
  std::filesystem::remove(out);
  EXPECT_NE(planned(fields + "x").find("x: no such file of fields"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(out));
}

// A scene that is loaded with help, and moves, is shown as it was rendered.
TEST_F(FieldsUsed, ArePicturedInTheSceneAsItWasRendered) {
  const std::string scene = (folder / "moves.xml").string();
  std::ofstream(scene) << R"(<scene version="3.0.0"><sensor type="perspective"/><shape type="hair"/>
    <shape type="rectangle"><transform name="to_world"><translate z="9"/></transform></shape>
    <shape type="sphere"><emitter type="area"/><animation name="to_world">
      <transform time="0"><translate z="4"/></transform><transform time="1"><translate z="5"/></transform>
    </animation></shape></scene>)";
  run_command_line({"render", scene, "-q", "--size", "8x8", "--integrator", "guided-bdpt", "--spp", "1", "--lenient",
                    "--at", "1", "-o", out, "--save-fields", fields});
  const auto shown = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"fields", fields, "--scene", scene, "-o", folder.string()});
    testing::internal::CaptureStdout();
    const std::string what = error([&] { run_command_line(more); });
    testing::internal::GetCapturedStdout();
    return what;
  };
  EXPECT_NE(shown({"--at", "1"}).find("unknown shape"), std::string::npos);
  EXPECT_NE(shown({"--lenient"}).find("fields of another scene"), std::string::npos);
  EXPECT_EQ(shown({"--lenient", "--at", "1"}), "");
  EXPECT_TRUE(std::filesystem::exists(folder / "cells.png"));
}

TEST(FieldMemory, IsASize) {
  EXPECT_EQ(parse_bytes("--field-memory", "8M"), size_t(8) << 20);
  EXPECT_EQ(parse_bytes("--field-memory", "512K"), size_t(512) << 10);
  EXPECT_EQ(parse_bytes("--field-memory", "1G"), size_t(1) << 30);
  EXPECT_EQ(parse_bytes("--field-memory", "70000"), size_t(70000));
  for (const char* text : {"", "M", "-8M", "8Q", "8 M", "8MB", "0", "63K", "65G", "99999999999999999999", "1e9"})
    EXPECT_THROW(parse_bytes("--field-memory", text), Error) << text;
}

TEST_F(FieldsUsed, AreToldAndShown) {
  const auto json = render({"--spp", "9", "--save-fields", fields});
  const std::string text = told({});
  EXPECT_NE(text.find(json["fields"]["cells"].dump() + " cells; level 0: "), std::string::npos) << text;
  EXPECT_NE(text.find(json["fields"]["bytes"].dump() + " bytes"), std::string::npos) << text;
  EXPECT_NE(text.find("begins with pass 13;"), std::string::npos) << text;
  const std::string more = told({"--scene", box, "--size", "40x30", "-o", folder.string()});
  EXPECT_EQ(more.find(text), 0u);
  for (const char* name : {"cells.png", "irradiance.png", "importance.png", "strata-q.png", "strata-w.png"}) {
    EXPECT_NE(more.find(name), std::string::npos) << name;
    const Picture picture = read_picture((folder / name).string());
    EXPECT_EQ(picture.width, 40);
    EXPECT_EQ(picture.height, 30);
    EXPECT_NE(*std::max_element(picture.pixels.begin(), picture.pixels.end()), 0) << name;
  }
}

TEST_F(FieldsUsed, PicturesNeedTheRightSceneAndAFolder) {
  render({"--spp", "1", "--save-fields", fields});
  const std::string other = AJAR_SOURCE_DIR "/scenes/sunrise/sunrise.xml";
  const auto refused = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"fields", fields});
    testing::internal::CaptureStdout();
    const std::string what = error([&] { run_command_line(more); });
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    return what;
  };
  EXPECT_NE(refused({"--scene", other, "-o", folder.string()}).find("fields of another scene"), std::string::npos);
  EXPECT_NE(refused({"--scene", box, "-o", fields}).find(fields), std::string::npos) << "a file, not a folder";
  EXPECT_NE(refused({"--scene", box}).find("add -o FOLDER"), std::string::npos);
  EXPECT_NE(refused({"-o", folder.string()}).find("add --scene"), std::string::npos);
  for (const std::vector<std::string>& more : {std::vector<std::string>{"-D", "door=5"}, {"--lenient"}, {"--at", "1"}})
    EXPECT_NE(refused(more).find("add --scene"), std::string::npos) << more[0];
  EXPECT_NE(refused({"--scene", box, "-o", folder.string(), "--at", "1"}).find("--at 1: nothing"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "cells.png"));
}

// A ground plane a thousand times as wide as the room: what shines is so many units that sums are full.
TEST_F(FieldsUsed, OfARoomInAHugeSceneComeBack) {
  std::ifstream in(box);
  std::string xml{std::istreambuf_iterator<char>(in), {}};
  const std::string ground =
      "<shape type='rectangle'><transform name='to_world'><scale value='1000'/><rotate x='1' angle='-90'/>"
      "<translate y='-3'/></transform></shape>";
  xml.insert(xml.rfind("</scene>"), ground);
  xml.insert(xml.find("<include"), "<path value='" AJAR_SOURCE_DIR "/scenes/box'/>");
  const std::string scene = (folder / "huge.xml").string();
  std::ofstream(scene) << xml;
  std::vector<std::string> arguments = {"render", scene,           "-q",           "--size",       "64x64",
                                        "--plan", "all",           "--integrator", "guided-bdpt",  "-o",
                                        out,      "--save-fields", fields,         "--checkpoint", state};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = arguments;
    all.insert(all.end(), more.begin(), more.end());
    return error([&] { run_command_line(all); });
  };
  EXPECT_EQ(with({"--spp", "5"}), "");
  told({});
  EXPECT_EQ(with({"--spp", "6", "--resume", state}), "") << "from the checkpoint";
}

}  // namespace
}  // namespace ajar
