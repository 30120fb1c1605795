// ajar render: loads a scene, renders it within a budget, writes image and record.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>

#include "ajar/core/error.h"
#include "ajar/core/files.h"
#include "ajar/core/parallel.h"
#include "arguments.h"
#include "command_threads.h"
#include "commands.h"
#include "outputs.h"
#include "progress.h"
#include "render_options.h"
#include "say.h"
#include "stop.h"
#include "summary.h"

namespace ajar {
namespace {

// The image is safe by now; the record is written again.
void hold_against(const RenderArguments& a, const Scene& scene, const Accel& accel, Run& run,
                  const RenderState& state) {
  if (a.versus == run.options.integrator) {
    if (!a.quiet) say(stderr, "ajar: note: {} was planned; there is nothing to hold it against\n", a.versus);
    return;
  }
  const Versus versus =
      run_versus(scene, accel, run.options, a.versus, state, [](const RenderState&) { return !stop_asked(); });
  if (stop_asked())
    throw Interrupted{fmt::format("interrupted; {} is whole, but what {} leaves is not known", a.out, a.versus)};
  run.versus = versus;
  write_record(a, run, state);
  if (!a.quiet) say(stdout, "{}\n", describe(run.versus, state));
}

// Of what is learned, where learning is decided.
std::string reason_of(const Plan& plan) {
  for (const Part& part : plan.parts)
    if (part.name == "camera-guiding") return part.why;
  return "it suits the scene";
}

void plan_run(const RenderArguments& a, const Scene& scene, Run& run) {
  run.plan = make_plan(scene, run.options);
  const std::string& chosen = run.options.integrator = run.plan.integrator;
  run.options.learn_lights &= !is_guided(chosen);
  run.options.techniques &= has_strategies(chosen);
  run.options.even &= is_guided(chosen);
  if (!a.quiet) say(stderr, "ajar: note: {} is used: {}\n", chosen, reason_of(run.plan));
  if (!is_guided(chosen) && !a.save_fields.empty())
    say(stderr, "ajar: note: nothing is learned, {} is not written\n", a.save_fields);
  if (!a.techniques.empty() && !run.options.techniques)
    say(stderr, "ajar: note: {} has no strategies to tell apart, {} is not written\n", chosen, a.techniques);
}

// Who names no integrator gets the scene's, and need not know that others learn where light comes from.
void note_integrator(const RenderArguments& a, const Run& run) {
  if (a.quiet || run.planned || !a.integrator.empty() || !a.plan.empty() || learns(run.options)) return;
  say(stderr, "ajar: note: the scene asks for {}; --plan auto chooses what suits it\n", run.options.integrator);
}

// A file of an earlier render that is not the one to go on from.
bool is_of_another(const std::string& path, const std::string& goes_on_from) {
  return !path.empty() && is_there(path) && (goes_on_from.empty() || !is_same_file(path, goes_on_from));
}

bool is_checkpoint(const std::string& path) {
  try {
    read_checkpoint_key(path);
    return true;
  } catch (const Error&) {
    return false;
  }
}

// A checkpoint of an earlier render that would be lost.
void note_checkpoint(const RenderArguments& a) {
  if (a.quiet || !is_of_another(a.checkpoint, a.resume)) return;
  say(stderr, "ajar: note: {} is begun anew{}\n", a.checkpoint,
      is_checkpoint(a.checkpoint) ? fmt::format("; --resume {} would go on from it", a.checkpoint)
                                  : ", though it holds no checkpoint of this version");
}

bool has_samples(const Film& film) { return film.passes > 0 || film.chunks > 0; }

// Files of an earlier render that one which was stopped early does not replace: they are worth more.
struct Spared {
  bool image = false, checkpoint = false, fields = false, log = false;
};

// Of a render that does not go on from them, and was at work for so many seconds: the image where no pass is whole,
// checkpoint, fields and log before the first save on the way.
Spared spare(const RenderArguments& a, const Run& run, const RenderState& state, const Log& log, double seconds) {
  if (!run.interrupted) return {};
  const bool early = seconds <= save_seconds;
  Spared out;
  out.image = state.film.passes == 0 && a.resume.empty() && is_there(a.out);
  out.checkpoint = early && is_of_another(a.checkpoint, a.resume);
  out.log = early && log.spares;
  out.fields = early && a.resume.empty() && is_of_another(a.save_fields, a.load_fields);
  return out;
}

// "a is written", "a, b and c are written", for the endings "is written" and "are written".
std::string listed(std::vector<std::string> names, const char* of_one, const char* of_several) {
  if (names.size() == 1) return fmt::format("{} {}", names[0], of_one);
  const std::string last = names.back();
  names.pop_back();
  return fmt::format("{} and {} {}", fmt::join(names, ", "), last, of_several);
}

std::string left_alone(const RenderArguments& a, const Spared& spared) {
  std::vector<std::string> names;
  if (spared.image) names.push_back(a.out);
  if (spared.checkpoint) names.push_back(a.checkpoint);
  if (spared.fields) names.push_back(a.save_fields);
  if (spared.log) names.push_back(a.log);
  return names.empty() ? "" : "; " + listed(names, "is left as it was", "are left as they were");
}

// What a render without a sample does not write.
std::string unwritten(const RenderArguments& a) {
  std::vector<std::string> names = {a.out};
  for (const std::string& name : {png_beside(a), a.checkpoint, a.save_fields, a.techniques})
    if (!name.empty()) names.push_back(name);
  return listed(names, "is not written", "are not written");
}

std::string interruption(const RenderArguments& a, const Spared& spared, const Film& film) {
  if (!has_samples(film)) return "interrupted before the first sample that is in the image; " + unwritten(a);
  const std::string rest = (spared.image ? "" : fmt::format("; {} has what was done", a.out)) + left_alone(a, spared);
  if (film.passes > 0) return fmt::format("interrupted after {:.1f} spp{}", spp_of(film), rest);
  const double share = 1 - double(film.chunks) / chunk_count(film);
  return fmt::format("interrupted in the first pass: {:.0f} % of the image has no sample{}", 100 * share, rest);
}

void warn(const Run& run, const RenderState& state) {
  const bool young = is_guided(run.options.integrator) && state.film.dropped == 0;
  if (young && traced_one_in(state.learning, state.film) > 1)
    say(stderr,
        "ajar: warning: most pixels have no sample: the first four passes of a guided render teach it, and "
        "trace few pixels; give it more time, or --spp 4 or more\n");
  if (state.stats.rejected == 0) return;
  say(stderr, "ajar: warning: {} values were not finite or negative and were left out", state.stats.rejected);
  for (const std::string& r : state.stats.replay) say(stderr, "; {}", r);
  say(stderr, "\n");
}

// One pass differs from no other.
void note_variance(const RenderArguments& a, const RenderState& state) {
  if (a.quiet || state.film.passes >= 2) return;
  if (std::find(a.features.begin(), a.features.end(), "variance") != a.features.end())
    say(stderr, "ajar: note: the variance is 0 everywhere, since it takes two passes to tell one\n");
}

void note_plain(const RenderArguments& a, const Run& run, const RenderState& state) {
  const Plain& p = state.plain;
  if (a.quiet || !may_leave_out(run.options)) return;
  if (p.merged > 0)
    say(stderr,
        "ajar: note: merging was left out after {} passes, since light is easy to find here; --plan all goes on "
        "merging\n",
        p.merged);
  if (!p.taken || state.film.passes <= p.passes) return;
  say(stderr,
      "ajar: note: path tracing took over from {} after {} passes, since light is easy to find here (error after "
      "equal time: {:.2g} times); --plan all goes on guiding\n",
      run.options.integrator, p.passes, p.ratio);
}

// No target for the noise ends such a render; see ajar/render/render.h.
void note_black(const RenderArguments& a, const Run& run, const RenderState& state) {
  if (a.quiet || run.interrupted || !ends_by_noise(run.options) || !is_black(state.film)) return;
  say(stderr,
      "ajar: note: the image is black after {} passes, and no more are tried for --noise; look at lights and camera\n",
      state.film.passes);
}

// A state to go on from: new, or what a checkpoint or a file of fields brings.
RenderState begin(const RenderArguments& a, Scene& scene, const Run& run) {
  RenderState state = start_render(scene, run.options);
  if (!a.resume.empty()) {
    load_checkpoint(a.resume, checkpoint_key(run, state.film), state);
    if (learns(run.options) && fit_lights(scene.light_tree, learn_options(run.options), state.learning.fields))
      throw Error(a.resume + ": what it learned of lights is of another scene; start again without --resume");
    if (run.options.spp > 0 && state.film.passes > run.options.spp && !a.quiet)
      say(stderr, "ajar: note: {} holds {} passes, more than --spp {}; they are all in the image\n", a.resume,
          state.film.passes, run.options.spp);
  }
  if (!a.load_fields.empty() && is_guided(run.options.integrator)) {
    StoredFields stored = load_fields(a.load_fields, scene_key(scene));
    go_on_from(scene, std::move(stored), learn_options(run.options), state.learning, state.film);
  }
  return state;
}

void trace(const RenderArguments& a, const Scene& scene, const Accel& accel, Run& run, RenderState& state, Log& log) {
  RenderOptions budget = run.options;
  if (!a.versus.empty()) budget.seconds *= 1 - versus_share, budget.cpu_seconds *= 1 - versus_share;
  Progress progress = make_progress(a.quiet);
  Saver saver{a.checkpoint, checkpoint_key(run, state.film), state.stats.seconds};
  const RenderOptions limits = without_start(budget, run);
  bool starved = false;
  const auto beside = [&](const auto& work) {  // memory that it lacks is no reason to lose the image
    try {
      work();
    } catch (const std::bad_alloc&) {
      if (!starved)
        clear_line(), say(stderr, "ajar: warning: out of memory for progress, log or checkpoint; the render goes on\n");
      starved = true;
    }
  };
  render(scene, accel, limits, state, [&](const RenderState& s) {
    Stopwatch watch;
    beside([&] { show(progress, budget, s), log.write(s, false), saver.save(s); });
    watch.add_to(run.beside_seconds, run.beside_cpu);
    return !stop_asked();
  });
  run.interrupted = stop_asked();
  beside([&] { finish(progress, budget, state, !run.interrupted); });
}

void write_all(const RenderArguments& a, const Scene& scene, const Accel& accel, Run& run, RenderState& state,
               const Spared& spared, Log& log) {
  std::vector<std::function<void()>> writes;
  const bool begun = has_samples(state.film) || !run.interrupted;  // else what is there is worth more
  if (!a.checkpoint.empty() && begun && !spared.checkpoint)
    writes.emplace_back([&] { save_checkpoint(a.checkpoint, checkpoint_key(run, state.film), state); });
  if (!a.save_fields.empty() && is_guided(run.options.integrator) && begun && !spared.fields)
    writes.emplace_back([&] {
      save_fields(a.save_fields, stored_fields(scene, state.learning, passes_drawn(state.film, state.adaptive)));
    });
  writes.emplace_back([&] {  // last of what goes on from the state
    if (run.interrupted) show_merged(state);
    if (!spared.log) log.write(state, true);
  });
  const bool shows = has_samples(state.film) && !spared.image;
  if (shows) writes.emplace_back([&] { write_image(a, scene, accel, run, state); });
  if (shows && !png_beside(a).empty()) writes.emplace_back([&] { write_png_beside(a, state); });
  if (run.options.techniques && begun && !spared.image)
    writes.emplace_back([&] { write_pyramid(state.pyramid, state.film, a.techniques); });
  writes.emplace_back([&] {
    if (!log.fault.empty()) throw Error(log.fault);
  });
  write_each(writes);
}

// What is asked for, of this scene.
Run run_of(const RenderArguments& a, Scene& scene) {
  Run run;
  run.scene_path = a.scene, run.out_path = a.out, run.content = scene.content, run.defines = a.defines;
  run.at = a.at, run.lenient = a.lenient;
  run.load_fields = a.load_fields, run.save_fields = a.save_fields;
  run.planned = plans(a, scene);
  run.options = render_options(a, scene, run.planned);
  run.threads = a.threads > 0 ? a.threads : processor_count();
  run.triangles = count_triangles(scene);
  return run;
}

void run_render(RenderArguments a) {
  Stopwatch watch;
  if (a.out.empty()) a.out = std::filesystem::path(a.scene).stem().string() + ".exr";
  check_outputs(a);
  if (!a.resume.empty() && a.integrator.empty() && (a.plan.empty() || a.plan == "all" || a.plan == "none"))
    a.integrator = integrator_of(read_checkpoint_key(a.resume));
  Scene scene = load_scene(a.scene, load_options(a.defines, a.lenient, a.at));
  check_apart(a, scene);
  check_time(a.at, scene);
  if (!a.size.empty()) set_size(scene.camera, a.size);
  Run run = run_of(a, scene);
  std::optional<Picture> reference = read_reference(a, scene.camera);
  if (!a.quiet) say_notes(scene.notes);
  watch.add_to(run.load_seconds, run.load_cpu);
  const Accel accel(scene);
  watch.add_to(run.build_seconds, run.build_cpu);
  run.accel_bytes = accel.bytes();
  catch_stop();
  note_integrator(a, run);
  note_checkpoint(a);
  if (run.planned) plan_run(a, scene, run);
  run.light_choice = light_choice_of(a, run.options.integrator);

  RenderState state = begin(a, scene, run);
  Log log = open_log(a, std::move(reference));
  const double before = state.stats.seconds;
  trace(a, scene, accel, run, state, log);
  const Spared spared = spare(a, run, state, log, state.stats.seconds - before);
  write_all(a, scene, accel, run, state, spared, log);
  note_plain(a, run, state), note_black(a, run, state), note_variance(a, state);
  warn(run, state);
  if (run.interrupted) throw Interrupted{interruption(a, spared, state.film)};
  if (!a.versus.empty()) hold_against(a, scene, accel, run, state);
}

}  // namespace

void add_render(CLI::App& app) {
  auto a = std::make_shared<RenderArguments>();
  CLI::App* c = app.add_subcommand("render", "Render a scene to an EXR image");
  add_options(*c, *a);
  c->callback([a] {
    const CommandThreads threads(a->threads);
    run_render(*a);
  });
}

}  // namespace ajar
