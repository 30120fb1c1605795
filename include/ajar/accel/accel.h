// Enters: a finished scene; rays.
// Leaves: hits and occlusion. Embree stays behind this header.
#pragma once

#include <memory>

#include "ajar/scene/scene.h"

namespace ajar {

/// Ray-tracing structure over a scene, which must outlive it, stay where it is, and keep its shapes, meshes and
/// materials unchanged. Safe to query from many threads. What a shape's masks let pass is not there (cutout.h).
class Accel {
 public:
  /// Throws Error where the scene is not finished, and when the ray tracer refuses (memory).
  explicit Accel(const Scene& scene);
  ~Accel();
  Accel(Accel&&) noexcept;
  Accel& operator=(Accel&&) noexcept;

  /// Nearest hit with t in (t_min, t_max); hit is written only when there is one. The ray tracer ends the program for
  /// rays that are none: o must be within `farthest` of the origin, d not longer than 10^9, t_min 0 or more.
  bool intersect(const Vec3& o, const Vec3& d, float t_min, float t_max, Hit& hit) const;
  /// Whether anything lies on o + t d, t in (0, t_max). o and d as above.
  bool occluded(const Vec3& o, const Vec3& d, float t_max) const;
  /// Whether it may be of this scene: of as many shapes, with as many triangles in the same places, as far as some of
  /// their corners tell, and as many instances.
  bool fits(const Scene& scene) const;
  /// Bytes held by the structure.
  size_t bytes() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
  void* top_ = nullptr;  // the top-level scene, one indirection closer for the hot path
  uint32_t first_instance_ = 0;
  // Rays are that many times as long to the ray tracer, which takes hits of triangles for their first corner where
  // twice the area, times the cosine, times the ray's length is below 1e-18. A power of two: distances stay exact.
  float stretch_ = 0x1p30f;
};

}  // namespace ajar
