// Enters: a finished or running render.
// Leaves: its record as JSON, the metadata of its EXR, and the key that a checkpoint is held to.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "ajar/film/picture.h"
#include "ajar/render/plan.h"
#include "ajar/render/sequence.h"
#include "versus.h"

namespace ajar {

/// What the user typed and where the time went, beside the render's own options.
struct Run {
  std::string scene_path, out_path;
  uint64_t content = 0;  ///< Scene::content
  std::vector<std::string> defines;
  std::optional<double> at;  ///< time of the scene's animations, where one was given
  bool lenient = false;
  std::string light_choice;              ///< of light_choice_names
  std::string load_fields, save_fields;  ///< files, empty: none
  RenderOptions options;
  std::optional<SequenceOptions> taught;  ///< how, of a frame whose fields are taught before it is rendered
  double load_seconds = 0, build_seconds = 0, beside_seconds = 0, write_seconds = 0;
  double load_cpu = 0, build_cpu = 0, beside_cpu = 0, write_cpu = 0;  ///< beside: log and checkpoints meanwhile
  uint64_t triangles = 0, accel_bytes = 0;
  int threads = 1;
  bool interrupted = false;
  Versus versus;
  Plan plan;  ///< where one was made
  bool planned = false;
};

/// The options with what building has left of their time: the user's begins after loading.
RenderOptions without_start(RenderOptions options, const Run& run);
nlohmann::ordered_json summary(const Run& run, const RenderState& state);
/// The text of the file that holds it; bytes of names that are no UTF-8 are replaced.
std::string record_of(const nlohmann::ordered_json& summary);
Metadata metadata(const Run& run, const RenderState& state);
/// Everything that decides the bytes of the image but the number of passes.
std::string checkpoint_key(const Run& run, const Film& film);
/// What a checkpoint of that key was rendered with; empty where the key is none of those above.
std::string integrator_of(const std::string& checkpoint_key);

}  // namespace ajar
