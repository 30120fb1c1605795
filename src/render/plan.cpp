// Leave out what a scene does not need: a pilot tells which integrator comes to a given error first.

#include "ajar/render/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "ajar/core/error.h"
#include "ajar/render/trials.h"

namespace ajar {
namespace {

// From the simplest to the fullest.
struct Candidate {
  const char* name;
  double sample;  // [us] about, before it is measured: for the pilot's size
  bool light_subpaths, guided;
};
constexpr Candidate candidates[] = {{"path", 2, false, false},
                                    {"guided-path", 5, false, true},
                                    {"bdpt", 6.5, true, false},
                                    {"guided-bdpt", 10, true, true}};
constexpr uint32_t trial_passes = 12;    // that count
constexpr double least_pixels = 600;     // below, a pilot says little
constexpr double first_guess = 20;       // CPU seconds of a render whose end its noise alone decides
constexpr double hysteresis = 0.9;       // what guides has to be this much better than what does not
constexpr double still_to_learn = 0.75;  // of a guided integrator's price: it goes on learning where the pilot ends

// CPU seconds; infinite where a target for the noise alone ends the render.
double budget_of(const RenderOptions& o, double pixels) {
  const double threads = o.threads > 0 ? o.threads : std::max(1u, std::thread::hardware_concurrency());
  double most = infinity;
  if (o.cpu_seconds > 0) most = std::min(most, o.cpu_seconds);
  if (o.seconds > 0) most = std::min(most, o.seconds * threads);
  const double typical = candidates[2].sample * 1e-6;
  if (const uint32_t passes = most_passes(o); passes > 0) most = std::min(most, passes * pixels * typical);
  return most;
}

// CPU seconds of all trials for a pixel.
double pilot_price() {
  double per_pixel = 0;
  for (const Candidate& c : candidates)
    per_pixel += (trial_passes + (c.guided ? blind_generations : 0)) * c.sample * 1e-6;
  return per_pixel;
}

// Scales the camera to so many pixels as the pilot of such a budget can afford; false where that is too few.
bool set_pilot_size(Camera& camera, double budget) {
  if (budget < least_budget(camera)) return false;
  const double full = double(camera.width) * camera.height;
  const double wanted = std::min(pilot_share * budget / pilot_price(), full);
  const double scale = std::sqrt(wanted / full);
  set_size(camera, std::max(1, int(camera.width * scale)), std::max(1, int(camera.height * scale)));
  return true;
}

// What an integrator sees in passes after those whose numbers guided ones drop, and what a sample costs. walls: where
// the first guided one found that they divide cells.
Trial run_trial(const Scene& scene, const Accel& accel, RenderOptions options, const Candidate& c,
                const Monitor& monitor, CellTable& walls, Sight& sight) {
  options.integrator = c.name;
  options.spp = trial_passes;
  options.seconds = options.cpu_seconds = options.noise = 0;
  options.techniques = options.leaves_out = false;
  options.learn.train = 0;
  RenderState state = start_render(scene, options);
  CellTable& table = state.learning.fields.table;
  table.cuts = walls.cuts, table.compartments = walls.compartments, table.portals = walls.portals;
  if (!c.guided) state.film.dropped = blind_generations;
  render(scene, accel, options, state, [&](const RenderState& now) {
    if (now.film.chunks == 0 && now.film.dropped > 0 && now.film.passes > sight.passes.size()) look(now.film, sight);
    return monitor(now);
  });
  if (c.guided) walls.cuts = table.cuts, walls.compartments = table.compartments, walls.portals = table.portals;
  const Counters& n = state.stats.counters;
  const double rays = double(n.camera_rays + n.light_rays + n.shadow_rays);
  Trial t;
  t.integrator = c.name, t.passes = state.film.passes;
  t.cost = rays / std::max(double(n.camera_paths), 1.0) * ray_cost(c.name);
  return t;
}

const Trial* find(const Plan& plan, const std::string& name) {
  for (const Trial& t : plan.trials)
    if (t.integrator == name) return &t;
  return nullptr;
}

const Candidate& candidate_of(const std::string& name) {
  return *std::find_if(std::begin(candidates), std::end(candidates),
                       [&](const Candidate& c) { return name == c.name; });
}

std::string times(const Plan& plan, const char* with, const char* without) {
  const Trial *a = find(plan, with), *b = find(plan, without);
  if (!a || !b) return "not measured";
  if (!(a->price() < infinity) && !(b->price() < infinity))
    return fmt::format("{} and {} saw black alone", with, without);
  if (!(a->price() < infinity) || !(b->price() > 0)) return "not measured";
  return fmt::format("{} takes {:.2g} times the time of {} to equal error", with, a->price() / b->price(), without);
}

void add_measured_parts(Plan& plan) {
  const Candidate& chosen = candidate_of(plan.integrator);
  plan.parts.push_back({"light-subpaths", chosen.light_subpaths,
                        chosen.guided ? times(plan, "guided-bdpt", "guided-path") : times(plan, "bdpt", "path")});
  const std::string guiding =
      chosen.light_subpaths ? times(plan, "guided-bdpt", "bdpt") : times(plan, "guided-path", "path");
  plan.parts.push_back({"camera-guiding", chosen.guided, guiding});
  plan.parts.push_back({"light-guiding", chosen.guided && chosen.light_subpaths,
                        chosen.light_subpaths ? guiding : "there are no light subpaths"});
}

// What the scene does not contain costs nothing: the tracer asks once per scene or material, not per path.
void add_contained_parts(const Scene& scene, Plan& plan) {
  const auto add = [&](const char* name, bool on, std::string with, std::string without) {
    plan.parts.push_back({name, on, on ? std::move(with) : std::move(without)});
  };
  const size_t lights = scene.lights.size();
  add("next-event", lights > 0, fmt::format("{} light{}", lights, lights == 1 ? "" : "s"), "the scene has no light");
  add("light-choice", lights > 1, "more than one light", "there is nothing to choose");
  add("environment", !scene.infinite_lights.empty(), "rays that escape find light", "rays that escape find nothing");
  add("instances", !scene.instances.empty(), fmt::format("{}", scene.instances.size()), "none in the scene");
  add("textures", !scene.textures.empty(), fmt::format("{}", scene.textures.size()), "none in the scene");
}

double expected_price(const Trial& t) { return t.price() * (is_guided(t.integrator) ? still_to_learn : 1); }

// Not that light subpaths be much better: what paths without them miss, as caustics, makes those look quiet, never the
// others.
void choose(Plan& plan) {
  const Trial* best = nullptr;
  const auto handicap = [](const Trial& t) { return is_guided(t.integrator) ? 1 : hysteresis; };
  for (const Trial& t : plan.trials)
    if (t.price() < infinity && (!best || handicap(t) * expected_price(t) < handicap(*best) * expected_price(*best)))
      best = &t;
  if (best) plan.integrator = best->integrator;
}

// CPU seconds to the noise that is asked for, by the best of the trials.
double time_to(double noise, double pixels, const Plan& plan) {
  double least = infinity;
  for (const Trial& t : plan.trials) least = std::min(least, t.price());
  return least * 1e-6 * pixels / noise;
}

// Factor on the time to equal error, of so many passes as the budget pays for. Small images lose more than
// blind_generations, but what their fields go on to learn makes up for it.
double waste_of(double passes, double pixels) {
  const double lost = std::min(passes_lost(size_t(pixels)), double(blind_generations));
  return passes > lost ? passes / (passes - lost) : infinity;
}

// All trials at the size that the budget allows, the camera's left as it was; false where that is too small.
bool run_pilot(Scene& scene, const Accel& accel, const RenderOptions& options, double budget, const Monitor& monitor,
               Plan& plan) {
  const Camera camera = scene.camera;
  const double pixels = double(camera.width) * camera.height;
  if (!set_pilot_size(scene.camera, budget)) return false;
  plan.width = scene.camera.width, plan.height = scene.camera.height;
  std::vector<Sight> sights;
  CellTable walls;
  plan.trials.clear();
  bool go_on = true;
  const Monitor watch = [&](const RenderState& state) { return go_on = !monitor || monitor(state); };
  for (const Candidate& c : candidates) {
    Sight sight;
    Trial trial = run_trial(scene, accel, options, c, watch, walls, sight);
    if (!go_on) break;
    plan.trials.push_back(std::move(trial));
    sights.push_back(std::move(sight));
  }
  scene.camera = camera;
  const std::vector<Judgement> judgements = judge(sights);
  for (size_t i = 0; i < sights.size(); ++i) {
    Trial& t = plan.trials[i];
    t.error = judgements[i].error, t.deviation = judgements[i].deviation, t.unseen = judgements[i].unseen;
    if (candidates[i].guided) t.waste = waste_of(budget * 1e6 / (pixels * t.cost), pixels);
  }
  return true;
}

}  // namespace

double least_budget(const Camera& camera) {
  return std::min(least_pixels, double(camera.width) * camera.height) * pilot_price() / pilot_share;
}

Plan make_plan(Scene& scene, const Accel& accel, const RenderOptions& options, const Monitor& monitor) {
  Plan plan;
  plan.integrator = "guided-bdpt";
  const double wall = wall_seconds(), cpu = process_cpu_seconds();
  const double pixels = double(scene.camera.width) * scene.camera.height, budget = budget_of(options, pixels);
  const bool open = !(budget < infinity);
  if (scene.lights.empty() || options.max_depth == 1) {  // nothing to join
    plan.integrator = "path";
  } else if (run_pilot(scene, accel, options, open ? first_guess : budget, monitor, plan)) {
    const double needed = open ? time_to(options.noise, pixels, plan) : 0;
    if (plan.trials.size() == std::size(candidates) && needed > 2 * first_guess && needed < infinity)
      run_pilot(scene, accel, options, needed, monitor, plan);
    choose(plan);
  } else {
    plan.integrator = "bdpt";  // learning takes longer than there is
  }
  add_measured_parts(plan);
  if (options.max_depth == 1)
    for (Part& p : plan.parts) p.why = "paths of one edge see lights alone";
  add_contained_parts(scene, plan);
  plan.seconds = wall_seconds() - wall, plan.cpu_seconds = process_cpu_seconds() - cpu;
  return plan;
}

void apply_parts(const std::vector<std::string>& parts, RenderOptions& options) {
  bool light = false, camera_guided = false, light_guided = false;
  for (const std::string& part : parts) {
    if (part == "light-subpaths")
      light = true;
    else if (part == "camera-guiding")
      camera_guided = true;
    else if (part == "light-guiding")
      light_guided = true;
    else if (part != "none")
      throw Error(
          fmt::format("--plan {}: no such part; write auto, all, none, or a list of light-subpaths, "
                      "camera-guiding, light-guiding",
                      part));
  }
  if (light_guided && !light) throw Error("--plan light-guiding: guides light subpaths; add light-subpaths");
  if (!camera_guided && !light_guided)
    options.integrator = light ? "bdpt" : "path";
  else
    options.integrator = light ? "guided-bdpt" : "guided-path";
  options.learn.guided = !light_guided ? Guided::camera : camera_guided ? Guided::both : Guided::light;
}

}  // namespace ajar
