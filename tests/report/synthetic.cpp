#include "synthetic.h"

#include <fmt/format.h>

#include <cmath>

#include "pictures.h"

namespace ajar::test {
namespace {

using nlohmann::json;

struct Kind {
  const char* name;
  double error, slope, seconds_per_spp, learn;  ///< relMSE after a second; exponent of time; share of CPU time learning
  const char* verdict;
};

constexpr Kind kinds[] = {{"bdpt", 0.40, -1.0, 0.11, 0, "baseline"},
                          {"path", 1.90, -0.9, 0.03, 0, "loss"},
                          {"guided-bdpt", 0.55, -1.35, 0.17, 0.12, "win"},
                          {"light", 0.43, -1.0, 0.04, 0, "tie"}};

/// In [-1, 1].
double noise(uint32_t a, uint32_t b) {
  uint32_t v = (a * 73856093u ^ b * 19349663u) * 2654435761u;
  v = (v ^ (v >> 15)) * 2246822519u;
  v ^= v >> 13;
  return v * 0x1p-31 - 1;
}

double error_at(const Kind& kind, double cpu, uint32_t seed, uint32_t step) {
  return kind.error * std::pow(cpu, kind.slope) * std::exp(0.18 * noise(seed, 99) + 0.05 * noise(seed + 7, step));
}

json sample(const Kind& kind, double cpu, uint32_t seed, uint32_t step) {
  const double error = error_at(kind, cpu, seed, step);
  return {{"seconds", cpu * 0.53},
          {"cpu_seconds", cpu},
          {"spp", std::ceil(cpu / kind.seconds_per_spp)},
          {"mse", error * 0.21},
          {"relmse", error},
          {"relmse_trimmed", error * 0.6},
          {"mape", 0.4 * std::sqrt(error)},
          {"ssim", 1 - 0.5 * error / (1 + error)},
          {"estimated_relmse", step == 0 ? json() : json(error * std::exp(0.25 * noise(seed + 3, step) - 0.05))}};
}

json strategies(double paths, bool light) {
  const auto row = [&](int s, int t, double rays, double energy, double time) -> json {
    return {{"s", s},           {"t", t},      {"joins", paths}, {"rays", rays}, {"visible", rays / 2},
            {"energy", energy}, {"time", time}};
  };
  json list = {row(0, 2, 0, 0.4, 0.1), row(1, 2, 1.5 * paths, 0.6, 0.2)};
  if (light) list.push_back(row(8, 1, paths, 0, 0.3));
  return list;
}

json run(const Kind& kind, uint32_t seed, double cpu) {
  json samples = json::array();
  uint32_t step = 0;
  for (double t = 0.3 + 0.05 * seed; t < cpu; t *= 1.25) samples.push_back(sample(kind, t, seed, step++));
  samples.push_back(sample(kind, cpu, seed, step));
  const double spp = std::ceil(cpu / kind.seconds_per_spp), paths = spp * synthetic_width * synthetic_height;
  const bool light = std::string(kind.name) != "path", camera = std::string(kind.name) != "light";
  return {{"seed", seed},
          {"spp", spp},
          {"seconds", cpu * 0.53},
          {"cpu_seconds", cpu},
          {"samples", samples},
          {"phases_cpu",
           {{"trace", cpu * (1 - kind.learn * 1.2)}, {"learn", cpu * kind.learn}, {"rebuild", cpu * kind.learn * 0.2}}},
          {"rays", {{"camera", camera ? paths * 4.1 : 0}, {"light", light ? paths * 3.7 : 0}, {"shadow", paths * 5.2}}},
          {"mean_path_edges", {{"camera", camera ? 4.1 : 0}, {"light", light ? 3.7 : 0}}},
          {"zero_contribution_paths", 0.31 + 0.1 * kind.slope * kind.slope * 0.4},
          {"tracing", {{"camera", 0.3}, {"light", light ? 0.3 : 0}, {"joins", light ? 0.3 : 0.6}, {"learn", 0.1}}},
          {"strategies", strategies(paths, light)},
          {"rejected_values", 0},
          {"field_bytes", kind.learn > 0 ? 48e6 : 0},
          {"memory_peak_bytes", 228e6}};
}

json figures(double median, double slope) {
  return {{"median", median},
          {"low", median * 0.86},
          {"high", median * 1.17},
          {"slope", {{"value", slope}, {"low", slope - 0.04}, {"high", slope + 0.03}}}};
}

json summary(const Kind& kind, double cpu) {
  const double error = kind.error * std::pow(cpu, kind.slope),
               ratio = kinds[0].error * std::pow(cpu, kinds[0].slope) / error;
  json relmse = figures(error, kind.slope);
  relmse["error_ratio"] = {{"value", ratio}, {"low", ratio * 0.9}, {"high", ratio * 1.12}};
  relmse["time_ratio"] = {
      {"value", std::pow(ratio, 0.9)}, {"low", std::pow(ratio, 0.9) * 0.9}, {"high", std::pow(ratio, 0.9) * 1.1}};
  return {{"relmse", relmse},
          {"mse", figures(error * 0.21, kind.slope)},
          {"relmse_trimmed", figures(error * 0.6, kind.slope)},
          {"mape", figures(0.4 * std::sqrt(error), kind.slope / 2)},
          {"ssim", {{"median", 1 - 0.5 * error / (1 + error)}, {"low", 0.9}, {"high", 0.99}}}};
}

std::string save(const std::filesystem::path& folder, const std::string& name, const Picture& picture) {
  std::filesystem::create_directories((folder / name).parent_path());
  write_exr((folder / name).string(), picture);
  return name;
}

json techniques(const std::filesystem::path& folder, const std::string& where) {
  json list = json::array();
  for (int k = 2; k <= 6; ++k)
    for (int s = 0; s < k; ++s) {
      const int t = k - s;
      Picture picture = pattern(synthetic_width, synthetic_height, 1);
      for (float& v : picture.pixels) v *= float((1 + s) * 0.5 / (k * k));
      const std::string name = fmt::format("techniques/{}/s{}t{}", where, s, t);
      list.push_back({{"s", s}, {"t", t}, {"weighted", save(folder, name + ".exr", picture)}, {"raw", nullptr}});
    }
  return list;
}

std::string field_picture(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / "fields");
  write_png((folder / "fields/q.png").string(), pattern(64, 64));
  return "fields/q.png";
}

json full_scene(const std::filesystem::path& folder, double cpu) {
  json methods = json::array();
  for (const Kind& kind : kinds) {
    const double error = kind.error * std::pow(cpu, kind.slope);
    const std::string image = fmt::format("images/room/{}.exr", kind.name);
    json method = {{"name", kind.name},
                   {"options", {{"integrator", kind.name}}},
                   {"image", save(folder, image, pattern(synthetic_width, synthetic_height, 6 * std::sqrt(error)))},
                   {"techniques", json::array()},
                   {"fields", json::array()},
                   {"runs", json::array()},
                   {"summary", summary(kind, cpu)},
                   {"verdict", kind.verdict}};
    for (uint32_t seed = 0; seed < 3; ++seed) method["runs"].push_back(run(kind, seed, cpu));
    if (kind.name == std::string("bdpt")) method["techniques"] = techniques(folder, "room/bdpt");
    if (kind.learn > 0) method["fields"].push_back({{"title", "Q at the door"}, {"image", field_picture(folder)}});
    methods.push_back(method);
  }
  return {{"name", "room"},
          {"file", "scenes/room/room.xml"},
          {"defines", {{"door", "5"}}},
          {"width", synthetic_width},
          {"height", synthetic_height},
          {"max_depth", 10},
          {"triangles", 12345},
          {"load_seconds", 0.12},
          {"build_seconds", 0.034},
          {"reference",
           {{"image", save(folder, "images/room/reference.exr", pattern(synthetic_width, synthetic_height))},
            {"relmse", 0.0021},
            {"made_by", {{"integrator", "bdpt"}, {"spp", 4096}}}}},
          {"skipped", nullptr},
          {"methods", methods}};
}

/// No reference, one seed, one method, nulls where they may be; and a value that is not a number in the image.
json bare_scene(const std::filesystem::path& folder, double cpu) {
  Picture broken = pattern(20, 30, 0.5);
  broken.pixels[0] = std::numeric_limits<float>::quiet_NaN();
  broken.pixels[4] = 123456;  // more than a half can hold
  json summary_of = {{"relmse", figures(0.02, -1)}};
  summary_of["relmse"]["slope"] = nullptr;
  json one = run(kinds[0], 0, cpu);
  for (json& s : one["samples"]) s["estimated_relmse"] = nullptr;
  return {{"name", "<b>&\"'</script><script>window.broken = 1</script>"},
          {"file", "<i>.xml"},
          {"defines", json::object()},
          {"width", 20},
          {"height", 30},
          {"max_depth", -1},
          {"triangles", 0},
          {"load_seconds", 0},
          {"build_seconds", 0},
          {"reference", {{"image", nullptr}, {"relmse", nullptr}}},
          {"skipped", nullptr},
          {"methods",
           {{{"name", "bdpt"},
             {"options", json::object()},
             {"image", save(folder, "images/odd <&\"/bdpt.exr", broken)},
             {"runs", {one}},
             {"summary", summary_of},
             {"verdict", "baseline"}}}}};
}

}  // namespace

json make_synthetic(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const double cpu = 30;
  return {{"format", 1},
          {"version", "0.1.0"},
          {"title", "Doors </title><b>& \"more\""},
          {"date", "2026-11-21T12:00:00Z"},
          {"machine",
           {{"cpu", "Some CPU at 3 GHz"},
            {"threads", 2},
            {"memory_bytes", 16e9},
            {"system", "Linux 6.1"},
            {"compiler", "g++ 12.2"}}},
          {"command", "ajar bench benchmarks/door.json -o door"},
          {"quick", false},
          {"budget", {{"cpu_seconds", cpu}}},
          {"seeds", {0, 1, 2}},
          {"baseline", "bdpt"},
          {"scenes",
           {full_scene(folder, cpu),
            bare_scene(folder, cpu),
            {{"name", "veach"}, {"skipped", "veach.xml is not there"}, {"methods", json::array()}}}}};
}

}  // namespace ajar::test
