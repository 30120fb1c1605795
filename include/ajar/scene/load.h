// Enters: the path of a Mitsuba XML file, -D parameters.
// Leaves: a finished Scene, or an Error that names file, line, element and cure.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "ajar/scene/scene.h"

namespace ajar {

/// What one load leaves for the next of the same scene at another time: images and meshes that files hold, which so are
/// read once. A file that has changed since the first load that named it is an Error, so that all are of one scene.
struct LoadCache {
  /// Tells, without reading it, that a file is most likely still the one that was read.
  struct Stamp {
    uintmax_t size = 0;
    std::filesystem::file_time_type written;
    bool operator==(const Stamp&) const = default;
  };
  struct File {
    Stamp stamp;
    uint64_t sum = 0;  ///< checksum
  };
  struct Placed {
    std::string source;  ///< file and options
    glm::dmat4 to_world{1};
    Mesh mesh;
  };
  std::map<std::string, Image> images;
  std::map<std::string, File> files;
  std::map<std::string, uint64_t> texts;  ///< checksums of XML files, which are read each time
  std::map<size_t, Placed> meshes;        ///< by the shape that they are of; one that moved is read again
};

struct LoadOptions {
  std::map<std::string, std::string> defines;  ///< -D name=value; a name that the scene does not know is an error
  bool lenient = false;                        ///< unknown elements become notes, replaced or left out (docs/scenes.md)
  std::optional<double> time;  ///< at which <animation>s are read; nothing: when the sensor's shutter opens, or 0
  LoadCache* cache = nullptr;  ///< read and filled, where given
};

/// Reads a scene as docs/scenes.md describes. Scene::notes holds what was done differently from what the file says.
Scene load_scene(const std::string& path, const LoadOptions& options = {});
/// The same from memory; folder resolves relative file names, name stands in messages.
Scene load_scene_text(const std::string& text, const std::string& folder, const std::string& name,
                      const LoadOptions& options = {});

}  // namespace ajar
