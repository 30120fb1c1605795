#include "environment.h"

#include <fmt/format.h>

#include "ajar/core/error.h"
#include "ajar/core/parallel.h"

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

Vec2 texels_of(const Distribution2D& table, const Vec3& w) {
  const float phi = std::atan2(w.x, -w.z), theta = std::atan2(std::sqrt(w.x * w.x + w.z * w.z), w.y);
  const float u = phi * (inv_pi / 2);
  return {(u < 0 ? u + 1 : u) * float(table.width), theta * inv_pi * float(table.height)};
}

// Density over the map in texels, turned into solid angle. At the poles themselves it would be infinite.
float density(const Distribution2D& table, const Vec2& texels, float sin_theta) {
  const Cell c = cell_at(table, texels);
  const float top = table.mass({c.x0, c.y0}) * (1 - c.fx) + table.mass({c.x1, c.y0}) * c.fx;
  const float bottom = table.mass({c.x0, c.y1}) * (1 - c.fx) + table.mass({c.x1, c.y1}) * c.fx;
  const float per_texel = top * (1 - c.fy) + bottom * c.fy;
  return per_texel * float(table.width) * float(table.height) / (2 * pi * pi * std::max(sin_theta, 1e-7f));
}

// Tent over (-1, 1).
float tent(float u) { return u < 0.5f ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 - 2 * u); }

// Integral of sin(theta) against the tent of a row of texels; the first and last row reach flat to the poles.
double solid_of_row(int y, int height) {
  const double h = std::numbers::pi / height;
  if (height == 1) return 2;
  if (y == 0 || y == height - 1) return 1 - (std::sin(1.5 * h) - std::sin(0.5 * h)) / h;
  return std::sin((y + 0.5) * h) * 2 * (1 - std::cos(h)) / h;
}

}  // namespace

Rgb environment_radiance(const Scene& scene, const Environment& e, const Vec3& w) {
  const Image& image = scene.images[e.image];
  const Cell c = cell_at(e.table, texels_of(e.table, w));
  const Rgb top = texel(image, c.x0, c.y0) * (1 - c.fx) + texel(image, c.x1, c.y0) * c.fx;
  const Rgb bottom = texel(image, c.x0, c.y1) * (1 - c.fx) + texel(image, c.x1, c.y1) * c.fx;
  return (top * (1 - c.fy) + bottom * c.fy) * e.scale;
}

float environment_pdf(const Environment& e, const Vec3& w) {
  if (e.table.rows.sum == 0) return 0;
  return density(e.table, texels_of(e.table, w), std::sqrt(w.x * w.x + w.z * w.z));
}

// A texel by its weight, then a tent around its centre, folded at the poles where rows are repeated outwards: the sum
// of tents is the bilinear interpolation of the weights.
Vec3 sample_environment(const Environment& e, Vec2 u, float& pdf) {
  pdf = 0;
  if (e.table.rows.sum == 0) return {0, 1, 0};
  const float w = float(e.table.width), h = float(e.table.height);
  const Distribution2D::Cell c = e.table.sample_cell(u);
  float x = float(c.x) + 0.5f + tent(u.x), y = float(c.y) + 0.5f + tent(u.y);
  x = x < 0 ? x + w : (x >= w ? x - w : x);
  y = y < 0 ? -y : (y > h ? 2 * h - y : y);
  const float phi = 2 * pi * (x / w), theta = pi * (y / h);
  const float sin_theta = std::sin(theta);
  if (sin_theta > 1e-7f) pdf = density(e.table, {x, y}, sin_theta);
  return {std::sin(phi) * sin_theta, std::cos(theta), -std::cos(phi) * sin_theta};
}

double environment_total(const Environment& e) {
  return e.table.rows.sum * (2 * std::numbers::pi / e.table.width) * double(e.scale);
}

Environment make_environment(const Scene& scene, uint32_t id, float scale) {
  const Image& image = scene.images[id];
  std::vector<float> weights(size_t(image.width) * size_t(image.height));
  std::vector<int> bad(size_t(image.height), -1);
  parallel_for(image.height, [&](int y) {
    const float solid = float(solid_of_row(y, image.height));
    for (int x = 0; x < image.width; ++x) {
      const Rgb c = texel(image, x, y);
      if (!(c.x >= 0 && c.y >= 0 && c.z >= 0 && is_finite(c))) bad[size_t(y)] = x;
      weights[size_t(y) * size_t(image.width) + size_t(x)] = luminance(c) * solid;
    }
  });
  for (int y = 0; y < image.height; ++y)
    if (bad[size_t(y)] >= 0)
      throw Error(
          fmt::format("{}: pixel ({}, {}) is negative or not finite; repair the image", image.name, bad[size_t(y)], y));
  return {id, scale, Distribution2D(weights, image.width, image.height)};
}

}  // namespace ajar
