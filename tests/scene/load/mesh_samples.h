// Enters: meshes.
// Leaves: the bytes of files that hold them, and a judgement whether a mesh is what readers promise.
#pragma once

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "scene/load/mesh.h"

namespace ajar::kit {

inline std::span<const std::byte> as_bytes(const std::string& s) { return std::as_bytes(std::span(s)); }

template <class T>
void put(std::string& out, T value, bool big = false) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (big) std::reverse(raw, raw + sizeof(T));
  out.append(raw, sizeof(T));
}

inline std::string deflated(const std::string& data) {
  uLongf size = compressBound(uLong(data.size()));
  std::string out(size, '\0');
  compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(data.data()),
            uLong(data.size()), 6);
  out.resize(size);
  return out;
}

/// Binary PLY with all that the mesh has; colours as uchar, face lists of uchar and int.
inline std::string ply_of(const Mesh& mesh, bool big) {
  std::string out = std::string("ply\nformat binary_") + (big ? "big" : "little") + "_endian 1.0\ncomment a test\n";
  out += "element vertex " + std::to_string(mesh.positions.size()) + "\n";
  const auto floats = [&](std::initializer_list<const char*> names) {
    for (const char* name : names) out += std::string("property float ") + name + "\n";
  };
  floats({"x", "y", "z"});
  if (!mesh.normals.empty()) floats({"nx", "ny", "nz"});
  if (!mesh.uvs.empty()) floats({"u", "v"});
  if (!mesh.colors.empty())
    for (const char* name : {"red", "green", "blue"}) out += std::string("property uchar ") + name + "\n";
  out += "element face " + std::to_string(mesh.triangles.size()) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    for (int k = 0; k < 3; ++k) put(out, mesh.positions[i][k], big);
    for (int k = 0; k < 3 && !mesh.normals.empty(); ++k) put(out, mesh.normals[i][k], big);
    for (int k = 0; k < 2 && !mesh.uvs.empty(); ++k) put(out, mesh.uvs[i][k], big);
    for (int k = 0; k < 3 && !mesh.colors.empty(); ++k) put(out, uint8_t(std::lround(mesh.colors[i][k] * 255)), big);
  }
  for (const glm::uvec3& t : mesh.triangles) {
    put(out, uint8_t(3), big);
    for (int k = 0; k < 3; ++k) put(out, int32_t(t[k]), big);
  }
  return out;
}

/// What is compressed in a serialized mesh. version 3 has no name.
template <class Real>
std::string payload_of(const Mesh& mesh, int version, uint32_t more_flags = 0) {
  std::string out;
  put(out, uint32_t((mesh.normals.empty() ? 0 : 1) | (mesh.uvs.empty() ? 0 : 2) | (mesh.colors.empty() ? 0 : 8) |
                    (sizeof(Real) == 4 ? 0x1000 : 0x2000) | more_flags));
  if (version == 4) out += std::string("name", 5);
  put(out, uint64_t(mesh.positions.size()));
  put(out, uint64_t(mesh.triangles.size()));
  const auto reals = [&](const auto& values, int n) {
    for (const auto& value : values)
      for (int k = 0; k < n; ++k) put(out, Real(value[k]));
  };
  reals(mesh.positions, 3);
  reals(mesh.normals, 3);
  reals(mesh.uvs, 2);
  reals(mesh.colors, 3);
  for (const glm::uvec3& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) put(out, t[k]);
  return out;
}

/// A serialized file around payloads, with the dictionary at its end.
inline std::string serialized_of(const std::vector<std::string>& payloads, int version) {
  std::string out, dictionary;
  for (const std::string& payload : payloads) {
    version == 4 ? put(dictionary, uint64_t(out.size())) : put(dictionary, uint32_t(out.size()));
    put(out, uint16_t(0x041c));
    put(out, uint16_t(version));
    out += deflated(payload);
  }
  out += dictionary;
  put(out, uint32_t(payloads.size()));
  return out;
}

/// What is wrong with a mesh that a reader returned; empty if nothing is.
inline std::string unsound(const Mesh& mesh) {
  const size_t n = mesh.positions.size();
  const auto finite = [](const auto& v) { return std::isfinite(v.x) && std::isfinite(v.y); };
  if (!mesh.normals.empty() && mesh.normals.size() != n) return "number of normals";
  if (!mesh.uvs.empty() && mesh.uvs.size() != n) return "number of uvs";
  if (!mesh.colors.empty() && mesh.colors.size() != n) return "number of colours";
  for (const Vec3& p : mesh.positions)
    if (!finite(p) || !std::isfinite(p.z)) return "position";
  for (const Vec3& m : mesh.normals)
    if (!(std::abs(glm::dot(glm::dvec3(m), glm::dvec3(m)) - 1) < 1e-5)) return "normal";
  for (const Vec2& uv : mesh.uvs)
    if (!finite(uv)) return "uv";
  for (const Rgb& c : mesh.colors)
    if (!finite(c) || !std::isfinite(c.z)) return "colour";
  for (const glm::uvec3& t : mesh.triangles)
    if (std::max(t.x, std::max(t.y, t.z)) >= n) return "index";
  return "";
}

/// Geometric normal of a triangle, zero where it has no area.
inline Vec3 face_normal(const Mesh& mesh, size_t triangle) {
  const glm::uvec3 t = mesh.triangles[triangle];
  const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
  const glm::dvec3 n = glm::cross(b - a, c - a);
  return glm::length(n) > 0 ? Vec3(glm::normalize(n)) : Vec3(0);
}

}  // namespace ajar::kit
