// Enters: a scene, a reference, methods at their start.
// Leaves: each method's error at log-spaced times, the methods having gone on in turns.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "reference.h"

namespace ajar {

/// One method with one seed on its way.
struct Racer {
  const Method* method = nullptr;
  RenderOptions options;
  RenderState state;
  nlohmann::ordered_json samples = nlohmann::ordered_json::array();
};
Racer make_racer(const Method& method, const LoadedScene& loaded, uint64_t seed, int threads);

/// Times, or samples per pixel, at which errors are measured: five a decade, over three decades up to the budget.
std::vector<double> make_targets(const Budget& budget);
/// The same kind of budget with another amount.
Budget with_amount(const Budget& budget, double amount);
/// Of the budget that is used up; in [0,1] but for the last pass.
double share_done(const Budget& budget, const RenderState& state);

/// Returns false to stop; sees who is at work, off the clock.
using RaceWatch = std::function<bool(const Racer&)>;
/// Lets all go on from target to target, each time another one first (turn: who begins), and measures them off the
/// clock. False when stopped.
bool race(const LoadedScene& loaded, const Budget& budget, const Picture& reference, size_t turn,
          std::vector<Racer>& racers, const RaceWatch& watch);

/// A run of results.json.
nlohmann::ordered_json run_json(const Racer& racer);

}  // namespace ajar
