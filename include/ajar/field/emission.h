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
/// How a camera subpath would have sent a ray the other way: from a vertex, with a density per solid angle, in which
/// the choice of the light is. Without a vertex: not at all.
struct WayBack {
  const Guide* guide = nullptr;
  double pdf = 0;
};
/// What a light subpath that started here is expected to bring (Promise of its first vertex that scatters, of all that
/// was emitted and of one watt; 0 where it came to none).
void record_start(const Scene& scene, const Fields& fields, Training& training, const EmissionSample& start,
                  float brings, float per_watt, const WayBack& way);
/// A free ray of a camera subpath to an infinite light, in direction wi: how a light subpath would have come to its
/// vertex, so what it would have taught. through: what glass on the way passes of it; count: rays that the vertex sent.
void record_start(const Scene& scene, const Fields& fields, Training& training, const LightPoint& point, const Vec3& wi,
                  const WayBack& way, float through, int count);

}  // namespace ajar
