// ajar render: loads a scene, renders it within a budget, writes image and record.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <thread>

#include "ajar/core/error.h"
#include "ajar/report/account.h"
#include "ajar/report/metrics.h"
#include "arguments.h"
#include "commands.h"
#include "progress.h"
#include "stop.h"
#include "summary.h"

namespace ajar {
namespace {

struct Arguments {
  std::string scene, out, size, time, cpu_time,
      heuristic = "power", sampler = "sobol", log, reference, checkpoint, resume, techniques, integrator, save_fields,
      load_fields, guide = "both", field_memory, field_structure, field_rule, field_rate, versus, plan, light_choice;
  std::optional<std::string> noise;
  std::optional<double> at;
  std::vector<std::string> defines, features;
  int spp = 0, max_depth = std::numeric_limits<int>::min(), threads = 0, roulette_depth = 5;
  uint64_t seed = 0;
  int train = 0;
  std::optional<float> merge_radius;
  bool no_next_event = false, png = false, half = false, quiet = false, lenient = false;
};

double parse_noise(const std::string& text) {
  size_t used = 0;
  double value = 0;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
  }
  if (used != text.size() || !(value > 0) || !std::isfinite(value))
    throw Error(fmt::format("--noise {}: not a target; write the relMSE to stop at, above 0, such as 0.01", text));
  return value;
}

float parse_merge_radius(float radius, const std::string& integrator) {
  if (!is_merging(integrator))
    throw Error(fmt::format("--merge-radius: {} merges nothing; take vcm, guided-vcm or photon", integrator));
  if (!(radius >= 0) || !std::isfinite(radius) || (radius == 0 && integrator == "photon"))
    throw Error(fmt::format("--merge-radius {}: write pixels, {}", radius,
                            integrator == "photon" ? "above 0" : "0 to merge nothing"));
  return radius;
}

// Index of a name that the option's check let pass.
template <class Names>
size_t index_of(const Names& names, const std::string& name) {
  return size_t(std::find(std::begin(names), std::end(names), name) - std::begin(names));
}
std::vector<std::string> listed(std::span<const char* const> names) { return {names.begin(), names.end()}; }

LearnOptions learn_options(const Arguments& a, const std::string& integrator, bool may_learn) {
  const std::pair<const char*, bool> asked[] = {{"--save-fields", !a.save_fields.empty()},
                                                {"--load-fields", !a.load_fields.empty()},
                                                {"--guide", a.guide != "both"},
                                                {"--field-memory", !a.field_memory.empty()},
                                                {"--field-structure", !a.field_structure.empty()},
                                                {"--field-rule", !a.field_rule.empty()},
                                                {"--field-rate", !a.field_rate.empty()},
                                                {"--train", a.train > 0}};
  const bool lights = a.light_choice == "learned";
  if (!may_learn)
    for (const auto& [option, given] : asked)
      if (given && !(lights && std::string_view(option) == "--field-memory"))
        throw Error(fmt::format("{}: the integrator {} learns no fields; add --integrator guided-bdpt or guided-path",
                                option, integrator));
  if (!a.load_fields.empty() && !a.resume.empty())
    throw Error("--load-fields: a checkpoint brings its own fields; leave out either this or --resume");
  if (!a.load_fields.empty() && !a.field_structure.empty())
    throw Error("--load-fields: stored fields bring their structure; leave out either this or --field-structure");
  if (a.train % 2) throw Error(fmt::format("--train {}: passes come in pairs; write an even number", a.train));
  if (integrator == "guided-path" && a.guide == "light")
    throw Error("--guide light: guided-path has no light subpaths; leave it out, or take guided-bdpt");
  if (integrator == "vpl" && a.guide != "both")
    throw Error(fmt::format("--guide {}: vpl guides light subpaths alone; leave it out", a.guide));
  if (!a.save_fields.empty()) check_file(a.save_fields);
  LearnOptions o;
  o.lights = lights || a.light_choice.empty();
  o.guided = a.guide == "camera" ? Guided::camera : a.guide == "light" ? Guided::light : Guided::both;
  if (!a.field_structure.empty()) o.structure = Structure(index_of(structure_names, a.field_structure));
  if (!a.field_rule.empty()) o.rule = Rule(index_of(rule_names, a.field_rule));
  if (a.field_rate == "visits") o.forget = 1;
  o.train = uint32_t(a.train);
  if (!a.field_memory.empty()) o.memory = parse_bytes("--field-memory", a.field_memory);
  return o;
}

void check_next_event(const RenderOptions& o, const Scene& scene) {
  if (o.next_event) return;
  if (o.integrator != "path" && o.integrator != "guided-path")
    throw Error(fmt::format("--no-next-event: {} needs it; take path or guided-path", o.integrator));
  for (const Light& light : scene.lights)
    if (light.kind == LightKind::point || light.kind == LightKind::spot || light.kind == LightKind::directional)
      throw Error("--no-next-event: the scene has lights without extent, which no ray can hit; leave it out");
}

// Whether a pilot decides: where the user asks for it, or where neither he nor the scene names an integrator.
bool plans(const Arguments& a, const Scene& scene) {
  if (a.plan.empty()) return a.integrator.empty() && scene.hints.integrator.empty() && a.resume.empty();
  if (!a.integrator.empty()) throw Error("--plan: chooses the integrator; leave out either this or --integrator");
  if (a.plan != "auto") return false;
  if (!a.resume.empty())
    throw Error("--plan auto: a checkpoint goes on as it began; name its integrator, which its record has");
  return true;
}

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> out(1);
  for (const char c : list)
    if (c == ',')
      out.emplace_back();
    else
      out.back() += c;
  return out;
}

std::string light_choice_of(const Arguments& a, const std::string& integrator) {
  return !a.light_choice.empty() ? a.light_choice : is_guided(integrator) ? "learned" : "tree";
}

RenderOptions render_options(const Arguments& a, Scene& scene, bool planned) {
  RenderOptions o;
  if (!a.integrator.empty()) check_integrator(a.integrator);
  if (!a.integrator.empty())
    o.integrator = a.integrator;
  else if (is_integrator(scene.hints.integrator))
    o.integrator = scene.hints.integrator;
  else if (!scene.hints.integrator.empty())
    scene.notes.push_back(fmt::format("{}: integrator {} is not in this version; {} is used", a.scene,
                                      scene.hints.integrator, o.integrator));
  o.spp = uint32_t(a.spp > 0 ? a.spp : scene.hints.spp > 0 ? scene.hints.spp : int(o.spp));
  if (!a.time.empty()) o.seconds = parse_duration("--time", a.time);
  if (!a.cpu_time.empty()) o.cpu_seconds = parse_duration("--cpu-time", a.cpu_time);
  if (a.noise) {
    o.noise = parse_noise(*a.noise);
    o.spp = uint32_t(a.spp);  // what the scene asks for is no limit here
  }
  o.seed = a.seed;
  o.threads = a.threads;
  o.max_depth = a.max_depth != std::numeric_limits<int>::min() ? a.max_depth : scene.hints.max_depth;
  if (o.max_depth < -1 || o.max_depth == 0)
    throw Error(fmt::format("--max-depth {}: -1 for unlimited, 1 or more edges otherwise", o.max_depth));
  o.roulette_depth = a.roulette_depth;
  o.heuristic = a.heuristic == "balance" ? Heuristic::balance : Heuristic::power;
  o.sampler = a.sampler == "independent" ? SamplerKind::independent : SamplerKind::sobol;
  o.techniques = !a.techniques.empty();
  o.next_event = !a.no_next_event;
  if (a.merge_radius) o.merge_radius = parse_merge_radius(*a.merge_radius, o.integrator);
  check_next_event(o, scene);
  if (a.plan == "all") o.integrator = "guided-bdpt";
  o.learn = learn_options(a, o.integrator, planned || is_guided(o.integrator));
  if (!a.plan.empty() && a.plan != "all" && a.plan != "auto") apply_parts(split(a.plan), o);
  o.learn_lights = a.light_choice == "learned" && !is_guided(o.integrator);
  if (o.learn_lights && o.integrator != "path" && o.integrator != "bdpt")
    throw Error(fmt::format("--light-choice learned: {} does no next-event estimation; leave it out", o.integrator));
  if (a.light_choice == "uniform" || a.light_choice == "power")
    set_light_choice(scene, a.light_choice == "uniform" ? LightChoice::uniform : LightChoice::power);
  if (!a.versus.empty() && !planned) check_versus(a.versus, o.integrator);
  return o;
}

// Appends a line to the log whenever time has grown by a tenth since the last one.
struct Log {
  std::ofstream file;
  std::optional<Picture> reference;
  double next = 0.1;

  void write(const RenderState& state, bool last) {
    if (!file.is_open() || (!last && state.stats.seconds < next) || state.film.passes == 0) return;
    next = std::max(next, state.stats.seconds) * 1.1;
    nlohmann::ordered_json j = {
        {"seconds", state.stats.seconds}, {"cpu_seconds", state.stats.cpu_seconds}, {"spp", state.film.passes}};
    if (const double error = estimated_error(state.film); error < infinity) j["estimated_relmse"] = error;
    if (reference) j["error"] = nlohmann::ordered_json::parse(to_json(compare(develop(state.film), *reference)));
    j["phases_cpu"] = phases_json(state.stats.cpu_seconds, state.stats.learn_cpu_seconds, state.stats.ledger);
    add_account(j, state);
    file << j.dump() << std::endl;
  }
};

Log open_log(const Arguments& a, const Film& film) {
  Log log;
  if (!a.reference.empty()) {
    log.reference = select(read_picture(a.reference), {"R", "G", "B"});
    if (log.reference->width != film.width || log.reference->height != film.height)
      throw Error(fmt::format("--reference {}: is {}x{}, the render {}x{}; use --size", a.reference,
                              log.reference->width, log.reference->height, film.width, film.height));
  }
  if (a.log.empty()) return log;
  log.file.open(a.log);
  if (!log.file) throw Error(a.log + ": cannot write the log; is its folder there?");
  return log;
}

Picture append(Picture a, const Picture& b) {
  Picture out{a.width, a.height, a.names, {}};
  out.names.insert(out.names.end(), b.names.begin(), b.names.end());
  const size_t na = a.names.size(), nb = b.names.size();
  for (size_t i = 0; i < size_t(a.width) * size_t(a.height); ++i) {
    out.pixels.insert(out.pixels.end(), &a.pixels[i * na], &a.pixels[i * na] + na);
    out.pixels.insert(out.pixels.end(), &b.pixels[i * nb], &b.pixels[i * nb] + nb);
  }
  return out;
}

Picture with_features(const Arguments& a, const Scene& scene, const Accel& accel, const RenderState& state) {
  Picture out = develop(state.film);
  const std::map<std::string, std::vector<std::string>> groups = {{"albedo", {"Albedo.R", "Albedo.G", "Albedo.B"}},
                                                                  {"normal", {"N.X", "N.Y", "N.Z"}},
                                                                  {"position", {"P.X", "P.Y", "P.Z"}}};
  std::vector<std::string> wanted;
  bool with_variance = false;
  for (const std::string& f : a.features) {
    if (f == "variance")
      with_variance = true;
    else
      wanted.insert(wanted.end(), groups.at(f).begin(), groups.at(f).end());
  }
  if (!wanted.empty()) out = append(out, select(render_features(scene, accel, a.seed), wanted));
  if (with_variance) out = append(out, variance(state.film));
  return out;
}

void write_record(const Arguments& a, const Run& run, const RenderState& state) {
  write_text(std::filesystem::path(a.out).replace_extension(".json").string(), summary(run, state).dump(2) + "\n");
}

void write_outputs(const Arguments& a, const Scene& scene, const Accel& accel, Run& run, const RenderState& state) {
  const double wall = wall_seconds(), cpu = process_cpu_seconds();
  const std::filesystem::path out(a.out);
  const bool only_png = out.extension() == ".png";
  const std::string png = std::filesystem::path(out).replace_extension(".png").string();
  if (!only_png) write_exr(a.out, with_features(a, scene, accel, state), metadata(run, state), a.half);
  if (only_png || a.png) write_png(png, develop(state.film));
  if (!a.techniques.empty()) write_pyramid(state.pyramid, state.film, a.techniques);
  run.write_seconds = wall_seconds() - wall;
  run.write_cpu = process_cpu_seconds() - cpu;
  write_record(a, run, state);
  if (a.quiet) return;
  fmt::print("{}\n", a.out);
  if (!only_png && a.png) fmt::print("{}\n", png);
}

// The image is safe by now; the record is written again.
void hold_against(const Arguments& a, const Scene& scene, const Accel& accel, Run& run, const RenderState& state) {
  if (a.versus == run.options.integrator) {
    fmt::print(stderr, "ajar: note: {} was planned; there is nothing to hold it against\n", a.versus);
    return;
  }
  run.versus = run_versus(scene, accel, run.options, a.versus, state, [](const RenderState&) { return !stop_asked(); });
  write_record(a, run, state);
  if (!a.quiet) fmt::print("{}\n", describe(run.versus, state));
}

void plan_run(const Arguments& a, Scene& scene, const Accel& accel, Run& run) {
  run.plan = make_plan(scene, accel, run.options, [](const RenderState&) { return !stop_asked(); });
  run.options.integrator = run.plan.integrator;
  run.options.learn_lights &= !is_guided(run.plan.integrator);
  run.light_choice = light_choice_of(a, run.options.integrator);
  if (!a.quiet) fmt::print(stderr, "ajar: note: {} is used; ajar plan says why\n", run.plan.integrator);
  if (!is_guided(run.plan.integrator) && !a.save_fields.empty())
    fmt::print(stderr, "ajar: note: nothing is learned, {} is not written\n", a.save_fields);
}

void warn(const RenderState& state) {
  if (state.stats.rejected == 0) return;
  fmt::print(stderr, "ajar: warning: {} values were not finite or negative and were left out", state.stats.rejected);
  for (const std::string& r : state.stats.replay) fmt::print(stderr, "; {}", r);
  fmt::print(stderr, "\n");
}

void run_render(Arguments a) {
  const double wall0 = wall_seconds(), cpu0 = process_cpu_seconds();
  if (a.out.empty()) a.out = std::filesystem::path(a.scene).stem().string() + ".exr";
  check_writable(a.out);
  LoadOptions load = load_options(a.defines, a.lenient);
  load.time = a.at;
  Scene scene = load_scene(a.scene, load);
  if (!a.size.empty()) set_size(scene.camera, a.size);
  Run run;
  run.scene_path = a.scene, run.out_path = a.out, run.defines = a.defines;
  run.load_fields = a.load_fields, run.save_fields = a.save_fields;
  run.planned = plans(a, scene);
  run.options = render_options(a, scene, run.planned);
  for (const std::string& n : scene.notes)
    if (!a.quiet) fmt::print(stderr, "ajar: note: {}\n", n);
  run.threads = a.threads > 0 ? a.threads : int(std::thread::hardware_concurrency());
  run.triangles = count_triangles(scene);
  const double wall1 = wall_seconds(), cpu1 = process_cpu_seconds();
  run.load_seconds = wall1 - wall0, run.load_cpu = cpu1 - cpu0;
  const Accel accel(scene);
  run.build_seconds = wall_seconds() - wall1, run.build_cpu = process_cpu_seconds() - cpu1;
  run.accel_bytes = accel.bytes();
  catch_stop();
  if (run.planned) plan_run(a, scene, accel, run);

  RenderState state = start_render(scene, run.options);
  const std::string key = checkpoint_key(run, state.film);
  if (!a.resume.empty()) {
    load_checkpoint(a.resume, key, state);
    if (learns(run.options) && fit_lights(scene.light_tree, learn_options(run.options), state.learning.fields))
      throw Error(a.resume + ": what it learned of lights is of another scene; start again without --resume");
  }
  if (!a.load_fields.empty() && is_guided(run.options.integrator)) {
    StoredFields stored = load_fields(a.load_fields, scene_key(scene));
    fit_lights(scene.light_tree, learn_options(run.options), stored.fields);
    go_on_from(std::move(stored), learn_options(run.options), state.learning, state.film);
  }
  Log log = open_log(a, state.film);
  Progress progress = make_progress(a.quiet);
  double saved = state.stats.seconds;
  RenderOptions budget = run.options;
  if (!a.versus.empty()) budget.seconds *= 1 - versus_share, budget.cpu_seconds *= 1 - versus_share;
  RenderOptions options = budget;  // the user's time begins after loading: building and the pilot count
  if (options.seconds > 0) options.seconds = std::max(options.seconds - run.build_seconds - run.plan.seconds, 1e-3);
  if (options.cpu_seconds > 0)
    options.cpu_seconds = std::max(options.cpu_seconds - run.build_cpu - run.plan.cpu_seconds, 1e-3);
  render(scene, accel, options, state, [&](const RenderState& s) {
    show(progress, budget, s);
    log.write(s, false);
    if (!a.checkpoint.empty() && s.stats.seconds - saved > 60) {
      saved = s.stats.seconds;
      save_checkpoint(a.checkpoint, key, s);
    }
    return !stop_asked();
  });
  run.interrupted = stop_asked();
  finish(progress, budget, state);
  log.write(state, true);
  if (run.interrupted && !a.quiet) fmt::print(stderr, "ajar: interrupted; writing what is there\n");
  if (!a.checkpoint.empty()) save_checkpoint(a.checkpoint, key, state);
  if (!a.save_fields.empty() && is_guided(run.options.integrator))
    save_fields(a.save_fields, stored_fields(scene, state.learning, state.film));
  write_outputs(a, scene, accel, run, state);
  if (!a.versus.empty() && !run.interrupted) hold_against(a, scene, accel, run, state);
  warn(state);
}

}  // namespace

void add_render(CLI::App& app) {
  auto a = std::make_shared<Arguments>();
  CLI::App* c = app.add_subcommand("render", "Render a scene to an EXR image");
  c->add_option("scene", a->scene, "Mitsuba XML scene")->required();
  c->add_option("-o,--out", a->out,
                "image to write: .exr, or .png for a tonemapped one (default: the scene's name, here)");
  c->add_flag("--png", a->png, "write a tonemapped PNG beside the EXR");
  c->add_option("--integrator", a->integrator,
                "path, bdpt, light, guided-path, guided-bdpt, vcm, guided-vcm, photon, vpl or plain-vpl (default: the "
                "scene's, else what the plan says)");
  c->add_option("--plan", a->plan,
                "what to use: auto (a short pilot decides), all, none, or a list of light-subpaths, camera-guiding, "
                "light-guiding (default: auto where no integrator is named)");
  c->add_option("--spp", a->spp, "samples per pixel")->check(CLI::Range(1, 1 << 30));
  c->add_option("--time", a->time, "wall time to render: 90s, 5m, 1h");
  c->add_option("--cpu-time", a->cpu_time, "CPU time of all threads to render");
  c->add_option("--noise", a->noise,
                "relMSE to stop at, as estimated without a reference: 0.01; time and spp, if given, are limits");
  c->add_option("--seed", a->seed, "another seed, other noise");
  c->add_option("--threads", a->threads, "threads (default: all)")->check(CLI::Range(1, 4096));
  c->add_option("--size", a->size, "WIDTHxHEIGHT instead of the scene's; the crop window is dropped");
  c->add_option("--max-depth", a->max_depth, "edges of the longest path; 1 sees lights alone, -1 is unlimited");
  c->add_option("--roulette-depth", a->roulette_depth, "edges of a subpath before Russian roulette begins")
      ->check(CLI::Range(1, 1 << 20));
  c->add_option("--heuristic", a->heuristic, "of multiple importance sampling")
      ->check(CLI::IsMember({"power", "balance"}));
  c->add_option("--sampler", a->sampler, "sobol (Owen-scrambled) or independent")
      ->check(CLI::IsMember({"sobol", "independent"}));
  c->add_option("-D", a->defines, "name=value: a parameter of the scene")->allow_extra_args(false);
  c->add_option("--at", a->at, "time at which the scene's <animation>s are read (default: each at its first key)");
  c->add_option("--aov", a->features, "more channels in the EXR: albedo,normal,position,variance")
      ->delimiter(',')
      ->check(CLI::IsMember({"albedo", "normal", "position", "variance"}));
  c->add_option("--reference", a->reference, "image to measure the error against in the log");
  c->add_option("--log", a->log, "JSON lines at log-spaced times");
  c->add_option("--techniques", a->techniques, "folder for an image of every strategy (s, t), weighted and raw");
  c->add_option("--checkpoint", a->checkpoint, "file to save the state to, every minute and at the end");
  c->add_option("--resume", a->resume, "checkpoint to go on from");
  c->add_option("--guide", a->guide, "which subpaths the learned fields guide: both, camera or light")
      ->check(CLI::IsMember({"both", "camera", "light"}));
  c->add_option("--field-memory", a->field_memory,
                "memory that learned fields may take, beside up to 3 MB for which regions see each other: 512K, 8M "
                "(default), 1G");
  c->add_option("--field-structure", a->field_structure, "of learned fields: adaptive (default), grid or probes")
      ->check(CLI::IsMember(listed(structure_names)));
  c->add_option("--field-rule", a->field_rule, "how they are learned: expected (default), max or return")
      ->check(CLI::IsMember(listed(rule_names)));
  c->add_option("--field-rate", a->field_rate,
                "of learning: recent (default: older evidence counts half), visits (1 / (1 + visits))")
      ->check(CLI::IsMember({"recent", "visits"}));
  c->add_option("--train", a->train, "passes that train the fields and are dropped; after them the fields are frozen")
      ->check(CLI::Range(2, 1 << 20));
  c->add_option(
       "--light-choice", a->light_choice,
       "of next-event estimation among lights: uniform, power, tree, or learned per cell (default: learned for "
       "guided integrators, else tree)")
      ->check(CLI::IsMember(listed(light_choice_names)));
  c->add_option("--merge-radius", a->merge_radius,
                "of vcm, guided-vcm and photon in the first pass, in pixels (default 5); it shrinks; 0: no merging");
  c->add_flag("--no-next-event", a->no_next_event, "lights are found by hitting them alone: path and guided-path");
  c->add_option("--save-fields", a->save_fields, "file to save the learned fields to");
  c->add_option("--load-fields", a->load_fields, "fields to start from, saved from a render of the same scene");
  c->add_option("--versus", a->versus,
                "path, bdpt or light: gets the last tenth of the time, to tell how much error it would have left");
  c->add_flag("--half", a->half, "16-bit floats in the EXR");
  c->add_flag("--lenient", a->lenient, "leave out what the loader does not know, with a note");
  c->add_flag("-q,--quiet", a->quiet, "no progress, no notes");
  c->callback([a] { run_render(*a); });
}

}  // namespace ajar
