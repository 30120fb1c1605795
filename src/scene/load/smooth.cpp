#include "smooth.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "ajar/core/error.h"

namespace ajar {
namespace {

using glm::dvec3;

// Below this a sum of weighted unit normals is cancellation, not a direction.
constexpr double cancelled = 1e-9;

double angle_at(const Mesh& mesh, const glm::uvec3& t, int corner) {
  const dvec3 p(mesh.positions[t[corner]]), a = dvec3(mesh.positions[t[(corner + 1) % 3]]) - p,
                                            b = dvec3(mesh.positions[t[(corner + 2) % 3]]) - p;
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

// Unit normal of a face, zero where it has no area.
dvec3 face_normal(const Mesh& mesh, const glm::uvec3& t) {
  const dvec3 n = face_cross(mesh, t);
  const double length = glm::length(n);
  return length > 0 ? n / length : dvec3(0);
}

bool missing(const Vec3& normal) { return normal == Vec3(0); }

// For each vertex the first one (in some fixed order) at the same position.
std::vector<uint32_t> weld(const std::vector<Vec3>& positions) {
  std::vector<uint32_t> order(positions.size()), first(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](uint32_t i) { return std::array{positions[i].x, positions[i].y, positions[i].z}; };
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const auto ka = key(a), kb = key(b);
    return ka != kb ? ka < kb : a < b;
  });
  for (size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && key(order[i - 1]) == key(order[i]) ? first[order[i - 1]] : order[i];
  return first;
}

// Corners (3 * triangle + corner) that share one normal.
struct Fans {
  std::vector<uint32_t> parent;

  explicit Fans(size_t corners) : parent(corners) { std::iota(parent.begin(), parent.end(), 0u); }
  uint32_t root(uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) {
    a = root(a), b = root(b);
    parent[std::max(a, b)] = std::min(a, b);
  }
};

// An edge of a triangle, its ends as welded vertices in ascending order, and the corners at those ends.
struct Edge {
  uint32_t low, high, low_corner, high_corner;
  bool operator<(const Edge& o) const {
    return std::array{low, high, low_corner} < std::array{o.low, o.high, o.low_corner};
  }
};

std::vector<Edge> sorted_edges(const Mesh& mesh) {
  const std::vector<uint32_t> welded = weld(mesh.positions);
  std::vector<Edge> edges;
  edges.reserve(mesh.triangles.size() * 3);
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3;
      const uint32_t a = welded[mesh.triangles[t][k]], b = welded[mesh.triangles[t][l]];
      const uint32_t at_a = 3 * t + uint32_t(k), at_b = 3 * t + uint32_t(l);
      edges.push_back(a < b ? Edge{a, b, at_a, at_b} : Edge{b, a, at_b, at_a});
    }
  std::sort(edges.begin(), edges.end());
  return edges;
}

Fans find_fans(const Mesh& mesh, const std::vector<dvec3>& normals, float max_angle) {
  Fans fans(mesh.triangles.size() * 3);
  // The slack lets coplanar faces, whose normals differ by rounding, pass at an angle of 0.
  const double threshold = std::cos(std::min(double(max_angle), 180.0) * std::numbers::pi / 180) - 1e-9;
  const std::vector<Edge> edges = sorted_edges(mesh);
  for (size_t i = 1; i < edges.size(); ++i) {
    const Edge &e = edges[i - 1], &f = edges[i];
    if (e.low != f.low || e.high != f.high) continue;
    if (glm::dot(normals[e.low_corner / 3], normals[f.low_corner / 3]) < threshold) continue;
    fans.join(e.low_corner, f.low_corner);
    fans.join(e.high_corner, f.high_corner);
  }
  return fans;
}

}  // namespace

void fill_normals(Mesh& mesh) {
  if (std::none_of(mesh.normals.begin(), mesh.normals.end(), missing)) return;
  std::vector<dvec3> sums(mesh.positions.size(), dvec3(0));
  for (const glm::uvec3& t : mesh.triangles) {
    const dvec3 n = face_normal(mesh, t);
    if (n == dvec3(0)) continue;
    for (int k = 0; k < 3; ++k)
      if (missing(mesh.normals[t[k]])) sums[t[k]] += n * angle_at(mesh, t, k);
  }
  for (size_t i = 0; i < sums.size(); ++i)
    if (const double length = glm::length(sums[i]); missing(mesh.normals[i]) && length > cancelled)
      mesh.normals[i] = Vec3(sums[i] / length);
  for (const glm::uvec3& t : mesh.triangles)
    for (int k = 0; k < 3; ++k)
      if (Vec3& n = mesh.normals[t[k]]; missing(n)) n = Vec3(face_normal(mesh, t));
  for (Vec3& n : mesh.normals)
    if (missing(n)) n = {0, 0, 1};
}

void split_sharp_edges(Mesh& mesh, float max_angle) {
  if (mesh.triangles.size() > 0xffffffffu / 3)
    throw Error("max_smooth_angle: more than 2^32 / 3 triangles; split the mesh");
  std::vector<dvec3> normals(mesh.triangles.size());
  std::transform(mesh.triangles.begin(), mesh.triangles.end(), normals.begin(),
                 [&](const glm::uvec3& t) { return face_normal(mesh, t); });
  Fans fans = find_fans(mesh, normals, max_angle);

  // A new vertex for each pair of fan and old vertex (a fan has several of these at seams of the texture coordinates).
  struct Corner {
    uint32_t fan, vertex, corner;
  };
  std::vector<Corner> corners(mesh.triangles.size() * 3);
  std::vector<dvec3> sums(corners.size(), dvec3(0));  // by the fan's root
  for (uint32_t i = 0; i < corners.size(); ++i) {
    const glm::uvec3& t = mesh.triangles[i / 3];
    corners[i] = {fans.root(i), t[int(i % 3)], i};
    sums[corners[i].fan] += normals[i / 3] * angle_at(mesh, t, int(i % 3));
  }
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    return std::array{a.vertex, a.fan, a.corner} < std::array{b.vertex, b.fan, b.corner};
  });

  Mesh out;
  out.triangles.resize(mesh.triangles.size());
  for (const Attribute& a : mesh.attributes)
    out.attributes.push_back({a.name, a.of_faces, a.of_faces ? a.values : std::vector<Rgb>()});
  for (size_t i = 0; i < corners.size(); ++i) {
    const auto [fan, vertex, corner] = corners[i];
    if (i == 0 || corners[i - 1].vertex != vertex || corners[i - 1].fan != fan) {
      const double length = glm::length(sums[fan]);
      out.positions.push_back(mesh.positions[vertex]);
      out.normals.push_back(length > cancelled ? Vec3(sums[fan] / length) : Vec3(0));
      if (!mesh.uvs.empty()) out.uvs.push_back(mesh.uvs[vertex]);
      if (!mesh.colors.empty()) out.colors.push_back(mesh.colors[vertex]);
      for (size_t k = 0; k < mesh.attributes.size(); ++k)
        if (!mesh.attributes[k].of_faces) out.attributes[k].values.push_back(mesh.attributes[k].values[vertex]);
    }
    out.triangles[corner / 3][int(corner % 3)] = uint32_t(out.positions.size() - 1);
  }
  mesh = std::move(out);
}

}  // namespace ajar
