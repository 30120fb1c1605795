// Enters: a whole path, as points, light and camera.
// Leaves: all its densities, computed afresh from these, for the oracle's weights.
#pragma once

#include "ajar/path/walk.h"
#include "kit/oracle.h"

namespace ajar {

// A vertex of a whole path, x_0 on the light .. x_k on the lens, with all that densities need.
struct Point {
  Vec3 p{0}, ng{0};
  Surface surface;
  bool delta = false;
};

struct WholePath {
  const Fields* fields = nullptr;
  LightPoint light;      // x_0; Point 0 is not used when it is infinite
  Vec3 travel{0, 0, 1};  // of the light at x_0
  std::vector<Point> points;
  int next_events = 1;  // rays to lights from the vertex after x_0
};

kit::OraclePath densities_afresh(const Scene& scene, const WholePath& path, const SampleCounts& counts,
                                 const Merging& merging);

}  // namespace ajar
