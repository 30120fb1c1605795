#include "ajar/scene/camera.h"

#include <fmt/format.h>

#include "ajar/core/error.h"
#include "ajar/core/warp.h"

namespace ajar {
namespace {

// Image position in units of the plane's half extent, x left and y up, and its inverse.
Vec2 to_plane(const Camera& c, const Vec2& raster) {
  return {1 - 2 * (raster.x / float(c.width) + c.principal.x), 1 - 2 * (raster.y / float(c.height) + c.principal.y)};
}
Vec2 to_raster(const Camera& c, const Vec2& on_plane) {
  return {((1 - on_plane.x) * 0.5f - c.principal.x) * float(c.width),
          ((1 - on_plane.y) * 0.5f - c.principal.y) * float(c.height)};
}

Vec3 lens_point(const Camera& c, const Vec2& lens) {
  return c.kind == CameraKind::thinlens ? Vec3(to_disk(lens) * c.aperture, 0) : Vec3(0);
}

float volume(const Mat4& m) { return std::abs(glm::dot(Vec3(m[0]), glm::cross(Vec3(m[1]), Vec3(m[2])))); }

// Pixels per unit of camera-space area in the image plane.
float pixel_density(const Camera& c) { return float(c.width) * float(c.height) / (4 * c.plane.x * c.plane.y); }

// A step dq in the plane of depth 1 turns the ray q = (qx, qy, 1) by |M|/|M q|^3 dq in world solid angle, where M is
// the linear part of to_world; |M q| is the distance over the depth. So pixels per area perpendicular to the ray are
// density / (|M| / |M q|^3) / distance^2. (No cube of the depth: it would leave the range of floats from 7e12 and below
// 1e-13.)
float perspective_factor(const Camera& c, float distance, float depth) {
  return depth > 0 ? pixel_density(c) / volume(c.to_world) * (distance / depth) / depth / depth : 0;
}

// A step in the image plane moves a ray by an area |Mx, My, Mz/|Mz|| perpendicular to it.
float orthographic_factor(const Camera& c) {
  return pixel_density(c) * std::sqrt(length2(Vec3(c.to_world[2]))) / volume(c.to_world);
}

// From camera-space o along q, whose depth is 1.
CameraRay make_ray(const Camera& c, const Vec3& o, const Vec3& q) {
  const Vec3 d = map_vector(c.to_world, q);
  const float per_depth = std::sqrt(length2(d));
  return {map_point(c.to_world, o), d / per_depth, (c.near_clip - o.z) * per_depth, (c.far_clip - o.z) * per_depth};
}

void set_matrices(Camera& c, const Mat4& to_world) {
  c.to_world = to_world;
  c.to_camera = inverse(to_world);
}

}  // namespace

CameraRay generate(const Camera& c, const Vec2& raster, const Vec2& lens) {
  const Vec2 at = to_plane(c, raster) * c.plane;
  if (c.kind == CameraKind::orthographic) return make_ray(c, Vec3(at, c.near_clip), Vec3(0, 0, 1));
  const Vec3 o = lens_point(c, lens);
  return make_ray(c, o, Vec3(at - Vec2(o) / c.focus, 1));
}

// From the eye: far from the origin the sums of a map from world coordinates would cancel.
Vec3 in_camera(const Camera& c, const Vec3& x) { return map_vector(c.to_camera, x - Vec3(c.to_world[3])); }

bool connect(const Camera& c, const Vec3& x, const Vec2& lens, float margin, CameraConnection& out) {
  const Vec3 local = in_camera(c, x);
  const bool parallel = c.kind == CameraKind::orthographic;
  if (!((parallel || local.z > 0) && local.z >= c.near_clip && local.z <= c.far_clip)) return false;
  const Vec3 o = parallel ? Vec3(Vec2(local), c.near_clip) : lens_point(c, lens);
  const Vec2 at = parallel ? Vec2(local) : Vec2(o) / c.focus + (Vec2(local) - Vec2(o)) / local.z;
  out.raster = to_raster(c, at / c.plane);
  const Vec2 low = Vec2(float(c.crop_x), float(c.crop_y)) - margin;
  const Vec2 high = Vec2(float(c.crop_x + c.crop_width), float(c.crop_y + c.crop_height)) + margin;
  if (!(out.raster.x >= low.x && out.raster.x <= high.x && out.raster.y >= low.y && out.raster.y <= high.y))
    return false;
  out.p = map_point(c.to_world, o);
  const Vec3 between = out.p - x;
  const float distance = std::sqrt(length2(between));
  if (!(distance > 0)) return false;
  out.w = between / distance;
  out.factor = parallel ? orthographic_factor(c) : perspective_factor(c, distance, local.z);
  return out.factor < infinity;
}

float raster_factor(const Camera& c, const Vec3& o, const Vec3& x) {
  if (c.kind == CameraKind::orthographic) return orthographic_factor(c);
  const Vec3 between = x - o;
  const float depth = map_vector(c.to_camera, between).z;
  return perspective_factor(c, std::sqrt(length2(between)), depth);
}

void set_perspective(Camera& c, float fov_x_degrees, const Mat4& to_world) {
  const float x = fov_x_degrees < 180 ? float(std::tan(double(fov_x_degrees) * std::numbers::pi / 360)) : infinity;
  if (c.kind == CameraKind::orthographic) c.kind = CameraKind::perspective;
  c.plane = {x, x * float(c.height) / float(c.width)};
  set_matrices(c, to_world);
}

void set_orthographic(Camera& c, const Mat4& to_world) {
  c.kind = CameraKind::orthographic;
  c.plane = {1, float(c.height) / float(c.width)};
  set_matrices(c, to_world);
}

void set_size(Camera& camera, int width, int height) {
  if (width < 1 || height < 1)
    throw Error(fmt::format("set_size: an image of {}x{} pixels is none; give it one or more each way", width, height));
  // half extents of a view of square pixels; shape is what the camera's transform stretches them by
  const double x = camera.plane.x, shape = double(camera.plane.y) * camera.width / (x * camera.height);
  const double y = camera.plane.y / shape;
  double per_pixel = x / width;
  switch (camera.axis) {
    case ViewAxis::x:
      break;
    case ViewAxis::y:
      per_pixel = y / height;
      break;
    case ViewAxis::smaller:
      per_pixel = std::min(x, y) / std::min(width, height);
      break;
    case ViewAxis::larger:
      per_pixel = std::max(x, y) / std::max(width, height);
      break;
    case ViewAxis::diagonal:
      per_pixel = std::hypot(x, y) / std::hypot(width, height);
      break;
  }
  camera.plane = {float(width * per_pixel), float(height * per_pixel * shape)};
  camera.width = camera.crop_width = width;
  camera.height = camera.crop_height = height;
  camera.crop_x = camera.crop_y = 0;
}

}  // namespace ajar
