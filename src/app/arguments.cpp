#include "arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>

#include "ajar/core/error.h"

namespace ajar {

void set_size(Camera& camera, const std::string& text) {
  int w = 0, h = 0, end = 0;
  if (std::sscanf(text.c_str(), "%dx%d%n", &w, &h, &end) != 2 || size_t(end) != text.size() || w < 1 || h < 1 ||
      w > 65536 || h > 65536)
    throw Error(fmt::format("--size {}: write WIDTHxHEIGHT, each 1 to 65536", text));
  set_size(camera, w, h);
}

LoadOptions load_options(const std::vector<std::string>& defines, bool lenient) {
  LoadOptions o;
  o.lenient = lenient;
  for (const std::string& d : defines) {
    const size_t equals = d.find('=');
    if (equals == 0 || equals == std::string::npos) throw Error(fmt::format("-D {}: write -D name=value", d));
    o.defines[d.substr(0, equals)] = d.substr(equals + 1);
  }
  return o;
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
  size_t used = 0;
  double value = -1;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
  }
  const std::string unit = value >= 0 ? text.substr(used) : "";
  const double factor = unit.empty() || unit == "s" ? 1 : unit == "m" || unit == "min" ? 60 : unit == "h" ? 3600 : 0;
  if (!(value > 0) || factor == 0 || !std::isfinite(value))
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

void check_writable(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  if (!std::filesystem::is_directory(folder))
    throw Error(fmt::format("{}: no such folder; make it first", folder.string()));
}

void check_file(const std::string& path) {
  check_writable(path);
  if (std::filesystem::is_directory(path)) throw Error(fmt::format("{}: is a folder; name a file in it", path));
}

}  // namespace ajar
