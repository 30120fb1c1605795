// Enters: Wavefront OBJ files.
// Leaves: what they say, nothing joined yet: several meshes may be made of one, and it is read once.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mesh.h"

namespace ajar {

struct ObjFile {
  /// Corner of a face: indices from 0, none where the file gives none.
  struct Corner {
    uint32_t v, vt, vn;
    bool operator==(const Corner&) const = default;
  };
  struct Face {
    size_t first;       ///< into corners; ends where the next face begins
    uint32_t line;      ///< for messages
    uint32_t material;  ///< into materials
  };

  std::string name;  ///< for messages
  std::vector<Vec3> v, vn;
  std::vector<Vec2> vt;
  std::vector<Rgb> colors;  ///< as many as v, or none
  std::vector<Corner> corners;
  std::vector<Face> faces;
  std::vector<std::string> materials;  ///< after usemtl, each once; the first is empty: before there was one
  std::vector<std::string> libraries;  ///< after mtllib, as they stand: one name, or several
};

/// name stands in messages. Throws Error as read_obj does.
ObjFile scan_obj(std::string_view text, const std::string& name);
/// The faces whose material the options take, as one mesh.
Mesh join(const ObjFile& file, const MeshOptions& options);

}  // namespace ajar
