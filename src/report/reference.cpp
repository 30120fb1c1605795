#include "reference.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "agreement.h"
#include "ajar/core/error.h"
#include "ajar/core/files.h"
#include "ajar/report/metrics.h"
#include "ajar/scene/load.h"
#include "element.h"

namespace ajar {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr int fewest_batches = 16;         // to know the variance of a mean from
constexpr double longest_batch = 15;       // seconds, CPU or wall: what Ctrl-C may cost
constexpr uint64_t first_seed = 1u << 31;  // far from the seeds of suites, whose noise must not be the reference's

Json scene_json(const BenchScene& scene, const Scene& loaded) {
  const Camera& camera = loaded.camera;
  return {{"file", scene.file},
          {"content", content_of(loaded)},
          {"defines", scene.defines},
          {"size", {camera.crop_width, camera.crop_height}},
          {"max_depth", loaded.hints.max_depth}};
}

Json request_json(const BenchScene& scene, const Scene& loaded) {
  Json parts = Json::array();
  for (const ReferencePart& part : scene.parts) {
    Json one = options_json(part.options, false);
    one.update(to_json(part.budget));
    parts.push_back(one);
  }
  return {{"scene", scene_json(scene, loaded)}, {"made_by", parts}};
}

/// How a part is cut into batches: a longer budget has more of the same, so that it goes on from a shorter one.
struct Cut {
  int count = fewest_batches;
  Budget each;
};

Cut cut(const Budget& budget) {
  Cut c;
  if (budget.spp > 0) {
    c.each.spp = budget.spp / fewest_batches;
    return c;
  }
  const double all = budget.cpu_seconds + budget.seconds;
  c.count = std::max(fewest_batches, int(std::ceil(all / longest_batch)));
  (budget.cpu_seconds > 0 ? c.each.cpu_seconds : c.each.seconds) = all / c.count;
  return c;
}

struct Part {
  Batches batches;
  double seconds = 0, cpu_seconds = 0, spp = 0;

  void add(ReferenceBatch batch, const Metadata& data) {
    spp += batch.spp;
    seconds += std::get<double>(data.at("ajar:seconds"));
    cpu_seconds += std::get<double>(data.at("ajar:cpu_seconds"));
    batches.push_back(std::move(batch));
  }
};

/// A batch that an earlier run left, if it is of this key, and whole.
bool read_batch(const fs::path& path, const std::string& key, Part& part) try {
  if (!is_there(path.string())) return false;
  const Metadata data = read_metadata(path.string());
  const auto found = data.find("ajar:key");
  if (found == data.end() || found->second != Metadata::mapped_type(key)) return false;
  part.add({read_rgb(path.string()), std::get<double>(data.at("ajar:spp"))}, data);
  return true;
} catch (const Error&) {
  return false;  // it is made again
}

/// False when the watch stops it.
bool render_batch(const LoadedScene& loaded, const RenderOptions& options, const fs::path& path, const std::string& key,
                  const std::function<bool(const RenderState&)>& go_on, Part& part) {
  RenderState state = start_render(*loaded.scene, options);
  bool stopped = false;
  render(*loaded.scene, *loaded.accel, options, state, [&](const RenderState& s) { return !(stopped = !go_on(s)); });
  if (stopped) return false;
  const ReferenceBatch batch{develop(state.film), spp_of(state.film)};
  const Metadata data = {{"ajar:key", key},
                         {"ajar:spp", batch.spp},
                         {"ajar:seconds", state.stats.seconds},
                         {"ajar:cpu_seconds", state.stats.cpu_seconds}};
  write_exr(path.string(), batch.image, data);
  part.add(batch, data);
  return true;
}

/// Renders or reads all batches, the two parts in turns; false when stopped.
bool collect(const BenchScene& scene, const LoadedScene& loaded, const BenchOptions& options, const fs::path& folder,
             std::array<Part, 2>& parts) {
  const Cut cuts[2] = {cut(scene.parts[0].budget), cut(scene.parts[1].budget)};
  const int all = cuts[0].count + cuts[1].count, rounds = std::max(cuts[0].count, cuts[1].count);
  const double start = wall_seconds();
  int done = 0, made = 0;
  for (int k = 0; k < rounds; ++k)
    for (size_t i = 0; i < 2; ++i) {
      if (k >= cuts[i].count) continue;
      RenderOptions render_options = with_budget(scene.parts[i].options, cuts[i].each);
      render_options.seed = first_seed + uint64_t(i) * (first_seed >> 1) + uint64_t(k);
      render_options.threads = options.threads;
      render_options.max_depth = loaded.scene->hints.max_depth;
      const Json key = {{"scene", scene_json(scene, *loaded.scene)},
                        {"options", options_json(render_options, false)},
                        {"batch", to_json(cuts[i].each)},
                        {"seed", render_options.seed},
                        {"version", options.version},
                        {"build", options.build}};
      const fs::path path = folder / fmt::format("{}-{}-{:03}.exr", i, render_options.integrator, k);
      ++done;
      if (read_batch(path, text_of(key, -1), parts[i])) continue;
      const auto go_on = [&](const RenderState&) {
        const double left = made > 0 ? (wall_seconds() - start) / made * (all - done + 1) : infinity;
        return !options.watch || options.watch({fmt::format("reference {} by {}, batch {} of {}", scene.name,
                                                            render_options.integrator, k + 1, cuts[i].count),
                                                double(done - 1) / all, left});
      };
      if (!render_batch(loaded, render_options, path, text_of(key, -1), go_on, parts[i])) return false;
      ++made;
    }
  return true;
}

Json block_json(const BlockTest& b) {
  return {{"x", b.x},
          {"y", b.y},
          {"width", b.width},
          {"height", b.height},
          {"channel", std::string(1, b.channel)},
          {"means", {b.first.mean, b.second.mean}},
          {"deviations", {std::sqrt(b.first.variance), std::sqrt(b.second.variance)}},
          {"t", b.t},
          {"p", b.p}};
}

Json record(const BenchScene& scene, const Scene& loaded, const BenchOptions& options, const std::array<Part, 2>& parts,
            const Agreement& agreement, const Combined& combined) {
  Json made = Json::array();
  for (size_t i = 0; i < 2; ++i)
    made.push_back({{"integrator", scene.parts[i].options.integrator},
                    {"batches", parts[i].batches.size()},
                    {"spp", parts[i].spp},
                    {"seconds", parts[i].seconds},
                    {"cpu_seconds", parts[i].cpu_seconds},
                    {"relmse", combined.relmse[i]},
                    {"weight", combined.weight[i]}});
  return {{"format", 1},
          {"version", options.version},
          {"request", request_json(scene, loaded)},
          {"made", made},
          {"agreement",
           {{"p", agreement.p}, {"whole", block_json(agreement.whole)}, {"worst", block_json(agreement.worst)}}},
          {"relmse", combined.relmse_both}};
}

void require_agreement(const Suite& suite, const BenchScene& scene, const Agreement& agreement) {
  if (agreement.p >= least_agreement) return;
  const BlockTest& b = agreement.worst;
  const double relative = (b.first.mean - b.second.mean) / std::max(std::abs(b.second.mean), 1e-30);
  throw ReferenceRefused(fmt::format(
      "{}: scenes \"{}\".reference: {} and {} disagree: channel {} of the {}x{} pixels at {},{} has means {:.6g} +- "
      "{:.2g} and {:.6g} +- {:.2g}, {:+.2g} %, p = {:.1g}; one is wrong here or misses what is rare: run longer, or "
      "name other integrators",
      suite.path.string(), scene.name, scene.parts[0].options.integrator, scene.parts[1].options.integrator, b.channel,
      b.width, b.height, b.x, b.y, b.first.mean, std::sqrt(b.first.variance), b.second.mean,
      std::sqrt(b.second.variance), 100 * relative, agreement.p));
}

void require_light(const Picture& image, const fs::path& path) {
  if (std::all_of(image.pixels.begin(), image.pixels.end(), [](float value) { return value == 0; }))
    throw ReferenceRefused(
        fmt::format("{}: is black, nothing can be measured against it; does light reach the camera within max_depth?",
                    path.string()));
}

// Where a reference that is made lies, without ".exr" or ".json".
fs::path reference_stem(const std::string& name, const Scene& scene, const fs::path& folder) {
  const Camera& camera = scene.camera;
  return folder / fmt::format("{}-{}x{}-depth{}", name, camera.crop_width, camera.crop_height, scene.hints.max_depth);
}

Picture read_reference(const fs::path& path, const Camera& camera) {
  Picture image = read_rgb(path.string());
  require_comparable(image, path.string());
  require_light(image, path);
  if (image.width != camera.crop_width || image.height != camera.crop_height)
    throw Error(fmt::format("{}: has {}x{} pixels, the scene renders {}x{}; set the scene's size in the suite",
                            path.string(), image.width, image.height, camera.crop_width, camera.crop_height));
  return image;
}

/// The noise that an image has by the record beside it, of `ajar render` or of a reference made before; nothing where
/// there is none. Beside images of others may lie what it will.
std::optional<double> recorded_relmse(fs::path image) {
  std::ifstream in(image.replace_extension(".json"), std::ios::binary);
  const Json record = Json::parse(in, nullptr, false);
  if (!record.is_object()) return {};
  for (const char* key : {"relmse", "estimated_relmse"})
    if (const auto found = record.find(key); found != record.end() && found->is_number() && found->get<double>() >= 0)
      return found->get<double>();
  return {};
}

}  // namespace

std::string hash_of(std::string_view bytes) {
  uint64_t hash = 0xcbf29ce484222325;
  for (const char c : bytes) hash = (hash ^ uint8_t(c)) * 0x100000001b3;
  return fmt::format("{:016x}", hash);
}

std::string content_of(const Scene& scene) { return fmt::format("{:016x}", scene.content); }

LoadedScene load(const Suite& suite, const BenchScene& scene) {
  LoadedScene loaded;
  const double start = wall_seconds();
  LoadOptions options;
  options.defines = scene.defines;
  try {
    loaded.scene = std::make_unique<Scene>(load_scene(scene.path.string(), options));
  } catch (const Error& error) {
    throw Error(fmt::format("{}: scenes \"{}\": {}", suite.path.string(), scene.name, error.what()));
  }
  if (scene.width > 0) set_size(loaded.scene->camera, scene.width, scene.height);
  int& depth = loaded.scene->hints.max_depth;
  if (scene.max_depth) depth = *scene.max_depth;
  if (depth == 0 || depth < -1)
    throw Error(fmt::format("{}: scenes \"{}\": the scene's max_depth is {}; give it another one here",
                            suite.path.string(), scene.name, depth));
  loaded.load_seconds = wall_seconds() - start;
  return loaded;
}

void build(LoadedScene& loaded) {
  const double start = wall_seconds();
  loaded.accel = std::make_unique<Accel>(*loaded.scene);
  loaded.build_seconds = wall_seconds() - start;
}

std::optional<Reference> find_reference(const Suite& suite, const BenchScene& scene, const Scene& loaded,
                                        const BenchOptions& options) {
  const Camera& camera = loaded.camera;
  if (!scene.reference.empty())
    return Reference{read_reference(scene.reference, camera),
                     recorded_relmse(scene.reference),
                     {{"image", scene.reference.filename().string()}}};
  const fs::path stem = reference_stem(scene.name, loaded, options.references);
  const fs::path image = stem.string() + ".exr", json = stem.string() + ".json";
  if (!is_there(json.string()) && is_there(image.string()) && !is_there(stem.string() + ".parts"))
    throw Error(
        fmt::format("{}: has no record {} beside it, so a bench did not make it, and would write over it; move "
                    "it, delete it, or name another folder with --references",
                    image.string(), json.filename().string()));
  if (!is_there(image.string()) || !is_there(json.string())) return {};
  Json made = read_json(json, "delete it, and the reference is made again");
  if (!made.is_object() || made.value("request", Json()) != request_json(scene, loaded))
    throw Error(
        fmt::format("{}: was made from another scene (a file of it may have changed) or with another budget than {} "
                    "asks for \"{}\"; ask for "
                    "the same, delete it, or name another folder with --references",
                    json.string(), suite.path.string(), scene.name));
  std::optional<double> relmse;
  if (made.contains("relmse") && made["relmse"].is_number()) relmse = made["relmse"].get<double>();
  return Reference{read_reference(image, camera), relmse, std::move(made)};
}

std::optional<Reference> make_reference(const Suite& suite, const BenchScene& scene, const LoadedScene& loaded,
                                        const BenchOptions& options) {
  const fs::path stem = reference_stem(scene.name, *loaded.scene, options.references);
  const fs::path folder = stem.string() + ".parts";
  make_folder(folder.string());
  std::array<Part, 2> parts;
  if (!collect(scene, loaded, options, folder, parts)) return {};
  const Agreement agreement = agree(parts[0].batches, parts[1].batches);
  require_agreement(suite, scene, agreement);
  const Combined combined = combine(parts[0].batches, parts[1].batches);
  require_light(combined.image, stem.string() + ".exr");
  const Json json = record(scene, *loaded.scene, options, parts, agreement, combined);
  write_exr(stem.string() + ".exr", combined.image, {{"ajar:version", options.version}}, PixelType::half);
  write_text(stem.string() + ".json", text_of(json, 2) + "\n");
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  return find_reference(suite, scene, *loaded.scene, options);  // as everyone will read it, in half precision
}

}  // namespace ajar
