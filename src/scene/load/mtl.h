// Enters: Wavefront material libraries.
// Leaves: their materials as the file gives them, numbers checked.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "ajar/scene/texture.h"

namespace ajar {

/// A picture of a material: map_Kd -s 2 2 FILE.
struct MtlMap {
  std::string file;                  ///< as it stands; empty: none
  Vec2 scale{1}, offset{0};          ///< of (u, v), v counted from below
  bool clamp = false;                ///< -clamp on: the edge goes on outside, in place of repeating
  Channel channel = Channel::color;  ///< -imfchan
  float height = 1;                  ///< -bm
};

struct MtlMaterial {
  std::string name;
  Rgb diffuse{0.5f}, specular{0};  ///< Kd, Ks: not negative, but maybe above 1
  bool has_specular = false;       ///< whether Ks is given
  float exponent = 0;              ///< Ns
  float ior = 1.5f;                ///< Ni
  float opacity = 1;               ///< d, or 1 - Tr where there is no d
  bool has_opacity = false;        ///< whether d is given
  int illum = 2;
  MtlMap map_diffuse, map_specular, map_opacity, map_bump;
};

struct MtlFile {
  std::vector<MtlMaterial> materials;  ///< the last of a name counts
  std::set<std::string> unread;        ///< statements that say something Ajar does not use
};

/// name stands in messages. Throws Error "name:line: ..." where a number is damaged or out of range, or missing.
MtlFile parse_mtl(std::string_view text, const std::string& name);

}  // namespace ajar
