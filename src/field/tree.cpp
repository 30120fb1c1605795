#include "tree.h"

#include <numbers>

#include "fixed.h"

namespace ajar {
namespace {

// Integral of x^2 / (x^2 + y^2) over [0, x] x [0, y] without what depends on one of them alone.
double antiderivative(double x, double y) {
  return 0.5 * (x * x * std::atan2(y, x) + x * y - y * y * std::atan2(x, y));
}

// Area of the projected hemisphere under a stratum: [corner, corner + width] of the unit square. Those of one level add
// up to pi. The map stretches by max(x, y)^2 / (x^2 + y^2), x and y from -1 to 1; no stratum lies on an axis, and one
// that a diagonal divides is cut in two equal halves by it.
double exact_area(const Vec2& corner, float width) {
  const glm::dvec2 a = glm::abs(2.0 * glm::dvec2(corner) - 1.0),
                   b = glm::abs(2.0 * (glm::dvec2(corner) + double(width)) - 1.0);
  glm::dvec2 from = glm::min(a, b), to = glm::max(a, b);
  if (from.y > from.x) std::swap(from.x, from.y), std::swap(to.x, to.y);
  if (from.x == from.y)
    return std::numbers::pi / 4 * (sqr(to.x) - sqr(from.x)) -
           2 * (antiderivative(to.x, from.y) - antiderivative(from.x, from.y));
  return antiderivative(to.x, to.y) - antiderivative(from.x, to.y) - antiderivative(to.x, from.y) +
         antiderivative(from.x, from.y);
}

// The same; of small strata, whose areas hardly differ from their neighbours', from four points.
float stratum_area(const Vec2& corner, float width) {
  constexpr int across = 16;
  static const std::vector<float> exact = [] {
    std::vector<float> areas;
    for (const int n : {4, across})
      for (int i = 0; i < n * n; ++i) areas.push_back(float(exact_area(Vec2(i % n, i / n) / float(n), 1 / float(n))));
    return areas;
  }();
  const int n = int(1 / width);
  if (n <= across) {
    const size_t at = size_t(corner.y * float(n)) * size_t(n) + size_t(corner.x * float(n));
    return exact[n == across ? 16 + at : at];
  }
  float sum = 0;
  for (int i = 0; i < 4; ++i) {
    const Vec2 a = 2.0f * (corner + width * Vec2(0.25f + 0.5f * float(i & 1), 0.25f + 0.5f * float(i >> 1))) - 1.0f;
    const float m = std::max(std::abs(a.x), std::abs(a.y));
    sum += m * m / glm::dot(a, a);
  }
  return sum * width * width;  // x 4 for the square's area, / 4 samples
}

// Fills the masses of a node and all below it; returns their sum.
float weigh_strata(Tree& tree, int32_t at, const Vec2& corner, float width, float floor) {
  float sum = 0;
  for (int i = 0; i < 16; ++i) {
    const float w = width / 4;
    const Vec2 c = corner + w * Vec2(i & 3, i >> 2);
    const int32_t child = tree[size_t(at)].child[i];
    const float mass =
        child >= 0 ? weigh_strata(tree, child, c, w, floor) : (tree[size_t(at)].mean[i] + floor) * stratum_area(c, w);
    tree[size_t(at)].mass[i] = mass;
    sum += mass;
  }
  return sum;
}

// The same for patches; returns irradiance over all of them. The grid's masses are without the cosine, as Comi's.
float weigh_patches(Tree& tree, float floor, Structure structure) {
  float sum = 0;
  for (int zone = no_zones; zone < 16; ++zone) {
    const float cosine = patch_cosine(zone);
    TreeNode& child = tree[size_t(tree[0].child[zone])];
    float radiance = 0;
    for (int i = no_segments; i < 16; ++i) radiance += child.mass[i] = child.mean[i] + floor;
    tree[0].mass[zone] = radiance * (structure == Structure::grid ? patch_angle : cosine);
    sum += radiance * cosine;
  }
  return sum;
}

// Share of a stratum's evidence that its parts begin with: what it is alone is no evidence that they are alike, and
// their own first records are to tell them apart.
constexpr float inherited = 0.1f;  // (G10)
// Where nothing is ever forgotten, what a stratum is remains the mean of all its records, those before it was divided
// too.
float inherited_by(const LearnOptions& options) { return options.forget < 1 ? inherited : 1; }

// How many records a stratum of a level got, by their weights: those of narrow strata weigh little, since many
// directions are drawn there.
constexpr float least_records = 8;
float records_in(float weight, float share, int level, float mix) {
  const float even = std::ldexp(1.0f, -4 * (level + 1));
  return weight * (1 - mix + mix * share / even);
}

void reshape(Tree& tree, int32_t at, int level, float total, const LearnOptions& options, bool divides) {
  for (int i = 0; i < 16; ++i) {
    const float share = tree[size_t(at)].mass[i] / total;
    const int32_t child = tree[size_t(at)].child[i];
    if (child >= 0) {
      if (share > 0.4f * options.divide_stratum) {
        reshape(tree, child, level + 1, total, options, divides);
        continue;
      }
      float mean = 0, weight = 0;
      bool leaf = true;
      for (int j = 0; j < 16; ++j) {
        leaf = leaf && tree[size_t(child)].child[j] < 0;
        mean += tree[size_t(child)].mean[j] / 16, weight += tree[size_t(child)].weight[j];
      }
      if (!leaf) continue;
      TreeNode& mine = tree[size_t(at)];
      mine.child[i] = -1, mine.mean[i] = mean, mine.weight[i] = weight;
    } else if (divides && share > options.divide_stratum && level + 1 < most_levels &&
               records_in(tree[size_t(at)].weight[i], share, level, options.mix) >= least_records) {
      const int32_t fresh = int32_t(tree.size());
      tree.emplace_back();
      TreeNode& mine = tree[size_t(at)];
      TreeNode& part = tree.back();
      for (int j = 0; j < 16; ++j)
        part.mean[j] = mine.mean[i], part.weight[j] = inherited_by(options) * mine.weight[i] / 16, part.child[j] = -1;
      mine.child[i] = fresh;
    }
  }
}

// before: share of the field's node; now: share of the tree's node at `at`.
double difference(const Field& field, uint32_t node, double before, const Tree& tree, int32_t at, double now) {
  const TreeNode& mine = tree[size_t(at)];
  double mass = 0, sum = 0;
  for (const float m : mine.mass) mass += double(m);
  for (int i = 0; i < 16; ++i) {
    const double was = before * field.nodes[node].steps(i) / 65536;
    const double is = mass > 0 ? now * double(mine.mass[i]) / mass : 0;
    const bool leaf = mine.child[i] < 0;
    sum +=
        leaf ? 0.5 * std::abs(was - is) : difference(field, field.nodes[node].child(i), was, tree, mine.child[i], is);
  }
  return sum;
}

// First place in use of a node of patches.
int first_of(Structure structure, bool is_root) {
  return structure == Structure::adaptive ? 0 : is_root ? no_zones : no_segments;
}

// Writes shares in steps of 2^-16; every stratum gets one at least, but those before the first one in use.
void quantise(const TreeNode& from, int first, StrataNode& to) {
  float sum = 0;
  for (const float m : from.mass) sum += m;
  double before = 0;
  uint32_t last = 0;
  for (int i = 0; i < 16; ++i) {
    to.before[i] = uint16_t(last);
    if (i < first) continue;
    before += from.mass[i];
    const uint32_t next =
        uint32_t(sum > 0 ? std::lround(before / sum * 65536) : 65536 * (i + 1 - first) / (16 - first));
    last = std::clamp(next, last + 1, 65536u - uint32_t(15 - i));
  }
}

// Blank strata.
void add_strata(Field& field, Structure structure) {
  const bool patches = structure != Structure::adaptive;
  const size_t root = field.nodes.size();
  field.nodes.resize(root + (patches ? 1 + zones : 1));
  for (size_t i = root; i < field.nodes.size(); ++i) quantise({}, first_of(structure, i == root), field.nodes[i]);
  if (patches)
    field.nodes[root].divided = uint16_t(0xffff << no_zones), field.nodes[root].children = uint32_t(root + 1);
  field.mean.resize(16 * field.nodes.size());
  field.weight.resize(16 * field.nodes.size());
}

}  // namespace

int32_t take(const Field& field, const Tallies& tallies, float forget, uint32_t node, Tree& tree) {
  const int32_t at = int32_t(tree.size());
  tree.emplace_back();
  for (int i = 0; i < 16; ++i) {
    const size_t k = 16 * size_t(node) + size_t(i);
    if (field.nodes[node].is_divided(i)) {
      const int32_t child = take(field, tallies, forget, field.nodes[node].child(i), tree);
      tree[size_t(at)].child[i] = child;
      continue;
    }
    const float fresh = float(double(tallies.weight[k]) * weight_step), kept = forget * field.weight[k];
    const float sum = kept + fresh;
    float mean = field.mean[k];
    if (fresh > 0) {
      const double value = double(tallies.value[k]) * value_step * field.unit / fresh;
      mean += float((value - mean) * (fresh / sum));  // (G3)
    }
    TreeNode& mine = tree[size_t(at)];
    mine.child[i] = -1;
    mine.mean[i] = mean;
    mine.weight[i] = fresh > 0 ? sum : float(field.weight[k]);
  }
  return at;
}

float weigh(Tree& tree, Structure structure, float floor) {
  if (structure == Structure::adaptive) return weigh_strata(tree, 0, Vec2(0), 1, floor);
  return weigh_patches(tree, floor, structure);
}

float most_radiance(const Tree& tree) {
  float most = 0;
  for (const TreeNode& n : tree)
    for (int i = 0; i < 16; ++i)
      if (n.child[i] < 0) most = std::max(most, n.mean[i]);
  return most;
}

float evidence(const Tree& tree) {
  float sum = 0;
  for (const TreeNode& n : tree)
    for (int i = 0; i < 16; ++i) sum += n.child[i] < 0 ? n.weight[i] : 0;
  return sum;
}

float contrast(const Tree& tree) {
  double sum = 0, squares = 0;
  for (const TreeNode& n : tree)
    for (int i = 0; i < 16; ++i)
      if (n.child[i] < 0) sum += double(n.mass[i]), squares += double(n.mass[i]) * double(n.mean[i]);
  return sum > 0 ? float(std::numbers::pi * squares / (sum * sum)) : 1;
}

void reshape(Tree& tree, float total, const LearnOptions& options, bool divides) {
  reshape(tree, 0, 0, total, options, divides);
}

double difference(const Field& field, uint32_t node, const Tree& tree) {
  return difference(field, node, 1, tree, 0, 1);
}

uint32_t append(Trees& out, const Tree& tree, Structure structure) {
  const uint32_t root = uint32_t(out.nodes.size());
  std::vector<int32_t> order = {0};
  for (size_t k = 0; k < order.size(); ++k) {
    const TreeNode& from = tree[size_t(order[k])];
    StrataNode to;
    quantise(from, first_of(structure, k == 0), to);
    to.children = root + uint32_t(order.size());
    for (int i = 0; i < 16; ++i) {
      if (from.child[i] >= 0) to.divided |= uint16_t(1u << i), order.push_back(from.child[i]);
      out.mean.push_back(from.child[i] >= 0 ? 0 : from.mean[i]);
      out.weight.push_back(from.child[i] >= 0 ? 0 : from.weight[i]);
    }
    out.nodes.push_back(to);
  }
  return root;
}

uint32_t append_evidence(Trees& out, const Tree& tree, const Field& field, uint32_t node) {
  const uint32_t root = append(out, tree, Structure::adaptive);
  std::vector<uint32_t> order = {node};
  for (size_t k = 0; k < order.size(); ++k) {
    const StrataNode& from = field.nodes[order[k]];
    std::copy(std::begin(from.before), std::end(from.before), std::begin(out.nodes[root + k].before));
    for (int i = 0; i < 16; ++i)
      if (from.is_divided(i)) order.push_back(from.child(i));
  }
  return root;
}

void add_cell(Field& field, uint32_t from, Structure structure) {
  FieldCell cell;
  cell.root = uint32_t(field.nodes.size());
  if (from == none) {
    add_strata(field, structure);
  } else {
    const FieldCell& parent = field.cells[from];
    const uint32_t shift = cell.root - parent.root;
    std::vector<uint32_t> order = {parent.root};
    for (size_t k = 0; k < order.size(); ++k) {
      StrataNode node = field.nodes[order[k]];
      for (int i = 0; i < 16; ++i) {
        if (node.is_divided(i)) order.push_back(node.child(i));
        field.mean.push_back(field.mean[16 * size_t(order[k]) + size_t(i)]);
        field.weight.push_back(0.25f * field.weight[16 * size_t(order[k]) + size_t(i)]);
      }
      node.children += shift;
      field.nodes.push_back(node);
    }
    const uint32_t root = cell.root;
    cell = parent;
    cell.root = root;
  }
  field.cells.push_back(cell);
}

}  // namespace ajar
