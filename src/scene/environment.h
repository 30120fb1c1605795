// Enters: an image map over the sphere, directions.
// Leaves: its radiance, samples and densities in the light's own space. Private to the room.
#pragma once

#include "ajar/scene/scene.h"

namespace ajar {

/// Radiance from unit local direction w.
Rgb environment_radiance(const Scene& scene, const Environment& e, const Vec3& w);
/// Density per solid angle of sample_environment at unit local direction w; finite.
float environment_pdf(const Environment& e, const Vec3& w);
/// Draws a unit local direction; pdf 0 where none was found.
Vec3 sample_environment(const Environment& e, Vec2 u, float& pdf);
/// Integral of the luminance over all local directions.
double environment_total(const Environment& e);

}  // namespace ajar
