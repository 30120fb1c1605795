#include "ajar/report/account.h"

#include <sys/resource.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace ajar {
namespace {

using Json = nlohmann::ordered_json;

double per(double amount, double of) { return of != 0 ? amount / of : 0; }

Json strategies_json(const Ledger& ledger) {
  const double energy = total_energy(ledger), ticks = double(total_ticks(ledger));
  Json list = Json::array();
  for (int s = 0; s <= Ledger::most; ++s)
    for (int t = 1; t <= Ledger::most; ++t) {
      const StrategyCost& c = ledger.strategies[s][t];
      if (c.joins == 0) continue;
      list.push_back({{"s", s},
                      {"t", t},
                      {"joins", c.joins},
                      {"rays", c.rays},
                      {"visible", c.visible},
                      {"energy", per(c.energy, energy)},
                      {"time", per(double(c.ticks), ticks)}});
    }
  return list;
}

// Merges of (s, t), the vertex that they share counted on both sides; their time by t alone.
Json merges_json(const Ledger& ledger) {
  const double energy = total_energy(ledger), ticks = double(total_ticks(ledger));
  Json list = Json::array();
  for (int t = 2; t <= Ledger::most; ++t) {
    const double time = per(double(ledger.merges[0][t].ticks), ticks);
    for (int s = 2; s <= Ledger::most; ++s) {
      const StrategyCost& c = ledger.merges[s][t];
      if (c.joins > 0) list.push_back({{"s", s}, {"t", t}, {"merges", c.joins}, {"energy", per(c.energy, energy)}});
    }
    if (time > 0) list.push_back({{"t", t}, {"time", time}});
  }
  return list;
}

Json tracing_json(const Ledger& l) {
  const double ticks = double(total_ticks(l));
  return {{"camera", per(double(l.camera_ticks), ticks)},
          {"light", per(double(l.light_ticks), ticks)},
          {"joins", per(double(join_ticks(l)), ticks)},
          {"learn", per(double(l.learn_ticks), ticks)}};
}

Json lights_json(const LearnedLights& v) {
  const auto rare = std::count_if(v.cuts.begin(), v.cuts.end(), [](const LightCut& c) { return c.asks < 1; });
  return {{"entries", v.entries.size()}, {"bytes", bytes(v)}, {"rare", per(double(rare), double(v.cuts.size()))}};
}

Json fields_json(const Learning& learning, const Film& film) {
  const Fields& f = learning.fields;
  return {{"structure", structure_names[size_t(f.structure)]},
          {"bytes", bytes(f)},
          {"cells", f.cells.size()},
          {"nodes", {{"q", f.q.nodes.size()}, {"w", f.w.nodes.size()}}},
          {"generation", f.generation},
          {"lights", lights_json(f.lights)},
          {"dropped_passes", dropped_passes(learning, film)}};
}

}  // namespace

Json phases_json(double seconds, double between_passes, const TimedTicks& ticks) {
  const double traced = seconds - between_passes;
  const double learn = traced * per(double(ticks.learn), double(ticks.all));
  return {{"trace", traced - learn}, {"learn", learn}, {"rebuild", between_passes}};
}

void add_account(Json& record, const RenderState& state) {
  const Counters& n = state.stats.counters;
  record["mean_path_edges"] = {{"camera", per(double(n.camera_rays), double(n.camera_paths))},
                               {"light", per(double(n.light_rays), double(n.light_paths))}};
  record["light_subpaths_per_sample"] = per(double(n.light_paths), double(n.camera_paths));
  if (state.adaptive.passes > 0) record["camera_samples_of_a_pass"] = samples_of_pass(state.film, state.adaptive);
  record["goes_on"] = state.balance.goes_on;
  record["zero_contribution_paths"] = per(double(n.zero_paths), double(n.camera_paths));
  record["tracing"] = tracing_json(state.stats.ledger);
  if (!state.learning.fields.table.slots.empty()) record["fields"] = fields_json(state.learning, state.film);
  record["strategies"] = strategies_json(state.stats.ledger);
  record["caustics"] = per(state.stats.ledger.caustics, total_energy(state.stats.ledger));
  if (const Json merges = merges_json(state.stats.ledger); !merges.empty()) record["merges"] = merges;
}

double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) * 1024;
}

}  // namespace ajar
