#include "ajar/field/strata.h"

namespace ajar {
namespace {

// Last stratum whose cumulative share does not exceed x; those of share 0 are passed over. Without branches.
int find(const StrataNode& node, uint32_t x) {
  int i = 0;
  for (int j = 1; j < 16; ++j) i += node.before[j] <= x;
  return i;
}

}  // namespace

float density(const std::vector<StrataNode>& nodes, uint32_t root, const Vec2& at) {
  float d = 1;
  Vec2 inside = at;
  for (const StrataNode* node = &nodes[root];;) {
    const int i = descend(inside);
    d *= float(node->steps(i)) * 0x1p-12f;
    if (!node->is_divided(i)) return d;
    node = &nodes[node->child(i)];
  }
}

Vec2 sample(const std::vector<StrataNode>& nodes, uint32_t root, const Vec2& u, float& density) {
  double x = double(u.x) * 65536;
  Vec2 corner(0);
  float width = 1;
  density = 1;
  for (const StrataNode* node = &nodes[root];;) {
    const int i = find(*node, uint32_t(x));
    const uint32_t steps = node->steps(i);
    x = (x - node->before[i]) / steps;
    density *= float(steps) * 0x1p-12f;
    width *= 0.25f;
    corner += width * Vec2(i & 3, i >> 2);
    if (!node->is_divided(i)) break;
    node = &nodes[node->child(i)];
    x *= 65536;
  }
  // Rounding must not carry the point over into the next stratum, whose density is another.
  return glm::min(corner + width * Vec2(float(x), u.y), (corner + width) * one_minus_epsilon);
}

}  // namespace ajar
