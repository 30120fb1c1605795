#include "arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "ajar/core/error.h"
#include "ajar/core/files.h"

namespace ajar {

std::string extension_of(const std::string& path) {
  std::string out = std::filesystem::path(path).extension().string();
  std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return out;
}

void set_size(Camera& camera, const std::string& text) {
  int w = 0, h = 0;
  const char* end = text.data() + text.size();
  const char* by = std::from_chars(text.data(), end, w).ptr;
  if (by == end || *by != 'x' || std::from_chars(by + 1, end, h).ptr != end || w < 1 || h < 1 || w > 65536 || h > 65536)
    throw Error(fmt::format("--size {}: write WIDTHxHEIGHT, each 1 to 65536", text));
  set_size(camera, w, h);
}

std::pair<std::string, std::string> parse_define(const std::string& written, const char* forms) {
  const size_t equals = written.find('=');
  if (equals == 0 || equals == written.npos) throw Error(fmt::format("-D {}: write {}", written, forms));
  return {written.substr(0, equals), written.substr(equals + 1)};
}

LoadOptions load_options(const std::vector<std::string>& defines, bool lenient, std::optional<double> at) {
  if (at && !std::isfinite(*at)) throw Error(fmt::format("--at {}: not a time; write a number", *at));
  LoadOptions o;
  o.lenient = lenient, o.time = at;
  for (const std::string& d : defines) {
    const auto [name, value] = parse_define(d);
    if (!o.defines.emplace(name, value).second)
      throw Error(fmt::format("-D {}: {} is given twice; leave one of them out", d, name));
  }
  return o;
}

void check_time(std::optional<double> at, const Scene& scene) {
  if (at && scene.hints.first_time > scene.hints.last_time)
    throw Error(fmt::format("--at {}: nothing in the scene has an <animation>; leave it out", *at));
}

size_t parse_bytes(const std::string& option, const std::string& text) {
  uint64_t n = 0;
  const char* end = text.data() + text.size();
  const auto [rest, failed] = std::from_chars(text.data(), end, n);
  const std::string unit(rest, end);
  const int shift = unit.empty() ? 0 : unit == "K" ? 10 : unit == "M" ? 20 : unit == "G" ? 30 : -1;
  constexpr uint64_t least = 64 << 10, most = uint64_t(64) << 30;
  if (failed != std::errc() || shift < 0 || n > most >> shift || (n << shift) < least)
    throw Error(fmt::format("{} {}: not a size; write 512K, 8M or 1G, from 64K to 64G", option, text));
  return size_t(n << shift);
}

double parse_duration(const std::string& option, const std::string& text) {
  double value = -1;
  const char* end = text.data() + text.size();
  const std::string unit(std::from_chars(text.data(), end, value).ptr, end);
  const double factor = unit.empty() || unit == "s" ? 1 : unit == "m" || unit == "min" ? 60 : unit == "h" ? 3600 : 0;
  if (!(value > 0) || factor == 0 || !std::isfinite(value * factor))
    throw Error(fmt::format("{} {}: not a time; write 90s, 5m or 1h", option, text));
  return value * factor;
}

void set_limits(const std::string& time, const std::string& cpu_time, int spp, const Scene& scene, RenderOptions& o) {
  if (!time.empty()) o.seconds = parse_duration("--time", time);
  if (!cpu_time.empty()) o.cpu_seconds = parse_duration("--cpu-time", cpu_time);
  o.spp = uint32_t(spp);
  if (!is_limited(o)) o.spp = scene.hints.spp > 0 ? uint32_t(scene.hints.spp) : default_spp;
}

void set_max_depth(int max_depth, const Scene& scene, RenderOptions& o) {
  if (max_depth > deepest)
    throw Error(fmt::format("--max-depth {}: paths end at {} edges; write that or less, or -1", max_depth, deepest));
  o.max_depth = max_depth != not_given ? max_depth : scene.hints.max_depth;
  if (o.max_depth < -1 || o.max_depth == 0)
    throw Error(fmt::format("--max-depth {}: -1 for unlimited, 1 or more edges otherwise", o.max_depth));
}

bool is_integrator(const std::string& name) {
  const std::vector<std::string> known = integrator_names();
  return std::find(known.begin(), known.end(), name) != known.end();
}

void check_integrator(const std::string& name) {
  if (!is_integrator(name))
    throw Error(fmt::format("--integrator {}: unknown; known are {}", name, fmt::join(integrator_names(), ", ")));
}

void check_guide(const std::string& guide, const std::string& integrator) {
  if (integrator == "guided-path" && guide == "light")
    throw Error("--guide light: guided-path has no light subpaths; leave it out, or take guided-bdpt");
  if (integrator == "vpl" && guide != "both")
    throw Error(fmt::format("--guide {}: vpl guides light subpaths alone; leave it out", guide));
}

bool is_png(const std::string& path) { return extension_of(path) == ".png"; }
bool is_exr(const std::string& path) { return extension_of(path) == ".exr"; }

std::string place_of(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const bool dangles = fs::is_symlink(path, error) && !fs::exists(path, error);  // a link to what is yet to be written
  fs::path place = fs::weakly_canonical(fs::absolute(dangles ? target_of(path) : path, error), error);
  if (place.has_relative_path() && !place.has_filename()) place = place.parent_path();  // of a folder: out/
  return place.empty() ? path : place.string();
}

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code unknown;  // one that is not there is no other's
  return place_of(a) == place_of(b) || std::filesystem::equivalent(a, b, unknown);
}

}  // namespace ajar
