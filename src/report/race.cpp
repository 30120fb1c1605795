#include "race.h"

#include <cmath>

#include "ajar/report/account.h"
#include "ajar/report/metrics.h"

namespace ajar {
namespace {

using Json = nlohmann::ordered_json;

Json measure(const RenderState& state, const Picture& reference) {
  const Metrics m = compare(develop(state.film), reference, false);
  const double estimated = estimated_error(state.film);
  return {{"seconds", state.stats.seconds},
          {"cpu_seconds", state.stats.cpu_seconds},
          {"spp", spp_of(state.film)},
          {"mse", m.mse},
          {"relmse", m.relmse},
          {"relmse_trimmed", m.relmse_trimmed},
          {"mape", m.mape},
          {"ssim", m.ssim},
          {"estimated_relmse", estimated < infinity ? Json(estimated) : Json(nullptr)}};
}

void advance(const LoadedScene& loaded, const Budget& to, const Picture& reference, Racer& racer,
             const Monitor& monitor) {
  const double spp = spp_of(racer.state.film);
  render(*loaded.scene, *loaded.accel, with_budget(racer.options, to), racer.state, monitor);
  if (spp_of(racer.state.film) != spp) racer.samples.push_back(measure(racer.state, reference));
}

}  // namespace

Racer make_racer(const Method& method, const LoadedScene& loaded, uint64_t seed, int threads) {
  Racer racer{&method, method.options, {}};
  racer.options.seed = seed;
  racer.options.threads = threads;
  racer.options.max_depth = loaded.scene->hints.max_depth;
  racer.state = start_render(*loaded.scene, racer.options);
  return racer;
}

std::vector<double> make_targets(const Budget& budget) {
  const bool count = budget.spp > 0;
  const double all = count ? budget.spp : budget.cpu_seconds + budget.seconds;
  std::vector<double> targets;
  for (int i = -15; i <= 0; ++i) {
    double target = all * std::pow(10, i / 5.0);
    if (count) target = std::max(std::round(target), 1.0);
    if (targets.empty() || target > targets.back()) targets.push_back(target);
  }
  return targets;
}

Budget with_amount(const Budget& budget, double amount) {
  Budget b;
  if (budget.spp > 0)
    b.spp = uint32_t(amount);
  else
    (budget.cpu_seconds > 0 ? b.cpu_seconds : b.seconds) = amount;
  return b;
}

double share_done(const Budget& budget, const RenderState& state) {
  if (budget.spp > 0) return spp_of(state.film) / budget.spp;
  return budget.cpu_seconds > 0 ? state.stats.cpu_seconds / budget.cpu_seconds : state.stats.seconds / budget.seconds;
}

bool race(const LoadedScene& loaded, const Budget& budget, const Picture& reference, size_t turn,
          std::vector<Racer>& racers, const RaceWatch& watch) {
  const std::vector<double> targets = make_targets(budget);
  bool stopped = false;
  for (size_t i = 0; i < targets.size(); ++i)
    for (size_t k = 0; k < racers.size(); ++k) {
      Racer& racer = racers[(k + i + turn) % racers.size()];
      advance(loaded, with_amount(budget, targets[i]), reference, racer,
              [&](const RenderState&) { return !(stopped = !watch(racer)); });
      if (stopped) return false;
    }
  return true;
}

Json run_json(const Racer& racer) {
  const RenderStats& stats = racer.state.stats;
  const Counters& n = stats.counters;
  Json run = {{"seed", racer.options.seed},
              {"spp", spp_of(racer.state.film)},
              {"seconds", stats.seconds},
              {"cpu_seconds", stats.cpu_seconds},
              {"samples", racer.samples},
              {"phases_cpu", phases_json(stats.cpu_seconds, stats.learn_cpu_seconds, stats.ticks)},
              {"rays", {{"camera", n.camera_rays}, {"light", n.light_rays}, {"shadow", n.shadow_rays}}},
              {"rejected_values", stats.rejected},
              {"field_bytes", bytes(racer.state.learning.fields)},
              {"memory_peak_bytes", peak_bytes()}};
  add_account(run, racer.state);
  return run;
}

}  // namespace ajar
