#include "animate_files.h"

#include <fmt/format.h>

#include <filesystem>

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

}  // namespace

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
