#include "ajar/report/bench.h"

#include <fmt/format.h>

#include <fstream>

#include "ajar/core/error.h"
#include "ajar/core/files.h"
#include "ajar/film/pyramid.h"
#include "ajar/report/fields.h"
#include "element.h"
#include "race.h"
#include "results.h"

namespace ajar {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Everything about one scene that goes from step to step.
struct Stand {
  const BenchScene* scene = nullptr;
  Json json;  ///< of results.json, without methods
  std::optional<Reference> reference;
  std::string reference_hash, content;
};

struct Bench {
  const Suite& suite;
  const BenchOptions& options;
  std::vector<Stand> stands = {};
  double start = 0, units = 0, done = 0;  ///< of runs; a unit is a budget
  bool stopped = false;
  std::vector<std::string> refused = {};  ///< why, of references

  fs::path run_path(const Stand& stand, const Method& method, uint64_t seed) const {
    return options.folder / "runs" / stand.scene->name / fmt::format("{}-seed{}.json", method.name, seed);
  }
};

/// A run of an earlier call; nothing where there is none. Throws Error for one that was held against another reference,
/// or of another scene.
std::optional<Json> find_run(const Bench& bench, const Stand& stand, const Method& method, uint64_t seed) {
  const fs::path path = bench.run_path(stand, method, seed);
  if (!is_there(path.string())) return {};
  Json file = read_json(path, "delete it, and the run is made again");
  const Json content = file.is_object() ? file.value("content", Json("")) : Json();
  if (!content.is_string() || !file.contains("run") || !is_run(file["run"]) || !file.contains("reference"))
    throw Error(fmt::format("{}: is no run of a bench; delete it", path.string()));
  if (content != stand.content)
    throw Error(fmt::format(
        "{}: a file of the scene has changed since; name another folder with -o, or delete {} and {}", path.string(),
        path.parent_path().string(), (bench.options.folder / "techniques" / stand.scene->name).string()));
  if (file["reference"] != stand.reference_hash)
    throw Error(fmt::format("{}: was measured against another reference; name another folder with -o, or delete {}",
                            path.string(), path.parent_path().string()));
  return file["run"];
}

void write_image(const Bench& bench, const Stand& stand, const std::string& name, const Picture& image) {
  const fs::path folder = bench.options.folder / "images" / stand.scene->name;
  make_folder(folder.string());
  write_exr((folder / (name + ".exr")).string(), image, {{"ajar:version", bench.options.version}});
}

/// Follows a racer, with the share of all that is to be done; false to stop.
bool watch(Bench& bench, const Stand& stand, const Racer& racer, double done) {
  if (!bench.options.watch) return true;
  const bool known = done > 0.02 * bench.units;  // the first of what a run measures costs more than it renders
  const double left = known ? (wall_seconds() - bench.start) / done * (bench.units - done) : infinity;
  const std::string what = fmt::format("{} seed {} {}", stand.scene->name, racer.options.seed, racer.method->name);
  const double share = bench.units > 0 ? done / bench.units : 1;  // all runs may be there already
  bench.stopped = !bench.options.watch({what, share, left});
  return !bench.stopped;
}

void write_runs(const Bench& bench, const Stand& stand, const std::vector<Racer>& racers) {
  for (const Racer& racer : racers) {
    const uint64_t seed = racer.options.seed;
    if (seed == bench.suite.seeds[0]) write_image(bench, stand, racer.method->name, develop(racer.state.film));
    const fs::path path = bench.run_path(stand, *racer.method, seed);
    make_folder(path.parent_path().string());
    const Json run = {{"reference", stand.reference_hash}, {"content", stand.content}, {"run", run_json(racer)}};
    write_text(path.string(), text_of(run, 1) + "\n");
  }
}

struct FieldPicture {
  const char *file, *title;
  Picture (*make)(const Scene&, const Accel&, const Fields&);
};
constexpr FieldPicture field_pictures[] = {
    {"cells.png", "Cells", picture_cells},
    {"irradiance.png", "Irradiance of each cell (Q)",
     [](const Scene& s, const Accel& a, const Fields& f) { return picture_totals(s, a, f, Side::camera).picture; }},
    {"importance.png", "Importance of each cell (W)",
     [](const Scene& s, const Accel& a, const Fields& f) { return picture_totals(s, a, f, Side::light).picture; }},
    {"q.png", "Hemispheres of Q",
     [](const Scene& s, const Accel& a, const Fields& f) { return picture_strata(s, a, f, Side::camera); }},
    {"w.png", "Hemispheres of W",
     [](const Scene& s, const Accel& a, const Fields& f) { return picture_strata(s, a, f, Side::light); }}};

fs::path fields_folder(const Stand& stand, const std::string& method) {
  return fs::path("fields") / stand.scene->name / method;
}

/// What a racer learned, as pictures.
void show_fields(const Bench& bench, const Stand& stand, const LoadedScene& loaded, const Racer& racer) {
  const Fields& fields = racer.state.learning.fields;
  if (fields.cells.empty()) return;
  const fs::path folder = bench.options.folder / fields_folder(stand, racer.method->name);
  make_folder(folder.string());
  for (const FieldPicture& p : field_pictures)
    write_png((folder / p.file).string(), p.make(*loaded.scene, *loaded.accel, fields));
}

Json fields_json(const Bench& bench, const Stand& stand, const Method& method) {
  Json list = Json::array();
  for (const FieldPicture& p : field_pictures) {
    const fs::path image = fields_folder(stand, method.name) / p.file;
    if (is_there((bench.options.folder / image).string()))
      list.push_back({{"title", p.title}, {"image", image.string()}});
  }
  return list;
}

/// One seed of one scene: the methods that have no run yet.
void run_seed(Bench& bench, const Stand& stand, const LoadedScene& loaded, size_t seed_index) {
  const Suite& suite = bench.suite;
  std::vector<Racer> racers;
  for (const Method& method : suite.methods)
    if (const uint64_t seed = suite.seeds[seed_index]; !find_run(bench, stand, method, seed))
      racers.push_back(make_racer(method, loaded, seed, bench.options.threads));
  if (racers.empty()) return;
  const auto follow = [&](const Racer& at_work) {
    double done = bench.done;
    for (const Racer& r : racers) done += std::min(share_done(suite.budget, r.state), 1.0);
    return watch(bench, stand, at_work, done);
  };
  if (!race(loaded, suite.budget, stand.reference->image, seed_index, racers, follow)) return;
  bench.done += double(racers.size());
  if (seed_index == 0)
    for (const Racer& racer : racers) show_fields(bench, stand, loaded, racer);
  write_runs(bench, stand, racers);
}

/// Images of the single strategies, of renders made for them alone, since keeping them takes time: a tenth of the
/// budget.
void make_techniques(Bench& bench, const Stand& stand, const LoadedScene& loaded) {
  const Budget& all = bench.suite.budget;
  const double amount = (all.cpu_seconds + all.seconds + all.spp) / 10;
  for (const Method& method : bench.suite.methods) {
    const fs::path folder = bench.options.folder / "techniques" / stand.scene->name / method.name;
    if (!has_strategies(method.options.integrator) || is_there(folder.string()) || bench.stopped) continue;
    Racer racer = make_racer(method, loaded, bench.suite.seeds[0], bench.options.threads);
    racer.options = with_budget(racer.options, with_amount(all, all.spp > 0 ? std::max(amount, 1.0) : amount));
    racer.options.techniques = true;
    racer.state = start_render(*loaded.scene, racer.options);
    render(*loaded.scene, *loaded.accel, racer.options, racer.state,
           [&](const RenderState&) { return watch(bench, stand, racer, bench.done); });
    if (bench.stopped || racer.state.pyramid.layers.empty()) continue;
    const fs::path aside = folder.parent_path() / ("." + method.name + ".tmp");  // a name that no method has
    make_folder(aside.string());
    write_pyramid(racer.state.pyramid, racer.state.film, aside.string());
    std::error_code error;
    fs::rename(aside, folder, error);
    if (error) throw Error(fmt::format("{}: cannot be renamed ({})", aside.string(), error.message()));
  }
}

Json techniques_json(const Bench& bench, const Stand& stand, const Method& method) {
  const fs::path relative = fs::path("techniques") / stand.scene->name / method.name;
  Json list = Json::array();
  for (const fs::path& path : files_in((bench.options.folder / relative).string())) {
    int s = 0, t = 0;
    char kind = 0;
    const fs::path file = path.filename();
    const std::string stem = file.stem().string();
    if (!is_layer(file.string()) || stem.ends_with("-raw")) continue;
    std::sscanf(stem.c_str(), "%c%dt%d", &kind, &s, &t);
    list.push_back({{"s", s},
                    {"t", t},
                    {"merged", kind == 'm'},
                    {"weighted", (relative / file).string()},
                    {"raw", (relative / (stem + "-raw.exr")).string()}});
  }
  return list;
}

Json method_json(const Bench& bench, const Stand& stand, const Method& method) {
  Json runs = Json::array();
  for (const uint64_t seed : bench.suite.seeds)
    if (auto run = find_run(bench, stand, method, seed)) runs.push_back(std::move(*run));
  const fs::path image = fs::path("images") / stand.scene->name / (method.name + ".exr");
  return {{"name", method.name},
          {"options", options_json(method.options)},
          {"image", is_there((bench.options.folder / image).string()) ? Json(image.string()) : Json(nullptr)},
          {"techniques", techniques_json(bench, stand, method)},
          {"fields", fields_json(bench, stand, method)},
          {"runs", runs}};
}

Json scene_json(const Bench& bench, const Stand& stand) {
  Json json = stand.json;
  json["methods"] = Json::array();
  if (!stand.reference) return json;
  for (const Method& method : bench.suite.methods) json["methods"].push_back(method_json(bench, stand, method));
  Json baseline_runs;
  for (const Json& method : json["methods"])
    if (method["name"] == bench.suite.baseline) baseline_runs = method["runs"];
  for (Json& method : json["methods"])
    summarise(method, baseline_runs, method["name"] == bench.suite.baseline, bench.suite.budget);
  return json;
}

Json results_json(const Bench& bench) {
  const Suite& suite = bench.suite;
  Json json = {{"format", 1},
               {"version", bench.options.version},
               {"build", bench.options.build},
               {"title", suite.title},
               {"date", date_text()},
               {"machine", machine_json(bench.options.threads)},
               {"command", bench.options.command},
               {"quick", suite.quick},
               {"interrupted", bench.stopped},
               {"refused", bench.refused},
               {"budget", to_json(suite.budget)},
               {"seeds", suite.seeds},
               {"baseline", suite.baseline},
               {"scenes", Json::array()}};
  for (const Stand& stand : bench.stands) json["scenes"].push_back(scene_json(bench, stand));
  return json;
}

Stand make_stand(const Bench& bench, const BenchScene& scene) {
  Stand stand;
  stand.scene = &scene;
  stand.json = {{"name", scene.name}, {"file", scene.file}, {"defines", scene.defines}};
  for (const char* key : {"width", "height", "max_depth", "triangles", "load_seconds", "build_seconds"})
    stand.json[key] = nullptr;
  stand.json["reference"] = nullptr;
  stand.json["skipped"] = scene.missing.empty() ? Json(nullptr) : Json(scene.missing);
  if (!scene.missing.empty()) return stand;
  const LoadedScene loaded = load(bench.suite, scene);
  const Camera& camera = loaded.scene->camera;
  stand.json["width"] = camera.crop_width;
  stand.json["height"] = camera.crop_height;
  stand.json["max_depth"] = loaded.scene->hints.max_depth;
  stand.content = content_of(*loaded.scene);
  stand.json["triangles"] = count_triangles(*loaded.scene);
  stand.reference = find_reference(bench.suite, scene, *loaded.scene, bench.options);
  return stand;
}

void set_reference(const Bench& bench, Stand& stand) {
  const Reference& r = *stand.reference;
  stand.reference_hash =
      hash_of({reinterpret_cast<const char*>(r.image.pixels.data()), r.image.pixels.size() * sizeof r.image.pixels[0]});
  for (const Method& method : bench.suite.methods)  // what does not go with them leaves the folder as it is
    for (const uint64_t seed : bench.suite.seeds) find_run(bench, stand, method, seed);
  write_image(bench, stand, "reference", r.image);
  stand.json["reference"] = {{"image", fmt::format("images/{}/reference.exr", stand.scene->name)},
                             {"relmse", r.relmse ? Json(*r.relmse) : Json(nullptr)},
                             {"made_by", r.made_by}};
}

/// Whether a bench wrote this file, perhaps one that ended before its first run.
bool is_of_bench(const fs::path& suite) {
  std::ifstream in(suite, std::ios::binary);
  const Json json = Json::parse(in, nullptr, false);
  return json.is_object() && json.contains("version") && json.contains("build") && json.contains("threads");
}

/// Of a folder in which no run lies: throws Error where files that no bench wrote would be written over.
void require_free(const fs::path& folder) {
  const bool claimed = is_there((folder / "suite.json").string());
  if (claimed && is_of_bench(folder / "suite.json")) return;
  for (const char* name : bench_files)
    if (is_there((folder / name).string()))
      throw Error(fmt::format("{}: is of no bench, and would be written over; name another folder with -o",
                              (folder / name).string()));
}

/// The folder is this suite's and this program's from now on.
void claim_folder(const Bench& bench) {
  const fs::path path = bench.options.folder / "suite.json";
  const std::string folder = bench.options.folder.string(), elsewhere = "name another folder with -o";
  Json key = to_json(bench.suite);
  key["version"] = bench.options.version, key["build"] = bench.options.build;
  key["threads"] = machine_json(bench.options.threads)["threads"];
  if (!is_there(path.string()) || !is_there((bench.options.folder / "runs").string())) {
    require_free(bench.options.folder);
    make_folder(folder);
    write_text(path.string(), text_of(key, 1) + "\n");
    return;
  }
  Json there = read_json(path, "delete the folder, or name another one with -o");
  if (there == key) return;
  const Json threads = there.is_object() ? there.value("threads", key["threads"]) : Json();
  if (there.is_object()) there["threads"] = key["threads"];
  if (there == key)
    throw Error(fmt::format("{}: holds runs by {} threads, whose times are others; write --threads {}, or {}", folder,
                            threads.dump(), threads.dump(), elsewhere));
  if (there.is_object()) there["version"] = key["version"], there["build"] = key["build"];
  if (there == key)
    throw Error(
        fmt::format("{}: holds runs of another build of Ajar, which are not for one table; {}", folder, elsewhere));
  throw Error(fmt::format("{}: holds runs of another suite than {} asks for{}; {}", folder, bench.suite.path.string(),
                          bench.suite.quick ? " with --quick" : "", elsewhere));
}

/// Throws Error where what is to be made could not be written.
void check_outputs(const Bench& bench) {
  const fs::path& folder = bench.options.folder;
  for (const char* name : {"results.json", "results.csv", "report.html", "curves.svg"})
    check_file((folder / name).string());
  for (const Stand& stand : bench.stands)
    if (!stand.reference && stand.scene->missing.empty()) check_folder(bench.options.references.string());
  for (const Stand& stand : bench.stands)
    if (stand.scene->missing.empty())
      for (const char* kind : {"runs", "images"}) check_folder((folder / kind / stand.scene->name).string());
}

void make_references(Bench& bench) {
  for (Stand& stand : bench.stands) {
    if (!stand.scene->missing.empty() || bench.stopped) continue;
    if (!stand.reference) {
      LoadedScene loaded = load(bench.suite, *stand.scene);
      build(loaded);
      try {
        stand.reference = make_reference(bench.suite, *stand.scene, loaded, bench.options);
        bench.stopped = !stand.reference;
      } catch (const ReferenceRefused& refused) {
        stand.json["skipped"] = refused.what();
        bench.refused.push_back(refused.what());
      }
    }
    if (stand.reference) set_reference(bench, stand);
  }
}

void run_scene(Bench& bench, Stand& stand) {
  LoadedScene loaded = load(bench.suite, *stand.scene);
  build(loaded);
  stand.json["load_seconds"] = loaded.load_seconds;
  stand.json["build_seconds"] = loaded.build_seconds;
  for (size_t i = 0; i < bench.suite.seeds.size() && !bench.stopped; ++i) run_seed(bench, stand, loaded, i);
  if (bench.suite.techniques && !bench.stopped) make_techniques(bench, stand, loaded);
}

}  // namespace

Json run_bench(const Suite& suite, const BenchOptions& options) {
  Bench bench{suite, options};
  for (const BenchScene& scene : suite.scenes) bench.stands.push_back(make_stand(bench, scene));
  check_outputs(bench);
  claim_folder(bench);
  make_references(bench);
  for (const Stand& stand : bench.stands)
    for (const Method& method : suite.methods)
      for (const uint64_t seed : suite.seeds) bench.units += stand.reference && !find_run(bench, stand, method, seed);
  bench.start = wall_seconds();
  for (Stand& stand : bench.stands)
    if (stand.reference && !bench.stopped) run_scene(bench, stand);
  const Json results = results_json(bench);
  write_text((options.folder / "results.json").string(), text_of(results, 1) + "\n");
  write_text((options.folder / "results.csv").string(), results_csv(results));
  return results;
}

}  // namespace ajar
