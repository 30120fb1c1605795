#include "versus.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "ajar/core/error.h"
#include "progress.h"

namespace ajar {
namespace {

nlohmann::ordered_json number_or_null(double x) { return x < infinity ? nlohmann::ordered_json(x) : nullptr; }

// Of the trimmed errors: single fireflies, which half of a short render sees and half does not, leave it alone.
double ratio(const Versus& v, const RenderState& done) {
  return v.expected.relmse_trimmed / estimate_error(done.film).relmse_trimmed;
}

}  // namespace

void check_versus(const std::string& other, const std::string& integrator) {
  std::vector<std::string> fit = integrator_names();
  std::erase_if(fit,
                [&](const std::string& name) { return is_guided(name) || is_merging(name) || name == integrator; });
  if (std::find(fit.begin(), fit.end(), other) == fit.end())
    throw Error(fmt::format("--versus {}: cannot be held against {}; write one of {}", other, integrator,
                            fmt::join(fit, ", ")));
}

Versus run_versus(const Scene& scene, const Accel& accel, RenderOptions options, const std::string& other,
                  const RenderState& done, const Monitor& monitor) {
  const double part = versus_share / (1 - versus_share);
  const bool counts_cpu = options.cpu_seconds > 0;
  options.integrator = other;
  options.spp = 0, options.noise = 0;
  options.techniques = false;
  options.seconds = counts_cpu ? 0 : std::max(done.stats.seconds * part, 1e-3);
  options.cpu_seconds = counts_cpu ? std::max(done.stats.cpu_seconds * part, 1e-3) : 0;
  RenderState state = start_render(scene, options);
  render(scene, accel, options, state, monitor);
  Versus v{other, state.stats.seconds, state.stats.cpu_seconds, spp_of(state.film), estimate_error(state.film), {}};
  const double shorter = v.cpu_seconds / done.stats.cpu_seconds;
  v.expected = {v.error.relmse * shorter, v.error.relmse_trimmed * shorter};
  return v;
}

std::string describe(const Versus& v, const RenderState& done) {
  const double left = estimate_error(done.film).relmse_trimmed;
  std::string line = fmt::format("error left after {}: ", clock_text(done.stats.seconds));
  if (!(left < infinity)) return line + "cannot be known; that takes two passes, and light in them";
  line += fmt::format("relMSE ~ {:.3g} without the worst 0.1 %; ", left);
  if (!(v.expected.relmse_trimmed < infinity))
    return line + fmt::format("{} had too little time to tell its own", v.integrator);
  return line + fmt::format("{} would have left ~ {:.3g}, {:.2g} times as much (from {} of it)", v.integrator,
                            v.expected.relmse_trimmed, ratio(v, done), clock_text(v.seconds));
}

nlohmann::ordered_json to_json(const Versus& v, const RenderState& done) {
  const double times = ratio(v, done);
  return {{"integrator", v.integrator},
          {"seconds", v.seconds},
          {"cpu_seconds", v.cpu_seconds},
          {"spp", v.spp},
          {"estimated_relmse", number_or_null(v.error.relmse)},
          {"estimated_relmse_trimmed", number_or_null(v.error.relmse_trimmed)},
          {"expected_relmse", number_or_null(v.expected.relmse)},
          {"expected_relmse_trimmed", number_or_null(v.expected.relmse_trimmed)},
          {"error_ratio", std::isfinite(times) ? nlohmann::ordered_json(times) : nullptr}};
}

}  // namespace ajar
