#include "planning.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace ajar {
namespace {

double cheapest(const Plan& plan) {
  double least = infinity;
  for (const Trial& t : plan.trials) least = std::min(least, t.price());
  return least;
}

std::string cell(double x, int digits) { return x < infinity ? fmt::format("{:.{}g}", x, digits) : "-"; }

}  // namespace

std::string describe(const Plan& plan) {
  std::string out;
  if (!plan.trials.empty()) {
    out += fmt::format("pilot at {}x{}, {:.1f} s ({:.1f} s of CPU)\n", plan.width, plan.height, plan.seconds,
                       plan.cpu_seconds);
    out += fmt::format("  {:<12} {:>6} {:>10} {:>14} {:>8} {:>22}\n", "integrator", "passes", "us/sample",
                       "relMSE/sample", "+-", "time to equal error");
    for (const Trial& t : plan.trials)
      out += fmt::format("  {:<12} {:>6} {:>10.2f} {:>14} {:>8} {:>22}\n", t.integrator, t.passes, t.cost,
                         cell(t.error + t.unseen, 3), t.price() < infinity ? cell(t.deviation, 2) : "-",
                         t.price() < infinity ? fmt::format("{:.2f}", t.price() / cheapest(plan)) : "-");
    if (!(cheapest(plan) < infinity))
      out += "  no trial saw any light: it is hard to find, or none comes to the camera within --max-depth\n";
  }
  out += fmt::format("  {:<16} {:<4} {}\n", "part", "on", "why");
  for (const Part& p : plan.parts) out += fmt::format("  {:<16} {:<4} {}\n", p.name, p.on ? "yes" : "no", p.why);
  return out + fmt::format("render with {}\n", plan.integrator);
}

nlohmann::ordered_json to_json(const Plan& plan) {
  const auto number_or_null = [](double x) { return x < infinity ? nlohmann::ordered_json(x) : nullptr; };
  nlohmann::ordered_json trials = nlohmann::ordered_json::array(), parts = nlohmann::ordered_json::array();
  for (const Trial& t : plan.trials)
    trials.push_back({{"integrator", t.integrator},
                      {"passes", t.passes},
                      {"microseconds", t.cost},
                      {"relmse_per_sample", number_or_null(t.error)},
                      {"deviation", t.deviation},
                      {"unseen", t.unseen},
                      {"waste", number_or_null(t.waste)},
                      {"time_to_equal_error", number_or_null(t.price() / cheapest(plan))}});
  for (const Part& p : plan.parts) parts.push_back({{"part", p.name}, {"on", p.on}, {"why", p.why}});
  return {{"integrator", plan.integrator},   {"width", plan.width}, {"height", plan.height}, {"seconds", plan.seconds},
          {"cpu_seconds", plan.cpu_seconds}, {"trials", trials},    {"parts", parts}};
}

}  // namespace ajar
