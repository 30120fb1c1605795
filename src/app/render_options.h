// Enters: what ajar render was asked for, and the scene.
// Leaves: the options of the render that follow, or an error where they do not go together.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ajar/scene/scene.h"
#include "arguments.h"

namespace CLI {
class App;
}

namespace ajar {

struct RenderArguments {
  std::string scene, out, size, time, cpu_time,
      heuristic = "power", sampler = "sobol", log, reference, checkpoint, resume, techniques, integrator, save_fields,
      load_fields, guide = "both", field_memory, field_structure, field_rule, field_rate, versus, plan, light_choice;
  std::optional<std::string> noise;
  std::optional<double> at;
  std::vector<std::string> defines, features;
  int spp = 0, max_depth = not_given, threads = 0, roulette_depth = 5;
  uint64_t seed = 0;
  int train = 0;
  std::optional<float> merge_radius;
  int final_gather = 0;
  bool even = false, limit_fireflies = false, no_next_event = false, png = false, half = false, quiet = false,
       lenient = false;
};

/// Adds them to a command, which must not outlive them.
void add_options(CLI::App& command, RenderArguments& arguments);
/// Whether the plan chooses: where the user asks for it, or where neither he nor the scene names an integrator; not
/// where fields are loaded, which choose guided-bdpt.
bool plans(const RenderArguments&, const Scene&);
/// Where the user says nothing.
std::string usual_light_choice(const std::string& integrator);
/// "uniform", "power", "tree" or "learned".
std::string light_choice_of(const RenderArguments&, const std::string& integrator);
/// Sets the scene's choice of lights, too. Throws Error where options do not go together.
RenderOptions render_options(const RenderArguments&, Scene& scene, bool planned);

}  // namespace ajar
