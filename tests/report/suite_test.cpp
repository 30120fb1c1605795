// Suite files, good and bad.

#include "ajar/report/suite.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "ajar/core/error.h"
#include "kit/files.h"

namespace ajar {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

struct SuiteFile : testing::Test {
  fs::path folder;

  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder = fs::path(testing::TempDir()) / ("ajar suite " + std::string(info->name()) + std::to_string(::getpid()));
    fs::create_directories(folder / "shared" / "scenes" / "far");
    fs::create_directories(folder / "shared" / "references");
    for (const char* file : {"a.xml", "b.xml", "r.exr", "shared/scenes/far/scene.xml", "shared/references/far.exr"})
      std::ofstream(folder / file) << "x";
    ::setenv("AJAR_SHARED_SCENES", (folder / "shared" / "scenes").c_str(), 1);
  }
  void TearDown() override {
    ::unsetenv("AJAR_SHARED_SCENES");
    fs::remove_all(folder);
  }

  static Json good() {
    return Json::parse(R"({
      "title": "t", "seeds": 3, "budget": {"cpu_seconds": 2.5}, "baseline": "b", "techniques": true,
      "methods": [{"name": "p", "integrator": "guided-bdpt", "roulette_depth": 3,
                   "guide": "light", "field_memory": 1048576, "field_structure": "probes",
                   "field_rule": "return", "field_rate": "visits", "train": 4},
                  {"name": "b", "integrator": "bdpt", "heuristic": "balance", "sampler": "independent"}],
      "scenes": [
        {"name": "one", "file": "a.xml", "defines": {"door": 5, "x": "y"}, "size": [32, 16], "max_depth": 7,
         "reference": {"made_by": [{"integrator": "bdpt", "cpu_seconds": 4}, {"integrator": "path", "spp": 64}]}},
        {"name": "far", "file": "far/scene.xml", "optional": true, "reference": {"image": "references/far.exr"}},
        {"name": "none", "file": "none.xml", "optional": true, "reference": {"image": "none.exr"}}],
      "quick": {"budget": {"spp": 4}, "seeds": [7], "scenes": ["far"], "methods": ["b"]}})");
  }

  fs::path write(const std::string& text) const {
    std::ofstream(folder / "s.json") << text;
    return folder / "s.json";
  }
  Suite load(const Json& json, bool quick = false) const { return load_suite(write(json.dump()), quick); }
  std::string error_of(const std::string& text) const {
    try {
      load_suite(write(text), false);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }
  /// The message for the good suite with one place changed; it names the file.
  std::string error_with(const std::string& pointer, const Json& value) const {
    Json json = good();
    json[Json::json_pointer(pointer)] = value;
    const std::string error = error_of(json.dump());
    EXPECT_EQ(error.find((folder / "s.json").string() + ": "), 0u) << pointer << ": " << error;
    EXPECT_EQ(error.find('\n'), std::string::npos);
    return error;
  }
  void expect_error(const std::string& pointer, const Json& value, const std::string& part) const {
    const std::string error = error_with(pointer, value);
    EXPECT_NE(error.find(part), std::string::npos) << pointer << ": " << error;
  }
};

TEST_F(SuiteFile, IsReadInFull) {
  const Suite s = load(good());
  EXPECT_EQ(s.title, "t");
  EXPECT_EQ(s.baseline, "b");
  EXPECT_EQ(s.seeds, (std::vector<uint64_t>{0, 1, 2}));
  EXPECT_EQ(s.budget.cpu_seconds, 2.5);
  EXPECT_EQ(s.budget.spp, 0u);
  EXPECT_EQ(s.budget.seconds, 0);
  EXPECT_TRUE(s.techniques);
  EXPECT_FALSE(s.quick);
  ASSERT_EQ(s.methods.size(), 2u);
  EXPECT_EQ(s.methods[0].options.integrator, "guided-bdpt");
  EXPECT_EQ(s.methods[0].options.roulette_depth, 3);
  EXPECT_EQ(s.methods[0].options.learn.guided, Guided::light);
  EXPECT_EQ(s.methods[0].options.learn.structure, Structure::probes);
  EXPECT_EQ(s.methods[0].options.learn.rule, Rule::returned);
  EXPECT_EQ(s.methods[0].options.learn.forget, 1);
  EXPECT_EQ(s.methods[0].options.learn.train, 4u);
  EXPECT_EQ(s.methods[0].options.learn.memory, size_t(1) << 20);
  EXPECT_EQ(s.methods[1].options.heuristic, Heuristic::balance);
  EXPECT_EQ(s.methods[1].options.sampler, SamplerKind::independent);
  ASSERT_EQ(s.scenes.size(), 3u);
  const BenchScene& one = s.scenes[0];
  EXPECT_EQ(one.path, folder / "a.xml");
  EXPECT_EQ(one.width, 32);
  EXPECT_EQ(one.height, 16);
  EXPECT_EQ(one.max_depth, 7);
  EXPECT_EQ(one.defines.at("door"), "5");
  EXPECT_EQ(one.defines.at("x"), "y");
  ASSERT_EQ(one.parts.size(), 2u);
  EXPECT_EQ(one.parts[0].budget.cpu_seconds, 4);
  EXPECT_EQ(one.parts[1].budget.spp, 64u);
  EXPECT_EQ(s.scenes[1].path, folder / "shared/scenes/far/scene.xml") << "found among the shared scenes";
  EXPECT_EQ(s.scenes[1].reference, folder / "shared/references/far.exr") << "found beside them";
  EXPECT_NE(s.scenes[2].missing.find("none.xml"), std::string::npos) << "optional";
}

TEST_F(SuiteFile, QuickOverrides) {
  const Suite s = load(good(), true);
  EXPECT_TRUE(s.quick);
  EXPECT_EQ(s.budget.spp, 4u);
  EXPECT_EQ(s.budget.cpu_seconds, 0);
  EXPECT_EQ(s.seeds, std::vector<uint64_t>{7});
  ASSERT_EQ(s.scenes.size(), 1u);
  EXPECT_EQ(s.scenes[0].name, "far");
  ASSERT_EQ(s.methods.size(), 1u);
  EXPECT_EQ(s.methods[0].name, "b");
  EXPECT_NE(to_json(s), to_json(load(good())));
}

TEST_F(SuiteFile, NotJsonNamesLineAndColumn) {
  EXPECT_NE(error_of("{\"title\": \"t\",\n  \"seeds\" 3}").find("line 2, column 11"), std::string::npos)
      << error_of("{\"title\": \"t\",\n  \"seeds\" 3}");
  EXPECT_NE(error_of("").find("line 1"), std::string::npos);
  EXPECT_NE(error_of("[1]").find("write an object"), std::string::npos);
  EXPECT_NE(error_of(R"({"title": "a", "title": "b"})").find("\"title\" comes twice"), std::string::npos);
  for (const fs::path& path : {folder / "absent.json", folder}) try {
      load_suite(path, false);
      FAIL();
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find(path.string() + ": cannot be read"), 0u);
    }
}

TEST_F(SuiteFile, UnknownAndMissingKeys) {
  expect_error("/sceens", 1, "unknown key \"sceens\"; known are title, ");
  expect_error("/methods/0/gidance", 1, "methods \"p\": unknown key \"gidance\"; known are name, integrator, ");
  expect_error("/scenes/0/depth", 1, "scenes \"one\": unknown key \"depth\"");
  expect_error("/scenes/0/reference/made_by/0/seed", 1, "unknown key \"seed\"");
  expect_error("/quick/baseline", "p", "quick: unknown key \"baseline\"");
  for (const char* key : {"title", "seeds", "budget", "methods", "scenes", "baseline"}) {
    Json json = good();
    json.erase(key);
    EXPECT_NE(error_of(json.dump()).find(std::string("\"") + key + "\" is missing"), std::string::npos) << key;
  }
}

TEST_F(SuiteFile, WrongTypesAndValues) {
  expect_error("/seeds", "three", "seeds: is \"three\"");
  expect_error("/seeds", 0, "seeds: is 0; write a number from 1");
  expect_error("/seeds", 1.5, "write a whole number");
  expect_error("/seeds", Json{1, 1}, "seeds must differ");
  expect_error("/budget", Json{{"seconds", 1}, {"spp", 1}}, "budget: has no budget or more than one");
  expect_error("/budget", Json::object(), "budget: has no budget or more than one");
  expect_error("/budget/cpu_seconds", -1, "budget.cpu_seconds: is -1");
  expect_error("/budget/cpu_seconds", "2", "budget.cpu_seconds: is \"2\"; write a number");
  expect_error("/techniques", 1, "techniques: is 1; write true or false");
  expect_error("/methods", Json::array(), "methods: is []");
  expect_error("/methods/0/integrator", "paht", "methods \"p\".integrator: \"paht\" is unknown; known are path, bdpt");
  expect_error("/methods/1/sampler", "halton", "known are sobol, independent");
  expect_error("/methods/0/roulette_depth", 0, "roulette_depth: is 0");
  expect_error("/methods/0/guide", "none", "guide");
  expect_error("/methods/0/field_structure", "octree", "field_structure");
  expect_error("/methods/0/field_rule", "mean", "field_rule");
  expect_error("/methods/0/field_memory", 100, "field_memory: is 100");
  expect_error("/methods/1/name", "p", "methods \"p\".name: another has this name");
  for (const char* name : {"../p", "..p", "a/b"}) expect_error("/methods/1/name", name, "names become file names");
  expect_error("/methods/1/name", std::string(101, 'p'), "use 100 letters at most");
  expect_error("/methods/0/name", "reference", "the reference's image has this name");
  expect_error("/scenes/1/name", "one", "another has this name");
  expect_error("/scenes/0/size", Json{32}, "scenes \"one\".size: write [WIDTH, HEIGHT]");
  expect_error("/scenes/0/size", Json{32, 0}, "scenes \"one\".size[1]: is 0");
  expect_error("/scenes/0/max_depth", 0, "max_depth: is 0; write -1");
  expect_error("/scenes/0/defines", Json{{"door", true}}, "\"door\" is true");
  expect_error("/baseline", "q", "baseline: no method is named \"q\"");
  expect_error("/quick/methods", Json{"p"}, "baseline: no method is named \"b\"");
  expect_error("/quick/scenes", Json{"two"}, "quick.scenes[0]: the suite has nothing named \"two\"");
  expect_error("/quick/scenes", Json{"far", "far"}, "\"far\" is listed twice");
}

TEST_F(SuiteFile, FilesAndReferences) {
  expect_error("/scenes/0/file", "c.xml", "scenes \"one\".file: c.xml is neither beside the suite nor in ");
  expect_error("/scenes/1/reference/image", "c.exr", "scenes \"far\".reference.image: c.exr is neither");
  expect_error("/scenes/0/reference", Json::object(), "write either \"image\"");
  const Json path = {{"integrator", "path"}, {"spp", 64}}, few = {{"integrator", "bdpt"}, {"spp", 15}};
  expect_error("/scenes/0/reference/made_by", Json::array({path}), "two different integrators");
  expect_error("/scenes/0/reference/made_by", Json::array({path, path}), "two different integrators");
  expect_error("/scenes/0/reference/made_by", Json::array({path, few}), "spp is under 16");
}

TEST_F(SuiteFile, WithoutQuickThereIsNoQuick) {
  Json json = good();
  json.erase("quick");
  EXPECT_FALSE(load(json).quick);
  EXPECT_THROW(load(json, true), Error);
}

// What the command line refuses: methods that would look different in the report and are the same.
TEST_F(SuiteFile, KeysThatDoNothingAreErrors) {
  const auto expect = [&](const Json& method, const std::string& part) {
    Json json = good();
    json["methods"][0] = method;
    json["methods"][0]["name"] = "p";
    const std::string error = error_of(json.dump());
    if (part.empty()) {
      EXPECT_EQ(error, "") << method;
    } else {
      EXPECT_NE(error.find("methods \"p\"." + part), std::string::npos) << method << ": " << error;
    }
  };
  for (const auto& [key, value] : {std::pair<const char*, Json>{"guide", "both"},
                                   {"field_memory", 1 << 20},
                                   {"field_structure", "grid"},
                                   {"field_rule", "max"},
                                   {"field_rate", "recent"},
                                   {"train", 4}}) {
    expect({{"integrator", "vcm"}, {key, value}}, key + std::string(": the integrator vcm learns no fields"));
    expect({{"integrator", "guided-vcm"}, {key, value}}, "");
  }
  expect({{"integrator", "path"}, {"field_memory", 1 << 20}, {"light_choice", "learned"}}, "");
  for (const std::string name : {"path", "vpl"})
    expect({{"integrator", name}, {"plan", "all"}}, "plan: " + name + " leaves nothing out");
  expect({{"integrator", "guided-path"}, {"guide", "light"}}, "guide: guided-path has no light subpaths");
  expect({{"integrator", "vpl"}, {"guide", "camera"}}, "guide: vpl guides light subpaths alone");
  expect({{"integrator", "vpl"}, {"guide", "both"}}, "");
  expect({{"integrator", "guided-bdpt"}, {"train", 3}}, "train: is 3; passes come in pairs");
  for (const char* choice : {"tree", "learned"})
    expect({{"integrator", "light"}, {"light_choice", choice}},
           "light_choice: light chooses its lights by their power");
  expect({{"integrator", "vcm"}, {"light_choice", "learned"}}, "light_choice: vcm learns no choice of lights");
  expect({{"integrator", "vcm"}, {"light_choice", "tree"}}, "");
  for (const std::string name : {"light", "photon"})
    expect({{"integrator", name}, {"heuristic", "balance"}}, "heuristic: " + name + " has one way to each path");
  expect({{"integrator", "path"}, {"heuristic", "balance"}}, "");
  expect({{"integrator", "bdpt"}, {"merge_radius", 2}}, "merge_radius: bdpt merges nothing");
  expect({{"integrator", "vcm"}, {"merge_radius", 0}}, "");
  expect({{"integrator", "photon"}, {"merge_radius", 0}}, "merge_radius: is 0; photon needs");
  expect({{"integrator", "vcm"}, {"final_gather", 4}}, "final_gather: vcm has no photon map to gather from");
  expect({{"integrator", "photon"}, {"final_gather", 4}}, "");
  expect({{"integrator", "light"}, {"limit_fireflies", true}}, "");
  const Json part = {{"integrator", "bdpt"}, {"spp", 64}, {"final_gather", 4}};
  expect_error("/scenes/0/reference/made_by", Json::array({part, {{"integrator", "path"}, {"spp", 64}}}),
               "made_by[0].final_gather: bdpt has no photon map");
}

// The suites that come with Ajar. Their scenes in this tree are there; those that are not are optional.
TEST(Suites, ThatComeWithAjar) {
  for (const char* name : {"door", "doors", "sweep", "unguided", "curves", "easy", "merging", "plan"})
    for (const bool quick : {false, true}) {
      const Suite suite = load_suite(kit::source_path(std::string("benchmarks/") + name + ".json"), quick);
      EXPECT_GE(suite.methods.size(), 2u) << name;
      EXPECT_GE(suite.scenes.size(), 1u) << name;
      EXPECT_EQ(suite.quick, quick);
    }
}

// They keep references in one folder, by name, size and depth: what has the same must be asked for in the same way.
TEST(Suites, ThatComeWithAjarShareReferences) {
  std::map<std::string, std::pair<std::string, std::string>> asked;  // by file: for what, and by which suite
  for (const char* name : {"door", "doors", "sweep", "unguided", "curves", "easy", "merging", "plan"})
    for (const bool quick : {false, true})
      for (const BenchScene& scene :
           load_suite(kit::source_path(std::string("benchmarks/") + name + ".json"), quick).scenes) {
        std::string request = scene.file + Json(scene.defines).dump();
        for (const ReferencePart& part : scene.parts)
          request += options_json(part.options, false).dump() + to_json(part.budget).dump();
        const std::string file =
            fmt::format("{}-{}x{}-depth{}", scene.name, scene.width, scene.height, scene.max_depth.value_or(0));
        const auto& [first, by] = asked.emplace(file, std::pair(request, name)).first->second;
        EXPECT_EQ(request, first) << file << " of " << name << " and " << by;
      }
  EXPECT_GT(asked.size(), 20u);
}

// Each scene is brighter lit than the one before, as its door is nearer to closed.
TEST(Suites, SweepClosesTheDoor) {
  const Suite suite = load_suite(kit::source_path("benchmarks/sweep.json"), false);
  ASSERT_EQ(suite.scenes.size(), 6u);
  for (size_t i = 1; i < suite.scenes.size(); ++i) {
    const auto &wide = suite.scenes[i - 1].defines, &narrow = suite.scenes[i].defines;
    EXPECT_LT(std::stod(narrow.at("door")), std::stod(wide.at("door")));
    EXPECT_GT(std::stod(narrow.at("radiance")), std::stod(wide.at("radiance")));
    EXPECT_EQ(suite.scenes[i].name, "door-" + narrow.at("door"));
  }
}

TEST(SuiteOptions, ThoseThatDifferFromTheirDefaults) {
  RenderOptions options;
  options.integrator = "path";
  EXPECT_EQ(options_json(options, false).dump(), R"({"integrator":"path"})");
  options.sampler = SamplerKind::independent;
  EXPECT_EQ(options_json(options, false).dump(), R"({"integrator":"path","sampler":"independent"})");
  options.limit_fireflies = true;
  EXPECT_EQ(options_json(options, false).dump(),
            R"({"integrator":"path","sampler":"independent","limit_fireflies":true})");
  EXPECT_EQ(options_json(options).size(), 16u);
}

}  // namespace
}  // namespace ajar
