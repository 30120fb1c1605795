// What a bench finds in its folders: of another suite, scene, build or reference, damaged, or in the way.

#include <fmt/format.h>

#include "ajar/core/files.h"
#include "ajar/film/picture.h"
#include "bench_stage.h"

namespace ajar {
namespace {

// Nobody wrote them by hand: what helps is to make them again.
TEST_F(Bench, DamagedRecordsAreNamedWithTheirCure) {
  run(small());
  const std::string reference = (options.references / "s-16x12-depth3.json").string();
  for (const auto& [file, cure] : {std::pair{options.folder / "runs/s/p-seed1.json", "the run is made again"},
                                   {options.folder / "suite.json", "name another one with -o"},
                                   {fs::path(reference), "the reference is made again"}}) {
    const std::string whole = kit::bytes_of(file);
    write_text(file.string(), whole.substr(0, whole.size() / 2));
    const std::string error = error_of(small());
    EXPECT_EQ(error.find(file.string() + ": line "), 0u) << error;
    EXPECT_NE(error.find(std::string("not JSON here; delete ")), std::string::npos) << error;
    EXPECT_NE(error.find(cure), std::string::npos) << error;
    write_text(file.string(), whole);
  }
}

TEST_F(Bench, AFolderOfAnotherSuiteIsRefused) {
  run(small());
  for (const auto& [pointer, value] :
       std::vector<std::pair<std::string, Json>>{{"/budget/spp", 5},
                                                 {"/seeds", 3},
                                                 {"/scenes/0/defines", Json{{"spp", 3}}},
                                                 {"/methods/0/sampler", "independent"}}) {
    Json other = small();
    other[Json::json_pointer(pointer)] = value;
    if (pointer == "/scenes/0/defines") other["scenes"][0]["reference"] = {{"image", "r.exr"}};
    fs::copy_file(options.folder / "images/s/reference.exr", folder / "r.exr", fs::copy_options::overwrite_existing);
    EXPECT_NE(error_of(other).find("out: holds runs of another suite"), std::string::npos) << error_of(other);
  }
  // Another title is the same suite.
  Json other = small();
  other["title"] = "u";
  EXPECT_EQ(error_of(other), "");
}

TEST_F(Bench, AFolderWithoutRunsIsFree) {
  run(small());
  fs::remove_all(options.folder / "runs");
  Json other = small();
  other["seeds"] = 3;
  EXPECT_EQ(error_of(other), "");
}

TEST_F(Bench, FilesThatNoBenchWroteStay) {
  for (const char* name : {"results.json", "suite.json", "report.html"}) {
    fs::create_directories(options.folder);
    std::ofstream(options.folder / name) << "{\"mine\": 1}";
    EXPECT_NE(error_of(small()).find(fmt::format("{}: is of no bench", name)), std::string::npos) << error_of(small());
    EXPECT_EQ(kit::bytes_of(options.folder / name), "{\"mine\": 1}");
    fs::remove_all(options.folder);
  }
  fs::create_directories(options.references);
  const fs::path image = options.references / "s-16x12-depth3.exr";
  std::ofstream(image) << "mine";
  EXPECT_NE(error_of(small()).find("has no record s-16x12-depth3.json beside it"), std::string::npos)
      << error_of(small());
  EXPECT_EQ(kit::bytes_of(image), "mine");
}

// Whoever goes on elsewhere, or leaves out --threads, would mix the times of one machine with those of another.
TEST_F(Bench, OtherThreadsAreRefused) {
  run(small());
  options.threads = 1;
  EXPECT_NE(error_of(small()).find("out: holds runs by 2 threads, whose times are others; write --threads 2, or name"),
            std::string::npos)
      << error_of(small());
  options.build = "other";
  EXPECT_NE(error_of(small()).find("out: holds runs of another build of Ajar"), std::string::npos) << error_of(small());
}

TEST_F(Bench, AFolderOfAnotherBuildIsRefused) {
  run(small());
  options.build = "other";
  EXPECT_NE(error_of(small()).find("out: holds runs of another build of Ajar"), std::string::npos) << error_of(small());
  fs::remove_all(options.folder);
  EXPECT_EQ(run(small())["build"], "other");
}

TEST_F(Bench, WhereNothingCanBeWrittenNothingIsRendered) {
  run(small());
  fs::remove_all(options.folder / "runs");
  std::ofstream(options.folder / "runs") << "a file";
  int seen = 0;
  options.watch = [&](const BenchProgress&) { return ++seen, true; };
  EXPECT_NE(error_of(small()).find("runs"), std::string::npos) << error_of(small());
  fs::remove(options.folder / "runs");
  fs::remove(options.folder / "results.csv");
  fs::create_directories(options.folder / "results.csv");
  EXPECT_NE(error_of(small()).find("results.csv"), std::string::npos) << error_of(small());
  EXPECT_EQ(seen, 0);
}

TEST_F(Bench, DamagedBatchesAreMadeAgain) {
  int seen = 0;
  options.watch = [&](const BenchProgress&) { return ++seen < 50; };
  EXPECT_TRUE(run(small())["interrupted"]);
  const fs::path batch = options.references / "s-16x12-depth3.parts" / "0-bdpt-000.exr";
  ASSERT_TRUE(fs::exists(batch));
  std::ofstream(batch) << "no image";
  seen = -1000;
  EXPECT_FALSE(run(small())["interrupted"]);
}

TEST_F(Bench, RunsThatLackWhatIsAskedOfThemAreTold) {
  run(small());
  const fs::path path = options.folder / "runs/s/p-seed0.json";
  const Json whole = Json::parse(kit::bytes_of(path));
  for (const auto& [pointer, value] : std::vector<std::pair<std::string, Json>>{{"/run", Json::object()},
                                                                                {"/run/seed", nullptr},
                                                                                {"/run/samples", Json::object()},
                                                                                {"/run/samples/0/relmse", nullptr},
                                                                                {"/run/tracing", nullptr}}) {
    Json file = whole;
    file[Json::json_pointer(pointer)] = value;
    std::ofstream(path) << file;
    EXPECT_NE(error_of(small()).find("p-seed0.json: is no run of a bench; delete it"), std::string::npos)
        << pointer << " " << error_of(small());
  }
}

TEST_F(Bench, WhatIsNoRunIsToldAsSuch) {
  run(small());
  const fs::path path = options.folder / "runs/s/p-seed0.json";
  Json file = Json::parse(kit::bytes_of(path));
  file["content"] = 1;
  std::ofstream(path) << file;
  EXPECT_NE(error_of(small()).find("p-seed0.json: is no run of a bench; delete it"), std::string::npos)
      << error_of(small());
}

TEST_F(Bench, AnotherReferenceIsRefused) {
  run(small());
  const fs::path stem = options.references / "s-16x12-depth3";
  Picture image = read_picture(stem.string() + ".exr");
  image.pixels[0] += 1;
  write_exr(stem.string() + ".exr", image, {}, PixelType::half);
  const fs::path shown = options.folder / "images" / small()["scenes"][0]["name"] / "reference.exr";
  const std::string before = kit::bytes_of(shown);
  EXPECT_NE(error_of(small()).find("p-seed0.json: was measured against another reference"), std::string::npos)
      << error_of(small());
  EXPECT_TRUE(kit::bytes_of(shown) == before) << "what is refused changes nothing";
}

// A file that the scene includes is of the scene: neither a reference nor runs of another state of it count.
TEST_F(Bench, AChangedSceneIsRefused) {
  fs::copy(kit::source_path("scenes/box"), folder / "box");
  Json json = small();
  json["scenes"][0]["file"] = (folder / "box/box.xml").string();
  run(json);
  std::ofstream(folder / "box/room.xml", std::ios::app) << " ";
  EXPECT_NE(error_of(json).find("s-16x12-depth3.json: was made from another scene"), std::string::npos);
  const fs::path stem = options.references / "s-16x12-depth3";
  fs::copy(stem.string() + ".exr", folder / "right.exr");
  json["scenes"][0]["reference"] = {{"image", (folder / "right.exr").string()}};
  options.folder = folder / "other";
  run(json);
  std::ofstream(folder / "box/room.xml", std::ios::app) << " ";
  EXPECT_NE(error_of(json).find("p-seed0.json: a file of the scene has changed since"), std::string::npos)
      << error_of(json);
}

}  // namespace
}  // namespace ajar
