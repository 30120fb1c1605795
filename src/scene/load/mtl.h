// Enters: Wavefront material libraries.
// Leaves: their materials as the file gives them, numbers checked.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
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
  Rgb diffuse{0}, specular{0};  ///< Kd, Ks: not negative, but maybe above 1; as they stand
  bool has_specular = false;    ///< whether Ks is given
  float exponent = 0;           ///< Ns
  float ior = 0;                ///< Ni; 0 where it is not given
  float opacity = 1;            ///< d
  int illum = 0;
  MtlMap map_diffuse, map_specular, map_opacity, map_bump;
};

struct MtlFile {
  std::vector<MtlMaterial> materials;
  std::unordered_map<std::string, uint32_t> by_name;  ///< into materials; the last of a name counts
  std::set<std::string> unread;                       ///< statements that say something Ajar does not use
};

/// name stands in messages. Throws Error "name:line: ..." where a number is damaged or out of range, or missing.
MtlFile parse_mtl(std::string_view text, const std::string& name);

}  // namespace ajar
