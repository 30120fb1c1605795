#include "environment.h"

#include <fmt/format.h>

#include "ajar/core/angle.h"
#include "ajar/core/error.h"
#include "ajar/core/parallel.h"
#include "ajar/core/warp.h"

namespace ajar {
namespace {

// Cells between texel centres around a position in texels: u wraps, v is clamped.
struct Cell {
  int x0, x1, y0, y1;
  float fx, fy;
};
Cell cell_at(const Distribution2D& table, const Vec2& texels) {
  const Vec2 p = texels - 0.5f;
  const Vec2 corner(std::floor(p.x), std::floor(p.y));
  const int x = int(corner.x), y = int(corner.y), w = table.width, h = table.height;
  return {x < 0 ? w - 1 : std::min(x, w - 1), x + 1 >= w ? 0 : x + 1, std::clamp(y, 0, h - 1),
          std::clamp(y + 1, 0, h - 1),        p.x - corner.x,         p.y - corner.y};
}

// Where the poles are among the rows of texels, and how many rows they are apart.
struct Rows {
  float top, steps;
};
Rows rows_of(const Environment& e) {
  return e.polar ? Rows{0.5f, float(e.table.height - 1)} : Rows{0, float(e.table.height)};
}

// A row at a pole reaches from there to one side alone: all of its tent is on that side.
float folded(const Environment& e, int y) { return e.polar && (y == 0 || y == e.table.height - 1) ? 2 : 1; }

Vec2 texels_of(const Environment& e, const Vec3& w) {
  const Rows rows = rows_of(e);
  const float phi = fast_atan2(w.x, -w.z), theta = fast_atan2(std::sqrt(w.x * w.x + w.z * w.z), w.y);
  const float u = phi * (inv_pi / 2);
  return {(u < 0 ? u + 1 : u) * float(e.table.width), rows.top + theta * inv_pi * rows.steps};
}

// Density per texel of the map, turned into solid angle. At the poles themselves it would be infinite.
float to_solid(const Environment& e, float per_texel, float sin_theta) {
  return per_texel * float(e.table.width) * rows_of(e).steps / (2 * pi * pi * std::max(sin_theta, 1e-7f));
}

float density(const Environment& e, const Vec2& texels, float sin_theta) {
  const Distribution2D& table = e.table;
  const Cell c = cell_at(table, texels);
  const float top = table.mass({c.x0, c.y0}) * (1 - c.fx) + table.mass({c.x1, c.y0}) * c.fx;
  const float bottom = table.mass({c.x0, c.y1}) * (1 - c.fx) + table.mass({c.x1, c.y1}) * c.fx;
  const float per_texel = top * folded(e, c.y0) * (1 - c.fy) + bottom * folded(e, c.y1) * c.fy;
  return to_solid(e, per_texel, sin_theta);
}

// Integral of sin(theta) against the tent of a row of texels; the first and last row reach flat to the poles, or stand
// at them.
double solid_of_row(int y, int height, bool polar) {
  const double h = std::numbers::pi / (polar ? height - 1 : height);
  if (polar) return y == 0 || y == height - 1 ? 1 - std::sin(h) / h : std::sin(y * h) * 2 * (1 - std::cos(h)) / h;
  if (height == 1) return 2;
  if (y == 0 || y == height - 1) return 1 - (std::sin(1.5 * h) - std::sin(0.5 * h)) / h;
  return std::sin((y + 0.5) * h) * 2 * (1 - std::cos(h)) / h;
}

}  // namespace

Rgb environment_radiance(const Scene& scene, const Environment& e, const Vec3& w) {
  const Image& image = scene.images[e.image];
  const Cell c = cell_at(e.table, texels_of(e, w));
  const Rgb top = texel(image, c.x0, c.y0) * (1 - c.fx) + texel(image, c.x1, c.y0) * c.fx;
  const Rgb bottom = texel(image, c.x0, c.y1) * (1 - c.fx) + texel(image, c.x1, c.y1) * c.fx;
  return (top * (1 - c.fy) + bottom * c.fy) * e.scale;
}

float environment_pdf(const Environment& e, const Vec3& w) {
  if (e.table.rows.sum == 0) return 0;
  return density(e, texels_of(e, w), std::sqrt(w.x * w.x + w.z * w.z));
}

namespace {

// A tent around a texel's centre, folded at the poles, where rows are repeated outwards or stand: the sum of tents is
// the bilinear interpolation of the texels' weights.
Vec2 around(const Environment& e, const Distribution2D::Cell& c, const Vec2& u) {
  const Rows rows = rows_of(e);
  const float w = float(e.table.width), low = rows.top, high = rows.top + rows.steps;
  const float x = float(c.x) + 0.5f + to_tent(u.x), y = float(c.y) + 0.5f + to_tent(u.y);
  return {x < 0 ? x + w : (x >= w ? x - w : x), y < low ? 2 * low - y : (y > high ? 2 * high - y : y)};
}

// Probability of a texel when its tile is drawn from.
float share_of(const Distribution2D& table, const Tile& tile, int x, int y) {
  const float* row = table.columns.data() + size_t(y) * (size_t(table.width) + 1);
  const float all = row[tile.high.x] - row[tile.low.x];
  return all > 0 ? tile.rows.pdf(uint32_t(y - tile.low.y)) * (row[x + 1] - row[x]) / all : 0;
}

}  // namespace

Vec3 direction_at(const Environment& e, const Vec2& texels, float& sin_theta) {
  const Rows rows = rows_of(e);
  const float phi = 2 * pi * (texels.x / float(e.table.width));
  const float theta = std::clamp(pi * ((texels.y - rows.top) / rows.steps), 0.0f, pi);
  sin_theta = std::sin(theta);
  return {std::sin(phi) * sin_theta, std::cos(theta), -std::cos(phi) * sin_theta};
}

int tile_densities(const Environment& e, const Tiling& tiling, const Vec3& w, TileDensity out[most_shares]) {
  const Cell c = cell_at(e.table, texels_of(e, w));
  const int xs[] = {c.x0, c.x1, c.x0, c.x1}, ys[] = {c.y0, c.y0, c.y1, c.y1};
  const float shares[] = {(1 - c.fx) * (1 - c.fy), c.fx * (1 - c.fy), (1 - c.fx) * c.fy, c.fx * c.fy};
  const float solid = to_solid(e, 1, std::sqrt(w.x * w.x + w.z * w.z));
  int n = 0;
  for (int i = 0; i < 4; ++i) {
    const uint32_t tile = tile_of(tiling, xs[i], ys[i]);
    const float pdf = shares[i] * folded(e, ys[i]) * share_of(e.table, tiling.tiles[tile], xs[i], ys[i]) * solid;
    int k = 0;
    while (k < n && out[k].tile != tile) ++k;
    if (k == n) out[n++] = {tile, 0};
    out[k].pdf += pdf;
  }
  return n;
}

Vec3 sample_tile(const Environment& e, const Tile& tile, Vec2 u) {
  const int y = tile.low.y + int(tile.rows.sample(u.y));
  const float* row = e.table.columns.data() + size_t(y) * (size_t(e.table.width) + 1);
  const float from = row[tile.low.x], at = from + u.x * (row[tile.high.x] - from);
  const float* found = std::upper_bound(row + tile.low.x + 1, row + tile.high.x, at) - 1;
  const float width = found[1] - found[0];
  if (width > 0) u.x = std::clamp((at - found[0]) / width, 0.0f, one_minus_epsilon);
  float sin_theta;
  return direction_at(e, around(e, {int(found - row), y}, u), sin_theta);
}

// A texel by its weight, then a tent around it.
Vec3 sample_environment(const Environment& e, Vec2 u, float& pdf) {
  pdf = 0;
  if (e.table.rows.sum == 0) return {0, 1, 0};
  const Distribution2D::Cell c = e.table.sample_cell(u);
  const Vec2 at = around(e, c, u);
  float sin_theta;
  const Vec3 w = direction_at(e, at, sin_theta);
  if (sin_theta > 1e-7f) pdf = density(e, at, sin_theta);
  return w;
}

double environment_total(const Environment& e) {
  return e.table.rows.sum * (2 * std::numbers::pi / e.table.width) * double(e.scale);
}

Environment make_environment(const Scene& scene, uint32_t id, float scale, bool polar) {
  const Image& image = scene.images[id];
  if (image.height == 1) polar = false;
  std::vector<float> weights(size_t(image.width) * size_t(image.height));
  std::vector<int> bad(size_t(image.height), -1);
  parallel_for(image.height, [&](int y) {
    const float solid = float(solid_of_row(y, image.height, polar));
    for (int x = 0; x < image.width; ++x) {
      const Rgb c = texel(image, x, y);
      if (!(c.x >= 0 && c.y >= 0 && c.z >= 0 && is_finite(c * std::max(scale, 1.0f)))) bad[size_t(y)] = x;
      weights[size_t(y) * size_t(image.width) + size_t(x)] = luminance(c) * solid;
    }
  });
  for (int y = 0; y < image.height; ++y)
    if (const int x = bad[size_t(y)]; x >= 0) {
      const Rgb c = texel(image, x, y);
      const bool by_scale = is_finite(c) && std::min({c.x, c.y, c.z}) >= 0;
      throw Error(fmt::format("{}: pixel ({}, {}) {}", image.name, x, y,
                              by_scale ? fmt::format("times {} is beyond what numbers hold; make scale smaller", scale)
                                       : "is negative or not finite; repair the image"));
    }
  return {id, scale, polar, Distribution2D(weights, image.width, image.height)};
}

}  // namespace ajar
