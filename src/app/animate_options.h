// Enters: what ajar animate was asked for, and the scene.
// Leaves: the options of all frames that follow, or an error where they do not go together.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ajar/render/sequence.h"
#include "ajar/scene/scene.h"
#include "arguments.h"

namespace CLI {
class App;
}

namespace ajar {

struct AnimateArguments {
  std::string scene, out, frames, keyframes, at, size, time, cpu_time, integrator, guide = "both", field_memory,
                                                                                   coherent = "on", reference, video;
  std::vector<std::string> defines;
  std::optional<uint32_t> teach;
  std::optional<float> forget;
  int spp = 0, max_depth = not_given, threads = 0;
  uint64_t seed = 0;
  std::optional<double> fps;
  bool even = false, limit_fireflies = false, half = false, quiet = false, lenient = false;
};

/// Adds them to a command, which must not outlive them.
void add_options(CLI::App& command, AnimateArguments& arguments);
SequenceOptions sequence_options(const AnimateArguments& arguments);
/// Throws Error.
RenderOptions render_options(const AnimateArguments& arguments, const Scene& scene);

}  // namespace ajar
