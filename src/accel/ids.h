// Enters: a scene's shapes, in groups or outside of them.
// Leaves: the numbers that the ray tracer knows them by, and the way back.
#pragma once

#include <vector>

#include "ajar/scene/scene.h"

namespace ajar {

/// Of shapes outside of groups their own numbers; in each group they are counted from 0, since the ray tracer holds
/// memory for every number up to a group's largest.
struct GeometryIds {
  std::vector<uint32_t> of_shape;
  std::vector<uint32_t> first;   ///< by group: where its shapes begin in
  std::vector<uint32_t> shapes;  ///< group by group, in the order of their numbers
};
GeometryIds number_geometries(const Scene& scene);

}  // namespace ajar
