// Enters: a ray in the space of a unit quadric.
// Leaves: its nearest hit between two parameters. In double: the ray may start far away or graze.
#pragma once

#include "ajar/scene/scene.h"

namespace ajar {

/// Nearest t in (t_min, t_max) where o + t d meets the unit object, and that point p. d need not be unit.
bool intersect_quadric(ShapeKind kind, const glm::dvec3& o, const glm::dvec3& d, double t_min, double t_max, double& t,
                       glm::dvec3& p);
/// The (u, v) of a point of the unit object that Hit::bary stores. Shadow rays do not ask for it.
Vec2 quadric_uv(ShapeKind kind, const glm::dvec3& p);

}  // namespace ajar
