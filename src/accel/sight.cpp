#include "ajar/accel/sight.h"

namespace ajar {

bool first_seen(const Scene& scene, const Accel& accel, CameraRay ray, Hit& hit) {
  if (scene.camera.lamps != Lamps::gone) return accel.intersect(ray.o, ray.d, ray.t_min, ray.t_max, hit);
  Hit next;
  while (accel.intersect(ray.o, ray.d, ray.t_min, ray.t_max, next)) {
    if (!is_passed(scene, next.shape)) {
      hit = next;
      return true;
    }
    ray.t_min = std::nextafter(next.t, infinity);  // rounding could make the same hit lie beyond its own t
  }
  return false;
}

bool camera_sees(const Scene& scene, const Accel& accel, const Vec3& o, const Vec3& d, float t_max) {
  if (!accel.occluded(o, d, t_max)) return true;
  Hit hit;
  return scene.camera.lamps == Lamps::gone && !first_seen(scene, accel, {o, d, 0, t_max}, hit);
}

}  // namespace ajar
