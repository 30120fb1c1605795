// Enters: an area light and the point that it is seen from.
// Leaves: points on the shape with their solid-angle density there, and what they emit. Private to the room.
#pragma once

#include "ajar/scene/geometry.h"
#include "ajar/scene/texture.h"

namespace ajar {

struct ShapeSample {
  Surface at;  ///< p, error, ng, shape, prim; uv (and bary) where the light is textured
  Vec3 wi{0};  ///< from x to the point, unit
  float distance = 0;
  float pdf = 0;  ///< per solid angle at x
};

/// A point of a rectangle whose emitting side faces x: point (but for its light), wi, distance and pdf of out.
bool sample_rectangle(const Rectangle& rectangle, const Vec3& x, const Vec2& u, DirectSample& out);
/// A point of another area light whose emitting side faces x; false where this sample gives none.
bool sample_shape(const Scene& scene, const Light& light, const Vec3& x, const Vec2& u, ShapeSample& out);
/// Density per solid angle at x with which sample_shape finds this point, which lies along unit wi.
float shape_pdf(const Scene& scene, const Light& light, const LightPoint& point, const Vec3& x, const Vec3& wi);
/// A point of an area light uniform by area; pdf per area, 0 where the light has none.
Surface sample_light_area(const Scene& scene, const Light& light, const Vec2& u, float& pdf);
/// Density per area with which sample_light_area finds this point.
float light_area_pdf(const Scene& scene, const Light& light, const LightPoint& point);
/// The point of light `light` that a surface shows.
inline LightPoint point_of(const Surface& at, uint32_t light) {
  LightPoint p;
  p.p = at.p, p.error = at.error, p.n = at.ng, p.uv = at.uv, p.light = light, p.prim = at.prim;
  return p;
}
/// Radiance that an area light emits there, on its emitting side.
inline Rgb radiance_at(const Scene& scene, const Light& light, const Surface& at) {
  return light.textured ? eval(scene, light.radiance, at) : light.radiance.value;
}
/// The rectangle that a mesh is; area 0 if it is none.
Rectangle rectangle_of(const Mesh& mesh);

}  // namespace ajar
