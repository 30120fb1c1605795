// Enters: sizes and colours of small test scenes.
// Leaves: the scenes, as the loader would have made them, and the parts to build others.
#pragma once

#include "ajar/scene/scene.h"

namespace ajar::kit {

uint32_t add(Scene& scene, const Material& material);
uint32_t add_diffuse(Scene& scene, const Rgb& reflectance);
/// Parallelogram with corner, corner + u, corner + v; its normal is u x v. Two triangles with texture coordinates.
uint32_t add_quad(Scene& scene, const Vec3& corner, const Vec3& u, const Vec3& v, uint32_t material);
uint32_t add_mesh(Scene& scene, Mesh mesh, uint32_t material);
uint32_t add_quadric(Scene& scene, ShapeKind kind, const Mat4& to_world, uint32_t material);
uint32_t add_sphere(Scene& scene, const Vec3& centre, float radius, uint32_t material);
/// Sphere of triangles with n x 2n faces and smooth normals, which lean by bend times their true direction towards y.
Mesh globe(const Vec3& centre, float radius, int n, float bend = 0);
uint32_t emit(Scene& scene, uint32_t shape, const Slot& radiance);
uint32_t add_light(Scene& scene, LightKind kind, const Slot& radiance);
/// Image texture of the given pixels (3 channels, row 0 on top) behind a slot.
Slot add_texture(Scene& scene, int width, int height, std::vector<float> rgb);
Mat4 look_at(const Vec3& eye, const Vec3& target);
void look(Scene& scene, const Vec3& eye, const Vec3& target, float fov_x_degrees, int width, int height);

/// Floor, back wall, red left and green right wall of the cube [-1, 1]^3, open above and towards the camera at z = +4,
/// which sees all of it. Materials are 60 % grey unless given.
void add_open_room(Scene& scene, uint32_t floor_material = none);
void add_ceiling(Scene& scene);
/// Downward square of the given half width just below y = 0.98.
uint32_t add_lamp(Scene& scene, float half, const Slot& radiance);

/// The usual stage of the statistical tests: room, ceiling and lamp, size x size pixels, box filter. finish() is still
/// to be called.
Scene stage(int size = 24);

}  // namespace ajar::kit
