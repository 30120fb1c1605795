#include "integrators.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "ajar/core/error.h"

namespace ajar {
namespace {

constexpr Integrator integrators[] = {
    {.name = "path", .trace = trace_path, .strategies = false},
    {.name = "bdpt", .trace = trace_bdpt, .splats = true},
    {.name = "light", .trace = trace_light, .splats = true, .strategies = false, .weighs = false},
    {.name = "guided-path", .trace = trace_bdpt, .guided = true},
    {.name = "guided-bdpt", .trace = trace_bdpt, .splats = true, .guided = true, .light_half = trace_light_half},
    {.name = "vcm", .trace = trace_bdpt, .splats = true, .light_half = trace_light_half, .merges = true},
    {.name = "guided-vcm",
     .trace = trace_bdpt,
     .splats = true,
     .guided = true,
     .light_half = trace_light_half,
     .merges = true},
    {.name = "photon", .trace = trace_photon, .light_half = trace_light_half, .merges = true, .weighs = false},
    {.name = "vpl", .trace = trace_vpl, .splats = true, .guided = true, .light_half = trace_light_half, .vpls = true},
    {.name = "plain-vpl", .trace = trace_vpl, .splats = true, .vpls = true}};

// Where no light vertices are joined, which bring what a cosine lobe finds badly: strata that could halve its variance
// guide (G14).
constexpr float alone_contrast = 2;

}  // namespace

const Integrator& find_integrator(const std::string& name) {
  for (const Integrator& i : integrators)
    if (name == i.name) return i;
  throw Error(fmt::format("--integrator {}: unknown; known are {}", name, fmt::join(integrator_names(), ", ")));
}

std::vector<std::string> integrator_names() {
  std::vector<std::string> names;
  for (const Integrator& i : integrators) names.emplace_back(i.name);
  return names;
}

bool is_guided(const std::string& integrator) { return find_integrator(integrator).guided; }

bool may_leave_out(const RenderOptions& o) {
  const Integrator& integrator = find_integrator(o.integrator);
  const LearnOptions usual;
  const bool as_usual = o.learn.train == 0 && o.learn.guided == usual.guided && o.learn.rule == usual.rule &&
                        o.learn.structure == usual.structure && o.learn.forget == usual.forget;
  return o.leaves_out && integrator.guided && !integrator.vpls && !o.techniques && as_usual;
}

bool learns(const RenderOptions& options) { return is_guided(options.integrator) || options.learn_lights; }

bool is_merging(const std::string& integrator) { return find_integrator(integrator).merges; }

bool has_strategies(const std::string& integrator) { return find_integrator(integrator).strategies; }

bool weighs_strategies(const std::string& integrator) { return find_integrator(integrator).weighs; }

LearnOptions learn_options(const RenderOptions& options) {
  LearnOptions o = options.learn;
  const Integrator& integrator = find_integrator(options.integrator);
  if (!integrator.guided)
    o.guided = Guided::neither;
  else if (!integrator.splats)
    o.guided = Guided::camera, o.least_contrast = std::min(o.least_contrast, alone_contrast);
  else if (integrator.vpls)
    o.guided = Guided::light;  // walks are short, and the price of a guide is not
  return o;
}

}  // namespace ajar
