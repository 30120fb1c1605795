// Enters: the path of a Mitsuba XML file, -D parameters.
// Leaves: a finished Scene, or an Error that names file, line, element and cure.
#pragma once

#include <map>
#include <string>

#include "ajar/scene/scene.h"

namespace ajar {

struct LoadOptions {
  std::map<std::string, std::string> defines;  ///< -D name=value; a name that the scene does not know is an error
  bool lenient = false;  ///< unknown elements become notes (unknown bsdf: grey diffuse; others left out)
};

/// Reads a scene as docs/scenes.md describes. Scene::notes holds what was done differently from what the file says.
Scene load_scene(const std::string& path, const LoadOptions& options = {});
/// The same from memory; folder resolves relative file names, name stands in messages.
Scene load_scene_text(const std::string& text, const std::string& folder, const std::string& name,
                      const LoadOptions& options = {});

}  // namespace ajar
