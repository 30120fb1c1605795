// Enters: finished runs as JSON.
// Leaves: what is said of them together: summaries, verdicts, the machine.
#pragma once

#include <nlohmann/json.hpp>

#include "ajar/report/statistics.h"
#include "ajar/report/suite.h"

namespace ajar {

/// Whether all is there that the functions below and the report ask of a run.
bool is_run(const nlohmann::ordered_json& run);
/// Error of one run against "seconds", "cpu_seconds" or "spp".
Curve curve_of(const nlohmann::ordered_json& run, const std::string& metric, const char* against);

/// "summary" and "verdict" of a method: runs and the baseline's runs are paired by seed. Errors are compared at equal
/// values of what the budget is in; time is CPU time, except for a budget in wall seconds.
void summarise(nlohmann::ordered_json& method, const nlohmann::ordered_json& baseline_runs, bool is_baseline,
               const Budget& budget);

nlohmann::ordered_json machine_json(int threads);
/// Now, UTC, "2026-11-21T12:00:00Z".
std::string date_text();

}  // namespace ajar
