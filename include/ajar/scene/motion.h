// Enters: a scene at two times.
// Leaves: where its surfaces moved between them.
#pragma once

#include "ajar/scene/scene.h"

namespace ajar {

struct Box {
  Vec3 lo{infinity}, hi{-infinity};
  bool empty() const { return !(lo.x <= hi.x); }
  void add(const Vec3& p) { lo = glm::min(lo, p), hi = glm::max(hi, p); }
  void add(const Box& b) { lo = glm::min(lo, b.lo), hi = glm::max(hi, b.hi); }
};

inline bool overlap(const Box& a, const Box& b) {
  return glm::all(glm::lessThanEqual(a.lo, b.hi)) && glm::all(glm::lessThanEqual(b.lo, a.hi));
}

/// Boxes about what is not where it was, one for each shape or instance, of where it was and where it is. Scenes with
/// different numbers of shapes or instances: one box about everything.
std::vector<Box> find_motion(const Scene& before, const Scene& after);

}  // namespace ajar
