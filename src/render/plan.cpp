// Leave out what a scene does not need: what it does not contain, what there is no time for, and what its first passes
// show that it can do without.

#include "ajar/render/plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "ajar/core/error.h"
#include "ajar/core/parallel.h"

namespace ajar {
namespace {

constexpr double sample_of_guided = 12, sample_of_bdpt = 6.5;  // [us] about
// CPU time that a pixel has to have for learning to pay [us]: below, guided-bdpt leaves more than bdpt and path do, in
// the mean over scenes (docs/results/plan.md).
constexpr double least_time = 150;
constexpr double pilot_share = 0.04;   // of the budget
constexpr double first_guess = 60;     // CPU seconds of a render whose end its noise alone decides
constexpr double least_pixels = 2500;  // below, a pilot says little
constexpr uint32_t pilot_passes = 17;  // the last look is before the last of them
constexpr uint32_t pilot_lessons = 8;  // about, in time of passes
// Of quotients beyond it a few bright pixels decide how large they are, if not that they are.
constexpr double most_trusted = 10;

// CPU seconds; infinite where a target for the noise alone ends the render.
double budget_of(const RenderOptions& o, double pixels) {
  const double threads = o.threads > 0 ? o.threads : processor_count();
  double most = infinity;
  if (o.cpu_seconds > 0) most = std::min(most, o.cpu_seconds);
  if (o.seconds > 0) most = std::min(most, o.seconds * threads);
  if (const uint32_t passes = most_passes(o); passes > 0)
    most = std::min(most, passes * pixels * sample_of_bdpt * 1e-6);
  return most;
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

void set_learned_parts(Plan& plan, bool light, bool guided, const std::string& why) {
  const std::pair<const char*, bool> parts[] = {
      {"light-subpaths", light}, {"camera-guiding", guided}, {"light-guiding", guided}};
  for (size_t i = 0; i < std::size(parts); ++i) plan.parts[i] = {parts[i].first, parts[i].second, why};
}

// Scales the film and its crop window, so that the camera sees the same.
void scale_size(Camera& camera, double scale) {
  const auto scaled = [&](int pixels) { return std::max(1, int(pixels * scale)); };
  const Camera full = camera;
  set_size(camera, scaled(full.width), scaled(full.height));
  camera.crop_x = std::min(int(full.crop_x * scale), camera.width - 1);
  camera.crop_y = std::min(int(full.crop_y * scale), camera.height - 1);
  camera.crop_width = std::min(scaled(full.crop_width), camera.width - camera.crop_x);
  camera.crop_height = std::min(scaled(full.crop_height), camera.height - camera.crop_y);
}

// Scales the camera to so many pixels as the pilot of such a budget can afford.
void set_pilot_size(Camera& camera, double budget) {
  const double price = (pilot_passes + pilot_lessons) * sample_of_guided * 1e-6;
  const double full = pixels_of(camera);
  const double wanted = std::min(std::max(pilot_share * budget / price, least_pixels), full);
  scale_size(camera, std::sqrt(wanted / full));
}

// Puts a scene's camera back.
struct CameraKeeper {
  explicit CameraKeeper(Scene& of) : scene(of), camera(of.camera) {}
  ~CameraKeeper() { scene.camera = camera; }
  CameraKeeper(const CameraKeeper&) = delete;
  CameraKeeper& operator=(const CameraKeeper&) = delete;
  Scene& scene;
  const Camera camera;
};

// Error of the worse of the two over that of the better one; 1 where nothing could be compared.
double times_worse(const Pilot& p) { return p.ratio > 0 ? std::max(p.ratio, 1 / p.ratio) : 1; }

std::string describe(const Pilot& p) {
  if (p.passes == 0) return "the pilot saw nothing to compare";
  const std::string times = !p.saves_more() ? fmt::format("{:.2f}", p.ratio)
                            : p.ratio > 1   ? fmt::format("more than {:g}", most_trusted)
                                            : fmt::format("less than {:g}", 1 / most_trusted);
  return fmt::format("path tracing leaves {} times the error after equal time{}", times,
                     p.settled ? "" : "; the render looks again");
}

}  // namespace

bool Pilot::saves_more() const { return times_worse(*this) > most_trusted; }

double Pilot::saved_seconds() const {
  return budget < infinity ? budget * (std::min(times_worse(*this), most_trusted) - 1) : 0;
}

double least_budget(const Camera& camera) { return least_time * 1e-6 * pixels_of(camera); }

Plan make_plan(const Scene& scene, const RenderOptions& options) {
  Plan plan;
  plan.parts.resize(3);
  if (scene.lights.empty() || options.max_depth == 1) {  // nothing to join
    plan.integrator = "path";
    set_learned_parts(plan, false, false,
                      options.max_depth == 1 ? "paths of one edge see lights alone" : "the scene has no light");
  } else if (budget_of(options, pixels_of(scene.camera)) < least_budget(scene.camera)) {
    plan.integrator = "bdpt";
    set_learned_parts(plan, true, false, "there is no time to learn");
    plan.parts[0].why = "finds caustics, and what shines through a gap";
  } else {
    plan.integrator = "guided-bdpt";
    set_learned_parts(plan, true, true, "until path tracing turns out to be enough");
  }
  add_contained_parts(scene, plan);
  return plan;
}

void run_pilot(Scene& scene, const Accel& accel, const RenderOptions& options, const Monitor& monitor, Plan& plan) {
  if (plan.integrator != "guided-bdpt") return;
  const double cpu = process_cpu_seconds();
  const CameraKeeper keeper(scene);
  Pilot p;
  p.budget = budget_of(options, pixels_of(scene.camera));
  set_pilot_size(scene.camera, p.budget < infinity ? p.budget : first_guess);
  p.width = scene.camera.crop_width, p.height = scene.camera.crop_height;
  RenderOptions small = options;
  small.integrator = plan.integrator, small.spp = pilot_passes, small.leaves_out = true;
  small.seconds = small.cpu_seconds = small.noise = 0;
  RenderState state = start_render(scene, small);
  bool go_on = true;
  render(scene, accel, small, state,
         [&](const RenderState& now) { return (go_on = !monitor || monitor(now)) && !now.plain.settled; });
  if (!go_on) return;
  const Plain& plain = state.plain;
  p.passes = plain.ratio > 0 ? plain.passes : 0, p.ratio = plain.ratio;
  p.plain = plain.taken, p.settled = plain.settled;
  p.guided = plain.guided_error, p.path = plain.plain_error, p.path_for_one = plain.pace;
  p.cpu_seconds = process_cpu_seconds() - cpu;
  set_learned_parts(plan, !p.plain, !p.plain, describe(p));
  plan.pilot = p;
}

void apply_parts(const std::vector<std::string>& parts, RenderOptions& options) {
  bool light = false, camera_guided = false, light_guided = false;
  for (const std::string& part : parts)
    if ((part == "all" || part == "auto" || part == "none") && parts.size() > 1)
      throw Error(
          fmt::format("--plan {}: {} stands alone; leave out either it or the rest", fmt::join(parts, ","), part));
  for (const std::string& part : parts) {
    if (part == "light-subpaths")
      light = true;
    else if (part == "camera-guiding")
      camera_guided = true;
    else if (part == "light-guiding")
      light_guided = true;
    else if (part != "none")
      throw Error(
          fmt::format("--plan \"{}\": no such part; write auto, all, none, or a list of light-subpaths, "
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
