#include "outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>

#include "ajar/core/error.h"
#include "ajar/core/files.h"
#include "ajar/film/pyramid.h"
#include "ajar/report/account.h"
#include "ajar/report/metrics.h"
#include "apart.h"
#include "progress.h"
#include "say.h"
#include "stop.h"

namespace ajar {
namespace {

Picture append(Picture a, const Picture& b) {
  Picture out{a.width, a.height, a.names, {}};
  out.pixels.reserve(a.pixels.size() + b.pixels.size());
  out.names.insert(out.names.end(), b.names.begin(), b.names.end());
  const size_t na = a.names.size(), nb = b.names.size();
  for (size_t i = 0; i < size_t(a.width) * size_t(a.height); ++i) {
    out.pixels.insert(out.pixels.end(), &a.pixels[i * na], &a.pixels[i * na] + na);
    out.pixels.insert(out.pixels.end(), &b.pixels[i * nb], &b.pixels[i * nb] + nb);
  }
  return out;
}

Picture with_features(const RenderArguments& a, const Scene& scene, const Accel& accel, const RenderState& state) {
  Picture out = develop(state.film);
  const std::map<std::string, std::vector<std::string>> groups = {{"albedo", {"Albedo.R", "Albedo.G", "Albedo.B"}},
                                                                  {"normal", {"N.X", "N.Y", "N.Z"}},
                                                                  {"position", {"P.X", "P.Y", "P.Z"}}};
  std::vector<std::string> wanted;
  bool with_variance = false;
  for (auto f = a.features.begin(); f != a.features.end(); ++f) {
    if (std::find(a.features.begin(), f, *f) != f) continue;  // named twice
    if (*f == "variance")
      with_variance = true;
    else
      wanted.insert(wanted.end(), groups.at(*f).begin(), groups.at(*f).end());
  }
  if (!wanted.empty()) out = append(out, select(render_features(scene, accel, a.seed), wanted));
  if (with_variance) out = append(out, variance(state.film));
  return out;
}

std::string with_extension(const std::string& path, const char* extension) {
  return std::filesystem::path(path).replace_extension(extension).string();
}

void check_name(const RenderArguments& a) {
  std::error_code error;
  if (std::filesystem::is_directory(a.out, error))
    throw Error(fmt::format("-o {}: is a folder; name a file in it, {}", a.out,
                            (std::filesystem::path(a.out) / "NAME.exr").string()));
  if (!is_exr(a.out) && !is_png(a.out))
    throw Error(fmt::format("-o {}: is no name for an image; write NAME.exr, or NAME.png for a tonemapped one", a.out));
  if (is_png(a.out) && (a.half || !a.features.empty()))
    throw Error(fmt::format("{}: is for EXR images; write -o NAME.exr, with --png for a PNG beside it",
                            a.half ? "--half" : "--aov"));
}

void add(std::vector<Named>& list, const char* option, const std::string& path) {
  if (!path.empty()) list.push_back({option, path});
}

std::vector<Named> written(const RenderArguments& a) {
  std::vector<Named> out;
  add(out, "-o", a.out);
  add(out, "the record", with_extension(a.out, ".json"));
  add(out, "--png", png_beside(a));
  add(out, "--log", a.log);
  add(out, "--checkpoint", a.checkpoint);
  add(out, "--save-fields", a.save_fields);
  return out;
}

std::vector<Named> read(const RenderArguments& a) {
  std::vector<Named> out;
  add(out, "the scene", a.scene);
  add(out, "--reference", a.reference);
  add(out, "--resume", a.resume);
  add(out, "--load-fields", a.load_fields);
  return out;
}

// What goes on may be saved under its old name.
bool goes_on(const Named& output, const Named& input) {
  return (output.option == "--checkpoint" && input.option == "--resume") ||
         (output.option == "--save-fields" && input.option == "--load-fields");
}

// Images of strategies take the place of all that lie in their folder, by their names.
void check_layers(const RenderArguments& a, const std::vector<Named>& files) {
  if (a.techniques.empty()) return;
  for (const Named& file : files) {
    const std::filesystem::path path = file.path;
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    if (is_layer(path.filename().string()) && is_same_file(folder.string(), a.techniques))
      throw Error(
          fmt::format("--techniques {}: would take away {} {}, whose name is that of a strategy's image; name "
                      "another folder",
                      a.techniques, file.option, file.path));
  }
}

// Of a render: what is none is somebody's.
bool is_record(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const nlohmann::json found = nlohmann::json::parse(file, nullptr, false);
  return found.is_object() && found.contains("version") && found.contains("image") && found.contains("options");
}

// AOVs are left out where memory is too short for them: the image is not lost.
Picture image_of(const RenderArguments& a, const Scene& scene, const Accel& accel, const RenderState& state) {
  if (a.features.empty()) return develop(state.film);
  try {
    return with_features(a, scene, accel, state);
  } catch (const std::bad_alloc&) {
    say(stderr, "ajar: warning: out of memory for --aov; {} is written without\n", a.out);
    return develop(state.film);
  }
}

// Takes away what follows the last whole line: one that was cut, by a disk that was full, say.
void drop_cut_line(const std::string& path) {
  if (!is_file(path)) return;
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::streamoff end = file.tellg();
  const auto is_whole = [&] { return file.seekg(end - 1) && file.get() == '\n'; };
  while (end > 0 && !is_whole()) --end;
  std::error_code as_it_is;
  std::filesystem::resize_file(path, uintmax_t(std::max(end, std::streamoff(0))), as_it_is);
}

}  // namespace

void Log::write(const RenderState& state, bool last) {
  if (!file.is_open() || (!last && state.stats.seconds < next) || state.film.passes == 0) return;
  next = std::max(next, state.stats.seconds) * 1.1;
  nlohmann::ordered_json j = {
      {"seconds", state.stats.seconds}, {"cpu_seconds", state.stats.cpu_seconds}, {"spp", state.film.passes}};
  if (const double error = estimated_error(state.film); error < infinity) j["estimated_relmse"] = error;
  if (reference) j["error"] = nlohmann::ordered_json::parse(to_json(compare(develop(state.film), *reference)));
  j["phases_cpu"] = phases_json(state.stats.cpu_seconds, state.stats.learn_cpu_seconds, state.stats.ticks);
  add_account(j, state);
  waiting += j.dump() + "\n";
  if (spares && !last && state.stats.seconds <= save_seconds) return;
  errno = 0;
  if (spares) file.close(), file.open(path, std::ios::out);  // empties it
  spares = false;
  if (file << waiting << std::flush) return waiting.clear();
  fault = fmt::format("{}: cannot be written ({}); the log ends there", path, std::strerror(errno));
  file.close();
  drop_cut_line(path);
}

Picture read_reference(const std::string& path, const Camera& camera) {
  Picture picture = read_rgb(path);
  require_comparable(picture, "--reference " + path);
  if (picture.width != camera.crop_width || picture.height != camera.crop_height)
    throw Error(fmt::format("--reference {}: is {}x{}, the render {}x{}; use --size", path, picture.width,
                            picture.height, camera.crop_width, camera.crop_height));
  return picture;
}

std::optional<Picture> read_reference(const RenderArguments& a, const Camera& camera) {
  if (a.reference.empty()) return {};
  if (a.log.empty()) throw Error("--reference: the error against it goes into the log; add --log FILE");
  return read_reference(a.reference, camera);
}

Log open_log(const RenderArguments& a, std::optional<Picture> reference) {
  Log log;
  log.path = a.log;
  log.reference = std::move(reference);
  if (a.log.empty()) return log;
  make_folder_of(a.log);
  if (!a.resume.empty()) drop_cut_line(a.log);
  std::error_code error;
  log.spares = a.resume.empty() && is_file(a.log) && std::filesystem::file_size(a.log, error) > 0 && !error;
  log.file.open(a.log, a.resume.empty() && !log.spares ? std::ios::out : std::ios::app);
  if (!log.file) throw Error(fmt::format("--log {}: cannot be written ({})", a.log, std::strerror(errno)));
  return log;
}

void check_apart(const RenderArguments& a, const Scene& scene) { require_apart(written(a), files_of(scene)); }

void check_outputs(const RenderArguments& a) {
  check_name(a);
  const std::vector<Named> outputs = written(a);
  for (size_t i = 0; i < outputs.size(); ++i) {
    for (size_t j = 0; j < i; ++j) require_apart(outputs[i], outputs[j]);
    for (const Named& input : read(a))
      if (!goes_on(outputs[i], input)) require_apart(outputs[i], input);
  }
  check_layers(a, outputs), check_layers(a, read(a));
  if (!a.techniques.empty()) require_apart({{"--techniques", a.techniques}}, outputs);
  for (const Named& output : outputs) check_file(output.path);
  check_record(a.out);
  if (!a.techniques.empty()) check_folder(a.techniques);
}

void check_record(const std::string& image) {
  const std::string record = with_extension(image, ".json");
  std::error_code unknown;
  if (!is_file(record) || std::filesystem::file_size(record, unknown) == 0) return;
  if (!is_record(record))
    throw Error(
        fmt::format("{}: is no record of a render, which would take its place beside {}; move it, or name "
                    "another image",
                    record, image));
}

void write_record(const RenderArguments& a, const Run& run, const RenderState& state) {
  write_text(with_extension(a.out, ".json"), record_of(summary(run, state)));
}

void write_image(const RenderArguments& a, const Scene& scene, const Accel& accel, Run& run, const RenderState& state) {
  Stopwatch watch;
  if (!is_png(a.out))
    write_exr(a.out, image_of(a, scene, accel, state), metadata(run, state),
              a.half ? PixelType::half : PixelType::float32);
  if (is_png(a.out)) write_png(a.out, develop(state.film));
  watch.add_to(run.write_seconds, run.write_cpu);
  write_record(a, run, state);
  if (!a.quiet) say(stdout, "{}\n", a.out);
}

std::string png_beside(const RenderArguments& a) {
  return a.png && !is_png(a.out) ? with_extension(a.out, ".png") : "";
}

void write_png_beside(const RenderArguments& a, const RenderState& state) {
  const std::string png = png_beside(a);
  write_png(png, develop(state.film));
  if (!a.quiet) say(stdout, "{}\n", png);
}

void Saver::save(const RenderState& state) {
  if (path.empty() || state.stats.seconds - saved <= save_seconds) return;
  saved = state.stats.seconds;
  try {
    save_checkpoint(path, key, state);
  } catch (const Error& error) {
    if (!failed) clear_line(), say(stderr, "ajar: warning: {}; the render goes on\n", error.what());
    failed = true;
  }
}

void write_each(const std::vector<std::function<void()>>& writes) {
  std::optional<Error> failed;
  for (const std::function<void()>& write : writes) {
    std::string fault;
    try {
      write();
      continue;
    } catch (const Interrupted&) {
      if (failed) say(stderr, "ajar: {}\n", failed->what());
      throw;
    } catch (const std::bad_alloc&) {
      fault = "out of memory; not all is written";
    } catch (const std::exception& error) {
      fault = error.what();
    }
    if (failed) say(stderr, "ajar: {}\n", failed->what());
    failed = Error(fault);
  }
  if (failed) throw *failed;
}

}  // namespace ajar
