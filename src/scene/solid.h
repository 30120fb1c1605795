// Enters: an emitting shape and the point that it is seen from.
// Leaves: points on the shape with their solid-angle density there. Private to the room.
#pragma once

#include "ajar/scene/geometry.h"

namespace ajar {

/// A point of the shape whose emitting side faces x; false where this sample gives none. uv: whether at.uv is needed.
bool sample_shape(const Scene& scene, uint32_t shape, bool uv, const Vec3& x, const Vec2& u, Surface& at, Vec3& wi,
                  float& distance, float& pdf);
/// Density per solid angle at x with which sample_shape finds this point, which lies along unit wi.
float shape_pdf(const Scene& scene, uint32_t shape, const LightPoint& point, const Vec3& x, const Vec3& wi);

}  // namespace ajar
