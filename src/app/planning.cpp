#include "planning.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace ajar {
namespace {

using Json = nlohmann::ordered_json;

std::string describe(const Pilot& p) {
  std::string out = fmt::format("pilot at {}x{}, {:.1f} s of CPU\n", p.width, p.height, p.cpu_seconds);
  if (p.passes == 0)
    return out + "  no light was seen: it is hard to find, or none comes to the camera within --max-depth\n";
  out += fmt::format("  {:<12} {:>20} {:>20} {:>18}\n", "", "samples in its time", "relMSE of a sample",
                     "error, equal time");
  out += fmt::format("  {:<12} {:>20.3g} {:>20.3g} {:>18.3g}\n", "guided-bdpt", 1.0, p.guided, 1.0);
  out += fmt::format("  {:<12} {:>20.3g} {:>20.3g} {:>18.3g}\n", "path", p.path_for_one, p.path, p.ratio);
  if (p.saved_seconds() > 0)
    out += fmt::format("  {} saves {} {:.0f} s of CPU to equal error against {}\n",
                       p.ratio < 1 ? "path" : "guided-bdpt", p.saves_more() ? "more than" : "some", p.saved_seconds(),
                       p.ratio < 1 ? "guided-bdpt" : "path");
  return out;
}

Json to_json(const Pilot& p) {
  return {{"width", p.width},
          {"height", p.height},
          {"cpu_seconds", p.cpu_seconds},
          {"passes", p.passes},
          {"error_after_equal_time", p.ratio},
          {"path_tracing_takes_over", p.plain},
          {"settled", p.settled},
          {"guided_relmse_per_sample", p.guided},
          {"path_relmse_per_sample", p.path},
          {"path_samples_for_one", p.path_for_one},
          {"saved_cpu_seconds", p.saved_seconds()}};
}

}  // namespace

std::string describe(const Plan& plan) {
  std::string out = plan.pilot ? describe(*plan.pilot) : "";
  out += fmt::format("  {:<16} {:<4} {}\n", "part", "on", "why");
  for (const Part& p : plan.parts) out += fmt::format("  {:<16} {:<4} {}\n", p.name, p.on ? "yes" : "no", p.why);
  const bool plain = plan.pilot && plan.pilot->plain;
  return out +
         fmt::format("render with {}{}\n", plan.integrator, plain ? ", which leaves this scene to path tracing" : "");
}

nlohmann::ordered_json to_json(const Plan& plan) {
  Json parts = Json::array();
  for (const Part& p : plan.parts) parts.push_back({{"part", p.name}, {"on", p.on}, {"why", p.why}});
  Json out = {{"integrator", plan.integrator}};
  if (plan.pilot) out["pilot"] = to_json(*plan.pilot);
  out["parts"] = parts;
  return out;
}

}  // namespace ajar
