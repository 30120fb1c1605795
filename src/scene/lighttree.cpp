#include "ajar/scene/lighttree.h"

#include <algorithm>
#include <cmath>

#include "ajar/core/warp.h"
#include "lightpieces.h"

namespace ajar {
namespace {

// Measure of the directions that a cone of normals and what goes out around them covers (Conty Estevez and Kulla 2018,
// equation 1).
double solid_measure(const LightBounds& b) {
  const double spread = std::acos(double(b.cos_spread)), reach = std::acos(double(b.cos_reach));
  const double all = std::min(spread + reach, std::numbers::pi);
  return 2 * std::numbers::pi * (1 - std::cos(spread)) + std::numbers::pi / 2 *
                                                             (2 * all * std::sin(spread) - std::cos(spread - 2 * all) -
                                                              2 * spread * std::sin(spread) + std::cos(spread));
}

double surface(const LightBounds& b) {
  const glm::dvec3 d = glm::max(glm::dvec3(b.high) - glm::dvec3(b.low), glm::dvec3(0));
  return d.x * d.y + d.y * d.z + d.z * d.x + 1e-9 * glm::dot(d, d);
}

double cost(const LightBounds& b) { return b.weight > 0 ? b.weight * surface(b) * solid_measure(b) : 0; }

struct Builder {
  LightTree& tree;
  std::vector<BoundedPiece>& pieces;
  bool sky = false;  // few infinite lights: each is a node

  Vec3 middle(size_t i) const { return ajar::middle(pieces[i].bounds); }
};

// Bins of equal width along the longest axis of a range's middles.
constexpr int bins = 16;
struct Binning {
  int axis = 0;
  float low = 0, size = 0;

  int bin_of(const LightBounds& b) const { return std::clamp(int((middle(b)[axis] - low) / size * bins), 0, bins - 1); }
};

Binning bin_range(const Builder& b, size_t from, size_t to) {
  Vec3 low(infinity), high(-infinity);
  for (size_t i = from; i < to; ++i) low = glm::min(low, b.middle(i)), high = glm::max(high, b.middle(i));
  const Vec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return {axis, low[axis], size[axis]};
}

// The last bin below the best place to divide, by the surface and orientation measure; -1 where nothing divides.
int best_bin(const Builder& b, size_t from, size_t to, const Binning& binning) {
  LightBounds of[bins], below, above[bins];
  for (size_t i = from; i < to; ++i) {
    LightBounds& in = of[binning.bin_of(b.pieces[i].bounds)];
    in = join(in, b.pieces[i].bounds);
  }
  for (int k = bins - 1; k > 0; --k) above[k - 1] = join(of[k], above[k]);
  int best = -1;
  double least = infinity;
  for (int k = 0; k + 1 < bins; ++k) {
    below = join(below, of[k]);
    const double c = cost(below) + cost(above[k]);
    if (below.weight > 0 && above[k].weight > 0 && c < least) least = c, best = k;
  }
  return best;
}

// The middle of a range, about which it is put in order along an axis.
size_t halve(Builder& b, size_t from, size_t to, int axis) {
  const auto at = [&](size_t i) { return b.pieces.begin() + ptrdiff_t(i); };
  const size_t half = (from + to) / 2;
  std::nth_element(at(from), at(half), at(to), [&](const BoundedPiece& p, const BoundedPiece& q) {
    const float x = p.bounds.low[axis] + p.bounds.high[axis], y = q.bounds.low[axis] + q.bounds.high[axis];
    return x != y                           ? x < y
           : p.piece.light != q.piece.light ? p.piece.light < q.piece.light
                                            : p.piece.part < q.piece.part;
  });
  return half;
}

// Where to divide a range, which is put in order for it: few infinite lights one from another, all else by bins, or in
// the middle where these do not divide it.
size_t divide(Builder& b, size_t from, size_t to) {
  const auto at = [&](size_t i) { return b.pieces.begin() + ptrdiff_t(i); };
  if (const uint32_t light = b.pieces[from].piece.light;
      b.sky && b.pieces[from].infinite && b.pieces[to - 1].piece.light != light) {
    while (b.pieces[from].piece.light == light) ++from;
    return from;
  }
  const Binning binning = bin_range(b, from, to);
  if (!(binning.size > 0)) return (from + to) / 2;
  const int best = best_bin(b, from, to, binning);
  const auto is_below = [&](const BoundedPiece& p) { return binning.bin_of(p.bounds) <= best; };
  const size_t middle = size_t(std::stable_partition(at(from), at(to), is_below) - b.pieces.begin());
  return middle > from && middle < to ? middle : halve(b, from, to, binning.axis);
}

// Cosine of the angle a - b, at least 0; both in [0, pi].
float cos_of_difference(float sin_a, float cos_a, float sin_b, float cos_b) {
  return cos_a > cos_b ? 1 : cos_a * cos_b + sin_a * sin_b;
}
float sin_of(float cos) { return safe_sqrt(1 - cos * cos); }

void set_node(const LightBounds& b, bool infinite, LightNode& n) {
  n.infinite = infinite;
  n.axis = b.axis, n.cos_spread = b.cos_spread, n.sin_spread = sin_of(b.cos_spread), n.cos_reach = b.cos_reach;
  n.weight = float(std::min(b.weight, 1e38));
  n.center = middle(b);
  n.radius = infinite ? 0 : radius_of(b) * 1.0001f + 1e-6f * max_abs(n.center);
}

LightBounds build(Builder& b, uint32_t node, size_t from, size_t to, int depth) {
  b.tree.nodes[node].first = uint32_t(from), b.tree.nodes[node].last = uint32_t(to);
  LightBounds bounds = b.pieces[from].bounds;
  if (to - from > 1) {
    const size_t middle = depth < 64 ? divide(b, from, to) : (from + to) / 2;
    const uint32_t left = uint32_t(b.tree.nodes.size());
    b.tree.nodes.resize(left + 2);
    b.tree.nodes[node].left = left;
    const LightBounds first = build(b, left, from, middle, depth + 1);
    bounds = join(first, build(b, left + 1, middle, to, depth + 1));
  }
  set_node(bounds, b.pieces[from].infinite, b.tree.nodes[node]);
  return bounds;
}

// Of lamps, then of infinite pieces, under one root where there are both; returns the root of the infinite ones.
uint32_t build_nodes(Builder& b, size_t lamps) {
  LightTree& t = b.tree;
  const size_t all = b.pieces.size();
  t.nodes.reserve(2 * all);
  t.nodes.resize(1);
  if (lamps == 0 || lamps == all) {
    build(b, 0, 0, all, 0);
    return 0;
  }
  constexpr uint32_t near = 1, sky = 2;
  t.nodes.resize(3);
  const LightBounds of_lamps = build(b, near, 0, lamps, 0), of_sky = build(b, sky, lamps, all, 0);
  set_node(join(of_lamps, of_sky), false, t.nodes[0]);
  t.nodes[0].left = near, t.nodes[0].first = 0, t.nodes[0].last = uint32_t(all);
  return sky;
}

// Makes room for the places of all pieces of each light, those too that give nothing.
void count_pieces(const std::vector<BoundedPiece>& pieces, size_t lights, LightTree& t) {
  t.first_piece.assign(lights + 1, 0);
  for (const BoundedPiece& p : pieces) ++t.first_piece[p.piece.light + 1];
  for (size_t i = 0; i < lights; ++i) t.first_piece[i + 1] += t.first_piece[i];
  t.place.assign(pieces.size(), none);
}

// How many lights the pieces from one on are of.
size_t count_lights(const std::vector<BoundedPiece>& pieces, size_t from) {
  size_t count = 0;
  for (size_t i = from; i < pieces.size(); ++i)
    count += i == from || pieces[i].piece.light != pieces[i - 1].piece.light ? 1 : 0;
  return count;
}

// Pieces in the order of the nodes, what powers are before each, and where each light's are.
void put_pieces(const std::vector<BoundedPiece>& pieces, LightTree& t) {
  for (size_t i = 0; i < pieces.size(); ++i) {
    const LightPiece& p = pieces[i].piece;
    t.pieces.push_back(p);
    t.power_before.push_back(t.power_before.back() + pieces[i].watts);
    t.place[t.first_piece[p.light] + (p.part == none ? 0 : p.part)] = uint32_t(i);
  }
}

// The nodes that hold the infinite pieces between them, divided by power until there are enough.
void set_regions(LightTree& t, uint32_t root) {
  t.regions = {root};
  while (t.regions.size() < most_regions_of_sky) {
    size_t worst = t.regions.size();
    double most = 0;
    for (size_t i = 0; i < t.regions.size(); ++i) {
      const LightNode& n = t.nodes[t.regions[i]];
      const double want = std::sqrt(power_of(t, n.first, n.last) * (1 - double(n.cos_spread)));
      if (n.left != 0 && want > most) most = want, worst = i;
    }
    if (worst == t.regions.size()) break;
    const uint32_t left = t.nodes[t.regions[worst]].left;
    t.regions[worst] = left;
    t.regions.push_back(left + 1);
  }
  for (uint32_t r = 0; r < t.regions.size(); ++r)
    for (uint32_t i = t.nodes[t.regions[r]].first; i < t.nodes[t.regions[r]].last; ++i) t.region[i] = r;
}

// The lights of a scene that has no other ones than a few infinite ones.
void set_sky(LightTree& t) {
  for (uint32_t node = 0; node < t.nodes.size(); ++node) {
    const LightNode& n = t.nodes[node];
    const auto light = [&](uint32_t place) { return t.pieces[place].light; };
    const bool whole = light(n.first) == light(n.last - 1) && (n.first == 0 || light(n.first - 1) != light(n.first)) &&
                       (n.last == t.pieces.size() || light(n.last) != light(n.first));
    if (!whole) continue;
    const bool tiled = t.tiling[light(n.first)] != none;
    const float share = t.nodes[0].weight > 0 ? n.weight / t.nodes[0].weight : 1;
    t.sky.push_back({light(n.first), n.first, n.last, node, share, !tiled});
  }
}

// What the sky's lights count for the receiver; their sum.
float weigh_sky(const LightTree& t, const Receiver& at, float out[most_sky]) {
  const bool turns = at.n != Vec3(0) && (t.choice == LightChoice::tree || t.choice == LightChoice::learned);
  float sum = 0;
  for (size_t i = 0; i < t.sky.size(); ++i) {
    const SkyLight& s = t.sky[i];
    out[i] = s.share;
    if (turns && s.turned) {
      const LightNode& n = t.nodes[s.node];
      out[i] *= glm::dot(at.n, n.axis) > -n.sin_spread ? 1 : 1e-4f;
    }
    sum += out[i];
  }
  return sum;
}

// What a child gets at least that promises anything: promises know nothing of walls.
constexpr float least_child = 0.01f;

// Probability of the left child; negative where neither can be.
float left_share(const LightTree& tree, const LightNode& n, const Receiver& at) {
  const float x = importance(tree, n.left, at), y = importance(tree, n.left + 1, at);
  const float sum = x + y;
  if (!(sum > 0)) return -1;
  return x > 0 && y > 0 ? std::clamp(x / sum, least_child, 1 - least_child) : x / sum;
}

// Tiles of one light below a node are chosen by power: they are alike to a receiver, and the walk would take longer
// than the choice saves.
bool is_by_power(const LightTree& tree, const LightNode& n) {
  return n.infinite && tree.pieces[n.first].part != none && tree.pieces[n.last - 1].light == tree.pieces[n.first].light;
}
float share_below(const LightTree& tree, const LightNode& n, uint32_t place) {
  return float(power_of(tree, place, place + 1) / power_of(tree, n.first, n.last));
}

// May overflow.
float unbounded_importance(const LightTree& tree, const LightNode& n, const Receiver& at) {
  if (tree.choice == LightChoice::uniform || tree.choice == LightChoice::power) return n.weight;
  const bool faces = at.n != Vec3(0);
  if (n.infinite) {
    if (!faces) return n.weight * tree.infinity_scale;
    const float c = glm::dot(at.n, n.axis);
    return n.weight * tree.infinity_scale *
           std::max(cos_of_difference(sin_of(c), c, n.sin_spread, n.cos_spread) + 1e-4f, 0.0f);
  }
  const Vec3 between = n.center - at.p;
  const float d2 = length2(between), r2 = n.radius * n.radius;
  const float nearest = std::max(d2, r2);
  if (!(nearest > 0)) return n.weight;
  if (d2 <= r2 * 1.0001f) return n.weight / nearest;
  const Vec3 w = between / std::sqrt(d2);
  const float sin_seen = std::sqrt(std::min(r2 / d2 * 1.001f + 1e-7f, 1.0f)), cos_seen = sin_of(sin_seen);
  float received = 1;
  if (faces) {
    const float c = glm::dot(at.n, w);
    received = cos_of_difference(sin_of(c), c, sin_seen, cos_seen);
    if (!(received > 0)) return 0;
  }
  // From the cone of normals to the direction of the receiver.
  const float c = -glm::dot(n.axis, w), out = cos_of_difference(sin_of(c), c, n.sin_spread, n.cos_spread);
  const float sent = cos_of_difference(sin_of(out), out, sin_seen, cos_seen);
  if (!(sent > n.cos_reach - 1e-4f)) return 0;
  return n.weight * received * std::max(sent, 1e-3f) / nearest;
}

}  // namespace

float importance(const LightTree& tree, uint32_t node, const Receiver& at) {
  return std::min(most_importance, unbounded_importance(tree, tree.nodes[node], at));
}

LightTree make_light_tree(const Scene& scene, LightChoice choice) {
  LightTree t;
  t.choice = choice;
  // Lamps send watts / pi to the steradian where they shine most; from infinity, watts are spread over the scene's
  // disk.
  t.infinity_scale = float(1 / (double(scene.radius) * double(scene.radius)));
  make_tilings(scene, t);
  std::vector<BoundedPiece> pieces = light_pieces(scene, t);
  count_pieces(pieces, scene.lights.size(), t);
  std::erase_if(pieces, [](const BoundedPiece& p) { return !(p.watts > 0); });
  t.power_before = {0};
  if (pieces.empty()) return t;
  const auto finite = std::stable_partition(pieces.begin(), pieces.end(), [](auto& p) { return !p.infinite; });
  const size_t lamps = size_t(finite - pieces.begin());
  Builder b{t, pieces, count_lights(pieces, lamps) <= most_sky};
  const uint32_t sky = build_nodes(b, lamps);
  put_pieces(pieces, t);
  t.region.assign(pieces.size(), none);
  if (lamps < pieces.size()) set_regions(t, sky);
  if (lamps == 0 && b.sky) set_sky(t);
  return t;
}

uint32_t place_of(const LightTree& t, uint32_t light, uint32_t part) {
  const uint32_t first = t.first_piece[light], count = t.first_piece[light + 1] - first;
  if (count == 0) return none;
  return t.place[first + (count > 1 ? part : 0)];
}

size_t bytes(const LightTree& t) {
  size_t sum = t.nodes.size() * sizeof(LightNode) + t.pieces.size() * sizeof(LightPiece) +
               t.power_before.size() * sizeof(double) +
               4 * (t.first_piece.size() + t.place.size() + t.tiling.size() + t.region.size() + t.regions.size()) +
               t.sky.size() * sizeof(SkyLight);
  for (const Tiling& x : t.tilings) {
    sum += x.of_texel.size() + x.tiles.size() * sizeof(Tile);
    for (const Tile& tile : x.tiles) sum += tile.rows.cdf.size() * sizeof(float);
  }
  return sum;
}

bool choose(const LightTree& tree, uint32_t node, const Receiver& at, float& u, uint32_t& place, float& pdf) {
  pdf = 1;
  for (;;) {
    const LightNode& n = tree.nodes[node];
    if (n.left == 0) {
      place = n.first;
      return true;
    }
    if (is_by_power(tree, n)) {
      place = choose_by_power(tree, n.first, n.last, u);
      pdf *= share_below(tree, n, place);
      return pdf > 0;
    }
    const float left = left_share(tree, n, at);
    if (left < 0) return false;
    if (take_part(u, left))
      node = n.left, pdf *= left;
    else
      node = n.left + 1, pdf *= 1 - left;
    if (!(pdf > 0)) return false;
  }
}

float choice_pdf(const LightTree& tree, uint32_t node, const Receiver& at, uint32_t place) {
  float pdf = 1;
  while (tree.nodes[node].left != 0) {
    const LightNode& n = tree.nodes[node];
    if (is_by_power(tree, n)) return pdf * share_below(tree, n, place);
    const float left = left_share(tree, n, at);
    if (left < 0) return 0;
    const bool right = place >= tree.nodes[n.left].last;
    pdf *= right ? 1 - left : left;
    node = n.left + (right ? 1 : 0);
  }
  return pdf;
}

const SkyLight& choose_of_sky(const LightTree& t, const Receiver& at, float& u, float& pdf) {
  float weights[most_sky];
  pdf = 1;
  if (t.sky.size() == 1) return t.sky[0];
  const float sum = weigh_sky(t, at, weights);
  float before = u * sum;
  size_t i = 0;
  for (; i + 1 < t.sky.size() && !(before < weights[i]); ++i) before -= weights[i];
  u = std::clamp(before / weights[i], 0.0f, one_minus_epsilon);
  pdf = weights[i] / sum;
  return t.sky[i];
}

float sky_pdf(const LightTree& t, const Receiver& at, uint32_t light) {
  float weights[most_sky];
  if (t.sky.size() == 1) return t.sky[0].light == light ? 1 : 0;
  const float sum = weigh_sky(t, at, weights);
  for (size_t i = 0; i < t.sky.size(); ++i)
    if (t.sky[i].light == light) return weights[i] / sum;
  return 0;
}

float sky_share(const LightTree& t, const Receiver& at, uint32_t node) {
  const LightNode& n = t.nodes[node];
  float weights[most_sky];
  const float sum = weigh_sky(t, at, weights);
  double share = 0;
  for (size_t i = 0; i < t.sky.size(); ++i) {
    const uint32_t first = std::max(n.first, t.sky[i].first), last = std::min(n.last, t.sky[i].last);
    if (first < last)
      share += double(weights[i] / sum) * power_of(t, first, last) / power_of(t, t.sky[i].first, t.sky[i].last);
  }
  return float(share);
}

uint32_t choose_by_power(const LightTree& t, uint32_t first, uint32_t last, float& u) {
  const double low = t.power_before[first], high = t.power_before[last], at = low + double(u) * (high - low);
  const auto begin = t.power_before.begin();
  const auto found = std::upper_bound(begin + first + 1, begin + last, at);
  const uint32_t i = std::min(uint32_t(found - begin) - 1, last - 1);
  const double width = t.power_before[i + 1] - t.power_before[i];
  u = width > 0 ? std::clamp(float((at - t.power_before[i]) / width), 0.0f, one_minus_epsilon) : u;
  return i;
}

}  // namespace ajar
