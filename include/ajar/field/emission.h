// Enters: lights, and the field W.
// Leaves: starts of light subpaths whose direction W guides, with densities (docs/method.md, "Two learned fields").
#pragma once

#include "ajar/field/fields.h"
#include "ajar/scene/light.h"

namespace ajar {

/// As in scene/light.h, for lights of any kind; only area lights are guided. fields may be null: then it is the same.
bool sample_emission(const Scene& scene, const Fields* fields, uint32_t light, const Vec2& u_position,
                     const Vec2& u_direction, EmissionSample& out);
EmissionPdf pdf_emission(const Scene& scene, const Fields* fields, const LightPoint& point, const Vec3& direction);

}  // namespace ajar
