// Enters: what a ray hit.
// Leaves: the hit's names (Hit) and its differential geometry (Surface), made by make_surface in scene/geometry.h.
#pragma once

#include "ajar/core/frame.h"

namespace ajar {

inline constexpr uint32_t none = 0xffffffffu;

/// What the ray tracer found: names only. t is in units of the ray direction's length.
struct Hit {
  float t = infinity;
  uint32_t shape = none;     ///< index into Scene::shapes
  uint32_t prim = 0;         ///< triangle of a mesh; 0 for quadrics
  uint32_t instance = none;  ///< index into Scene::instances
  Vec2 bary{0};              ///< mesh: weights of the triangle's 2nd and 3rd vertex; quadrics: their (u, v)
};

/// A point on a surface, world space. Directions are unit length; ng is the shape's own outward side, never turned to
/// the ray. frame.n is the shading normal and lies on ng's side.
struct Surface {
  Vec3 p{0};
  float error = 0;  ///< offset along ng that leaves the surface: scales with position and size
  Vec3 ng{0, 0, 1};
  Frame frame;
  Vec2 uv{0};
  Vec2 bary{0};
  Vec3 dpdu{0};  ///< not normalised; zero where the mesh has no useful texture coordinates, or Shape::tangents is off
  Vec3 dpdv{0};
  uint32_t shape = none;
  uint32_t prim = 0;
  uint32_t instance = none;
};

}  // namespace ajar
