#include "animate_frames.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "ajar/core/error.h"
#include "ajar/core/files.h"
#include "ajar/core/parallel.h"
#include "ajar/report/metrics.h"
#include "animate_files.h"
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

// Whether its frames' fields are taught before they are rendered.
bool is_taught(const Animation& a) {
  return is_guided(a.options.integrator) && (a.sequence.coherence.fields || a.sequence.coherence.numbers);
}

std::string samples_text(const RenderState& state) { return fmt::format("{:.1f} spp", spp_of(state.film)); }

// On a terminal one line that tells of the frame at work; else one for each that is finished.
void show(Animation& a, int frame, const std::string& what, bool finished) {
  const double now = wall_seconds();
  const bool terminal = isatty(STDERR_FILENO) != 0;
  if (a.arguments.quiet || finished == terminal || (terminal && now - a.shown < 0.25)) return;
  a.shown = now;
  std::string line = fmt::format("frame {} ({} of {}) {}  {}  {} elapsed", frame, finished ? a.done : a.done + 1,
                                 a.to_do.size(), describe(a.shooting.timeline, frame), what, clock_text(now - a.began));
  if (a.done > 0 && size_t(a.done) < a.to_do.size())
    line += fmt::format("  {} left", clock_text((now - a.began) / a.done * double(a.to_do.size() - size_t(a.done))));
  put_line(std::move(line), false);
}

[[noreturn]] void interrupted(int frame) {
  throw Interrupted{fmt::format("interrupted in frame {}; the same command goes on from there", frame)};
}

void write_frame(Animation& a, int frame, const Stage& stage, Run& run, const RenderState& state) {
  Stopwatch watch;
  const Picture image = develop(state.film);
  Metadata data = metadata(run, state);
  data["ajar:frame"] = frame_key(a, frame, *stage.scene);
  data["ajar:mean"] = mean_of(image);
  write_png(frame_name(a.png, frame), image);
  run.triangles = count_triangles(*stage.scene), run.accel_bytes = stage.accel->bytes();
  watch.add_to(run.write_seconds, run.write_cpu);
  nlohmann::ordered_json record = summary(run, state);
  record["frame"] = frame;
  record["coherent"] = a.arguments.coherent;
  record["image_seed"] = image_seed(a.sequence, a.options.seed, uint32_t(frame));
  const fs::path name = fs::path(run.out_path).replace_extension(".json");
  write_text(name.string(), record_of(record));
  // Last: a frame is done when its image is there.
  try {
    write_exr(run.out_path, image, data, a.arguments.half ? PixelType::half : PixelType::float32);
  } catch (const Error&) {
    std::error_code as_it_is;
    fs::remove(name, as_it_is), fs::remove(frame_name(a.png, frame), as_it_is);
    throw;
  }
}

// What its record tells.
Run frame_run(const Animation& a, int frame, const Stage& stage) {
  Run run;
  run.scene_path = a.arguments.scene, run.out_path = frame_name(a.pattern, frame);
  for (const auto& [name, value] : parameters_at(a.shooting.timeline, frame)) run.defines.push_back(name + "=" + value);
  run.at = time_at(a.shooting.timeline, frame);
  run.lenient = a.arguments.lenient;
  run.options = frame_options(a, frame, *stage.scene);
  if (is_taught(a)) run.taught = a.sequence;
  run.light_choice = usual_light_choice(run.options.integrator);
  run.threads = a.options.threads > 0 ? a.options.threads : processor_count();
  run.load_seconds = stage.load_seconds, run.load_cpu = stage.load_cpu;
  run.build_seconds = stage.build_seconds, run.build_cpu = stage.build_cpu;
  return run;
}

// Renders one frame.
void render_frame(Animation& a, int frame, const Stage& stage, const Lessons& lessons) {
  Run run = frame_run(a, frame, stage);
  RenderOptions options = run.options;
  options.seed = image_seed(a.sequence, a.options.seed, uint32_t(frame));
  RenderState state =
      a.carried ? start_with(*stage.scene, options, a.carried->fields) : start_render(*stage.scene, options);
  state.stats.seconds = state.stats.learn_seconds = lessons.seconds;
  state.stats.cpu_seconds = state.stats.learn_cpu_seconds = lessons.cpu_seconds;
  state.stats.counters = lessons.counters;
  render(*stage.scene, *stage.accel, without_start(options, run), state, [&](const RenderState& s) {
    show(a, frame, samples_text(s), false);
    return !stop_asked();
  });
  if (stop_asked()) interrupted(frame);
  write_frame(a, frame, stage, run, state);
  ++a.done;
  show(a, frame, samples_text(state), true);
  if (state.stats.rejected == 0) return;
  clear_line();
  say(stderr, "ajar: warning: frame {}: {} values were not finite or negative and were left out\n", frame,
      state.stats.rejected);
}

// For a command that goes on from here; without them it learns them again.
void save_for_later(Animation& a) {
  try {
    save_carried(carried_name(a), a.key, *a.carried);
  } catch (const Error& error) {
    if (!a.lost) clear_line(), say(stderr, "ajar: warning: {}; the animation goes on\n", error.what());
    a.lost = true;
  }
}

// The fields of a frame from those of the frame before.
Lessons teach_frame(Animation& a, int frame, const Stage& stage) {
  Stopwatch watch;
  Lessons lessons;
  const Carried* before = a.sequence.coherence.fields && a.carried ? &*a.carried : nullptr;
  std::optional<Fields> fields = teach(*stage.scene, *stage.accel, frame_options(a, frame, *stage.scene), a.sequence,
                                       before, stage.moved, uint32_t(frame), [&](const RenderState& now) {
                                         lessons.counters = now.stats.counters;
                                         show(a, frame, "learning", false);
                                         return !stop_asked();
                                       });
  if (!fields) interrupted(frame);
  const FileHistory files = with_frame(a.carried ? a.carried->files : FileHistory{}, stage.scene->content);
  a.carried = Carried{uint32_t(frame), std::move(*fields), files};
  watch.add_to(lessons.seconds, lessons.cpu_seconds);
  return lessons;
}

void tell_frame(const Animation& a, int frame) {
  if (a.arguments.quiet) return;
  clear_line();
  say(stdout, "{}\n", frame_name(a.pattern, frame));
  std::fflush(stdout);
}

// What the loader notes of a frame alone, or of it and those that follow.
void tell_notes(Animation& a, int frame, const Scene& scene) {
  for (const std::string& note : scene.notes) {
    if (!a.noted.insert(note).second || a.arguments.quiet) continue;
    clear_line();
    say(stderr, "ajar: note: frame {}: {}\n", frame, note);
  }
}

// Whether the frames that taught these fields have the files that they had then. Where this one has those of the first
// frame, those between are not loaded for it.
bool is_of_these_files(Animation& a, const Carried& carried) {
  const auto content = [&](int frame) { return load_frame(a.shooting, frame)->content; };
  FileHistory files = with_frame({}, content(0));
  if (content(int(carried.frame)) != carried.files.content) return false;
  if (files == carried.files) return true;
  for (int f = 1; f <= int(carried.frame); ++f) files = with_frame(files, content(f));
  return files == carried.files;
}

// Says why the frames from one on to those that are to be rendered are learned again.
void tell_learned_again(const Animation& a, int frame) {
  if (a.arguments.quiet) return;
  const int next = a.to_do.front();
  std::string why = "none of them left any here that go with this scene and these options";
  const auto is_of_them = [&](const Carried& c) { return int(c.frame) >= frame; };
  if (const auto other = find_carried(a.folder, a.other_key, next - 1, is_of_them)) {
    const bool in_time = has_time_limit(a.options);
    why = fmt::format("those that frame {} left here were learned {} a time limit, these are {} one", other->frame,
                      in_time ? "without" : "with", in_time ? "with" : "without");
  }
  say(stderr, "ajar: note: the fields of frames {} to {} are learned again: {}\n", frame, next - 1, why);
}

}  // namespace

void render_frames(Animation& a) {
  const bool taught = is_taught(a);
  std::optional<Stage> before;
  const int count = a.shooting.timeline.frames.count;
  int frame = a.to_do.front();
  if (a.carries) {
    a.carried =
        find_carried(a.folder, a.key, frame - 1, [&](const Carried& found) { return is_of_these_files(a, found); });
    frame = a.carried ? int(a.carried->frame) + 1 : 0;
    if (a.carried) before = Stage{load_frame(a.shooting, int(a.carried->frame)), {}, {}, {}};
    if (frame < a.to_do.front()) tell_learned_again(a, frame);
  }
  for (; frame <= a.to_do.back(); ++frame) {
    const bool wanted = std::binary_search(a.to_do.begin(), a.to_do.end(), frame);
    if (!wanted && !a.carries) continue;
    Stage stage = set_up(a.shooting, frame, before ? &*before : nullptr);
    if (wanted) tell_notes(a, frame, *stage.scene);
    if (wanted) note_size(a, frame, *stage.scene);
    if (wanted) check_apart(a.arguments, {frame, frame, count}, *stage.scene, a.shooting.cache);
    const Lessons lessons = taught ? teach_frame(a, frame, stage) : Lessons{};
    if (wanted) {
      render_frame(a, frame, stage, lessons);
      if (a.carries) save_for_later(a);
      tell_frame(a, frame);
    }
    before = std::move(stage);
  }
}

}  // namespace ajar
