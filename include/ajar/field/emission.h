// Enters: lights, and the field W.
// Leaves: starts of light subpaths: lights, points, and directions that W guides, with densities (docs/method.md, "Many
// lights", "Two learned fields").
#pragma once

#include "ajar/field/training.h"
#include "ajar/scene/light.h"

namespace ajar {

struct Guide;

/// Draws one of the scene's lights, a point and a direction. The densities include the choice, in that of position or,
/// for infinite lights, of direction. fields may be null.
bool sample_emission(const Scene& scene, const Fields* fields, float u_choice, const Vec2& u_position,
                     const Vec2& u_direction, EmissionSample& out);
/// The same densities; for infinite lights point.p is any point of the ray.
EmissionPdf pdf_emission(const Scene& scene, const Fields* fields, const LightPoint& point, const Vec3& direction);
/// What a light subpath that started here is expected to bring (Promise of its first vertex, of all that was emitted
/// and of one watt; 0 where it hit nothing). straight: that vertex, where nothing lies between; null else.
void record_start(const Scene& scene, const Fields& fields, Training& training, const EmissionSample& start,
                  float brings, float per_watt, const Guide* straight);
/// A free ray of next-event estimation to an infinite light, one of count that a camera vertex sent: how a light
/// subpath would have come there, so what it would have taught. pdf: of wi, the choice of the light included.
void record_start(const Scene& scene, const Fields& fields, Training& training, const Guide& guide,
                  const LightPoint& point, const Vec3& wi, double pdf, int count);

}  // namespace ajar
