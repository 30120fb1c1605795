// ajar animate: renders the frames of an animation, one after another, with what frames have in common kept.

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "ajar/core/bytes.h"
#include "ajar/core/error.h"
#include "ajar/core/files.h"
#include "ajar/core/parallel.h"
#include "ajar/report/metrics.h"
#include "animate_files.h"
#include "animate_options.h"
#include "command_threads.h"
#include "commands.h"
#include "frames.h"
#include "outputs.h"
#include "progress.h"
#include "render_options.h"
#include "say.h"
#include "stop.h"
#include "summary.h"

namespace ajar {
namespace {

namespace fs = std::filesystem;

// What went into the fields of a frame, which is part of its time.
struct Lessons {
  double seconds = 0, cpu_seconds = 0;
  Counters counters;
};

// One animation at work.
struct Work {
  const AnimateArguments& arguments;
  Shooting shooting;
  FramePattern pattern, png;
  std::string folder;
  RenderOptions options;                  // of frame 0, whichever frames are to be rendered; see frame_options
  int width = 0, height = 0;              // of frame 0
  int first_width = 0, first_height = 0;  // of the range's first frame
  std::string other_size;                 // of the first of them that was seen to have another; for messages
  SequenceOptions sequence;
  std::string options_key;  // of the whole animation, without budgets
  std::string key;          // the same with the files of its first frame, and whether lessons have a time limit
  std::string other_key;    // the same of lessons with one where these have none, or the other way round
  bool carries = false;     // fields
  bool lost = false;        // fields for a later command: they could not be written
  std::optional<Carried> carried;
  std::set<std::string> noted;  // by the loader, and told
  std::vector<int> to_do;
  int done = 0;  // of these
  double began = 0;
  double shown = -infinity;
};

// Budget and depth may be the scene's own, and its parameters may change them from frame to frame.
RenderOptions frame_options(const Work& w, int frame, const Scene& scene) {
  RenderOptions options = render_options(w.arguments, scene);
  if (options.integrator != w.options.integrator)
    throw Error(fmt::format("frame {}: the scene names the integrator {}, but {} in frame 0; choose with --integrator",
                            frame, options.integrator, w.options.integrator));
  return options;
}

// Everything that decides the pixels of all frames but their budgets and the scene's files. scene: of frame 0.
std::string animation_key(const Work& w, const Scene& scene) {
  Run run;
  run.scene_path = w.arguments.scene;
  run.options = w.options;
  run.defines = w.arguments.defines;
  const Timeline& t = w.shooting.timeline;
  const SequenceOptions& s = w.sequence;
  std::string key = fmt::format("{} | {} frames, {}, teach {} {}, forget {:g} | ",  // the budgets are each frame's own
                                checkpoint_key(run, make_film(scene.camera, scene.filter, false)), t.frames.count,
                                w.arguments.coherent, s.begin, s.teach, s.forget);
  for (int f = 0; f < t.frames.count; ++f) key += describe(t, f) + ";";
  return fmt::format("{:016x} {}", checksum(key.data(), key.size(), 0),
                     fs::path(w.arguments.scene).filename().string());
}

std::string files_key(const Scene& scene) { return fmt::format("files with checksum {:016x}", scene.content); }

std::string frame_key(const Work& w, int frame, const Scene& scene) {
  const RenderOptions o = frame_options(w, frame, scene);
  const std::string budget = fmt::format("{:g} s,{:g} CPU s,{} spp", o.seconds, o.cpu_seconds, o.spp);
  std::string key = fmt::format("{},frame {} {},{},{}", w.options_key, frame, describe(w.shooting.timeline, frame),
                                files_key(scene), budget);
  const int width = scene.camera.crop_width, height = scene.camera.crop_height;
  if (o.max_depth != w.options.max_depth) key += fmt::format(",depth {}", o.max_depth);
  if (width != w.width || height != w.height) key += fmt::format(",{}x{}", width, height);
  if (w.arguments.half) key += ",half";
  return key;
}

// Sizes may change from frame to frame; a film has one.
void note_size(Work& w, int frame, const Scene& scene) {
  const int width = scene.camera.crop_width, height = scene.camera.crop_height;
  if (!w.other_size.empty() || (width == w.first_width && height == w.first_height)) return;
  w.other_size = fmt::format("frame {} is {}x{}, frame {} {}x{}", w.shooting.timeline.frames.first, w.first_width,
                             w.first_height, frame, width, height);
}

void require_one_size(const Work& w) {
  if (w.arguments.video.empty() || w.other_size.empty()) return;
  throw Error(fmt::format("--video {}: {}, and frames of a film have one size; add --size, or leave --video out",
                          w.arguments.video, w.other_size));
}

// Whether the frame is there as it should be; a PNG that is missing is made again.
bool is_done(Work& w, int frame) {
  const std::string path = frame_name(w.pattern, frame);
  if (!is_there(path)) return false;
  const Picture image = read_frame(path);
  const Metadata metadata = read_metadata(path);
  const auto found = metadata.find("ajar:frame");
  const std::shared_ptr<const Scene> scene = load_frame(w.shooting, frame);
  note_size(w, frame, *scene);
  const std::string here = frame_key(w, frame, *scene);
  const auto* there = found == metadata.end() ? nullptr : std::get_if<std::string>(&found->second);
  if (there && *there == here) {
    if (const std::string png = frame_name(w.png, frame); !is_file(png)) write_png(png, image);
    return true;
  }
  const std::string why = there && there->starts_with(w.options_key + ",")
                              ? "was made otherwise: " + difference(*there, here)
                              : "is of another animation, or of other options";
  throw Error(fmt::format("{}: {}; remove it, or write elsewhere", path, why));
}

std::string samples_text(const RenderState& state) { return fmt::format("{:.1f} spp", spp_of(state.film)); }

// On a terminal one line that tells of the frame at work; else one for each that is finished.
void show(Work& w, int frame, const std::string& what, bool finished) {
  const double now = wall_seconds();
  const bool terminal = isatty(STDERR_FILENO) != 0;
  if (w.arguments.quiet || finished == terminal || (terminal && now - w.shown < 0.25)) return;
  w.shown = now;
  std::string line = fmt::format("frame {} ({} of {}) {}  {}  {} elapsed", frame, finished ? w.done : w.done + 1,
                                 w.to_do.size(), describe(w.shooting.timeline, frame), what, clock_text(now - w.began));
  if (w.done > 0 && size_t(w.done) < w.to_do.size())
    line += fmt::format("  {} left", clock_text((now - w.began) / w.done * double(w.to_do.size() - size_t(w.done))));
  std::fprintf(stderr, terminal ? "\r%s\033[K" : "%s\n", line.c_str());
  std::fflush(stderr);
}

[[noreturn]] void interrupted(int frame) {
  throw Interrupted{fmt::format("interrupted in frame {}; the same command goes on from there", frame)};
}

void write_frame(Work& w, int frame, const Stage& stage, Run& run, const RenderState& state) {
  Stopwatch watch;
  const Picture image = develop(state.film);
  Metadata data = metadata(run, state);
  data["ajar:frame"] = frame_key(w, frame, *stage.scene);
  data["ajar:mean"] = mean_of(image);
  write_png(frame_name(w.png, frame), image);
  run.triangles = count_triangles(*stage.scene), run.accel_bytes = stage.accel->bytes();
  watch.add_to(run.write_seconds, run.write_cpu);
  nlohmann::ordered_json record = summary(run, state);
  record["frame"] = frame;
  record["coherent"] = w.arguments.coherent;
  write_text(fs::path(run.out_path).replace_extension(".json").string(), record_of(record));
  write_exr(run.out_path, image, data,
            w.arguments.half ? PixelType::half : PixelType::float32);  // last: a frame is done when its image is there
}

// What its record tells.
Run frame_run(const Work& w, int frame, const Stage& stage) {
  Run run;
  run.scene_path = w.arguments.scene, run.out_path = frame_name(w.pattern, frame);
  for (const auto& [name, value] : parameters_at(w.shooting.timeline, frame)) run.defines.push_back(name + "=" + value);
  run.at = time_at(w.shooting.timeline, frame);
  run.lenient = w.arguments.lenient;
  run.options = frame_options(w, frame, *stage.scene);
  run.options.seed = image_seed(w.sequence, w.options.seed, uint32_t(frame));
  run.light_choice = usual_light_choice(run.options.integrator);
  run.threads = w.options.threads > 0 ? w.options.threads : processor_count();
  run.load_seconds = stage.load_seconds, run.load_cpu = stage.load_cpu;
  run.build_seconds = stage.build_seconds, run.build_cpu = stage.build_cpu;
  return run;
}

// Renders one frame.
void render_frame(Work& w, int frame, const Stage& stage, const Lessons& lessons) {
  Run run = frame_run(w, frame, stage);
  RenderState state =
      w.carried ? start_with(*stage.scene, run.options, w.carried->fields) : start_render(*stage.scene, run.options);
  state.stats.seconds = state.stats.learn_seconds = lessons.seconds;
  state.stats.cpu_seconds = state.stats.learn_cpu_seconds = lessons.cpu_seconds;
  state.stats.counters = lessons.counters;
  RenderOptions budget = run.options;  // the frame's time begins after loading: building counts
  if (budget.seconds > 0) budget.seconds = std::max(budget.seconds - run.build_seconds, 1e-3);
  if (budget.cpu_seconds > 0) budget.cpu_seconds = std::max(budget.cpu_seconds - run.build_cpu, 1e-3);
  render(*stage.scene, *stage.accel, budget, state, [&](const RenderState& s) {
    show(w, frame, samples_text(s), false);
    return !stop_asked();
  });
  if (stop_asked()) interrupted(frame);
  write_frame(w, frame, stage, run, state);
  ++w.done;
  show(w, frame, samples_text(state), true);
  if (state.stats.rejected == 0) return;
  clear_line();
  say(stderr, "ajar: warning: frame {}: {} values were not finite or negative and were left out\n", frame,
      state.stats.rejected);
}

std::string carried_name(const Work& w) {
  const FrameRange& r = w.shooting.timeline.frames;
  return fmt::format("{}/carried_{}-{}.fields", w.folder, r.first, r.last);
}

// For a command that goes on from here; without them it learns them again.
void save_for_later(Work& w) {
  try {
    save_carried(carried_name(w), w.key, *w.carried);
  } catch (const Error& error) {
    if (!w.lost) clear_line(), say(stderr, "ajar: warning: {}; the animation goes on\n", error.what());
    w.lost = true;
  }
}

// The fields of a frame from those of the frame before.
Lessons teach_frame(Work& w, int frame, const Stage& stage) {
  Stopwatch watch;
  Lessons lessons;
  const Carried* before = w.sequence.coherence.fields && w.carried ? &*w.carried : nullptr;
  std::optional<Fields> fields = teach(*stage.scene, *stage.accel, frame_options(w, frame, *stage.scene), w.sequence,
                                       before, stage.moved, uint32_t(frame), [&](const RenderState& now) {
                                         lessons.counters = now.stats.counters;
                                         show(w, frame, "learning", false);
                                         return !stop_asked();
                                       });
  if (!fields) interrupted(frame);
  const FileHistory files = with_frame(w.carried ? w.carried->files : FileHistory{}, stage.scene->content);
  w.carried = Carried{uint32_t(frame), std::move(*fields), files};
  watch.add_to(lessons.seconds, lessons.cpu_seconds);
  return lessons;
}

void tell_frame(const Work& w, int frame) {
  if (w.arguments.quiet) return;
  clear_line();
  say(stdout, "{}\n", frame_name(w.pattern, frame));
  std::fflush(stdout);
}

// What the loader notes of a frame alone, or of it and those that follow.
void tell_notes(Work& w, int frame, const Scene& scene) {
  for (const std::string& note : scene.notes) {
    if (!w.noted.insert(note).second || w.arguments.quiet) continue;
    clear_line();
    say(stderr, "ajar: note: frame {}: {}\n", frame, note);
  }
}

// Whether the frames that taught these fields have the files that they had then. Where this one has those of the first
// frame, those between are not loaded for it.
bool is_of_these_files(Work& w, const Carried& carried) {
  const auto content = [&](int frame) { return load_frame(w.shooting, frame)->content; };
  FileHistory files = with_frame({}, content(0));
  if (content(int(carried.frame)) != carried.files.content) return false;
  if (files == carried.files) return true;
  for (int f = 1; f <= int(carried.frame); ++f) files = with_frame(files, content(f));
  return files == carried.files;
}

// Says why the frames from one on to those that are to be rendered are learned again.
void tell_learned_again(const Work& w, int frame) {
  if (w.arguments.quiet) return;
  const int next = w.to_do.front();
  std::string why = "none of them left any here that go with this scene and these options";
  const auto is_of_them = [&](const Carried& c) { return int(c.frame) >= frame; };
  if (const auto other = find_carried(w.folder, w.other_key, next - 1, is_of_them)) {
    const bool in_time = has_time_limit(w.options);
    why = fmt::format("those that frame {} left here were learned {} a time limit, these are {} one", other->frame,
                      in_time ? "without" : "with", in_time ? "with" : "without");
  }
  say(stderr, "ajar: note: the fields of frames {} to {} are learned again: {}\n", frame, next - 1, why);
}

// From the first frame whose fields are needed to the last that is missing.
void render_frames(Work& w) {
  const bool taught = is_guided(w.options.integrator) && (w.sequence.coherence.fields || w.sequence.coherence.numbers);
  std::optional<Stage> before;
  const int count = w.shooting.timeline.frames.count;
  int frame = w.to_do.front();
  if (w.carries) {
    w.carried =
        find_carried(w.folder, w.key, frame - 1, [&](const Carried& found) { return is_of_these_files(w, found); });
    frame = w.carried ? int(w.carried->frame) + 1 : 0;
    if (w.carried) before = Stage{load_frame(w.shooting, int(w.carried->frame)), {}, {}, {}};
    if (frame < w.to_do.front()) tell_learned_again(w, frame);
  }
  for (; frame <= w.to_do.back(); ++frame) {
    const bool wanted = std::binary_search(w.to_do.begin(), w.to_do.end(), frame);
    if (!wanted && !w.carries) continue;
    Stage stage = set_up(w.shooting, frame, before ? &*before : nullptr);
    if (wanted) tell_notes(w, frame, *stage.scene);
    if (wanted) note_size(w, frame, *stage.scene);
    if (wanted) check_apart(w.arguments, {frame, frame, count}, *stage.scene, w.shooting.cache);
    const Lessons lessons = taught ? teach_frame(w, frame, stage) : Lessons{};
    if (wanted) {
      render_frame(w, frame, stage, lessons);
      if (w.carries) save_for_later(w);
      tell_frame(w, frame);
    }
    before = std::move(stage);
  }
}

// What would stand in the way of the files to come.
void check_outputs(const Work& w) {
  check_files(w.arguments, w.to_do.front());
  check_no_folders(w.arguments, w.shooting.timeline.frames);
  for (const int frame : w.to_do) check_record(frame_name(w.pattern, frame));
  if (w.carries) check_file(carried_name(w));
}

void write_film(const Work& w) {
  const AnimateArguments& a = w.arguments;
  if (a.video.empty()) return;
  require_one_size(w);
  make_video(w.png, w.shooting.timeline.frames, a.fps.value_or(usual_fps), a.video);
  if (!a.quiet) say(stdout, "{}\n", a.video);
}

std::string figures_stem(const Work& w) { return w.folder + "/animation"; }

void write_figures(const Work& w) {
  std::optional<FramePattern> reference;
  if (!w.arguments.reference.empty()) reference = parse_pattern("--reference", w.arguments.reference);
  const std::vector<FrameFigures> figures = measure(w.pattern, w.shooting.timeline, reference, w.options_key);
  const std::string stem = figures_stem(w);
  write_text(stem + ".json", sequence_json(figures));
  write_text(stem + ".csv", sequence_csv(figures));
  write_text(stem + ".svg", sequence_svg(figures, fmt::format("{}, {}", fs::path(w.arguments.scene).stem().string(),
                                                              w.options.integrator)));
  if (!w.arguments.quiet) say(stdout, "{}.json\n{}.csv\n{}.svg\n", stem, stem, stem);
}

// An error that only they have does not hide why the animation ended.
void write_figures_so_far(const Work& w) {
  try {
    write_figures(w);
  } catch (const std::exception& error) {
    say(stderr, "ajar: warning: {}\n", error.what());
  }
}

// CPU seconds that go into a look ahead: at all frames, and at those where parameters have keys or change sign.
constexpr double look_seconds = 5, longest_look_seconds = 30;

// Loads the frames, while that is cheap, so that what is wrong with one of them is told before others are rendered.
// First and last were loaded; the second is, however long that takes: there a parameter that is to be whole may not be.
void look_ahead(Work& w) {
  const Timeline& t = w.shooting.timeline;
  const FrameRange& r = t.frames;
  if (t.tracks.empty() && !(t.has_time && t.first_time != t.last_time)) return;
  const double began = process_cpu_seconds();
  std::shared_ptr<const Scene> scene;
  for (const int frame : w.to_do) {
    if (frame == 0 || frame == r.first || frame == r.last) continue;
    const double spent = process_cpu_seconds() - began;
    const double limit = frame == r.first + 1 ? infinity : is_marked(t, frame) ? longest_look_seconds : look_seconds;
    if (spent > limit) continue;
    scene = load_frame(w.shooting, frame);
    frame_options(w, frame, *scene), note_size(w, frame, *scene);
  }
  if (scene) check_apart(w.arguments, r, *scene, w.shooting.cache);
}

Work prepare(const AnimateArguments& a) {
  Work w{a, {a.scene, a.size, a.lenient, make_timeline(a.frames, a.defines, a.keyframes, a.at), {}}};
  w.pattern = w.png = parse_pattern("-o", a.out);
  w.png.after.replace(w.png.after.size() - 4, 4, ".png");
  if (a.fps && a.video.empty()) throw Error("--fps: is of a film; add --video OUT.mp4, or leave it out");
  if (!a.video.empty()) check_video(a.video, a.fps.value_or(usual_fps));
  const FrameRange& r = w.shooting.timeline.frames;
  // Finds out what times there are, and that both ends can be loaded.
  const std::shared_ptr<const Scene> zero = load_frame(w.shooting, 0), last = load_frame(w.shooting, r.last),
                                     scene = load_frame(w.shooting, r.first);
  for (const auto& one : {zero, scene, last}) check_apart(a, r, *one, w.shooting.cache);
  if (!a.at.empty() && scene->hints.first_time > scene->hints.last_time)
    throw Error(fmt::format("--at {}: nothing in the scene has an <animation>; leave it out", a.at));
  if (!a.quiet) say_notes(w.shooting.timeline.notes), say_notes(scene->notes);
  w.noted.insert(scene->notes.begin(), scene->notes.end());
  w.options = render_options(a, *zero);
  w.width = zero->camera.crop_width, w.height = zero->camera.crop_height;
  w.first_width = scene->camera.crop_width, w.first_height = scene->camera.crop_height;
  frame_options(w, r.first, *scene), frame_options(w, r.last, *last), note_size(w, r.last, *last);
  w.sequence = sequence_options(a);
  w.carries = w.sequence.coherence.fields && is_guided(w.options.integrator);
  w.options_key = animation_key(w, *zero);
  // What all frames have by the user's word each may have otherwise by the scene's. Lessons that time cut short are
  // others than whole ones.
  const auto key = [&](bool in_time) {
    return fmt::format("{},{}{}{}{}", w.options_key, files_key(*zero), a.max_depth == not_given ? "" : ",one depth",
                       a.size.empty() ? "" : ",one size", in_time ? ",in time" : "");
  };
  w.key = key(has_time_limit(w.options)), w.other_key = key(!has_time_limit(w.options));
  check_references(a, w.shooting);
  const fs::path folder = fs::path(frame_name(w.pattern, 0)).parent_path();
  w.folder = folder.empty() ? "." : folder.string();
  if (!a.video.empty()) check_file(a.video);
  for (int f = r.first; f <= r.last; ++f)
    if (!is_done(w, f)) w.to_do.push_back(f);
  if (!w.to_do.empty()) check_outputs(w);
  check_figures(figures_stem(w));
  look_ahead(w);
  require_one_size(w);
  return w;
}

void run_animate(const AnimateArguments& a) {
  Work w = prepare(a);
  const FrameRange& r = w.shooting.timeline.frames;
  const int there = r.last - r.first + 1 - int(w.to_do.size());
  if (there > 0 && !a.quiet)
    say(stderr, "ajar: note: {} of {} frames are there already\n", there, r.last - r.first + 1);
  w.began = wall_seconds();
  catch_stop();
  try {
    if (!w.to_do.empty()) render_frames(w);
  } catch (...) {  // an interruption, or an error of a frame
    if (!a.quiet) clear_line();
    if (there + w.done > 0) write_figures_so_far(w);
    throw;
  }
  if (!a.quiet) clear_line();
  // An error that only the figures have, of a reference elsewhere in the folder, say, does not cost the film.
  write_each({[&] { write_figures(w); }, [&] { write_film(w); }});
}

}  // namespace

void add_animate(CLI::App& app) {
  auto a = std::make_shared<AnimateArguments>();
  CLI::App* c = app.add_subcommand("animate", "Render the frames of an animation (docs/animation.md)");
  add_options(*c, *a);
  c->callback([a] {
    const CommandThreads threads(a->threads);
    run_animate(*a);
  });
}

}  // namespace ajar
