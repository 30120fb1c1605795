#include "run.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "ajar/core/error.h"

namespace ajar::stress {
namespace {

constexpr double level = 1e-6;
constexpr double bias_of_merging = 0.02;  // relative deviation
constexpr uint64_t seeds_of_references = 1u << 20;

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

// o.seed: of the first.
void render_all(const Case& c, const Scene& scene, RenderOptions o, int batches, CellTable* walls, Outcome& out) {
  const Accel accel(scene);
  const bool guided = is_guided(o.integrator);
  StoredFields stored;
  if (guided && c.fields) stored = c.fields();
  out.width = scene.camera.crop_width, out.height = scene.camera.crop_height;
  for (int i = 0; i < batches; ++i, ++o.seed) {
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
    out.cells = state.learning.fields.cells.size();
  }
  out.noise = noise_of(out);
}

bool is_black(const Outcome& out) {
  return std::all_of(out.runs.begin(), out.runs.end(), [](const std::vector<double>& run) {
    return std::all_of(run.begin(), run.end(), [](double v) { return v == 0; });
  });
}

Outcome run_from(uint64_t seed, const Case& c, const std::string& integrator, int batches, double passes,
                 CellTable* walls) {
  Outcome out;
  try {
    RenderOptions o = options_of(c, integrator, passes);
    o.seed = seed;
    render_all(c, c.make(), o, batches, walls, out);
  } catch (const Error& e) {
    out.refusal = e.what();
  }
  return out;
}

// Why it is wrong whatever its pixels are; nothing if it is not.
std::string fault_of(const Case& c, const std::string& integrator, const Outcome& out) {
  if (out.refusal.empty() != c.refused.empty())
    return c.refused.empty() ? fmt::format("refused: {}", out.refusal) : "was not refused";
  if (out.refusal.find(c.refused) == std::string::npos)
    return fmt::format("refused, but not for \"{}\": {}", c.refused, out.refusal);
  if (out.rejected > 0) return fmt::format("{} rejected, {}", out.rejected, out.replay);
  for (const std::vector<double>& run : out.runs)
    if (!std::all_of(run.begin(), run.end(), [](double v) { return std::isfinite(v); })) return "not finite";
  if (c.refused.empty() && is_guided(integrator) && (out.cells < c.least_cells || out.cells > c.most_cells))
    return fmt::format("{} cells", out.cells);
  return {};
}

// All but the share missing of an image.
kit::Estimate without(kit::Estimate e, double missing) {
  for (double& v : e.mean) v *= 1 - missing;
  for (double& v : e.variance) v *= (1 - missing) * (1 - missing);
  for (std::vector<double>& run : e.runs)
    for (double& v : run) v *= 1 - missing;
  return e;
}

Verdict compare(const Case& c, const std::string& integrator, const kit::Estimate& image, const kit::Estimate& right) {
  const kit::Slack slack{.relative = is_merging(integrator) ? bias_of_merging : 1e-4, .faint = c.faint};
  const auto test = [&](double missing) { return kit::z_test(without(image, missing), right, level, 3, slack); };
  // All pixels see the same virtual lights: what a rare one brings moves all blocks together.
  const auto p_of = [&](const kit::ZTest& z) { return c.tails || integrator.ends_with("vpl") ? z.p_mean : z.p; };
  const kit::ZTest z = test(0);
  Verdict v{p_of(z) >= level, p_of(z), infinity, {}};
  for (const double missing : {0.01, 0.02, 0.03, 0.05, 0.1, 0.2, 0.3, 0.5})
    if (v.noticed == infinity && p_of(test(missing)) < level) v.noticed = missing;
  const double n = double(image.mean.size());
  v.message = fmt::format("mean {:.6g} for {:.6g}; {}", sum(image.mean) / n, sum(right.mean) / n, z.message);
  if (v.ok && v.noticed == infinity) v.ok = false, v.message = "half of the image would not be missed; " + v.message;
  return v;
}

}  // namespace

Outcome run(const Case& c, const std::string& integrator, int batches, double passes, CellTable* walls) {
  return run_from(1, c, integrator, batches, passes, walls);
}

Outcome reference(const Case& c, int batches) {
  if (c.answer >= 0 || !c.refused.empty() || c.judge.empty()) return {};
  Case judged = c;
  judged.factor = 1;
  if (c.twin) judged.make = c.twin;
  return run_from(seeds_of_references, judged, c.judge, batches, 2, nullptr);
}

bool can_find(const Case& c, const std::string& integrator) {
  if (std::find(c.blind.begin(), c.blind.end(), integrator) != c.blind.end()) return false;
  if (integrator == "light") return c.light;
  return c.path || (integrator != "path" && integrator != "guided-path");
}

bool judges_itself(const Case& c, const std::string& integrator) {
  return c.answer < 0 && !c.twin && integrator == c.judge;
}

Verdict judge(const Case& c, const std::string& integrator, const Outcome& out, const Outcome& ref) {
  if (const std::string fault = fault_of(c, integrator, out); !fault.empty()) return {false, 0, 0, fault};
  if (!c.refused.empty() || (c.answer < 0 && c.judge.empty())) return {true};
  if (c.answer == 0) return is_black(out) ? Verdict{true} : Verdict{false, 0, 0, "not black"};
  if (c.answer < 0 && ref.runs.empty()) return {false, 0, 0, "there is no image to hold it to: " + ref.refusal};
  const kit::Estimate right =
      c.answer > 0 ? flat(out.width, out.height, c.answer) : kit::estimate(ref.width, ref.height, ref.runs);
  return compare(c, integrator, kit::estimate(out.width, out.height, out.runs), right);
}

}  // namespace ajar::stress
