// Enters: the path of a Mitsuba XML file, -D parameters.
// Leaves: a finished Scene, or an Error that names file, line, element and cure.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "ajar/scene/scene.h"

namespace ajar {

/// What one load leaves for the next of the same scene at another time: images and meshes that files hold, which so are
/// read once. Who changes the files between two loads is not seen.
struct LoadCache {
  struct Placed {
    std::string source;  ///< file and options
    glm::dmat4 to_world{1};
    Mesh mesh;
  };
  std::map<std::string, Image> images;
  std::map<std::string, uint64_t> files;  ///< their checksums
  std::map<size_t, Placed> meshes;        ///< by the shape that they are of; one that moved is read again
};

struct LoadOptions {
  std::map<std::string, std::string> defines;  ///< -D name=value; a name that the scene does not know is an error
  bool lenient = false;        ///< unknown elements become notes (unknown bsdf: grey diffuse; others left out)
  std::optional<double> time;  ///< at which <animation>s are read; nothing: when the sensor's shutter opens, or 0
  LoadCache* cache = nullptr;  ///< read and filled, where given
};

/// Reads a scene as docs/scenes.md describes. Scene::notes holds what was done differently from what the file says.
Scene load_scene(const std::string& path, const LoadOptions& options = {});
/// The same from memory; folder resolves relative file names, name stands in messages.
Scene load_scene_text(const std::string& text, const std::string& folder, const std::string& name,
                      const LoadOptions& options = {});

}  // namespace ajar
