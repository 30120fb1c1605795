#include "run.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "ajar/core/error.h"

namespace ajar::stress {
namespace {

constexpr double level = 1e-6;
constexpr double bias_of_merging = 0.02;  // relative deviation

RenderOptions options_of(const Case& c, const std::string& integrator, double passes) {
  RenderOptions o;
  o.integrator = integrator;
  o.sampler = SamplerKind::independent;  // so that the spread of renders is their variance
  o.max_depth = c.max_depth;
  o.spp = uint32_t(std::lround(c.passes * passes));
  o.learn.least_contrast = 2;  // fields guide wherever they may
  if (c.tune) c.tune(o.learn);
  return o;
}

double sum(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); }

double noise_of(const Outcome& out) {
  if (out.runs.size() < 2) return 0;
  const kit::Estimate e = kit::estimate(out.width, out.height, out.runs);
  const double n = double(e.mean.size()), mean = sum(e.mean) / n, pixels = double(out.width) * out.height;
  return mean > 0 ? std::sqrt(sum(e.variance) / n * out.paths / pixels) / mean : 0;
}

kit::Estimate flat(int width, int height, double value) {
  kit::Estimate e;
  e.width = width, e.height = height;
  e.mean.assign(3 * size_t(width) * size_t(height), value);
  e.variance.assign(e.mean.size(), 0);
  return e;
}

void render_all(const Case& c, const Scene& scene, RenderOptions o, int batches, CellTable* walls, Outcome& out) {
  const Accel accel(scene);
  const bool guided = is_guided(o.integrator);
  StoredFields stored;
  if (guided && c.fields) stored = c.fields();
  out.width = scene.camera.crop_width, out.height = scene.camera.crop_height;
  for (int i = 0; i < batches; ++i) {
    o.seed = uint64_t(i) + 1;
    RenderState state = start_render(scene, o);
    if (guided && c.fields) go_on_from(scene, stored, learn_options(o), state.learning, state.film);
    CellTable& table = state.learning.fields.table;
    if (walls && table.compartments.empty()) kit::copy_walls(*walls, table);
    render(scene, accel, o, state, nullptr);
    if (walls && !table.compartments.empty()) kit::copy_walls(table, *walls);
    const Picture p = develop(state.film);
    out.runs.emplace_back(p.pixels.begin(), p.pixels.end());
    for (double& v : out.runs.back()) v /= c.factor;
    out.rejected += state.stats.rejected;
    if (out.replay.empty() && !state.stats.replay.empty()) out.replay = state.stats.replay[0];
    out.paths += double(state.film.pixels()) * state.film.passes;
    out.cpu_seconds += state.stats.cpu_seconds;
    out.field_bytes = guided ? double(bytes(state.learning.fields)) : 0;
  }
  out.noise = noise_of(out);
}

bool is_black(const Outcome& out) {
  return std::all_of(out.runs.begin(), out.runs.end(), [](const std::vector<double>& run) {
    return std::all_of(run.begin(), run.end(), [](double v) { return v == 0; });
  });
}

}  // namespace

Outcome run(const Case& c, const std::string& integrator, int batches, double passes, CellTable* walls) {
  Outcome out;
  try {
    render_all(c, c.make(), options_of(c, integrator, passes), batches, walls, out);
  } catch (const Error& e) {
    out.refusal = e.what();
  }
  return out;
}

Outcome reference(const Case& c, int batches) {
  if (c.answer >= 0 || c.refused || c.judge.empty()) return {};
  Case judged = c;
  judged.factor = 1;
  if (c.twin) judged.make = c.twin;
  return run(judged, c.judge, batches, 2);
}

bool can_find(const Case& c, const std::string& integrator) {
  if (std::find(c.blind.begin(), c.blind.end(), integrator) != c.blind.end()) return false;
  if (integrator == "light") return c.light;
  return c.path || (integrator != "path" && integrator != "guided-path");
}

Verdict judge(const Case& c, const std::string& integrator, const Outcome& out, const Outcome& ref) {
  if (c.refused != !out.refusal.empty())
    return {false, 0, c.refused ? "was not refused" : fmt::format("refused: {}", out.refusal)};
  if (c.refused) return {true, 1, {}};
  if (out.rejected > 0) return {false, 0, fmt::format("{} rejected, {}", out.rejected, out.replay)};
  for (const std::vector<double>& run : out.runs)
    for (const double v : run)
      if (!std::isfinite(v)) return {false, 0, "not finite"};
  if (c.answer == 0) return {is_black(out), is_black(out) ? 1.0 : 0.0, is_black(out) ? "" : "not black"};
  if (c.answer < 0 && ref.runs.empty()) return {true, 1, {}};
  const kit::Estimate image = kit::estimate(out.width, out.height, out.runs);
  const kit::Estimate right =
      c.answer > 0 ? flat(out.width, out.height, c.answer) : kit::estimate(ref.width, ref.height, ref.runs);
  const kit::Slack slack{.relative = is_merging(integrator) ? bias_of_merging : 1e-4};
  const kit::ZTest z = kit::z_test(image, right, level, 3, slack);
  const double n = double(image.mean.size());
  // All pixels see the same virtual lights: what a rare one brings moves all blocks together.
  const double p = c.tails || integrator.ends_with("vpl") ? z.p_mean : z.p;
  return {p >= level, p,
          fmt::format("mean {:.6g} for {:.6g}; {}", sum(image.mean) / n, sum(right.mean) / n, z.message)};
}

}  // namespace ajar::stress
