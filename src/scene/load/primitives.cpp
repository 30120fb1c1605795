#include <array>

#include "mesh.h"

namespace ajar {

Mesh make_rectangle() {
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {2, 3, 0}};
  return mesh;
}

Mesh make_cube() {
  // Where uv is (0, 0), and which way u and v grow: facts of the format, as textured scenes rely on them. All of them
  // are left-handed (cross(u, v) points inwards), hence the winding.
  struct Face {
    Vec3 corner, u, v;
  };
  constexpr float a = -1, b = 1, d = 2;
  const std::array<Face, 6> faces{{{{a, a, a}, {0, 0, d}, {d, 0, 0}},
                                   {{b, b, b}, {-d, 0, 0}, {0, 0, -d}},
                                   {{b, a, b}, {0, d, 0}, {0, 0, -d}},
                                   {{a, a, b}, {0, d, 0}, {d, 0, 0}},
                                   {{a, a, a}, {0, d, 0}, {0, 0, d}},
                                   {{a, b, a}, {0, -d, 0}, {d, 0, 0}}}};
  Mesh mesh;
  for (const auto& [corner, u, v] : faces) {
    const uint32_t i = uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {corner, corner + u, corner + u + v, corner + v});
    mesh.uvs.insert(mesh.uvs.end(), {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    mesh.triangles.insert(mesh.triangles.end(), {{i, i + 2, i + 1}, {i, i + 3, i + 2}});
  }
  return mesh;
}

Mesh make_sphere(int rings, int segments) {
  rings = std::max(rings, 2), segments = std::max(segments, 3);
  Mesh mesh;
  for (int r = 0; r <= rings; ++r)
    for (int s = 0; s <= segments; ++s) {
      const double v = double(r) / rings, u = double(s % segments) / segments;
      const double theta = v * std::numbers::pi, phi = u * 2 * std::numbers::pi;
      const bool pole = r == 0 || r == rings;
      const double sine = pole ? 0 : std::sin(theta);
      const Vec3 p(sine * std::cos(phi), sine * std::sin(phi), std::cos(theta));
      mesh.positions.push_back(p);
      mesh.normals.push_back(p);
      // At a pole u has no value: the middle of the one triangle that uses this vertex.
      const double middle = r == 0 ? -0.5 : pole ? 0.5 : 0;
      mesh.uvs.push_back(Vec2((s + middle) / segments, v));
    }
  const auto at = [&](int r, int s) { return uint32_t(r * (segments + 1) + s); };
  for (int r = 0; r < rings; ++r)
    for (int s = 0; s < segments; ++s) {
      if (r > 0) mesh.triangles.push_back({at(r, s), at(r + 1, s), at(r, s + 1)});
      if (r + 1 < rings) mesh.triangles.push_back({at(r, s + 1), at(r + 1, s), at(r + 1, s + 1)});
    }
  return mesh;
}

}  // namespace ajar
