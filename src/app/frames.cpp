#include "frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "ajar/core/error.h"
#include "ajar/core/files.h"
#include "ajar/report/metrics.h"
#include "arguments.h"

namespace ajar {
namespace {

namespace fs = std::filesystem;

double number_or(const Metadata& metadata, const std::string& name, double otherwise) {
  const auto found = metadata.find(name);
  if (found == metadata.end() || !std::holds_alternative<double>(found->second)) return otherwise;
  return std::get<double>(found->second);
}

// Whether an image that is there is a frame of the animation; of a damaged one its reader tells.
bool is_of(const std::string& path, const std::string& key) {
  if (key.empty()) return true;
  try {
    const Metadata metadata = read_metadata(path);
    const auto found = metadata.find("ajar:frame");
    const auto* frame = found == metadata.end() ? nullptr : std::get_if<std::string>(&found->second);
    return frame && frame->starts_with(key + ",");
  } catch (const Error&) {
    return true;
  }
}

Error damaged(const std::string& path) {
  return Error(fmt::format("{}: is no frame, or a damaged one; remove it, and it is rendered again", path));
}

Metadata frame_metadata(const std::string& path) {
  try {
    return read_metadata(path);
  } catch (const Error&) {
    throw damaged(path);
  }
}

// What the file tells without its pixels; of a frame without a mean it is NaN.
FrameFigures measure_frame(const std::string& path, const Timeline& timeline, int frame) {
  FrameFigures f;
  f.frame = frame;
  f.parameters = parameters_at(timeline, frame);
  if (const auto time = time_at(timeline, frame))  // of the scene: a parameter may be called so too
    f.parameters[f.parameters.count("time") ? "scene_time" : "time"] = fmt::format("{:.9g}", *time);
  const Metadata metadata = frame_metadata(path);
  f.seconds = number_or(metadata, "ajar:seconds", NAN);
  f.cpu_seconds = number_or(metadata, "ajar:cpu_seconds", NAN);
  f.spp = number_or(metadata, "ajar:spp", NAN);
  f.mean = number_or(metadata, "ajar:mean", NAN);
  return f;
}

}  // namespace

FramePattern parse_pattern(const std::string& option, const std::string& text) {
  const auto wrong = [&](const std::string& why) {
    return Error(fmt::format("{} {}: {}; write DIR/frame_%04d.exr", option, text, why));
  };
  const size_t percent = text.find('%');
  if (percent == text.npos) throw wrong("needs a place for the number of the frame");
  const size_t d = text.find_first_not_of("0123456789", percent + 1);
  if (d == text.npos || text[d] != 'd' || text.find('%', d) != text.npos || d - percent > 3)
    throw wrong("the number of the frame stands as %d or %04d, once");
  FramePattern p{text.substr(0, percent), text.substr(d + 1), 0};
  if (d > percent + 1) p.digits = std::stoi(text.substr(percent + 1, d - percent - 1));
  if (!p.after.ends_with(".exr")) throw wrong("frames are EXR files");
  if (p.after.find('/') != p.after.npos) throw wrong("all frames lie in one folder");
  return p;
}

std::string frame_name(const FramePattern& p, int frame) {
  return fmt::format("{}{:0{}}{}", p.before, frame, p.digits, p.after);
}

Picture read_frame(const std::string& path) {
  try {
    return select(read_picture(path), {"R", "G", "B"});
  } catch (const Error&) {
    throw damaged(path);
  }
}

void check_mean(const std::string& path, const Picture& image, const Metadata& metadata, double slack) {
  const double mean = mean_of(image), told = number_or(metadata, "ajar:mean", mean);
  if (!(std::abs(mean - told) <= slack * std::abs(told))) throw damaged(path);
}

std::optional<double> time_at(const Timeline& t, int frame) {
  if (!t.has_time) return {};
  if (t.frames.count == 1) return t.first_time;
  return t.first_time + (t.last_time - t.first_time) * frame / (t.frames.count - 1);
}

std::string describe(const Timeline& timeline, int frame) {
  std::string out;
  const std::map<std::string, std::string> all = parameters_at(timeline, frame);
  for (const auto& [name, track] : timeline.tracks)
    out += fmt::format("{}{}={}", out.empty() ? "" : " ", name, all.at(name));
  if (const auto time = time_at(timeline, frame)) out += fmt::format("{}time={:.9g}", out.empty() ? "" : " ", *time);
  return out;
}

namespace {

// The loader knows parameters by -D alone, and of no frames.
Scene load(const Shooting& s, const LoadOptions& options, int frame) {
  try {
    return load_scene(s.scene_path, options);
  } catch (const Error& error) {
    std::string what = error.what();
    for (const auto& [name, track] : s.timeline.tracks)
      if (const std::string typed = fmt::format("-D {}:", name); !track.file.empty() && what.find(typed) != what.npos)
        what.replace(what.find(typed), typed.size(), fmt::format("{}: parameter \"{}\":", track.file, name));
    if (const std::string there = describe(s.timeline, frame); !there.empty())
      what += fmt::format(" (frame {}: {})", frame, there);
    throw Error(what);
  }
}

}  // namespace

std::shared_ptr<const Scene> load_frame(Shooting& s, int frame) {
  LoadOptions options;
  options.defines = parameters_at(s.timeline, frame);
  options.lenient = s.lenient;
  options.time = time_at(s.timeline, frame);
  options.cache = &s.cache;
  auto scene = std::make_shared<Scene>(load(s, options, frame));
  if (!s.timeline.has_time && scene->hints.first_time < scene->hints.last_time) {
    // The user said nothing: the whole of what the file tells.
    s.timeline.has_time = true;
    s.timeline.first_time = scene->hints.first_time, s.timeline.last_time = scene->hints.last_time;
    return load_frame(s, frame);
  }
  if (!s.size.empty()) set_size(scene->camera, s.size);
  return scene;
}

// Whether the ray tracer may ask the scene whether there is a surface: then it must be of the frame's own.
bool has_masks(const Scene& scene) {
  return std::any_of(scene.shapes.begin(), scene.shapes.end(), [](const Shape& shape) { return shape.mask != none; });
}

Stage set_up(Shooting& s, int frame, const Stage* before) {
  Stage stage;
  Stopwatch watch;
  stage.scene = load_frame(s, frame);
  if (before) stage.moved = find_motion(*before->scene, *stage.scene);
  watch.add_to(stage.load_seconds, stage.load_cpu);
  const bool masked = has_masks(*stage.scene) || (before && has_masks(*before->scene));
  if (before && before->accel && stage.moved.empty() && !masked) {
    stage.accel = before->accel, stage.built_for = before->built_for;
  } else {
    stage.accel = std::make_shared<Accel>(*stage.scene), stage.built_for = stage.scene;
  }
  watch.add_to(stage.build_seconds, stage.build_cpu);
  return stage;
}

std::optional<Carried> find_carried(const std::string& folder, const std::string& key, int last,
                                    const std::function<bool(const Carried&)>& suits) {
  std::optional<Carried> best;
  for (const fs::path& path : files_in(folder)) {
    if (path.extension() != ".fields") continue;
    try {
      Carried c = load_carried(path.string(), key);
      if (int(c.frame) <= last && (!best || c.frame > best->frame) && suits(c)) best = std::move(c);
    } catch (const Error&) {
      // of another animation, or damaged: what it holds is learned again
    }
  }
  return best;
}

std::vector<FrameFigures> measure(const FramePattern& pattern, const Timeline& timeline,
                                  const std::optional<FramePattern>& reference, const std::string& key) {
  std::vector<FrameFigures> out;
  Picture before, reference_before;
  for (int f = 0; f < timeline.frames.count; ++f) {
    const std::string path = frame_name(pattern, f);
    const Picture last = std::exchange(before, {}), last_truth = std::exchange(reference_before, {});
    if (!is_there(path) || !is_of(path, key)) continue;
    out.push_back(measure_frame(path, timeline, f));
    const std::string name = reference ? frame_name(*reference, f) : "";
    const bool compared = reference && is_there(name);
    if (!compared && !std::isnan(out.back().mean)) continue;
    Picture image = read_frame(path);
    if (std::isnan(out.back().mean)) out.back().mean = mean_of(image);
    if (!compared) continue;
    Picture truth = read_rgb(name);
    if (truth.width != image.width || truth.height != image.height)
      throw Error(fmt::format("--reference {}: is {}x{}, the frame {}x{}; use --size", name, truth.width, truth.height,
                              image.width, image.height));
    const Metrics m = compare(image, truth, false);
    out.back().relmse = m.relmse, out.back().relmse_trimmed = m.relmse_trimmed;
    if (last.width == image.width && last.height == image.height)
      out.back().flicker = flicker(last, image, last_truth, truth);
    before = std::move(image), reference_before = std::move(truth);
  }
  return out;
}

}  // namespace ajar
