// Enters: rays of the camera, points that it may see.
// Leaves: what they hit and whether it is seen, past the shapes of lights where the camera sees none (Camera::lamps).
#pragma once

#include "ajar/accel/accel.h"

namespace ajar {

/// Whether the camera itself sees through a shape.
inline bool is_passed(const Scene& scene, uint32_t shape) {
  return scene.camera.lamps == Lamps::gone && scene.shapes[shape].light != none;
}

/// Nearest hit that the camera sees; hit is written only when there is one.
bool first_seen(const Scene& scene, const Accel& accel, CameraRay ray, Hit& hit);
/// Whether the camera sees along o + t d, t in (0, t_max), from one end to the other.
bool camera_sees(const Scene& scene, const Accel& accel, const Vec3& o, const Vec3& d, float t_max);

}  // namespace ajar
