#include "ajar/report/suite.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdlib>
#include <set>
#include <span>

#include "ajar/core/error.h"
#include "ajar/core/files.h"
#include "element.h"

namespace ajar {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr double longest = 1e7;  // seconds

std::vector<std::string> listed(std::span<const char* const> names) { return {names.begin(), names.end()}; }

const std::vector<std::string> heuristics = listed(heuristic_names), samplers = listed(sampler_names),
                               structures = listed(structure_names), rules = listed(rule_names),
                               guided = listed(guided_names), rates = {"recent", "visits"};
const std::vector<std::string> plans = {"auto", "all"};  // whether a guided integrator leaves out what does not pay
const std::vector<std::string> light_choices = {"tree", "learned"};

// Why an option would do nothing, as the command line has it; empty if it does something.
std::string if_guided(const RenderOptions& o) {
  if (is_guided(o.integrator)) return {};
  return fmt::format("the integrator {} learns no fields; leave it out, or take guided-bdpt or guided-path",
                     o.integrator);
}
std::string if_it_leaves_out(const RenderOptions& o) {
  RenderOptions usual;
  usual.integrator = o.integrator, usual.leaves_out = true;
  return may_leave_out(usual) ? "" : fmt::format("{} leaves nothing out; leave it out", o.integrator);
}
std::string if_it_guides(const RenderOptions& o) {
  if (o.integrator == "guided-path" && o.learn.guided == Guided::light)
    return "guided-path has no light subpaths; leave it out, or take guided-bdpt";
  if (o.integrator == "vpl" && o.learn.guided != Guided::both) return "vpl guides light subpaths alone; leave it out";
  return if_guided(o);
}
std::string if_it_learns(const RenderOptions& o) { return o.learn_lights ? "" : if_guided(o); }
std::string if_it_trains(const RenderOptions& o) {
  return o.learn.train % 2 ? fmt::format("is {}; passes come in pairs: write an even number", o.learn.train)
                           : if_guided(o);
}
std::string if_it_chooses_lights(const RenderOptions& o) {
  if (o.integrator == "light") return "light chooses its lights by their power alone; leave it out";
  if (!o.learn_lights || is_guided(o.integrator) || o.integrator == "path" || o.integrator == "bdpt") return {};
  return fmt::format("{} learns no choice of lights; leave it out", o.integrator);
}
std::string if_it_merges(const RenderOptions& o) {
  if (!is_merging(o.integrator))
    return fmt::format("{} merges nothing; leave it out, or take vcm, guided-vcm or photon", o.integrator);
  return o.integrator == "photon" && !(o.merge_radius > 0) ? "is 0; photon needs a radius above 0" : "";
}
std::string if_it_weighs(const RenderOptions& o) {
  if (weighs_strategies(o.integrator)) return {};
  return fmt::format("{} has one way to each path, and nothing to weigh; leave it out", o.integrator);
}
std::string if_it_gathers(const RenderOptions& o) {
  if (o.integrator == "photon") return {};
  return fmt::format("{} has no photon map to gather from; leave it out, or take photon", o.integrator);
}
std::string always(const RenderOptions&) { return {}; }

/// An option of a method: how a suite sets it, how a report shows it, what speaks against it. A new option is a line
/// in the table.
struct Option {
  const char* key;
  void (*set)(RenderOptions&, const Element&);
  Json (*show)(const RenderOptions&);
  std::string (*refuse)(const RenderOptions&) = always;
};
const Option options_table[] = {
    {"integrator",
     [](RenderOptions& o, const Element& e) { o.integrator = integrator_names()[choice(e, integrator_names())]; },
     [](const RenderOptions& o) { return Json(o.integrator); }},
    {"heuristic", [](RenderOptions& o, const Element& e) { o.heuristic = Heuristic(choice(e, heuristics)); },
     [](const RenderOptions& o) { return Json(heuristics[size_t(o.heuristic)]); }, if_it_weighs},
    {"sampler", [](RenderOptions& o, const Element& e) { o.sampler = SamplerKind(choice(e, samplers)); },
     [](const RenderOptions& o) { return Json(samplers[size_t(o.sampler)]); }},
    {"roulette_depth", [](RenderOptions& o, const Element& e) { o.roulette_depth = int(integer(e, 1, deepest)); },
     [](const RenderOptions& o) { return Json(o.roulette_depth); }},
    {"plan", [](RenderOptions& o, const Element& e) { o.leaves_out = choice(e, plans) == 0; },
     [](const RenderOptions& o) { return Json(plans[o.leaves_out || !is_guided(o.integrator) ? 0 : 1]); },
     if_it_leaves_out},
    {"guide", [](RenderOptions& o, const Element& e) { o.learn.guided = Guided(choice(e, guided)); },
     [](const RenderOptions& o) { return Json(guided[size_t(o.learn.guided)]); }, if_it_guides},
    {"field_memory",
     [](RenderOptions& o, const Element& e) { o.learn.memory = size_t(integer(e, 64 << 10, int64_t(64) << 30)); },
     [](const RenderOptions& o) { return Json(o.learn.memory); }, if_it_learns},
    {"field_structure",
     [](RenderOptions& o, const Element& e) { o.learn.structure = Structure(choice(e, structures)); },
     [](const RenderOptions& o) { return Json(structures[size_t(o.learn.structure)]); }, if_guided},
    {"field_rule", [](RenderOptions& o, const Element& e) { o.learn.rule = Rule(choice(e, rules)); },
     [](const RenderOptions& o) { return Json(rules[size_t(o.learn.rule)]); }, if_guided},
    {"field_rate", [](RenderOptions& o, const Element& e) { o.learn.forget = choice(e, rates) == 1 ? 1 : 0.5f; },
     [](const RenderOptions& o) { return Json(rates[o.learn.forget == 1]); }, if_guided},
    {"light_choice",
     [](RenderOptions& o, const Element& e) { o.learn.lights = o.learn_lights = choice(e, light_choices) == 1; },
     [](const RenderOptions& o) {
       return Json(light_choices[o.learn.lights && (o.learn_lights || is_guided(o.integrator))]);
     },
     if_it_chooses_lights},
    {"merge_radius", [](RenderOptions& o, const Element& e) { o.merge_radius = float(number(e, 0, 1e6)); },
     [](const RenderOptions& o) { return Json(o.merge_radius); }, if_it_merges},
    {"final_gather", [](RenderOptions& o, const Element& e) { o.final_gather = int(integer(e, 1, 1024)); },
     [](const RenderOptions& o) { return Json(o.final_gather); }, if_it_gathers},
    {"even", [](RenderOptions& o, const Element& e) { o.even = flag(e); },
     [](const RenderOptions& o) { return Json(o.even); }, if_guided},
    {"limit_fireflies", [](RenderOptions& o, const Element& e) { o.limit_fireflies = flag(e); },
     [](const RenderOptions& o) { return Json(o.limit_fireflies); }},
    {"train", [](RenderOptions& o, const Element& e) { o.learn.train = uint32_t(integer(e, 0, 1 << 20)); },
     [](const RenderOptions& o) { return Json(o.learn.train); }, if_it_trains},
};

const std::vector<std::string> budget_keys = {"cpu_seconds", "seconds", "spp"};

std::vector<std::string> option_keys(std::vector<std::string> keys) {
  for (const Option& option : options_table) keys.emplace_back(option.key);
  return keys;
}

// As ajar render has them.
RenderOptions usual_options() {
  RenderOptions options;
  options.leaves_out = true;
  return options;
}

RenderOptions read_options(const Element& e) {
  RenderOptions options = usual_options();
  get(e, "integrator", fmt::format("write one of {}", fmt::join(integrator_names(), ", ")));
  for (const Option& option : options_table)
    if (const auto given = find(e, option.key)) option.set(options, *given);
  for (const Option& option : options_table)
    if (const auto given = find(e, option.key))
      if (const std::string why = option.refuse(options); !why.empty()) fail(*given, why);
  return options;
}

/// From an object that may hold other keys too.
Budget read_budget(const Element& e) {
  Budget budget;
  if (const auto given = find(e, "cpu_seconds")) budget.cpu_seconds = number(*given, 1e-3, longest);
  if (const auto given = find(e, "seconds")) budget.seconds = number(*given, 1e-3, longest);
  if (const auto given = find(e, "spp")) budget.spp = uint32_t(integer(*given, 1, 1 << 30));
  if ((budget.cpu_seconds > 0) + (budget.seconds > 0) + (budget.spp > 0) != 1)
    fail(e, "has no budget or more than one; write one of cpu_seconds, seconds, spp");
  return budget;
}

std::vector<uint64_t> read_seeds(const Element& e) {
  std::vector<uint64_t> seeds;
  if (e.value->is_number()) {
    const auto count = uint64_t(integer(e, 1, 1000));
    for (uint64_t i = 0; i < count; ++i) seeds.push_back(i);
    return seeds;
  }
  for (const Element& item : items(e, "write how many, or a list like [0, 1, 2]")) {
    const auto seed = uint64_t(integer(item, 0, 0x7fffffff));
    if (std::find(seeds.begin(), seeds.end(), seed) != seeds.end())
      fail(item, fmt::format("{} is there already; seeds must differ", seed));
    seeds.push_back(seed);
  }
  return seeds;
}

/// A name becomes part of file names.
std::string read_name(const Element& e, std::set<std::string>& names) {
  const Element given = get(e, "name", "give it one");
  const std::string name = text(given);
  constexpr const char* letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.+";
  if (name.find_first_not_of(letters) != std::string::npos || name[0] == '.')
    fail(given, "names become file names: use letters, digits, - _ + and dots only, no dot first");
  if (name.size() > 100) fail(given, "names become file names: use 100 letters at most");
  if (name == "reference") fail(given, "the reference's image has this name; choose a different one");
  if (!names.insert(name).second) fail(given, "another has this name; choose a different one");
  return name;
}

fs::path shared_scenes(const fs::path& suite) {
  const char* set = std::getenv("AJAR_SHARED_SCENES");
  return set ? fs::path(set) : fs::absolute(suite).parent_path() / "../../shared/scenes";
}

/// Where a file of the suite is; empty: nowhere.
fs::path locate(const fs::path& suite, const std::string& name) {
  const fs::path shared = shared_scenes(suite);
  for (const fs::path& folder : {suite.parent_path(), shared, shared / ".."})
    if (is_file((folder / name).string())) return (folder / name).lexically_normal();
  return {};
}

std::string not_found(const fs::path& suite, const std::string& name) {
  return fmt::format("{} is neither beside the suite nor in {} (set AJAR_SHARED_SCENES to another folder)", name,
                     shared_scenes(suite).lexically_normal().string());
}

std::map<std::string, std::string> read_defines(const Element& e) {
  std::map<std::string, std::string> defines;
  if (!e.value->is_object()) fail(e, "write an object {\"parameter\": \"value\"}");
  for (const auto& [key, value] : e.value->items()) {
    if (!value.is_string() && !value.is_number())
      fail(e, fmt::format("\"{}\" is {}; write a text or a number", key, value.dump()));
    defines[key] = value.is_string() ? value.get<std::string>() : value.dump();
  }
  return defines;
}

void read_reference(const fs::path& suite, const Element& e, BenchScene& scene) {
  require_keys(e, {"image", "made_by"});
  const auto image = find(e, "image"), made_by = find(e, "made_by");
  if (image.has_value() == made_by.has_value())
    fail(e, "write either \"image\": a file, or \"made_by\": two integrators with their budgets");
  if (image) {
    scene.reference = locate(suite, text(*image));
    if (scene.reference.empty() && !scene.path.empty())
      fail(*image, not_found(suite, text(*image)) + "; correct it, or let it be made");
    return;
  }
  for (const Element& item : items(*made_by, "write a list of two integrators with their budgets")) {
    std::vector<std::string> keys = option_keys(budget_keys);
    require_keys(item, keys);
    scene.parts.push_back({read_options(item), read_budget(item)});
    if (scene.parts.back().budget.spp > 0 && scene.parts.back().budget.spp < 16)
      fail(item, "spp is under 16, too few to know the noise; write 16 or more");
  }
  if (scene.parts.size() != 2 || scene.parts[0].options.integrator == scene.parts[1].options.integrator)
    fail(*made_by, "a reference is what two different integrators agree on; name two");
}

BenchScene read_scene(const fs::path& suite, const Element& e, std::set<std::string>& names) {
  require_keys(e, {"name", "file", "defines", "size", "max_depth", "reference", "optional"});
  BenchScene scene;
  scene.name = read_name(e, names);
  const Element file = get(e, "file", "name a Mitsuba XML file");
  scene.file = text(file);
  scene.path = locate(suite, scene.file);
  if (const auto optional = find(e, "optional"); scene.path.empty()) {
    if (!optional || !flag(*optional)) fail(file, not_found(suite, scene.file) + "; correct it, or mark it optional");
    scene.missing = not_found(suite, scene.file);
  } else if (optional) {
    flag(*optional);
  }
  if (const auto defines = find(e, "defines")) scene.defines = read_defines(*defines);
  if (const auto size = find(e, "size")) {
    const auto numbers = items(*size, "write [WIDTH, HEIGHT]");
    if (numbers.size() != 2) fail(*size, "write [WIDTH, HEIGHT]");
    scene.width = int(integer(numbers[0], 1, 65536));
    scene.height = int(integer(numbers[1], 1, 65536));
  }
  if (const auto depth = find(e, "max_depth")) {
    scene.max_depth = int(integer(*depth, -1, deepest));
    if (scene.max_depth == 0) fail(*depth, "is 0; write -1 for unlimited, or 1 or more edges");
  }
  read_reference(suite, get(e, "reference", "write {\"image\": FILE} or {\"made_by\": [...]}"), scene);
  return scene;
}

/// Keeps what the list of names says.
template <class Named>
void keep(const Element& e, std::vector<Named>& all) {
  std::vector<Named> kept;
  for (const Element& item : items(e, "write a list of names")) {
    const std::string name = text(item);
    const auto at = std::find_if(all.begin(), all.end(), [&](const Named& n) { return n.name == name; });
    if (at == all.end()) fail(item, fmt::format("the suite has nothing named \"{}\"; correct the name", name));
    if (std::any_of(kept.begin(), kept.end(), [&](const Named& n) { return n.name == name; }))
      fail(item, fmt::format("\"{}\" is listed twice; keep one", name));
    kept.push_back(*at);
  }
  all = std::move(kept);
}

void apply_quick(const Element& e, Suite& suite) {
  if (const auto budget = find(e, "budget")) {
    require_keys(*budget, budget_keys);
    suite.budget = read_budget(*budget);
  }
  if (const auto seeds = find(e, "seeds")) suite.seeds = read_seeds(*seeds);
  if (const auto scenes = find(e, "scenes")) keep(*scenes, suite.scenes);
  if (const auto methods = find(e, "methods")) keep(*methods, suite.methods);
}

void require_baseline(const Element& e, const Suite& suite) {
  if (std::none_of(suite.methods.begin(), suite.methods.end(), [&](auto& m) { return m.name == suite.baseline; }))
    fail(e, fmt::format("no method is named \"{}\"; name one of those that run", suite.baseline));
}

}  // namespace

Suite load_suite(const fs::path& path, bool quick) {
  const Json json = read_json(path);
  const Element root{&json, path.string(), ""};
  require_keys(root, {"title", "seeds", "budget", "scenes", "methods", "baseline", "techniques", "quick"});
  Suite suite;
  suite.path = path;
  suite.title = text(get(root, "title", "say in a line what is compared"));
  suite.seeds = read_seeds(get(root, "seeds", "write how many, or a list"));
  const Element budget = get(root, "budget", "write {\"cpu_seconds\": 20}, {\"seconds\": 10} or {\"spp\": 64}");
  require_keys(budget, budget_keys);
  suite.budget = read_budget(budget);
  if (const auto techniques = find(root, "techniques")) suite.techniques = flag(*techniques);
  std::set<std::string> names;
  for (const Element& e : items(get(root, "methods", "list them"), "write a list of methods")) {
    require_keys(e, option_keys({"name"}));
    const std::string name = read_name(e, names);
    suite.methods.push_back({name, read_options(e)});
  }
  names.clear();
  for (const Element& e : items(get(root, "scenes", "list them"), "write a list of scenes"))
    suite.scenes.push_back(read_scene(path, e, names));
  const Element baseline = get(root, "baseline", "name the method that the others are held against");
  suite.baseline = text(baseline);
  require_baseline(baseline, suite);
  if (const auto overrides = find(root, "quick")) {
    require_keys(*overrides, {"budget", "seeds", "scenes", "methods"});
    Suite hurried = suite;  // applied in any case, so that a mistake shows at once
    apply_quick(*overrides, hurried);
    require_baseline(baseline, hurried);
    if (quick) suite = std::move(hurried);
  } else if (quick) {
    fail(root, "has no \"quick\"; add one, or leave out --quick");
  }
  suite.quick = quick;
  return suite;
}

Json to_json(const Budget& budget) {
  if (budget.cpu_seconds > 0) return {{"cpu_seconds", budget.cpu_seconds}};
  if (budget.seconds > 0) return {{"seconds", budget.seconds}};
  return {{"spp", budget.spp}};
}

Json options_json(const RenderOptions& options, bool all) {
  Json json;
  for (const Option& option : options_table)
    if (all || &option == options_table || option.show(options) != option.show(usual_options()))
      json[option.key] = option.show(options);
  return json;
}

Json to_json(const Suite& suite) {
  Json json = {{"budget", to_json(suite.budget)}, {"seeds", suite.seeds},     {"baseline", suite.baseline},
               {"techniques", suite.techniques},  {"methods", Json::array()}, {"scenes", Json::array()}};
  for (const Method& method : suite.methods)
    json["methods"].push_back({{"name", method.name}, {"options", options_json(method.options, false)}});
  for (const BenchScene& scene : suite.scenes)
    json["scenes"].push_back({{"name", scene.name},
                              {"file", scene.file},
                              {"defines", scene.defines},
                              {"size", {scene.width, scene.height}},
                              {"max_depth", scene.max_depth ? Json(*scene.max_depth) : Json(nullptr)}});
  return json;
}

RenderOptions with_budget(RenderOptions options, const Budget& budget) {
  options.cpu_seconds = budget.cpu_seconds;
  options.seconds = budget.seconds;
  options.spp = budget.spp;
  return options;
}

}  // namespace ajar
