// Enters: a shape element.
// Leaves: its faces in parts, each with the bsdf that it is made of.
#pragma once

#include <set>
#include <string>

#include "loader.h"

namespace ajar {

struct MeshPart {
  std::string name;               ///< what usemtl calls it; empty for the rest
  const Node* bsdf = nullptr;     ///< none: the default
  std::set<std::string> without;  ///< of the rest: names of the other parts; empty where it is the whole
  uint32_t material = none;       ///< out of the file's own library, where it is of that
};

/// Whether it is not all of the file.
inline bool is_some(const MeshPart& part) { return !part.name.empty() || !part.without.empty(); }

/// Of an obj with several bsdfs, one part for each name and one for the rest; one part of any other shape. In version
/// 0.x what has no bsdf there goes by the materials of the file's own libraries.
std::vector<MeshPart> parts_of(Params& p);

/// Adds a part for each material that the libraries of an obj (mtllib) have, some of its faces and no part yet.
void add_library_parts(Params& p, std::vector<MeshPart>& parts);

/// The file, read once for all its parts; welded in version 0.x. Throws Error as read_obj does.
const ObjFile& open_obj(Loader& loader, const std::string& path);
/// shapeIndex of version 0.x: the group of faces that an obj is; -1 for all.
int obj_group(Params& p);
/// Whether faces of an obj come under this usemtl.
bool has_material(Params& p, const std::string& name);

/// The material of a part: its bsdf, or what shapes without one have.
uint32_t material_of(Params& p, const MeshPart& part, bool emits);

}  // namespace ajar
