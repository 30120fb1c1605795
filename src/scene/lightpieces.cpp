#include "lightpieces.h"

#include <algorithm>
#include <cmath>

#include "ajar/core/warp.h"
#include "ajar/scene/geometry.h"
#include "environment.h"

namespace ajar {
namespace {

float cos_within(double x) { return float(std::clamp(x, -1.0, 1.0)); }

// The cone that holds the directions on a grid over a rectangle of texels, with half a texel around it for the tents
// that reach out of it. at: direction of a point of the map, in texels.
template <class At>
void set_cone(const Vec2& low, const Vec2& high, const At& at, LightBounds& b) {
  constexpr int n = 8;
  Vec3 sum(0);
  Vec3 w[(n + 1) * (n + 1)];
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) sum += w[i * (n + 1) + j] = at(low + (high - low) * Vec2(i, j) * (1.0f / n));
  const float length = std::sqrt(length2(sum));
  b.axis = length > 0.1f * (n + 1) * (n + 1) ? sum / length : Vec3(0, 0, 1);
  double widest = length > 0.1f * (n + 1) * (n + 1) ? 0 : std::numbers::pi, step = 0;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const Vec3& here = w[i * (n + 1) + j];
      widest = std::max(widest, std::acos(double(cos_within(glm::dot(here, b.axis)))));
      if (j > 0) step = std::max(step, std::acos(double(cos_within(glm::dot(here, w[i * (n + 1) + j - 1])))));
      if (i > 0) step = std::max(step, std::acos(double(cos_within(glm::dot(here, w[(i - 1) * (n + 1) + j])))));
    }
  b.cos_spread = float(std::cos(std::min(widest + step + 1e-3, std::numbers::pi)));
  b.low = b.high = b.axis;
}

struct Part {
  Tile tile;
  double mass = 0, solid = 0;
};

double mass_of(const Distribution2D& t, const Tile& tile) {
  double sum = 0;
  for (int y = tile.low.y; y < tile.high.y; ++y) {
    const float* row = t.columns.data() + size_t(y) * (size_t(t.width) + 1);
    sum += double(t.rows.pdf(uint32_t(y))) * double(row[tile.high.x] - row[tile.low.x]);
  }
  return sum;
}

Part part_of(const Distribution2D& table, const glm::ivec2& low, const glm::ivec2& high) {
  Part p;
  p.tile.low = low, p.tile.high = high;
  p.mass = mass_of(table, p.tile);
  const double top = std::numbers::pi * low.y / table.height, bottom = std::numbers::pi * high.y / table.height;
  p.solid = (std::cos(top) - std::cos(bottom)) / 2 * (high.x - low.x) / table.width;
  return p;
}

// How much a part wants to be divided: both strong and wide.
double cost(const Part& p) { return std::sqrt(p.mass * p.solid); }

// The best of a few straight cuts; false for a single texel.
bool divide(const Distribution2D& table, const Part& p, Part& a, Part& b) {
  constexpr int tries = 32;
  double least = infinity;
  for (int k = 0; k < 2; ++k) {
    const int size = p.tile.high[k] - p.tile.low[k], steps = std::min(size, tries);
    for (int i = 1; i < steps; ++i) {
      glm::ivec2 middle_high = p.tile.high, middle_low = p.tile.low;
      middle_high[k] = middle_low[k] = p.tile.low[k] + size * i / steps;
      const Part left = part_of(table, p.tile.low, middle_high), right = part_of(table, middle_low, p.tile.high);
      if (const double c = cost(left) + cost(right); c < least) least = c, a = left, b = right;
    }
  }
  return least < infinity;
}

// Divides what wants it most until there are enough tiles.
static_assert(most_tiles <= 256);  // numbers of one byte
Tiling tile_up(const Distribution2D& table) {
  Tiling t;
  t.width = table.width, t.height = table.height;
  std::vector<Part> parts = {part_of(table, {0, 0}, {table.width, table.height})};
  while (parts.size() < most_tiles) {
    const auto worst = std::max_element(parts.begin(), parts.end(), [](auto& a, auto& b) { return cost(a) < cost(b); });
    Part a, b;
    if (!(cost(*worst) > 0)) break;
    if (!divide(table, *worst, a, b)) {
      worst->solid = 0;  // a texel
      continue;
    }
    *worst = a;
    parts.push_back(b);
  }
  t.of_texel.resize(size_t(t.width) * size_t(t.height));
  for (Part& p : parts) {
    std::vector<float> rows;
    for (int y = p.tile.low.y; y < p.tile.high.y; ++y) {
      const float* row = table.columns.data() + size_t(y) * (size_t(table.width) + 1);
      rows.push_back(table.rows.pdf(uint32_t(y)) * (row[p.tile.high.x] - row[p.tile.low.x]));
      uint8_t* of_row = t.of_texel.data() + size_t(y) * size_t(t.width);
      std::fill(of_row + p.tile.low.x, of_row + p.tile.high.x, uint8_t(t.tiles.size()));
    }
    p.tile.rows = Distribution(rows);
    t.tiles.push_back(std::move(p.tile));
  }
  return t;
}

constexpr int grid_width = 16, grid_height = 8;  // of a constant light

Tiling even_tiles() {
  Tiling t;
  t.width = grid_width, t.height = grid_height;
  for (int y = 0; y < t.height; ++y)
    for (int x = 0; x < t.width; ++x) {
      t.of_texel.push_back(uint8_t(t.tiles.size()));
      t.tiles.push_back({{x, y}, {x + 1, y + 1}, {}});
    }
  return t;
}

struct Gatherer {
  const Scene& scene;
  const LightTree& tree;
  std::vector<BoundedPiece> out;

  void add(uint32_t light, uint32_t part, const LightBounds& bounds, double watts, bool infinite, double peak = 1) {
    out.push_back({{light, part}, bounds, watts, peak, infinite});
  }
};

void add_infinite(Gatherer& g, uint32_t id, double watts) {
  const Light& light = g.scene.lights[id];
  LightBounds b;
  if (g.tree.tiling[id] == none) {
    b.axis = b.low = b.high = -light.direction;
    b.cos_spread = 1 - light.cone;
    g.add(id, none, b, watts, true);
    return;
  }
  const Tiling& t = g.tree.tilings[g.tree.tiling[id]];
  const bool even = light.kind == LightKind::constant;
  for (uint32_t k = 0; k < t.tiles.size(); ++k) {
    const Tile& tile = t.tiles[k];
    if (even) {
      const Vec2 size(t.width, t.height);
      set_cone(
          Vec2(tile.low), Vec2(tile.high),
          [&](const Vec2& at) {
            return to_sphere({at.y / size.y, at.x / size.x});
          },
          b);
      g.add(id, k, b, watts / double(t.tiles.size()), true);
      continue;
    }
    const Environment& map = g.scene.environments[light.environment];
    const Mat3 turn(light.to_world);
    set_cone(
        Vec2(tile.low) - 0.5f, Vec2(tile.high) + 0.5f,
        [&](const Vec2& at) {
          float sin_theta;
          return glm::normalize(turn * direction_at(map, at, sin_theta));
        },
        b);
    g.add(id, k, b, watts * mass_of(map.table, tile), true);
  }
}

// A mesh of fewer is not worth the walk through the tree.
constexpr size_t least_triangles = 16;

// The ball about a shape's centre, and the box about the shape.
void set_ball(const Vec3& center, float radius, const Vec3& box, LightBounds& b) {
  b.low = center - box, b.high = center + box;
  b.radius = radius;
}

// Half extents of an ellipse's box.
Vec3 ellipse_box(const Vec3& x, const Vec3& y) { return glm::sqrt(x * x + y * y); }

// Half of an ellipse's longer axis.
float longest(const Vec3& x, const Vec3& y) {
  const float a = length2(x), b = length2(y);
  return std::sqrt(0.5f * (a + b) + std::sqrt(sqr(0.5f * (a - b)) + sqr(glm::dot(x, y))));
}

// Of a mesh that is one piece, the cone of all normals; the largest area that is seen from any side, roughly, over all
// of it.
double set_normals(const Mesh& mesh, LightBounds& b) {
  LightBounds all;
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    LightBounds one;
    one.axis = mesh.faces[i].ng, one.weight = double(triangle_area(mesh, uint32_t(i)));
    all = join(all, one);
  }
  b.axis = all.axis, b.cos_spread = all.cos_spread;
  if (!(all.weight > 0) || mesh.triangles.size() >= least_triangles) return 1;
  const auto seen_from = [&](const Vec3& w) {
    double sum = 0;
    for (size_t i = 0; i < mesh.triangles.size(); ++i)
      sum += double(triangle_area(mesh, uint32_t(i)) * std::max(glm::dot(mesh.faces[i].ng, w), 0.0f));
    return sum / all.weight;
  };
  double most = seen_from(all.axis);
  for (const auto& face : mesh.faces) most = std::max(most, seen_from(face.ng));
  return std::clamp(most, 0.25, 1.0);
}

void include(const Vec3& p, LightBounds& b) { b.low = glm::min(b.low, p), b.high = glm::max(b.high, p); }

void set_rectangle(const Rectangle& r, LightBounds& b) {
  for (const Vec3& p : {r.corner, r.corner + r.x, r.corner + r.y, r.corner + r.x + r.y}) include(p, b);
  b.axis = r.normal;
}

// Disk, sphere or cylinder; returns BoundedPiece::peak.
double set_quadric(const Scene& scene, uint32_t id, LightBounds& b) {
  const Shape& shape = scene.shapes[id];
  const Mat4& m = shape.to_world;
  const Vec3 x(m[0]), y(m[1]), z(m[2]), o(m[3]);
  const float across = longest(x, y);
  if (shape.kind == ShapeKind::disk) {
    float pdf;
    set_ball(o, across, ellipse_box(x, y), b);
    b.axis = sample_area(scene, id, Vec2(0.5f), pdf).ng;
    return 1;
  }
  b.cos_spread = -1;
  if (shape.kind == ShapeKind::sphere) {
    set_ball(o, across, Vec3(across), b);
    return 0.25;
  }
  set_ball(o + 0.5f * z, across + 0.5f * std::sqrt(length2(z)), ellipse_box(x, y) + 0.5f * glm::abs(z), b);
  return 1 / std::numbers::pi;
}

void include_triangle(const Mesh& mesh, uint32_t i, LightBounds& b) {
  for (int k = 0; k < 3; ++k) include(mesh.positions[mesh.triangles[i][k]], b);
}

// Each one a piece.
void add_triangles(Gatherer& g, uint32_t id, const Mesh& mesh, double watts) {
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    LightBounds b;
    b.cos_reach = 0;
    include_triangle(mesh, i, b);
    b.axis = mesh.faces[i].ng;
    g.add(id, i, b, mesh.total_area > 0 ? watts * double(triangle_area(mesh, i)) / mesh.total_area : 0, false);
  }
}

void add_area(Gatherer& g, uint32_t id, double watts) {
  const Light& light = g.scene.lights[id];
  const Shape& shape = g.scene.shapes[light.shape];
  LightBounds b;
  b.cos_reach = 0;
  double peak = 1;
  if (light.rectangle.area > 0) {
    set_rectangle(light.rectangle, b);
  } else if (shape.kind == ShapeKind::mesh) {
    const Mesh& mesh = g.scene.meshes[shape.mesh];
    const size_t count = mesh.triangles.size();
    if (count >= least_triangles && g.out.size() + count <= most_pieces) return add_triangles(g, id, mesh, watts);
    for (uint32_t i = 0; i < count; ++i) include_triangle(mesh, i, b);
    peak = set_normals(mesh, b);
  } else {
    peak = set_quadric(g.scene, light.shape, b);
  }
  g.add(id, none, b, watts, false, peak);
}

void add_delta(Gatherer& g, uint32_t id, double watts) {
  const Light& light = g.scene.lights[id];
  LightBounds b;
  b.low = b.high = light.position;
  b.axis = light.direction;
  double peak = 0.25;
  if (light.kind == LightKind::point) b.cos_spread = -1;
  if (light.kind == LightKind::spot) {
    const float beam = std::min(light.beam, light.cutoff);  // as bright all over, and falling off beyond
    b.cos_spread = std::cos(beam), b.cos_reach = std::cos(light.cutoff - beam);
    peak = std::numbers::pi / std::max(spot_solid_angle(light), 1e-12);
  }
  if (light.kind == LightKind::projector) {
    b.cos_spread = 1 / std::sqrt(1 + glm::dot(light.plane, light.plane)) - 1e-4f;
    peak = std::numbers::pi / std::max(4.0 * light.plane.x * light.plane.y, 1e-12);
  }
  g.add(id, none, b, watts, false, peak);
}

}  // namespace

LightBounds join(const LightBounds& a, const LightBounds& b) {
  if (!(a.weight > 0)) return b;
  if (!(b.weight > 0)) return a;
  LightBounds out = a.cos_spread <= b.cos_spread ? a : b;
  const LightBounds& lesser = a.cos_spread <= b.cos_spread ? b : a;
  out.low = glm::min(a.low, b.low), out.high = glm::max(a.high, b.high);
  const auto reach = [&](const LightBounds& of) {
    return radius_of(of) + std::sqrt(length2(middle(of) - middle(out)));
  };
  out.radius = std::max(reach(a), reach(b));
  out.weight = a.weight + b.weight;
  out.cos_reach = std::min(a.cos_reach, b.cos_reach);
  // The cone about both cones (Conty Estevez and Kulla 2018, algorithm 1).
  const double wide = std::acos(double(out.cos_spread)), narrow = std::acos(double(lesser.cos_spread)),
               between = std::acos(double(cos_within(glm::dot(out.axis, lesser.axis))));
  if (std::min(between + narrow, std::numbers::pi) <= wide) return out;
  const double half = (wide + between + narrow) / 2;
  const Vec3 across = lesser.axis - out.axis * glm::dot(out.axis, lesser.axis);
  const float l2 = length2(across);
  if (half >= std::numbers::pi || !(l2 > 1e-12f)) {
    out.cos_spread = l2 > 1e-12f || between + narrow > 1 ? -1 : out.cos_spread;
    return out;
  }
  const double turn = half - wide;
  out.axis = glm::normalize(out.axis * float(std::cos(turn)) + across * float(std::sin(turn)) / std::sqrt(l2));
  out.cos_spread = float(std::cos(half));
  return out;
}

void make_tilings(const Scene& scene, LightTree& tree) {
  tree.tiling.assign(scene.lights.size(), none);
  for (uint32_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const bool map = light.kind == LightKind::envmap && scene.environments[light.environment].table.rows.sum > 0;
    if (!map && light.kind != LightKind::constant) continue;
    tree.tiling[i] = uint32_t(tree.tilings.size());
    tree.tilings.push_back(map ? tile_up(scene.environments[light.environment].table) : even_tiles());
  }
}

std::vector<BoundedPiece> light_pieces(const Scene& scene, const LightTree& tree) {
  Gatherer g{scene, tree, {}};
  for (uint32_t i = 0; i < scene.lights.size(); ++i) {
    const size_t from = g.out.size();
    const Light& light = scene.lights[i];
    // What next-event estimation is told to leave out, rays find: then light subpaths start there by its power.
    const double asked = double(light.sampling_weight);
    const bool starts_alone = !(asked > 0) && !has_no_extent(light.kind);
    const double watts = double(power(scene, i)) * (starts_alone ? 1 : asked);
    if (is_infinite(light.kind))
      add_infinite(g, i, watts);
    else if (light.kind == LightKind::area)
      add_area(g, i, watts);
    else
      add_delta(g, i, watts);
    double sum = 0;
    for (size_t k = from; k < g.out.size(); ++k) {
      BoundedPiece& p = g.out[k];
      if (!(p.watts > 0 && p.watts < 1e38)) p.watts = p.watts > 0 ? 1e38 : 0;
      sum += p.watts;
    }
    // uniform: every light alike, its pieces by power
    const bool uniform = tree.choice == LightChoice::uniform, by_power = tree.choice == LightChoice::power;
    for (size_t k = from; k < g.out.size(); ++k) {
      BoundedPiece& p = g.out[k];
      const double promise = by_power ? p.watts : std::min(p.watts * p.peak, 1e38);
      p.bounds.weight = uniform && sum > 0 ? p.watts / sum * asked : promise;
      if (starts_alone) p.bounds.weight = 0;
    }
  }
  return std::move(g.out);
}

}  // namespace ajar
