#include "mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "ajar/core/error.h"
#include "smooth.h"

namespace ajar {
namespace {

using glm::dvec3;

bool finite(const dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool try_normalize(Vec3& n) {
  const dvec3 d(n);
  const double length = glm::length(d);  // double: no float's square leaves its range
  if (!(length > 0) || !std::isfinite(length)) return false;
  n = Vec3(d / length);
  return true;
}

// det * inverse transpose, which exists for singular matrices too.
glm::dmat3 cofactor(const glm::dmat3& m) {
  return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

// Moves positions and normals; returns whether the map is a mirror. Bad positions are the caller's business.
bool move(Mesh& mesh, const Mat4& to_world) {
  const glm::dmat4 m(to_world);
  const glm::dmat3 linear(m);
  for (Vec3& p : mesh.positions) p = Vec3(linear * dvec3(p) + dvec3(m[3]));
  const bool mirror = glm::determinant(linear) < 0;
  const glm::dmat3 normal = cofactor(linear) * (mirror ? -1.0 : 1.0);
  for (Vec3& n : mesh.normals) {
    const dvec3 d = normal * dvec3(n);
    const double length = glm::length(d);
    n = length > 0 && std::isfinite(length) ? Vec3(d / length) : Vec3(0);
  }
  return mirror;
}

void wind_by_normals(Mesh& mesh) {
  for (glm::uvec3& t : mesh.triangles) {
    const dvec3 sum = dvec3(mesh.normals[t.x]) + dvec3(mesh.normals[t.y]) + dvec3(mesh.normals[t.z]);
    if (glm::dot(face_cross(mesh, t), sum) < 0) std::swap(t.y, t.z);
  }
}

void turn_winding(Mesh& mesh) {
  for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
}

}  // namespace

dvec3 face_cross(const Mesh& mesh, const glm::uvec3& t) {
  const dvec3 p(mesh.positions[t.x]);
  return glm::cross(dvec3(mesh.positions[t.y]) - p, dvec3(mesh.positions[t.z]) - p);
}

void transform(Mesh& mesh, const Mat4& to_world) {
  const bool had_normals = !mesh.normals.empty(), mirror = move(mesh, to_world);
  for (const Vec3& p : mesh.positions)
    if (!finite(p)) throw Error("a to_world transform moves a vertex beyond the range of numbers: use smaller factors");
  if (mirror) turn_winding(mesh);
  if (!had_normals) return;
  fill_normals(mesh);
  wind_by_normals(mesh);  // an uneven scale can move the sum of three normals to the other side
}

std::ifstream open_bytes(const std::string& path) {
  std::error_code ignored;
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  if (std::filesystem::is_directory(path, ignored)) throw Error(fmt::format("{}: is not a file", path));
  return in;
}

std::string read_bytes(const std::string& path) {
  std::error_code ignored;
  std::ifstream in = open_bytes(path);
  std::string bytes;
  const auto size = std::filesystem::file_size(path, ignored);
  bytes.resize(ignored ? 0 : size);
  in.read(bytes.data(), std::streamsize(bytes.size()));
  bytes.resize(size_t(in.gcount()));
  return bytes;
}

namespace {

// Polygons of more corners are not looked at: that takes their cube in time.
constexpr size_t most_corners = 256;

// Whether the triangles of a fan all turn as it does on the whole, whose normal is n.
bool is_fan(const Mesh& mesh, std::span<const uint32_t> c, const dvec3& n) {
  for (size_t i = 2; i < c.size(); ++i)
    if (glm::dot(face_cross(mesh, {c[0], c[i - 1], c[i]}), n) < 0) return false;
  return true;
}

bool is_inside(const Mesh& mesh, const glm::uvec3& t, const dvec3& n, const dvec3& p) {
  for (int k = 0; k < 3; ++k) {
    const dvec3 a(mesh.positions[t[k]]), b(mesh.positions[t[(k + 1) % 3]]);
    if (p == a || glm::dot(glm::cross(b - a, p - a), n) < 0) return false;
  }
  return true;
}

glm::uvec3 around(std::span<const uint32_t> c, size_t i) {
  return {c[(i + c.size() - 1) % c.size()], c[i], c[(i + 1) % c.size()]};
}

// A corner whose triangle lies in the polygon and holds no other corner; the first where there is none.
size_t find_ear(const Mesh& mesh, std::span<const uint32_t> c, const dvec3& n) {
  const auto holds_none = [&](const glm::uvec3& t) {
    return std::none_of(c.begin(), c.end(),
                        [&](uint32_t v) { return is_inside(mesh, t, n, dvec3(mesh.positions[v])); });
  };
  for (size_t i = 0; i < c.size(); ++i)
    if (const glm::uvec3 t = around(c, i); glm::dot(face_cross(mesh, t), n) > 0 && holds_none(t)) return i;
  return 0;
}

// Ear by ear (Meisters 1975, Polygons Have Ears).
void add_concave(Mesh& mesh, std::vector<uint32_t> c, const dvec3& n) {
  while (c.size() > 3) {
    const size_t i = find_ear(mesh, c, n);
    mesh.triangles.push_back(around(c, i));
    c.erase(c.begin() + std::ptrdiff_t(i));
  }
  mesh.triangles.push_back({c[0], c[1], c[2]});
}

}  // namespace

void add_polygon(Mesh& mesh, std::span<const uint32_t> c) {
  if (c.size() == 4) {
    const glm::uvec3 a(c[0], c[1], c[2]), b(c[0], c[2], c[3]);
    if (glm::dot(face_cross(mesh, a), face_cross(mesh, b)) < 0) {  // a reflex corner at c[1] or c[3]
      mesh.triangles.insert(mesh.triangles.end(), {{c[1], c[2], c[3]}, {c[1], c[3], c[0]}});
      return;
    }
  }
  if (c.size() > 4 && c.size() <= most_corners) {
    dvec3 n(0);  // twice the area
    for (size_t i = 2; i < c.size(); ++i) n += face_cross(mesh, {c[0], c[i - 1], c[i]});
    if (!is_fan(mesh, c, n)) return add_concave(mesh, {c.begin(), c.end()}, n);
  }
  for (size_t i = 2; i < c.size(); ++i) mesh.triangles.push_back({c[0], c[i - 1], c[i]});
}

Vec2 finite_or_zero(const Vec2& uv) { return std::isfinite(uv.x) && std::isfinite(uv.y) ? uv : Vec2(0); }

void complete(Mesh& mesh, const MeshOptions& options, const std::string& name) {
  if (mesh.positions.size() >= none || mesh.triangles.size() >= none)
    throw Error(fmt::format("{}: more than 2^32 - 2 vertices or triangles; split the mesh", name));
  for (const glm::uvec3& t : mesh.triangles)
    if (std::max(t.x, std::max(t.y, t.z)) >= mesh.positions.size())
      throw Error(fmt::format("{}: triangle {} names a vertex beyond the last of {}; is the file whole?", name,
                              &t - mesh.triangles.data(), mesh.positions.size()));
  const bool anew = options.max_smooth_angle >= 0;
  if (options.face_normals || anew) mesh.normals.clear();
  const bool own_normals = !mesh.normals.empty();
  for (Vec2& uv : mesh.uvs) {
    uv = finite_or_zero(uv);
    if (options.flip_v) uv.y = 1 - uv.y;
  }
  for (const Rgb& c : mesh.colors)
    if (!finite(c))
      throw Error(
          fmt::format("{}: the colour of vertex {} is not finite; repair the mesh", name, &c - mesh.colors.data()));
  for (const Vec3& p : mesh.positions)
    if (!finite(p))
      throw Error(fmt::format("{}: vertex {} is not finite; repair the mesh", name, &p - mesh.positions.data()));
  for (Vec3& n : mesh.normals)
    if (!try_normalize(n)) n = Vec3(0);

  const bool mirror = move(mesh, options.to_world);
  if (mirror && options.keeps_side) turn_winding(mesh);
  for (const Vec3& p : mesh.positions)
    if (!finite(p))
      throw Error(fmt::format("{}: the to_world transform moves vertex {} beyond the range of numbers", name,
                              &p - mesh.positions.data()));
  if (options.face_normals) {
    if (options.flip_normals) turn_winding(mesh);
    return;
  }
  if (anew)
    split_sharp_edges(mesh, options.max_smooth_angle);
  else if (!own_normals)
    mesh.normals.assign(mesh.positions.size(), Vec3(0));
  fill_normals(mesh);
  if (options.flip_normals)
    for (Vec3& n : mesh.normals) n = -n;
  wind_by_normals(mesh);
}

}  // namespace ajar
