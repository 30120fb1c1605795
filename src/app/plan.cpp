// ajar plan: what a scene needs, as a small render of it shows.

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "ajar/scene/load.h"
#include "arguments.h"
#include "command_threads.h"
#include "commands.h"
#include "options.h"
#include "planning.h"
#include "say.h"
#include "stop.h"

namespace ajar {
namespace {

struct PlanArguments {
  std::string scene, size, cpu_time = "60s";
  std::vector<std::string> defines;
  std::optional<double> at;
  uint64_t seed = 0;
  int threads = 0, max_depth = not_given;
  bool json = false, lenient = false;
};

void run_plan(const PlanArguments& a) {
  Scene scene = load_scene(a.scene, load_options(a.defines, a.lenient, a.at));
  check_time(a.at, scene);
  say_notes(scene.notes);
  if (!a.size.empty()) set_size(scene.camera, a.size);
  const Accel accel(scene);
  RenderOptions options;
  options.cpu_seconds = parse_duration("--cpu-time", a.cpu_time);
  options.seed = a.seed, options.threads = a.threads;
  set_max_depth(a.max_depth, scene, options);
  catch_stop();
  Plan plan = make_plan(scene, options);
  run_pilot(
      scene, accel, options, [](const RenderState&) { return !stop_asked(); }, plan);
  if (stop_asked()) throw Interrupted{"interrupted in the pilot; nothing is planned"};
  if (const double least = least_budget(scene.camera); !scene.lights.empty() && options.cpu_seconds < least)
    say(stderr, "ajar: note: --cpu-time {} is too short to learn anything; give {:.0f}s or more\n", a.cpu_time,
        std::ceil(least));
  say(stdout, "{}", a.json ? to_json(plan).dump(2) + "\n" : describe(plan));
}

}  // namespace

void add_plan(CLI::App& app) {
  auto a = std::make_shared<PlanArguments>();
  CLI::App* c = app.add_subcommand("plan", "Tell which parts of the method a scene needs");
  c->add_option("scene", a->scene, "Mitsuba XML scene")->required();
  c->add_option("--cpu-time", a->cpu_time,
                "budget of the render that is planned (default 60s); the pilot takes 4 % of it, more of a short one");
  c->add_option("--size", a->size, "WIDTHxHEIGHT instead of the scene's");
  c->add_option("--max-depth", a->max_depth, max_depth_help);
  c->add_option("--seed", a->seed, "another seed (default 0)")->check(whole(0, ~uint64_t(0)));
  add_threads(*c, a->threads);
  c->add_option("-D", a->defines, "name=value: a parameter of the scene")->allow_extra_args(false);
  add_time(*c, a->at);
  c->add_flag("--json", a->json, "for machines");
  c->add_flag("--lenient", a->lenient, "leave out what the loader does not know, with a note");
  c->callback([a] {
    const CommandThreads threads(a->threads);
    run_plan(*a);
  });
}

}  // namespace ajar
