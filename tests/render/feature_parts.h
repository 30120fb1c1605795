// Enters: nothing.
// Leaves: what the scenes of several features are made of; the features themselves, by what they are about.
#pragma once

#include "features.h"
#include "kit/stage.h"

namespace ajar {

Scene finished(Scene scene);
Material of_kind(MaterialKind kind);
Material rough(MaterialKind kind, Microfacet distribution, float alpha_u, float alpha_v);
Material glass();
/// A material around one or two others.
uint32_t nest(Scene& scene, MaterialKind kind, uint32_t first, uint32_t second = none);
/// The usual room with a sphere of this material in it.
Scene with_sphere(const Material& material, float radius = 0.45f);
Scene with_rough_sphere(MaterialKind kind, Microfacet distribution, float alpha_u, float alpha_v);
/// Room without lamp and ceiling, whose opening the camera does not see.
Scene open_stage();

std::span<const Feature> features_of_materials();
std::span<const Feature> features_of_lights();
std::span<const Feature> features_of_cameras();

}  // namespace ajar
