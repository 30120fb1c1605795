#include "summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "ajar/report/account.h"
#include "ajar/report/json.h"
#include "planning.h"
#include "version.h"

namespace ajar {
namespace {

double per(double amount, double of) { return of > 0 ? amount / of : 0; }

nlohmann::ordered_json options_json(const Run& run, const Film& film) {
  const RenderOptions& o = run.options;
  nlohmann::ordered_json j = {{"integrator", o.integrator},
                              {"spp", o.spp},
                              {"seconds", o.seconds},
                              {"cpu_seconds", o.cpu_seconds},
                              {"noise", o.noise},
                              {"seed", o.seed},
                              {"threads", run.threads},
                              {"width", film.width},
                              {"height", film.height},
                              {"crop_x", film.x0},
                              {"crop_y", film.y0},
                              {"max_depth", o.max_depth},
                              {"roulette_depth", o.roulette_depth},
                              {"heuristic", heuristic_names[size_t(o.heuristic)]},
                              {"sampler", sampler_names[size_t(o.sampler)]},
                              {"next_event", o.next_event},
                              {"defines", run.defines}};
  if (run.at) j["at"] = *run.at;
  if (run.lenient) j["lenient"] = true;
  j["light_choice"] = run.light_choice;
  if (o.learn_lights) j["field_memory"] = o.learn.memory;
  if (is_merging(o.integrator)) j["merge_radius"] = o.merge_radius;
  if (o.even) j["even"] = true;
  if (o.limit_fireflies) j["limit_fireflies"] = true;
  if (o.final_gather > 0) j["final_gather"] = o.final_gather;
  if (!is_guided(o.integrator)) return j;
  j["leaves_out"] = may_leave_out(o);
  j["guide"] = guided_names[size_t(learn_options(o).guided)];
  j["field_memory"] = o.learn.memory;
  j["field_structure"] = structure_names[size_t(o.learn.structure)];
  j["field_rule"] = rule_names[size_t(o.learn.rule)];
  j["field_rate"] = o.learn.forget == 1 ? "visits" : "recent";
  j["train"] = o.learn.train;
  if (run.taught) j["teach"] = run.taught->teach;
  if (run.taught && run.taught->coherence.fields) j["forget"] = run.taught->forget;
  if (!run.load_fields.empty()) j["load_fields"] = run.load_fields;
  if (!run.save_fields.empty()) j["save_fields"] = run.save_fields;
  return j;
}

// Loading, building, logs and checkpoints, and writing around the render's own phases.
nlohmann::ordered_json phases_of(double load, double build, nlohmann::ordered_json render, double beside,
                                 double write) {
  nlohmann::ordered_json j = {{"load", load}, {"build", build}};
  j.update(render);
  j["beside"] = beside, j["write"] = write;
  return j;
}

}  // namespace

std::string record_of(const nlohmann::ordered_json& summary) { return text_of(summary, 2) + "\n"; }

RenderOptions without_start(RenderOptions options, const Run& run) {
  if (options.seconds > 0) options.seconds = std::max(options.seconds - run.build_seconds, 1e-3);
  if (options.cpu_seconds > 0) options.cpu_seconds = std::max(options.cpu_seconds - run.build_cpu, 1e-3);
  return options;
}

nlohmann::ordered_json summary(const Run& run, const RenderState& state) {
  const Counters& n = state.stats.counters;
  const double rays = double(n.camera_rays + n.light_rays + n.shadow_rays);
  const ErrorEstimate error = estimate_error(state.film);
  nlohmann::ordered_json j;
  j["version"] = version;
  j["scene"] = run.scene_path;
  j["image"] = run.out_path;
  j["options"] = options_json(run, state.film);
  j["spp"] = spp_of(state.film);
  j["interrupted"] = run.interrupted;
  const RenderStats& stats = state.stats;
  j["seconds"] =
      phases_of(run.load_seconds, run.build_seconds, phases_json(stats.seconds, stats.learn_seconds, stats.ticks),
                run.beside_seconds, run.write_seconds);
  j["cpu_seconds"] =
      phases_of(run.load_cpu, run.build_cpu, phases_json(stats.cpu_seconds, stats.learn_cpu_seconds, stats.ticks),
                run.beside_cpu, run.write_cpu);
  j["triangles"] = run.triangles;
  j["rays"] = {{"camera", n.camera_rays}, {"light", n.light_rays}, {"shadow", n.shadow_rays}};
  j["rays_per_second"] = per(rays, state.stats.seconds);
  j["rays_per_cpu_second"] = per(rays, state.stats.cpu_seconds);
  j["samples_per_cpu_second"] = per(double(n.camera_paths), state.stats.cpu_seconds);
  j["rejected_values"] = state.stats.rejected;
  j["replay_rejected"] = state.stats.replay;
  j["memory_peak_bytes"] = peak_bytes();
  j["accel_bytes"] = run.accel_bytes;
  if (error.relmse < infinity) {
    j["estimated_relmse"] = error.relmse;
    j["estimated_relmse_trimmed"] = error.relmse_trimmed;
  }
  if (run.options.noise > 0)
    j["noise"] = {{"target", run.options.noise}, {"reached", error.relmse <= run.options.noise}};
  if (run.planned) j["plan"] = to_json(run.plan);
  if (const Plain& p = state.plain; p.passes > 0 || p.merged > 0)
    j["path_tracing"] = {{"took_over", p.taken},
                         {"after_passes", p.passes},
                         {"error_after_equal_time", p.ratio},
                         {"returned_passes", p.returned},
                         {"merged_passes", p.merged}};
  if (!run.versus.integrator.empty()) j["versus"] = to_json(run.versus, state);
  add_account(j, state);
  return j;
}

Metadata metadata(const Run& run, const RenderState& state) {
  return {{"ajar:version", std::string(version)},
          {"ajar:scene", run.scene_path},
          {"ajar:options", text_of(options_json(run, state.film), -1)},
          {"ajar:seed", fmt::to_string(run.options.seed)},
          {"ajar:spp", spp_of(state.film)},
          {"ajar:seconds", state.stats.seconds},
          {"ajar:cpu_seconds", state.stats.cpu_seconds}};
}

std::string checkpoint_key(const Run& run, const Film& film) {
  nlohmann::ordered_json o = options_json(run, film);
  for (const char* budget :
       {"spp", "seconds", "cpu_seconds", "noise", "threads", "leaves_out", "load_fields", "save_fields"})
    o.erase(budget);
  std::sort(o["defines"].begin(), o["defines"].end());
  return fmt::format("{},{},files with checksum {:016x},{}", version,
                     std::filesystem::path(run.scene_path).filename().string(), run.content, text_of(o, -1));
}

std::string integrator_of(const std::string& checkpoint_key) {
  const size_t sum = checkpoint_key.find(",files with checksum ");
  const size_t options = checkpoint_key.find('{', std::min(sum, checkpoint_key.size()));
  if (options == checkpoint_key.npos) return {};
  const auto json = nlohmann::json::parse(checkpoint_key.substr(options), nullptr, false);
  return json.is_object() && json.contains("integrator") && json["integrator"].is_string() ? json["integrator"] : "";
}

}  // namespace ajar
