#include "animate_files.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "ajar/core/error.h"
#include "ajar/core/files.h"
#include "apart.h"
#include "outputs.h"

namespace ajar {
namespace {

namespace fs = std::filesystem;

std::vector<Named> written(const AnimateArguments& a, const FrameRange& frames) {
  const FramePattern pattern = parse_pattern("-o", a.out);
  std::vector<Named> out;
  for (int f = frames.first; f <= frames.last; ++f)
    for (const char* extension : {".exr", ".png", ".json"})
      out.push_back({"-o, frame", fs::path(frame_name(pattern, f)).replace_extension(extension).string()});
  for (const char* name : {"animation.json", "animation.csv", "animation.svg"})
    out.push_back({"-o, figures", (fs::path(a.out).parent_path() / name).string()});
  if (!a.video.empty()) out.push_back({"--video", a.video});
  return out;
}

std::vector<Named> read(const AnimateArguments& a, const FrameRange& frames, const Scene& scene,
                        const LoadCache& cache) {
  std::vector<Named> out = files_of(scene);
  out.insert(out.begin(), {"the scene", a.scene});
  for (const auto& [file, sum] : cache.files) out.push_back({"a file of the scene,", file});
  if (!a.keyframes.empty()) out.push_back({"--keyframes", a.keyframes});
  if (a.reference.empty()) return out;
  const FramePattern reference = parse_pattern("--reference", a.reference);
  for (int f = frames.first; f <= frames.last; ++f) out.push_back({"--reference", frame_name(reference, f)});
  return out;
}

// Whether animation.json tells of an animation: a user's keyframes may have that name, too.
bool has_figures(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const nlohmann::json found = nlohmann::json::parse(file, nullptr, false);
  return found.is_object() && found.contains("frames_done");
}

// Whether a table or plot begins as those of figures do.
bool begins_as_figures(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  std::getline(file, line);
  if (path.ends_with(".csv")) return line.starts_with("frame,") && line.ends_with(",flicker");
  return line.starts_with("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 700 500'");
}

}  // namespace

void check_figures(const std::string& stem) {
  const std::string figures = stem + ".json";
  const bool known = is_file(figures) && has_figures(figures);  // is written before the others
  for (const char* extension : {".json", ".csv", ".svg"}) {
    const std::string path = stem + extension;
    std::error_code unknown;
    if (known || !is_file(path) || fs::file_size(path, unknown) == 0) continue;
    if (path == figures || !begins_as_figures(path))
      throw Error(
          fmt::format("{}: holds no figures of an animation, which would take its place; move it, or write the "
                      "frames to another folder",
                      path));
  }
}

void check_apart(const AnimateArguments& a, const FrameRange& frames, const Scene& scene, const LoadCache& cache) {
  require_apart(written(a, frames), read(a, frames, scene, cache));
}

void check_files(const AnimateArguments& a, int frame) {
  for (const Named& file : written(a, {frame, frame, frame + 1})) check_file(file.path);
}

void check_no_folders(const AnimateArguments& a, const FrameRange& frames) {
  for (const Named& file : written(a, frames))
    if (is_there(file.path) && !is_file(file.path)) check_file(file.path);
}

void check_references(const AnimateArguments& a, Shooting& shooting) {
  if (a.reference.empty()) return;
  const FramePattern reference = parse_pattern("--reference", a.reference);
  const FrameRange& r = shooting.timeline.frames;
  for (int f = r.first; f <= r.last; ++f)
    if (const std::string name = frame_name(reference, f); !is_there(name))
      throw Error(fmt::format("--reference {}: there is no {}; make it, or take a part of the --frames, such as 0-9/48",
                              a.reference, name));
  std::shared_ptr<const Scene> scene;
  for (int f = r.first; f <= r.last; ++f) {
    if (!scene || !shooting.timeline.tracks.empty()) scene = load_frame(shooting, f);  // parameters may be of its size
    read_reference(frame_name(reference, f), scene->camera);
  }
}

}  // namespace ajar
