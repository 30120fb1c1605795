// Enters: the first bytes of a PLY file.
// Leaves: its header: elements, their properties, what these are to a mesh.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace ajar {

enum class PlyFormat : uint8_t { ascii, little, big };
enum class PlyType : uint8_t { i8, u8, i16, u16, i32, u32, f32, f64 };

inline constexpr std::array<size_t, 8> ply_sizes{1, 1, 2, 2, 4, 4, 4, 8};
inline constexpr std::array<double, 8> ply_largest{127,        255,        32767, 65535,
                                                   2147483647, 4294967295, 1,     1};  // what stands for 1

inline size_t size_of(PlyType t) { return ply_sizes[size_t(t)]; }
inline bool is_integer(PlyType t) { return t < PlyType::f32; }

/// What a property is to us. The scalar roles of a vertex come first and number its values.
enum PlyRole : uint8_t {
  role_x,
  role_y,
  role_z,
  role_nx,
  role_ny,
  role_nz,
  role_u,
  role_v,
  scalar_roles,
  role_indices,
  role_other
};

struct PlyProperty {
  std::string name;
  PlyRole role = role_other;
  PlyType type = PlyType::f32;    ///< of a list: its entries'
  std::optional<PlyType> length;  ///< of a list: its length's
};

struct PlyElement {
  std::string name;
  size_t count = 0;
  std::vector<PlyProperty> properties;

  bool has(std::initializer_list<PlyRole> roles) const {
    return std::all_of(roles.begin(), roles.end(), [&](PlyRole r) {
      return std::any_of(properties.begin(), properties.end(), [&](const PlyProperty& p) { return p.role == r; });
    });
  }
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
};

// Properties that are one attribute of a mesh.
struct PlyGroup {
  std::string name;
  std::array<size_t, 3> parts{};  // indices of properties; a single number is all three
  bool color = false;             // integers are parts of 1, whatever MeshOptions say
};

/// Reads up to the line after end_header, where p is then. Throws Error with file and line.
PlyHeader read_ply_header(const char*& p, const char* end, const std::string& file);
/// Mitsuba's convention: r g b (or red green blue, each after diffuse_ or not) is "color"; NAME_x y z, NAME_0 1 2 and
/// NAME_1 2 3 side by side are NAME, NAME_r g b is NAME_color; a fourth part is passed over, and the first alone is a
/// single number.
std::vector<PlyGroup> ply_groups(const PlyElement& e, const std::string& prefix);

}  // namespace ajar
