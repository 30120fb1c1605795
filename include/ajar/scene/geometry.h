// Enters: hits, shapes and random numbers.
// Leaves: differential geometry at hits, points drawn uniformly on shapes, and ray origins that do not hit their own
// surface.
#pragma once

#include "ajar/scene/scene.h"

namespace ajar {

/// Differential geometry of a hit. The position comes from the surface (barycentrics, quadric), not from t. Meshes: ng
/// is on the side from which the triangle's vertices run counter-clockwise, in instances as in the group (mirrored or
/// not). set_surface writes over all of out, where a walk keeps it.
void set_surface(const Scene& scene, const Hit& hit, const Vec3& ray_o, const Vec3& ray_d, Surface& out);
inline Surface make_surface(const Scene& scene, const Hit& hit, const Vec3& ray_o, const Vec3& ray_d) {
  Surface surface;
  set_surface(scene, hit, ray_o, ray_d, surface);
  return surface;
}
/// (u, v) of a hit, as textures read them.
Vec2 texture_point(const Scene& scene, uint32_t shape, uint32_t prim, const Vec2& bary);
/// A point uniform by area on a shape that emits; u in [0,1)^2. pdf is the exact density per area, area_pdf of the same
/// point; 0 where the shape has no area. Fills p, error, ng, uv, shape, prim, and of meshes bary. (Cylinders under a
/// transform that is not a similarity about their axis: uniform in angle and height, with the area density that this
/// has.)
Surface sample_area(const Scene& scene, uint32_t shape, const Vec2& u, float& pdf);
/// The same on one triangle of a mesh.
Surface sample_triangle(const Scene& scene, uint32_t shape, uint32_t prim, const Vec2& u, float& pdf);
/// Density per area with which sample_area finds this point.
float area_pdf(const Scene& scene, uint32_t shape, uint32_t prim, const Vec2& uv);
/// World area of a shape [m^2]; of one in a shapegroup, the group's.
double area(const Scene& scene, uint32_t shape);
/// Area of a triangle of a mesh, never NaN.
float triangle_area(const Mesh& mesh, uint32_t triangle);
/// Whether axes stay equal in length and at right angles, to a share of their length.
bool is_similarity(const glm::dmat4& m, double tolerance = 1e-4);
/// By how much a turn may be off that was written with three decimals.
inline constexpr double off_by_rounding = 2e-3;
/// (u, v) of a point of a sphere, as hits have them: u = azimuth / (2 pi) about the object's z, v = polar angle / pi.
Vec2 sphere_uv(const Shape& sphere, const Vec3& p);
/// Vertices, normal and error of a triangle, computed afresh.
PackedTriangle pack_triangle(const Mesh& mesh, uint32_t triangle);
/// Surface::error of a point computed on a quadric by its transform.
float position_error(const Shape& quadric, const Vec3& p);
/// Ray origin off the surface, on the side of direction d.
inline Vec3 offset(const Vec3& p, const Vec3& ng, float error, const Vec3& d) {
  return p + ng * (glm::dot(ng, d) < 0 ? -error : error);
}

}  // namespace ajar
