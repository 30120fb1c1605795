// Enters: sizes and colours of small test scenes.
// Leaves: the scenes, as the loader would have made them; ajar/scene/build.h has the parts to make others.
#pragma once

#include "ajar/scene/build.h"

namespace ajar::kit {

/// Sphere of triangles with n x 2n faces and smooth normals, which lean by bend times their true direction towards y.
Mesh globe(const Vec3& centre, float radius, int n, float bend = 0);

/// Floor, back wall, red left and green right wall of the cube [-1, 1]^3, open above and towards the camera at z = +4,
/// which sees all of it. Materials are 60 % grey unless given.
void add_open_room(Scene& scene, uint32_t floor_material = none);
void add_ceiling(Scene& scene);
/// Paper: of what falls on it three fifths are let through, scattered evenly, the rest meets a matt grey.
uint32_t add_paper(Scene& scene, const Rgb& reflectance);
/// Downward square of the given half width just below y = 0.98.
uint32_t add_lamp(Scene& scene, float half, const Slot& radiance);

/// The usual stage of the statistical tests: room, ceiling and lamp, size x size pixels, box filter. finish() is still
/// to be called.
Scene stage(int size = 24);

/// The closed box [-1, 1]^3 in two halves with paper between them at x = 0, the lamp in that of negative x, the camera
/// in the other one. Finished.
Scene lit_through_paper();

/// A closed box of 4 x 2 x 4, seen from within, with a hole of 0.8 x 0.8 in its lid, on dark ground that reaches so far
/// in all directions, under a light of the kind (infinite): the further, the fewer light subpaths come in. Finished.
Scene under_a_lid(LightKind kind, float ground, int size);

}  // namespace ajar::kit
