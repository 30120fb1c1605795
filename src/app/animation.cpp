#include "animation.h"

#include <fmt/format.h>

#include <filesystem>

#include "ajar/core/bytes.h"
#include "ajar/core/error.h"
#include "ajar/core/files.h"
#include "ajar/core/parallel.h"
#include "animate_files.h"
#include "outputs.h"
#include "render_options.h"
#include "say.h"
#include "summary.h"

namespace ajar {
namespace {

namespace fs = std::filesystem;

// Everything that decides the pixels of all frames but their budgets and the scene's files. scene: of frame 0.
std::string animation_key(const Animation& a, const Scene& scene) {
  Run run;
  run.scene_path = a.arguments.scene;
  run.options = a.options;
  run.defines = a.arguments.defines;
  const Timeline& t = a.shooting.timeline;
  const SequenceOptions& s = a.sequence;
  std::string key = fmt::format("{} | {} frames, {}, teach {} {}, forget {:g} | ",  // the budgets are each frame's own
                                checkpoint_key(run, make_film(scene.camera, scene.filter, false)), t.frames.count,
                                a.arguments.coherent, s.begin, s.teach, s.forget);
  for (int f = 0; f < t.frames.count; ++f) key += describe(t, f) + ";";
  return fmt::format("{:016x} {}", checksum(key.data(), key.size(), 0),
                     fs::path(a.arguments.scene).filename().string());
}

std::string files_key(const Scene& scene) { return fmt::format("files with checksum {:016x}", scene.content); }

// Whether the frame is there as it should be; a PNG that is missing is made again.
bool is_done(Animation& a, int frame) {
  const std::string path = frame_name(a.pattern, frame);
  if (!is_there(path)) return false;
  const Picture image = read_frame(path);
  const Metadata metadata = read_metadata(path);
  // What is stored as half is rounded, by a part in 2048 at most; all else comes back as it was.
  check_mean(path, image, metadata, a.arguments.half ? 0x1p-11 : 0);
  const auto found = metadata.find("ajar:frame");
  const std::shared_ptr<const Scene> scene = load_frame(a.shooting, frame);
  note_size(a, frame, *scene);
  const std::string here = frame_key(a, frame, *scene);
  const auto* there = found == metadata.end() ? nullptr : std::get_if<std::string>(&found->second);
  if (there && *there == here) {
    if (const std::string png = frame_name(a.png, frame); !is_file(png)) write_png(png, image);
    return true;
  }
  const std::string why = there && there->starts_with(a.options_key + ",")
                              ? "was made otherwise: " + difference(*there, here)
                              : "is of another animation, or of other options";
  throw Error(fmt::format("{}: {}; remove it, or write elsewhere", path, why));
}

// What is done before the first frame may take long: told now and then.
struct Teller {
  const char* done;
  bool quiet;
  double told = wall_seconds();

  void tell(int frame, const FrameRange& r) {
    if (quiet || wall_seconds() - told < 5) return;
    told = wall_seconds();
    say(stderr, "ajar: note: {} frame {} of {} to {}\n", done, frame, r.first, r.last);
  }
};

// Every frame that is there is looked at, and its scene loaded.
void find_what_is_left(Animation& a) {
  const FrameRange& r = a.shooting.timeline.frames;
  Teller teller{"looked at", a.arguments.quiet};
  for (int f = r.first; f <= r.last; ++f) {
    if (!is_done(a, f)) a.to_do.push_back(f);
    teller.tell(f, r);
  }
}

// What would stand in the way of the files to come.
void check_outputs(const Animation& a) {
  check_files(a.arguments, a.to_do.front());
  check_no_folders(a.arguments, a.shooting.timeline.frames);
  for (const int frame : a.to_do) check_record(frame_name(a.pattern, frame));
  if (a.carries) check_file(carried_name(a));
}

// CPU seconds that go into a look ahead: at all frames, and at those where parameters have keys or change sign.
constexpr double look_seconds = 5, longest_look_seconds = 30;

// Loads the frames, while that is cheap, so that what is wrong with one of them is told before others are rendered.
// First and last were loaded; the second is, however long that takes: there a parameter that is to be whole may not be.
void look_ahead(Animation& a) {
  const Timeline& t = a.shooting.timeline;
  const FrameRange& r = t.frames;
  if (t.tracks.empty() && !(t.has_time && t.first_time != t.last_time)) return;
  const double began = process_cpu_seconds();
  std::shared_ptr<const Scene> scene;
  Teller teller{"looked ahead at", a.arguments.quiet};
  for (const int frame : a.to_do) {
    if (frame == 0 || frame == r.first || frame == r.last) continue;
    const double spent = process_cpu_seconds() - began;
    const double limit = frame == r.first + 1 ? infinity : is_marked(t, frame) ? longest_look_seconds : look_seconds;
    if (spent > limit) continue;
    scene = load_frame(a.shooting, frame);
    frame_options(a, frame, *scene), note_size(a, frame, *scene);
    teller.tell(frame, r);
  }
  if (scene) check_apart(a.arguments, r, *scene, a.shooting.cache);
}

// What was typed, taken apart.
Animation announce(const AnimateArguments& arguments) {
  Timeline timeline = make_timeline(arguments.frames, arguments.defines, arguments.keyframes, arguments.at);
  Animation a{arguments, {arguments.scene, arguments.size, arguments.lenient, std::move(timeline), {}}};
  a.pattern = a.png = parse_pattern("-o", arguments.out);
  a.png.after.replace(a.png.after.size() - 4, 4, ".png");
  if (arguments.fps && arguments.video.empty())
    throw Error("--fps: is of a film; add --video OUT.mp4, or leave it out");
  if (!arguments.video.empty()) check_video(arguments.video, arguments.fps.value_or(usual_fps));
  return a;
}

// Scenes of frame 0, whose options all frames have, and of both ends of the range.
struct Ends {
  std::shared_ptr<const Scene> zero, first, last;
};

// Finds out what times there are, and that all three can be loaded.
Ends load_ends(Animation& a) {
  const AnimateArguments& arguments = a.arguments;
  const FrameRange& r = a.shooting.timeline.frames;
  Ends ends;
  ends.zero = load_frame(a.shooting, 0), ends.last = load_frame(a.shooting, r.last);
  ends.first = load_frame(a.shooting, r.first);
  for (const auto& one : {ends.zero, ends.first, ends.last}) check_apart(arguments, r, *one, a.shooting.cache);
  if (!arguments.at.empty() && ends.first->hints.first_time > ends.first->hints.last_time)
    throw Error(fmt::format("--at {}: nothing in the scene has an <animation>; leave it out", arguments.at));
  if (!arguments.quiet) say_notes(a.shooting.timeline.notes), say_notes(ends.first->notes);
  a.noted.insert(ends.first->notes.begin(), ends.first->notes.end());
  return ends;
}

void set_options(Animation& a, const Ends& ends) {
  const FrameRange& r = a.shooting.timeline.frames;
  a.options = render_options(a.arguments, *ends.zero);
  a.width = ends.zero->camera.crop_width, a.height = ends.zero->camera.crop_height;
  a.first_width = ends.first->camera.crop_width, a.first_height = ends.first->camera.crop_height;
  frame_options(a, r.first, *ends.first), frame_options(a, r.last, *ends.last), note_size(a, r.last, *ends.last);
  a.sequence = sequence_options(a.arguments);
  a.carries = a.sequence.coherence.fields && is_guided(a.options.integrator);
}

// What all frames have by the user's word each may have otherwise by the scene's. Lessons that time cut short are
// others than whole ones.
void set_keys(Animation& a, const Scene& zero) {
  a.options_key = animation_key(a, zero);
  const auto key = [&](bool in_time) {
    return fmt::format("{},{}{}{}{}", a.options_key, files_key(zero),
                       a.arguments.max_depth == not_given ? "" : ",one depth",
                       a.arguments.size.empty() ? "" : ",one size", in_time ? ",in time" : "");
  };
  a.key = key(has_time_limit(a.options)), a.other_key = key(!has_time_limit(a.options));
}

}  // namespace

RenderOptions frame_options(const Animation& a, int frame, const Scene& scene) {
  RenderOptions options = render_options(a.arguments, scene);
  if (options.integrator != a.options.integrator)
    throw Error(fmt::format("frame {}: the scene names the integrator {}, but {} in frame 0; choose with --integrator",
                            frame, options.integrator, a.options.integrator));
  return options;
}

std::string frame_key(const Animation& a, int frame, const Scene& scene) {
  const RenderOptions o = frame_options(a, frame, scene);
  const std::string budget = fmt::format("{:g} s,{:g} CPU s,{} spp", o.seconds, o.cpu_seconds, o.spp);
  std::string key = fmt::format("{},frame {} {},{},{}", a.options_key, frame, describe(a.shooting.timeline, frame),
                                files_key(scene), budget);
  const int width = scene.camera.crop_width, height = scene.camera.crop_height;
  if (o.max_depth != a.options.max_depth) key += fmt::format(",depth {}", o.max_depth);
  if (width != a.width || height != a.height) key += fmt::format(",{}x{}", width, height);
  if (a.arguments.half) key += ",half";
  return key;
}

void note_size(Animation& a, int frame, const Scene& scene) {
  const int width = scene.camera.crop_width, height = scene.camera.crop_height;
  if (!a.other_size.empty() || (width == a.first_width && height == a.first_height)) return;
  a.other_size = fmt::format("frame {} is {}x{}, frame {} {}x{}", a.shooting.timeline.frames.first, a.first_width,
                             a.first_height, frame, width, height);
}

void require_one_size(const Animation& a) {
  if (a.arguments.video.empty() || a.other_size.empty()) return;
  throw Error(fmt::format("--video {}: {}, and frames of a film have one size; add --size, or leave --video out",
                          a.arguments.video, a.other_size));
}

std::string carried_name(const Animation& a) {
  const FrameRange& r = a.shooting.timeline.frames;
  return fmt::format("{}/carried_{}-{}.fields", a.folder, r.first, r.last);
}

std::string figures_stem(const Animation& a) { return a.folder + "/animation"; }

Animation prepare(const AnimateArguments& arguments) {
  Animation a = announce(arguments);
  const Ends ends = load_ends(a);
  set_options(a, ends);
  set_keys(a, *ends.zero);
  check_references(arguments, a.shooting);
  const fs::path folder = fs::path(frame_name(a.pattern, 0)).parent_path();
  a.folder = folder.empty() ? "." : folder.string();
  if (!arguments.video.empty()) check_file(arguments.video);
  find_what_is_left(a);
  if (!a.to_do.empty()) check_outputs(a);
  check_figures(figures_stem(a));
  look_ahead(a);
  require_one_size(a);
  return a;
}

}  // namespace ajar
