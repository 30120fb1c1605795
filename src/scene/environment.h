// Enters: an image map over the sphere, directions.
// Leaves: its radiance, samples and densities in the light's own space. Private to the room.
#pragma once

#include "ajar/scene/scene.h"

namespace ajar {

/// Radiance from unit local direction w.
Rgb environment_radiance(const Scene& scene, const Environment& e, const Vec3& w);
/// Density per solid angle of sample_environment at unit local direction w; finite.
float environment_pdf(const Environment& e, const Vec3& w);
/// Draws a unit local direction; pdf 0 where none was found.
Vec3 sample_environment(const Environment& e, Vec2 u, float& pdf);
/// Unit local direction of unit world direction w; stretch: solid angle there over solid angle here (1 for a rotation).
inline Vec3 to_local(const Light& light, const Vec3& w, float& stretch) {
  const Vec3 v = light.to_local * w;
  const float l = std::sqrt(length2(v));
  stretch = std::abs(glm::determinant(light.to_local)) / (l * l * l);
  return v / l;
}

/// Unit local direction of a position in texels; beyond a pole the pole's.
Vec3 direction_at(const Environment& e, const Vec2& texels, float& sin_theta);

/// Densities per solid angle at unit local direction w of the tiles that reach there.
struct TileDensity {
  uint32_t tile = 0;
  float pdf = 0;
};
int tile_densities(const Environment& e, const Tiling& tiling, const Vec3& w, TileDensity out[most_shares]);
/// Draws a unit local direction by one tile.
Vec3 sample_tile(const Environment& e, const Tile& tile, Vec2 u);

/// Integral of the luminance over all local directions.
double environment_total(const Environment& e);

}  // namespace ajar
