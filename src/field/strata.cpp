#include "ajar/field/strata.h"

namespace ajar {
namespace {

// Last stratum whose cumulative share does not exceed x; those of share 0 are passed over. Without branches: the row,
// then the place in it.
int find(const StrataNode& node, uint32_t x) {
  const auto starts = [&](int i) { return int(node.before[i] <= x); };
  const int row = 4 * (starts(4) + starts(8) + starts(12));
  return row + starts(row + 1) + starts(row + 2) + starts(row + 3);
}

// Stratum for x in [0, 65536); x becomes the place within it, in [0, 1), and share is multiplied by the stratum's.
int choose(const StrataNode& node, double& x, float& share) {
  const int i = find(node, uint32_t(x));
  const uint32_t steps = node.steps(i);
  x = (x - node.before[i]) / steps;
  share *= float(steps) * 0x1p-16f;
  return i;
}

}  // namespace

Vec2 sample(const std::vector<StrataNode>& nodes, uint32_t root, const Vec2& u, float& density) {
  double x = double(u.x) * 65536;
  Vec2 corner(0);
  float width = 1;
  density = 1;
  for (const StrataNode* node = &nodes[root];;) {
    const int i = choose(*node, x, density);
    density *= 16;
    width *= 0.25f;
    corner += width * Vec2(i & 3, i >> 2);
    if (!node->is_divided(i)) break;
    node = &nodes[node->child(i)];
    x *= 65536;
  }
  // Rounding must not carry the point over into the next stratum, whose density is another.
  return glm::min(corner + width * Vec2(float(x), u.y), (corner + width) * one_minus_epsilon);
}

float patch_density(const std::vector<StrataNode>& nodes, uint32_t root, const Vec3& local) {
  const Patch at = patch_of(local);
  const StrataNode& node = nodes[root];
  return float(node.steps(at.zone)) * float(nodes[node.child(at.zone)].steps(at.segment)) * (0x1p-32f / patch_angle);
}

Vec3 sample_patch(const std::vector<StrataNode>& nodes, uint32_t root, const Vec2& u, float& density) {
  double x = double(u.x) * 65536;
  density = 1 / patch_angle;
  const int zone = choose(nodes[root], x, density);
  x *= 65536;
  const int segment = choose(nodes[nodes[root].child(zone)], x, density);
  const float phi = 2 * pi * (float(segment - no_segments) + std::min(float(x), one_minus_epsilon)) / segments;
  const float z = (float(zone - no_zones) + u.y) / zones, r = safe_sqrt(1 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

}  // namespace ajar
