#include "ids.h"

namespace ajar {

GeometryIds number_geometries(const Scene& scene) {
  GeometryIds ids;
  std::vector<uint32_t> count(scene.groups, 0);
  for (uint32_t i = 0; i < scene.shapes.size(); ++i) {
    const uint32_t group = scene.shapes[i].group;
    ids.of_shape.push_back(group == none ? i : count[group]++);
  }
  uint32_t before = 0;
  for (const uint32_t n : count) ids.first.push_back(before), before += n;
  ids.shapes.resize(before);
  for (uint32_t i = 0; i < scene.shapes.size(); ++i)
    if (const uint32_t group = scene.shapes[i].group; group != none) ids.shapes[ids.first[group] + ids.of_shape[i]] = i;
  return ids;
}

}  // namespace ajar
