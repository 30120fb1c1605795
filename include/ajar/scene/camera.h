// Enters: a sensor description.
// Leaves: camera rays, and the connection of a point to the camera with the raster density that it needs.
#pragma once

#include "ajar/core/vec.h"

namespace ajar {

enum class CameraKind : uint8_t { perspective, thinlens, orthographic };

/// Along what the field of view was given; smaller and larger: of the film's sides.
enum class ViewAxis : uint8_t { x, y, smaller, larger, diagonal };

/// What the camera itself sees of lights: what they emit; their shapes, but nothing that is emitted; or neither, as if
/// it looked through them. What surfaces show of them is the same.
enum class Lamps : uint8_t { seen, dark, gone };

/// Raster coordinates are in pixels of the full image, (0,0) the upper left corner; x right, y down.
struct Camera {
  CameraKind kind = CameraKind::perspective;
  ViewAxis axis = ViewAxis::x;  ///< keeps its extent in set_size
  Mat4 to_world{1};  ///< camera space: looks along +z, y up, x to the *left* in the image (Mitsuba's convention)
  Mat4 to_camera{1};
  int width = 768, height = 576;  ///< full film
  int crop_x = 0, crop_y = 0, crop_width = 768, crop_height = 576;
  Vec2 plane{1, 1};      ///< half extent of the image at camera-space depth 1 (perspective) or absolute (orthographic)
  Vec2 principal{0, 0};  ///< principal point offset, fraction of the full width and height; moves the image left and up
  float aperture = 0;    ///< thinlens: radius
  float focus = 1;       ///< thinlens: distance to the plane in focus
  float near_clip = 0, far_clip = infinity;  ///< camera-space depth; near may be negative when orthographic
  Lamps lamps = Lamps::seen;
};

/// Of the crop window, which alone is rendered.
inline double pixels_of(const Camera& camera) { return double(camera.crop_width) * camera.crop_height; }
/// Whether light that comes to the lens by so many edges from where it was emitted is in the image.
inline bool shows_lights(const Camera& c, int edges) { return edges > 1 || c.lamps == Lamps::seen; }

struct CameraRay {
  Vec3 o{0};
  Vec3 d{0, 0, 1};                    ///< unit
  float t_min = 0, t_max = infinity;  ///< from the clip planes
};

/// A point seen by the camera. factor: raster area [pixels] per unit of area *perpendicular to w* at the point; so the
/// area density of camera rays at a surface point is factor * |cos(ng, w)| per sample and pixel, and what a light
/// vertex gives the film is beta * f * |cos(ns, w)| * factor.
struct CameraConnection {
  Vec3 p{0};  ///< on the lens; orthographic: on the near clip plane
  Vec3 w{0};  ///< from the point to the lens, unit
  Vec2 raster{0};
  float factor = 0;
};

/// Ray through a raster position; lens in [0,1)^2 is used by thinlens alone.
CameraRay generate(const Camera& camera, const Vec2& raster, const Vec2& lens);
/// A point in camera space.
Vec3 in_camera(const Camera& camera, const Vec3& x);
/// Connects a point to the camera; false where it is behind the camera, outside the clip planes or farther than margin
/// pixels outside the crop window.
bool connect(const Camera& camera, const Vec3& x, const Vec2& lens, float margin, CameraConnection& out);
/// factor of CameraConnection for a camera ray's own hit at x, seen from o on the lens.
float raster_factor(const Camera& camera, const Vec3& o, const Vec3& x);
/// Sets plane, to_world and to_camera from a field of view in degrees along x, between 0 and 180 (see docs/scenes.md
/// for the other axes), and the film's width and height, which must be set before. to_world may be any invertible
/// affine map. finish refuses what is neither. An orthographic camera becomes a perspective one; a lens, clip planes
/// and the principal point stay.
void set_perspective(Camera& camera, float fov_x_degrees, const Mat4& to_world);
/// The same for an orthographic camera: the image is 2 wide in camera space, so to_world's scale gives its size.
void set_orthographic(Camera& camera, const Mat4& to_world);
/// Another size in pixels: what the view spans along camera.axis stays, the rest follows, a crop window is dropped.
/// Throws Error for less than a pixel either way.
void set_size(Camera& camera, int width, int height);

}  // namespace ajar
