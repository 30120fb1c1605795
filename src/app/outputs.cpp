#include "outputs.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "ajar/core/error.h"
#include "ajar/report/account.h"
#include "ajar/report/metrics.h"

namespace ajar {
namespace {

Picture append(Picture a, const Picture& b) {
  Picture out{a.width, a.height, a.names, {}};
  out.names.insert(out.names.end(), b.names.begin(), b.names.end());
  const size_t na = a.names.size(), nb = b.names.size();
  for (size_t i = 0; i < size_t(a.width) * size_t(a.height); ++i) {
    out.pixels.insert(out.pixels.end(), &a.pixels[i * na], &a.pixels[i * na] + na);
    out.pixels.insert(out.pixels.end(), &b.pixels[i * nb], &b.pixels[i * nb] + nb);
  }
  return out;
}

Picture with_features(const RenderArguments& a, const Scene& scene, const Accel& accel, const RenderState& state) {
  Picture out = develop(state.film);
  const std::map<std::string, std::vector<std::string>> groups = {{"albedo", {"Albedo.R", "Albedo.G", "Albedo.B"}},
                                                                  {"normal", {"N.X", "N.Y", "N.Z"}},
                                                                  {"position", {"P.X", "P.Y", "P.Z"}}};
  std::vector<std::string> wanted;
  bool with_variance = false;
  for (const std::string& f : a.features) {
    if (f == "variance")
      with_variance = true;
    else
      wanted.insert(wanted.end(), groups.at(f).begin(), groups.at(f).end());
  }
  if (!wanted.empty()) out = append(out, select(render_features(scene, accel, a.seed), wanted));
  if (with_variance) out = append(out, variance(state.film));
  return out;
}

}  // namespace

void Log::write(const RenderState& state, bool last) {
  if (!file.is_open() || (!last && state.stats.seconds < next) || state.film.passes == 0) return;
  next = std::max(next, state.stats.seconds) * 1.1;
  nlohmann::ordered_json j = {
      {"seconds", state.stats.seconds}, {"cpu_seconds", state.stats.cpu_seconds}, {"spp", state.film.passes}};
  if (const double error = estimated_error(state.film); error < infinity) j["estimated_relmse"] = error;
  if (reference) j["error"] = nlohmann::ordered_json::parse(to_json(compare(develop(state.film), *reference)));
  j["phases_cpu"] = phases_json(state.stats.cpu_seconds, state.stats.learn_cpu_seconds, state.stats.ledger);
  add_account(j, state);
  file << j.dump() << std::endl;
}

Log open_log(const RenderArguments& a, const Film& film) {
  Log log;
  if (!a.reference.empty()) {
    log.reference = select(read_picture(a.reference), {"R", "G", "B"});
    if (log.reference->width != film.width || log.reference->height != film.height)
      throw Error(fmt::format("--reference {}: is {}x{}, the render {}x{}; use --size", a.reference,
                              log.reference->width, log.reference->height, film.width, film.height));
  }
  if (a.log.empty()) return log;
  log.file.open(a.log);
  if (!log.file) throw Error(a.log + ": cannot write the log; is its folder there?");
  return log;
}

void write_record(const RenderArguments& a, const Run& run, const RenderState& state) {
  write_text(std::filesystem::path(a.out).replace_extension(".json").string(), summary(run, state).dump(2) + "\n");
}

void write_outputs(const RenderArguments& a, const Scene& scene, const Accel& accel, Run& run,
                   const RenderState& state) {
  const double wall = wall_seconds(), cpu = process_cpu_seconds();
  const std::filesystem::path out(a.out);
  const bool only_png = out.extension() == ".png";
  const std::string png = std::filesystem::path(out).replace_extension(".png").string();
  if (!only_png) write_exr(a.out, with_features(a, scene, accel, state), metadata(run, state), a.half);
  if (only_png || a.png) write_png(png, develop(state.film));
  if (!a.techniques.empty()) write_pyramid(state.pyramid, state.film, a.techniques);
  run.write_seconds = wall_seconds() - wall;
  run.write_cpu = process_cpu_seconds() - cpu;
  write_record(a, run, state);
  if (a.quiet) return;
  fmt::print("{}\n", a.out);
  if (!only_png && a.png) fmt::print("{}\n", png);
}

}  // namespace ajar
