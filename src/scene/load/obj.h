// Enters: Wavefront OBJ files.
// Leaves: what they say, nothing joined yet: several meshes may be made of one, and it is read once.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "mesh.h"

namespace ajar {

/// First and one past the last.
using FaceRange = std::pair<size_t, size_t>;

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
  bool lacks_normals = false;  ///< a corner has none
  std::vector<Face> faces;
  std::vector<size_t> groups;  ///< faces that are the first after g or usemtl, or at all: meshes in Mitsuba 0.x
  std::vector<uint32_t> same_v, same_vt;  ///< by weld(): the first of all that are equal; empty without need
  std::vector<std::string> materials;     ///< after usemtl, each once; the first is empty: before there was one
  std::unordered_map<std::string, uint32_t> by_name;  ///< into materials
  std::vector<std::vector<FaceRange>> runs;           ///< by material: its faces, as few ranges as they are, in order
  std::vector<std::string> libraries;                 ///< after mtllib, as they stand: one name, or several
};

/// name stands in messages. Throws Error as read_obj does.
ObjFile scan_obj(std::string_view text, const std::string& name);
/// Lets corners without a normal share vertices by value: fills same_v and same_vt where there are such corners.
void weld(ObjFile& file);
/// The faces of a group; of all for -1. Throws Error where there is no such group.
FaceRange faces_of(const ObjFile& file, int group);
/// The faces whose material and group the options take, as one mesh.
Mesh join(const ObjFile& file, const MeshOptions& options);

}  // namespace ajar
