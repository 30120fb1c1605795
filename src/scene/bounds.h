// Enters: points, shapes, boxes under a transform.
// Leaves: their axis-aligned boxes.
#pragma once

#include "ajar/core/parallel.h"
#include "ajar/scene/motion.h"
#include "ajar/scene/scene.h"

namespace ajar {

constexpr size_t grain = 16384;

// Joins what f(from, to) gives for blocks of [0, n), in their order.
template <class T, class F, class Join>
T reduce(size_t n, T value, const F& f, const Join& join) {
  std::vector<T> parts((n + grain - 1) / grain);
  parallel_for(parts.size(), [&](size_t b) { parts[b] = f(b * grain, std::min(n, (b + 1) * grain)); });
  for (const T& part : parts) value = join(value, part);
  return value;
}

Box box_of(const std::vector<Vec3>& points);
/// Of a quadric.
Box box_of(const Shape& shape);
Box box_of(const Mat4& m, const Box& box);

/// Of a scene: of every shape as it is (in its group, where it is in one), of every instance, and of all that is seen.
struct Boxes {
  std::vector<Box> shapes, instances;
  Box all;
};
Boxes boxes_of(const Scene& scene);

}  // namespace ajar
