#include "results.h"

#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>

#include "ajar/core/parallel.h"
#include "ajar/report/bench.h"

namespace ajar {
namespace {

using Json = nlohmann::ordered_json;

const char* const metric_names[] = {"relmse", "mse", "relmse_trimmed", "mape"};

Json json_of(const std::optional<Spread>& s) {
  if (!s) return nullptr;
  return {{"median", s->median}, {"low", s->low}, {"high", s->high}};
}

/// The same with the key that ratios have. Infinities are no JSON.
Json value_json(const std::optional<Spread>& s) {
  if (!s) return nullptr;
  const auto finite = [](double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); };
  return {{"value", finite(s->median)}, {"low", finite(s->low)}, {"high", finite(s->high)}};
}

bool has_numbers(const Json& object, std::initializer_list<const char*> keys) {
  return object.is_object() && std::all_of(keys.begin(), keys.end(), [&](const char* key) {
           return object.contains(key) && object[key].is_number();
         });
}

const Json* run_of_seed(const Json& runs, const Json& seed) {
  for (const Json& run : runs)
    if (run["seed"] == seed) return &run;
  return nullptr;
}

std::vector<double> last_values(const Json& runs, const char* metric) {
  std::vector<double> values;
  for (const Json& run : runs)
    if (!run["samples"].empty()) values.push_back(run["samples"].back()[metric].get<double>());
  return values;
}

/// What errors are drawn against: the budget's kind, and time.
struct Axes {
  const char *budget, *time;
};

struct Ratios {
  std::vector<double> error, time;
  bool bound = false;
};

Ratios ratios(const Json& runs, const Json& baseline_runs, const char* metric, const Axes& axes) {
  Ratios r;
  for (const Json& run : runs) {
    const Json* other = run_of_seed(baseline_runs, run["seed"]);
    if (!other) continue;
    const auto both = [&](const char* against, auto ratio_of) {
      return ratio_of(curve_of(run, metric, against), curve_of(*other, metric, against));
    };
    if (const auto ratio = both(axes.budget, error_ratio)) r.error.push_back(*ratio);
    if (const auto ratio = both(axes.time, time_ratio)) r.time.push_back(ratio->value), r.bound |= ratio->bound;
  }
  return r;
}

Json error_summary(const Json& runs, const Json& baseline_runs, const char* metric, const Axes& axes) {
  Json summary = json_of(spread(last_values(runs, metric)));
  if (summary.is_null()) return nullptr;
  std::vector<double> slopes;
  for (const Json& run : runs)
    if (const auto slope = fitted_slope(curve_of(run, metric, axes.time))) slopes.push_back(*slope);
  const Ratios r = ratios(runs, baseline_runs, metric, axes);
  summary["slope"] = value_json(spread(slopes));
  summary["time_ratio"] = value_json(spread(r.time));
  if (r.bound) summary["time_ratio"]["bound"] = true;
  summary["error_ratio"] = value_json(spread(r.error));
  return summary;
}

std::string first_value(const char* path, const char* key) {
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(key) && line.find(": ") != std::string::npos) return line.substr(line.find(": ") + 2);
  return "unknown";
}

/// "0.0123 [0.0110, 0.0131]".
std::string shown(const Json& s, const char* key, const char* absent = "-") {
  if (s.is_null() || s[key].is_null()) return absent;
  const auto end = [](const Json& x) {
    return x.is_null() ? std::string("inf") : fmt::format("{:.3g}", x.get<double>());
  };
  return fmt::format("{:.3g} [{}, {}]", s[key].get<double>(), end(s["low"]), end(s["high"]));
}

/// A line for a scene whose reference is too noisy for what is measured against it, or may be; else nothing.
std::string warning(const Json& scene) {
  if (scene["reference"].is_null()) return {};
  if (scene["reference"]["relmse"].is_null())
    return fmt::format("{}: the noise of the reference is unknown; no record of a render beside its image tells it\n",
                       scene["name"].get<std::string>());
  double least = infinity;
  for (const Json& method : scene["methods"])
    if (const Json& relmse = method["summary"]["relmse"]; !relmse.is_null())
      least = std::min(least, relmse["median"].get<double>());
  const double own = scene["reference"]["relmse"].get<double>();
  if (own <= 0.1 * least) return {};
  return fmt::format("{}: the reference's own relMSE is about {:.2g}, {:.0f} % of the smallest here; make it longer\n",
                     scene["name"].get<std::string>(), own, 100 * own / least);
}

std::string median_of(const Json& runs, const std::function<double(const Json&)>& value) {
  std::vector<double> values;
  for (const Json& run : runs) values.push_back(value(run));
  const auto s = spread(values);
  return s ? fmt::format("{:.4g}", s->median) : "-";
}

/// Camera paths, those of lessons among them, whose time counts too; where there are none, samples in the image.
double samples_of(const Json& run, double pixels) {
  const Json edges = run.contains("mean_path_edges") ? run["mean_path_edges"]["camera"] : Json();
  if (!edges.is_number() || !(edges.get<double>() > 0)) return run["spp"].get<double>() * pixels;
  return run["rays"]["camera"].get<double>() / edges.get<double>();
}

std::vector<std::string> row_of(const Json& scene, const Json& method) {
  const double pixels = scene["width"].get<double>() * scene["height"].get<double>();
  const Json& relmse = method["summary"]["relmse"];
  const auto part = [&](const char* key) { return relmse.is_null() ? Json() : relmse[key]; };
  const bool bound = !part("time_ratio").is_null() && part("time_ratio").contains("bound");
  return {scene["name"],
          method["name"],
          shown(relmse, "median"),
          shown(part("error_ratio"), "value"),
          shown(part("time_ratio"), "value") + (bound ? " *" : ""),
          shown(part("slope"), "value"),
          median_of(method["runs"], [](const Json& r) { return r["spp"].get<double>(); }),
          median_of(method["runs"],
                    [&](const Json& r) { return 1e6 * r["cpu_seconds"].get<double>() / samples_of(r, pixels); }),
          method["verdict"].is_null() ? "-" : method["verdict"].get<std::string>()};
}

/// Lines of columns as wide as their widest cell, numbers to the right. The last cell of a row may be longer.
std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  std::vector<size_t> widths(rows[0].size(), 0);
  for (const auto& row : rows)
    for (size_t i = 0; i + 1 < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  std::string out;
  for (const auto& row : rows) {
    for (size_t i = 0; i + 1 < row.size(); ++i)
      out += i == 6 || i == 7 ? fmt::format("{:>{}}  ", row[i], widths[i]) : fmt::format("{:<{}}  ", row[i], widths[i]);
    out += row.back() + "\n";
  }
  return out;
}

}  // namespace

bool is_run(const Json& run) {
  if (!has_numbers(run,
                   {"seed", "spp", "seconds", "cpu_seconds", "rejected_values", "field_bytes", "memory_peak_bytes"}))
    return false;
  for (const char* key : {"samples", "strategies"})
    if (!run.contains(key) || !run[key].is_array()) return false;
  for (const char* key : {"phases_cpu", "rays", "tracing", "mean_path_edges"})
    if (!run.contains(key) || !run[key].is_object()) return false;
  return std::all_of(run["samples"].begin(), run["samples"].end(), [](const Json& sample) {
    return sample.contains("estimated_relmse") &&
           has_numbers(sample, {"seconds", "cpu_seconds", "spp", "mse", "relmse", "relmse_trimmed", "mape", "ssim"});
  });
}

Curve curve_of(const Json& run, const std::string& metric, const char* against) {
  Curve curve;
  for (const Json& s : run["samples"])
    curve.push_back({s[against].get<double>(), s[metric].get<double>(), s["spp"].get<double>()});
  return curve;
}

void summarise(Json& method, const Json& baseline_runs, bool is_baseline, const Budget& budget) {
  const Json& runs = method["runs"];
  const Axes axes{budget.spp > 0       ? "spp"
                  : budget.seconds > 0 ? "seconds"
                                       : "cpu_seconds",
                  budget.seconds > 0 ? "seconds" : "cpu_seconds"};
  Json summary;
  for (const char* metric : metric_names) summary[metric] = error_summary(runs, baseline_runs, metric, axes);
  summary["ssim"] = json_of(spread(last_values(runs, "ssim")));
  method["summary"] = summary;
  const std::vector<double> seeds = ratios(runs, baseline_runs, "relmse", axes).error;
  method["verdict"] = is_baseline ? Json("baseline") : seeds.empty() ? Json(nullptr) : Json(verdict(seeds));
}

Json machine_json(int threads) {
  utsname name{};
  uname(&name);
  const double memory = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE));
#ifdef __clang__
  const std::string compiler = "clang " __clang_version__;
#else
  const std::string compiler = "g++ " __VERSION__;
#endif
  return {{"cpu", first_value("/proc/cpuinfo", "model name")},
          {"threads", threads > 0 ? threads : processor_count()},
          {"memory_bytes", memory},
          {"system", fmt::format("{} {} {}", name.sysname, name.release, name.machine)},
          {"compiler", compiler}};
}

std::string date_text() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char buffer[32];
  std::strftime(buffer, sizeof buffer, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return buffer;
}

std::string results_csv(const Json& results) {
  std::string csv = "scene,method,seed,seconds,cpu_seconds,spp,mse,relmse,relmse_trimmed,mape,ssim,estimated_relmse\n";
  for (const Json& scene : results["scenes"])
    for (const Json& method : scene["methods"])
      for (const Json& run : method["runs"])
        for (const Json& s : run["samples"]) {
          csv += fmt::format("{},{},{}", scene["name"].get<std::string>(), method["name"].get<std::string>(),
                             run["seed"].get<uint64_t>());
          for (const char* key :
               {"seconds", "cpu_seconds", "spp", "mse", "relmse", "relmse_trimmed", "mape", "ssim", "estimated_relmse"})
            csv += s[key].is_null() ? "," : fmt::format(",{}", s[key].get<double>());
          csv += "\n";
        }
  return csv;
}

std::string results_table(const Json& results) {
  std::vector<std::vector<std::string>> rows = {
      {"scene", "method", "relMSE", "error ratio", "time ratio", "slope", "spp", "us/spl", "verdict"}};
  for (const Json& scene : results["scenes"]) {
    const std::string name = scene["name"];
    if (!scene["skipped"].is_null()) rows.push_back({name, "left out: " + scene["skipped"].get<std::string>()});
    for (const Json& method : scene["methods"]) rows.push_back(row_of(scene, method));
  }
  std::string table = aligned(rows);
  for (const Json& scene : results["scenes"]) table += warning(scene);
  return table + fmt::format(
                     "medians over seeds [low, high]; ratios to {}, above 1 is better; us/spl: microseconds of CPU per "
                     "sample; *: at least that far from 1\n",
                     results["baseline"].get<std::string>());
}

}  // namespace ajar
