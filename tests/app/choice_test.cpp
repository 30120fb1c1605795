// What ajar render takes where the user leaves it open: the integrator, of the scene, a checkpoint or the plan; which
// options go with it, and what is told of it.

#include <nlohmann/json.hpp>

#include "ajar/core/files.h"
#include "ajar/film/picture.h"
#include "ajar/scene/load.h"
#include "app/render_options.h"
#include "outputs_stage.h"

namespace ajar {
namespace {

// What no ray hits would be black.
TEST_F(Outputs, LightsWithoutExtentNeedNextEventEstimation) {
  const std::string text = kit::bytes_of("box.xml"), end = "</scene>";
  for (const char* type : {"point", "spot", "projector", "directional"}) {
    const std::string light = "<emitter type='" + std::string(type) + "'/>";
    write_text("box.xml", text.substr(0, text.rfind(end)) + light + end);
    EXPECT_NE(error_of({"--integrator", "path", "--no-next-event"}).find("without extent"), std::string::npos) << type;
  }
}

TEST_F(Outputs, ResumingWithLessThanThereIsTellsSo) {
  run({"--spp", "4", "--checkpoint", "state"});
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  run_command_line({"render", "box.xml", "--size", "8x8", "--max-depth", "3", "--integrator", "bdpt", "-o", "a.exr",
                    "--spp", "3", "--resume", "state"});
  testing::internal::GetCapturedStdout();
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("note: state holds 4 passes, more than --spp 3"), std::string::npos) << said;
  EXPECT_NE(said.find("[########################]"), std::string::npos) << "a render that is done is whole: " << said;
}

// What it is rendered with, whatever the scene names: box.xml asks for path.
TEST_F(Outputs, AResumedRenderKeepsItsIntegrator) {
  const auto render = [](Words more) {
    more.insert(more.begin(), {"render", "box.xml", "-q", "--size", "8x8", "--max-depth", "3", "-o", "a.exr"});
    return kit::error_of([&] { run_command_line(more); });
  };
  const auto integrator = [] { return nlohmann::json::parse(kit::bytes_of("a.json"))["options"]["integrator"]; };
  EXPECT_EQ(render({"--plan", "all", "--spp", "4"}), "");
  const std::vector<float> straight = read_picture("a.exr").pixels;
  EXPECT_EQ(render({"--plan", "all", "--spp", "2", "--checkpoint", "guided"}), "");
  EXPECT_EQ(render({"--resume", "guided", "--spp", "4"}), "");
  EXPECT_EQ(integrator(), "guided-bdpt");
  EXPECT_EQ(read_picture("a.exr").pixels, straight);
  EXPECT_EQ(render({"--plan", "auto", "--spp", "2", "--checkpoint", "planned"}), "");
  EXPECT_EQ(integrator(), "bdpt") << "too few samples to learn";
  EXPECT_EQ(render({"--resume", "planned", "--spp", "4"}), "");
  EXPECT_EQ(integrator(), "bdpt");
  const std::string other = render({"--resume", "planned", "--integrator", "path", "--spp", "4"});
  EXPECT_EQ(other, "planned: a checkpoint of bdpt, not of path; go on with that, or start again without --resume");
  EXPECT_NE(
      render({"--resume", "planned", "--seed", "2"}).find("\"seed\":0, here \"seed\":2; give what it was made with"),
      std::string::npos);
  EXPECT_NE(render({"--resume", "planned", "--plan", "auto"}).find("leave out --plan"), std::string::npos);
  EXPECT_EQ(render({"--resume", "none"}), "none: no such checkpoint; render once with --checkpoint");
}

TEST_F(Outputs, WhatIsRenderedWithUnaskedIsTold) {
  const auto said = [](Words more) {
    more.insert(more.begin(), {"render", "box.xml", "--size", "8x8", "--max-depth", "3", "--spp", "2", "-o", "a.exr"});
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    run_command_line(more);
    testing::internal::GetCapturedStdout();
    return testing::internal::GetCapturedStderr();
  };
  const std::string note = "note: the scene asks for path; --plan auto chooses what suits it\n";
  EXPECT_NE(said({}).find(note), std::string::npos);
  for (const Words& asked : {Words{"-q"}, {"--integrator", "path"}, {"--plan", "none"}, {"--plan", "auto"}})
    EXPECT_EQ(said(asked).find("asks for"), std::string::npos) << asked.back();
  EXPECT_NE(said({"--plan", "auto"}).find("note: bdpt is used: there is no time to learn\n"), std::string::npos);
}

TEST_F(Outputs, VersusIsCheckedBeforeAPlannedRender) {
  for (const char* other : {"nope", "guided-bdpt"}) {
    const std::string said = kit::error_of([&] {
      run_command_line({"render", "box.xml", "-q", "--plan", "auto", "--versus", other, "-o", "a.exr", "--spp", "1"});
    });
    EXPECT_EQ(said.find("--versus " + std::string(other) + ": cannot be held against what is planned"), 0u) << said;
  }
  EXPECT_EQ(count(), 3u);
}

// Whatever the scene names: what is planned may guide, and merges nothing.
TEST_F(Outputs, WhatIsPlannedIsCheckedAsWhatGuidesIs) {
  const auto said = [](Words words) {
    words.insert(words.begin(), {"render", "box.xml", "-q", "--plan", "auto", "--size", "8x8", "-o", "a.exr"});
    return kit::error_of([&] { run_command_line(words); });
  };
  EXPECT_NE(said({"--no-next-event"}).find("guided-bdpt finds light in more ways"), std::string::npos);
  EXPECT_NE(said({"--merge-radius", "9"}).find("guided-bdpt merges nothing"), std::string::npos);
  EXPECT_NE(said({"--final-gather", "8"}).find("guided-bdpt has no photon map"), std::string::npos);
  EXPECT_EQ(count(), 3u);
  testing::internal::CaptureStdout();
  EXPECT_EQ(said({"--light-choice", "learned", "--spp", "1"}), "");  // bdpt's, for want of time
  testing::internal::GetCapturedStdout();
  EXPECT_NE(kit::bytes_of("a.json").find("\"light_choice\": \"learned\""), std::string::npos);
}

// A checkpoint is not gone on from by itself.
TEST_F(Outputs, ACheckpointThatIsBegunAnewIsTold) {
  const auto said = [](const Words& more) {
    Words words = {"render", "box.xml", "--integrator", "path",  "--size",       "8x8",
                   "--spp",  "1",       "-o",           "a.exr", "--checkpoint", "state"};
    words.insert(words.end(), more.begin(), more.end());
    testing::internal::CaptureStdout(), testing::internal::CaptureStderr();
    run_command_line(words);
    testing::internal::GetCapturedStdout();
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_EQ(said({}).find("begun anew"), std::string::npos);
  EXPECT_NE(said({}).find("note: state is begun anew; --resume state would go on from it\n"), std::string::npos);
  EXPECT_EQ(said({"--resume", "state"}).find("begun anew"), std::string::npos);
}

// What a list of parts makes is checked as if it had been named.
TEST_F(Outputs, PartsOfAPlanAreCheckedAsAnIntegratorIs) {
  const auto said = [](Words words) {
    words.insert(words.begin(), {"render", "box.xml", "-q", "--size", "8x8", "--spp", "2", "-o", "a.exr"});
    return kit::error_of([&] { run_command_line(words); });
  };
  EXPECT_NE(said({"--plan", "light-subpaths", "--no-next-event"}).find("bdpt finds light in more ways"),
            std::string::npos);
  EXPECT_NE(said({"--plan", "none", "--save-fields", "f"}).find("path learns no fields"), std::string::npos);
  EXPECT_NE(said({"--plan", "light-subpaths", "--final-gather", "4"}).find("--final-gather: bdpt"), std::string::npos);
  EXPECT_NE(said({"--plan", "none", "--guide", "light"}).find("--guide: the parts"), std::string::npos);
  EXPECT_NE(said({"--plan", "all,light-subpaths"}).find("all stands alone"), std::string::npos);
  EXPECT_EQ(count(), 3u);
  testing::internal::CaptureStdout();
  EXPECT_EQ(said({"--plan", "light-subpaths,camera-guiding", "--save-fields", "f"}), "");
  testing::internal::GetCapturedStdout();
  EXPECT_TRUE(fs::exists("f"));
}

// The loader, which comes before the integrators, knows their names as well.
TEST_F(Outputs, AScenesIntegratorIsFoundByEitherSpelling) {
  const auto load = [](const std::string& integrator) {
    return load_scene_text(
        "<scene version=\"3.0.0\"><integrator type=\"" + integrator +
            "\"/><sensor type=\"perspective\"/><emitter type=\"constant\"/><shape type=\"sphere\"/></scene>",
        ".", "text", {});
  };
  for (std::string name : integrator_names()) {
    const std::string right = name;
    std::replace(name.begin(), name.end(), '-', '_');
    for (const std::string& spelling : {right, name}) {
      const Scene scene = load(spelling);
      EXPECT_EQ(scene.hints.integrator, right);
      EXPECT_TRUE(scene.notes.empty()) << spelling << ": " << scene.notes[0];
    }
  }
  const Scene other = load("metropolis");
  EXPECT_EQ(other.notes.size(), 1u);
  EXPECT_TRUE(plans({}, other)) << "as if none were named";
  EXPECT_FALSE(plans({}, load("bdpt")));
}

TEST_F(Outputs, NoPlanGoesWithAnyIntegrator) {
  run({"--plan", "none", "--integrator", "guided-bdpt"});
  const auto options = nlohmann::json::parse(kit::bytes_of("a.json"))["options"];
  EXPECT_EQ(options["integrator"], "guided-bdpt");
  EXPECT_EQ(options["leaves_out"], false);
}

}  // namespace
}  // namespace ajar
