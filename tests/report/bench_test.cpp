// The bench on tiny scenes: order of work, going on after a stop, references made and kept.

#include <sstream>

#include "ajar/film/picture.h"
#include "ajar/report/metrics.h"
#include "ajar/report/statistics.h"
#include "bench_stage.h"

namespace ajar {
namespace {

/// Without what no two runs have in common.
Json timeless(const Json& json) {
  if (!json.is_structured()) return json;
  Json out = json.is_array() ? Json::array() : Json::object();
  for (const auto& [key, value] : json.items()) {
    const bool time = key.find("seconds") != std::string::npos || key == "date" || key == "phases_cpu" ||
                      key == "memory_peak_bytes" || key == "slope" || key == "time_ratio" || key == "command" ||
                      key == "tracing" || key == "time";
    if (time && json.is_object()) continue;
    json.is_array() ? out.push_back(timeless(value)) : void(out[key] = timeless(value));
  }
  return out;
}

TEST_F(Bench, MethodsTakeTurns) {
  std::string order;
  options.watch = [&](const BenchProgress& p) {
    if (p.what.starts_with("s seed")) order += p.what.back();
    return true;
  };
  const Json results = run(small());
  // Targets 1, 2, 3 and 4 samples, a pass each; another method first at each target and at each seed.
  EXPECT_EQ(order,
            "pbbppbbp"
            "bppbbppb");
  const Json& method = results["scenes"][0]["methods"][0];
  std::vector<double> spp;
  for (const Json& s : method["runs"][1]["samples"]) spp.push_back(s["spp"]);
  EXPECT_EQ(spp, (std::vector<double>{1, 2, 3, 4}));
}

TEST_F(Bench, ResultsAreWhatTheImagesSay) {
  const Json results = run(small());
  EXPECT_EQ(results, Json::parse(kit::bytes_of(options.folder / "results.json")));
  const Json& scene = results["scenes"][0];
  EXPECT_EQ(scene["width"], 16);
  ASSERT_EQ(scene["methods"].size(), 2u);
  const Picture reference = read_picture((options.folder / scene["reference"]["image"]).string());
  for (const Json& method : scene["methods"]) {
    const Picture image = read_picture((options.folder / method["image"]).string());
    const Metrics m = compare(image, reference);
    const Json& last = method["runs"][0]["samples"].back();
    EXPECT_EQ(last["relmse"], m.relmse);
    EXPECT_EQ(last["mse"], m.mse);
    EXPECT_EQ(last["mape"], m.mape);
    EXPECT_EQ(last["ssim"], m.ssim);
    const double a = method["runs"][0]["samples"].back()["relmse"], b = method["runs"][1]["samples"].back()["relmse"];
    EXPECT_NE(a, b);
    EXPECT_DOUBLE_EQ(method["summary"]["relmse"]["median"], (a + b) / 2);
  }
  const auto last = [&](int method, int seed) {
    return scene["methods"][method]["runs"][seed]["samples"].back()["relmse"].get<double>();
  };
  const double first = last(1, 0) / last(0, 0), second = last(1, 1) / last(0, 1);
  EXPECT_DOUBLE_EQ(scene["methods"][0]["summary"]["relmse"]["error_ratio"]["value"], (first + second) / 2);
  EXPECT_EQ(scene["methods"][0]["verdict"], verdict({first, second}));
  EXPECT_EQ(scene["methods"][1]["verdict"], "baseline");
  std::istringstream csv(kit::bytes_of(options.folder / "results.csv"));
  int lines = 0;
  for (std::string line; std::getline(csv, line); ++lines)
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 11) << line;
  EXPECT_EQ(lines, 1 + 2 * 2 * 4);
}

TEST_F(Bench, GoesOnAfterAStop) {
  const Json straight = run(small());
  fs::rename(options.folder, folder / "straight");
  stop_after(12);  // of 8 steps a seed: in the second
  const Json broken = run(small());
  EXPECT_TRUE(broken["interrupted"]);
  EXPECT_EQ(broken["scenes"][0]["methods"][0]["runs"].size(), 1u);
  EXPECT_TRUE(fs::exists(options.folder / "results.csv"));
  fs::remove_all(options.folder);
  stop_after(3);
  const Json begun = run(small());
  EXPECT_TRUE(begun["scenes"][0]["methods"][0]["verdict"].is_null());
  EXPECT_TRUE(begun["scenes"][0]["methods"][0]["summary"]["relmse"].is_null());
  EXPECT_NE(results_table(begun).find("s      p       -"), std::string::npos);
  stop_after(12);
  run(small());
  int steps = 0;
  options.watch = [&](const BenchProgress&) { return ++steps > 0; };
  const Json whole = run(small());
  EXPECT_EQ(steps, 8) << "the finished seed is not run again, nor the reference made";
  EXPECT_EQ(timeless(whole).dump(1), timeless(straight).dump(1));
  EXPECT_EQ(kit::bytes_of(options.folder / "images/s/b.exr"), kit::bytes_of(folder / "straight/images/s/b.exr"));
  steps = 0;
  run(small());
  EXPECT_EQ(steps, 0);
}

TEST_F(Bench, ARunThatIsMissingIsMade) {
  const Json straight = run(small());
  fs::remove(options.folder / "runs/s/p-seed1.json");
  std::string order;
  options.watch = [&](const BenchProgress& p) { return order += p.what.back(), true; };
  EXPECT_EQ(timeless(run(small())), timeless(straight));
  EXPECT_EQ(order, "pppp");
}

TEST_F(Bench, ThreadsDoNotMatter) {
  const Json two = run(small());
  options.threads = 1;
  fs::remove_all(options.folder);
  Json one = run(small());
  one["machine"] = two["machine"];
  EXPECT_EQ(timeless(one).dump(1), timeless(two).dump(1));
}

// As ajar render does.
TEST_F(Bench, DepthIsTheScenesUnlessTheSuiteSaysOtherwise) {
  Json json = small();
  json["scenes"][0].erase("max_depth");
  EXPECT_EQ(run(json)["scenes"][0]["max_depth"], -1) << "the box says no more";
  EXPECT_TRUE(fs::exists(options.references / "s-16x12-depth-1.exr"));
  json["scenes"][0]["defines"] = {{"max_depth", "3"}};
  options.folder = folder / "three";
  const Json three = run(json);
  EXPECT_EQ(three["scenes"][0]["max_depth"], 3);
  options.folder = folder / "told", options.references = folder / "references of it";
  const Json told = run(small());
  for (const Json& method : three["scenes"][0]["methods"])
    for (const Json& other : told["scenes"][0]["methods"])
      if (method["name"] == other["name"]) {
        EXPECT_EQ(method["runs"][0]["rays"], other["runs"][0]["rays"]) << method["name"];
      }
}

TEST_F(Bench, ReferenceIsMadeOnceAndKept) {
  const Json results = run(small());
  const fs::path stem = options.references / "s-16x12-depth3";
  EXPECT_FALSE(fs::exists(stem.string() + ".parts"));
  const Json json = Json::parse(kit::bytes_of(stem.string() + ".json"));
  EXPECT_EQ(json["made"][0]["integrator"], "bdpt");
  EXPECT_EQ(json["made"][0]["spp"], 64);
  EXPECT_GE(json["agreement"]["p"].get<double>(), 1e-4);
  EXPECT_EQ(results["scenes"][0]["reference"]["relmse"], json["relmse"]);
  // Its own noise is less than that of 64 samples of either, and it is the same image from the same batches.
  EXPECT_LT(json["relmse"], json["made"][0]["relmse"]);
  EXPECT_LT(json["relmse"], json["made"][1]["relmse"]);
  const auto made = fs::last_write_time(stem.string() + ".exr");
  fs::remove_all(options.folder);
  run(small());
  EXPECT_EQ(fs::last_write_time(stem.string() + ".exr"), made);
  // Asked for otherwise, it is not quietly overwritten.
  Json other = small();
  other["scenes"][0]["reference"]["made_by"][0]["spp"] = 128;
  fs::remove_all(options.folder);
  EXPECT_NE(
      error_of(other).find(
          "s-16x12-depth3.json: was made from another scene (a file of it may have changed) or with another budget"),
      std::string::npos);
  EXPECT_FALSE(fs::exists(options.folder)) << "nothing is begun";
}

TEST_F(Bench, ReferenceGoesOnFromItsBatches) {
  run(small());
  const fs::path stem = options.references / "s-16x12-depth3";
  const std::string straight = kit::bytes_of(stem.string() + ".exr");
  fs::remove_all(options.folder);
  fs::remove_all(options.references);
  int seen = 0;
  options.watch = [&](const BenchProgress&) { return ++seen < 50; };  // batches of 4 passes: in the 13th of 32
  EXPECT_TRUE(run(small())["interrupted"]);
  EXPECT_TRUE(fs::exists(stem.string() + ".parts"));
  seen = -1000;
  run(small());
  EXPECT_EQ(seen + 1000, 20 * 4 + 16) << "12 of 32 batches were there";
  EXPECT_EQ(kit::bytes_of(stem.string() + ".exr"), straight);
}

TEST_F(Bench, IntegratorsThatDisagreeMakeNoReference) {
  Json json = small();  // light tracing alone sees nothing through glass
  json["scenes"][0]["file"] = kit::source_path("scenes/glass/glass.xml");
  json["scenes"][0]["reference"]["made_by"][0]["integrator"] = "light";
  json["scenes"][0]["size"] = {32, 24};
  json["scenes"][0]["max_depth"] = 5;
  for (Json& part : json["scenes"][0]["reference"]["made_by"]) part["spp"] = 256;
  json["scenes"].push_back(small()["scenes"][0]);
  json["scenes"][1]["name"] = "other";
  const Json results = run(json);
  ASSERT_EQ(results["refused"].size(), 1u);
  const std::string error = results["refused"][0];
  EXPECT_NE(error.find("scenes \"s\".reference: light and path disagree: channel "), std::string::npos) << error;
  EXPECT_NE(error.find("has means "), std::string::npos);
  const fs::path stem = options.references / "s-32x24-depth5";
  EXPECT_FALSE(fs::exists(stem.string() + ".exr"));
  EXPECT_TRUE(fs::exists(stem.string() + ".parts")) << "a longer run goes on from here";
  EXPECT_EQ(results["scenes"][0]["skipped"], error);
  EXPECT_EQ(results["scenes"][0]["methods"].size(), 0u);
  EXPECT_EQ(results["scenes"][1]["methods"].size(), 2u) << "the others are measured";
}

TEST_F(Bench, ABlackReferenceIsRefused) {
  Json json = small();  // nothing but mirrors on the way to the lamp: too many for 5 edges
  json["scenes"][0]["file"] = kit::source_path("scenes/mirrors/mirrors.xml");
  json["scenes"][0]["max_depth"] = 5;
  const std::string why = run(json)["refused"][0];
  EXPECT_NE(why.find("s-16x12-depth5.exr: is black"), std::string::npos) << why;
  EXPECT_FALSE(fs::exists(options.references / "s-16x12-depth5.exr"));
}

TEST_F(Bench, ScenesAreLoadedBeforeAnythingIsMade) {
  Json json = small();
  json["scenes"][0]["defines"] = {{"dor", 5}};
  const std::string error = error_of(json);
  EXPECT_NE(error.find("s.json: scenes \"s\": "), std::string::npos) << error;
  EXPECT_NE(error.find("dor"), std::string::npos) << error;
  EXPECT_FALSE(fs::exists(options.folder));
  json = small();
  write_exr((folder / "r.exr").string(), {2, 2, {"R", "G", "B"}, std::vector<float>(12, 1)}, {}, PixelType::half);
  json["scenes"][0]["reference"] = {{"image", "r.exr"}};
  EXPECT_NE(error_of(json).find("r.exr: has 2x2 pixels, the scene renders 16x12"), std::string::npos);
  EXPECT_FALSE(fs::exists(options.folder));
}

TEST_F(Bench, AbsentOptionalSceneIsSkippedAndSaidSo) {
  Json json = small();
  json["scenes"].push_back(
      {{"name", "far"}, {"file", "far.xml"}, {"optional", true}, {"reference", {{"image", "far.exr"}}}});
  const Json results = run(json);
  const Json& far = results["scenes"][1];
  EXPECT_NE(far["skipped"].get<std::string>().find("far.xml"), std::string::npos);
  EXPECT_EQ(far["methods"], Json::array());
  EXPECT_TRUE(results["scenes"][0]["skipped"].is_null());
  EXPECT_NE(results_table(results).find("left out"), std::string::npos);
}

TEST_F(Bench, TableIsInLine) {
  Json results = run(small());
  results["scenes"][0]["name"] = "a scene with a long name";
  for (const char* key : {"median", "low", "high"})
    results["scenes"][0]["methods"][0]["summary"]["relmse"][key] = 1.23456e-12;
  const std::string table = results_table(results);
  std::istringstream in(table);
  std::string head, row, last;
  std::getline(in, head), std::getline(in, row), std::getline(in, last);
  const size_t at = head.find("error ratio");
  EXPECT_EQ(row.substr(at - 3, 2), "] ") << table;
  EXPECT_NE(row[at], ' ') << table;
  EXPECT_EQ(row.find("p", 24), head.find("method")) << table;
  EXPECT_EQ(last.find("baseline"), head.find("verdict")) << table;
}

TEST_F(Bench, TableWarnsOfANoisyReference) {
  Json results = run(small());
  Json& relmse = results["scenes"][0]["reference"]["relmse"];
  const Json& methods = results["scenes"][0]["methods"];
  const double least = std::min(methods[0]["summary"]["relmse"]["median"].get<double>(),
                                methods[1]["summary"]["relmse"]["median"].get<double>());
  relmse = 0.11 * least;
  EXPECT_NE(results_table(results).find("s: the reference's own relMSE is about"), std::string::npos);
  EXPECT_NE(results_table(results).find("11 % of the smallest"), std::string::npos);
  relmse = 0.09 * least;
  EXPECT_EQ(results_table(results).find("the reference's own"), std::string::npos);
  relmse = nullptr;
  EXPECT_EQ(results_table(results).find("the reference's own"), std::string::npos);
  EXPECT_NE(results_table(results).find("s: the noise of the reference is unknown"), std::string::npos);
}

TEST_F(Bench, TheRecordBesideAReferenceTellsItsNoise) {
  Json json = small();
  run(json);
  const fs::path stem = options.references / "s-16x12-depth3";
  fs::copy(stem.string() + ".exr", folder / "right.exr");
  json["scenes"][0]["reference"] = {{"image", "right.exr"}};
  options.folder = folder / "other";
  const auto noise = [&] { return run(json)["scenes"][0]["reference"]["relmse"]; };
  EXPECT_TRUE(noise().is_null());
  std::ofstream(folder / "right.json") << R"({"image": "right.exr", "estimated_relmse": 0.0125})";
  EXPECT_EQ(noise(), 0.0125);
  for (const char* other : {"no JSON", "[]", R"({"estimated_relmse": "small"})", R"({"relmse": -1})"}) {
    std::ofstream(folder / "right.json") << other;
    EXPECT_TRUE(noise().is_null()) << other;
  }
  fs::copy(stem.string() + ".json", folder / "right.json", fs::copy_options::overwrite_existing);
  EXPECT_EQ(noise(), Json::parse(kit::bytes_of(stem.string() + ".json"))["relmse"]);
}

TEST_F(Bench, TimeBudgetsAreKept) {
  Json json = small();
  json["seeds"] = 1;
  json["budget"] = {{"cpu_seconds", 0.2}};
  const Json results = run(json);
  for (const Json& method : results["scenes"][0]["methods"]) {
    const Json& samples = method["runs"][0]["samples"];
    ASSERT_GE(samples.size(), 10u);
    for (size_t i = 0; i < samples.size(); ++i) {
      const double cpu = samples[i]["cpu_seconds"];
      EXPECT_TRUE(i == 0 || cpu > samples[i - 1]["cpu_seconds"].get<double>());
    }
    EXPECT_GE(samples.back()["cpu_seconds"].get<double>(), 0.2);
    EXPECT_LT(samples.back()["cpu_seconds"].get<double>(), 0.3);
  }
}

TEST_F(Bench, TechniquesOnRequest) {
  Json json = small();
  json["techniques"] = true;
  json["seeds"] = 1;
  const Json results = run(json);
  const Json& list = results["scenes"][0]["methods"][1]["techniques"];
  bool found = false;
  for (const Json& t : list) {
    EXPECT_TRUE(fs::exists(options.folder / t["weighted"]) && fs::exists(options.folder / t["raw"]));
    found |= t["s"] == 1 && t["t"] == 2;
  }
  EXPECT_TRUE(found);
  std::vector<double> shares;
  options.watch = [&](const BenchProgress& p) { return shares.push_back(p.share), true; };
  run(json);
  EXPECT_TRUE(shares.empty()) << "nothing is left to do, of path tracing neither, which has no strategies";
  fs::remove_all(options.folder / "techniques/s/b");
  run(json);
  EXPECT_FALSE(shares.empty());
  for (const double share : shares) EXPECT_EQ(share, 1) << "all runs are there";
}

// Whatever they are called.
TEST_F(Bench, MethodsKeepTheirTechniques) {
  Json json = small();
  json["techniques"] = true;
  json["methods"] = {{{"name", "b.tmp"}, {"integrator", "bdpt"}}, {{"name", "b"}, {"integrator", "bdpt"}}};
  const Json results = run(json);
  for (const Json& method : results["scenes"][0]["methods"])
    EXPECT_GT(method["techniques"].size(), 3u) << method["name"];
}

}  // namespace
}  // namespace ajar
