// Enters: a rough dielectric boundary.
// Leaves: how much light enters through it from outside, tabulated over the cosine and, where textures vary it, alpha;
// and how much it sends back inside.
#pragma once

#include "ajar/scene/material.h"

namespace ajar {

inline constexpr int table_cosines = 128;            ///< intervals of the cosine; an entry more than that
inline constexpr int table_row = table_cosines + 3;  ///< the cosine-weighted mean stands before them, and behind
inline constexpr int table_leaving = table_row - 1;  ///< eta^2 (1 - R), R the share of light inside that stays there
// If alpha is textured, rows for it:
inline constexpr int table_alphas = 16;         ///< intervals of sqrt(alpha) from 0 to 1
inline constexpr int table_wide_alphas = 8;     ///< intervals of 1 / sqrt(alpha) beyond, from 1 to 0
inline constexpr float widest_in_table = 1e6f;  ///< alpha of the last row, where nothing changes any more

/// Linear interpolation in one row.
inline float table_at(const float* row, float cos) {
  const float x = std::min(cos, 1.0f) * table_cosines;
  const int i = std::min(int(x), table_cosines - 1);
  return row[1 + i] + (row[2 + i] - row[1 + i]) * (x - float(i));
}

/// A row of Material::entering_table and the position between it and the next.
struct TableRow {
  const float* at;
  float between;
};
inline TableRow table_row_of(const Material& m, float alpha) {
  if (m.entering_table.size() == table_row) return {m.entering_table.data(), 0};
  const float root = std::sqrt(std::min(alpha, widest_in_table));
  const float x = root < 1 ? root * table_alphas : table_alphas + (1 - 1 / root) * table_wide_alphas;
  const int i = std::min(int(x), table_alphas + table_wide_alphas - 1);
  return {m.entering_table.data() + i * table_row, x - float(i)};
}

/// Share of the light from the cosine that a rough boundary lets through, by refraction at visible normals with masking
/// of the refracted direction: the integral of the transmission part of roughdielectric.
float rough_transmittance(Microfacet kind, float alpha, float ior, float cos);
/// What it reflects, by mirroring at visible normals with masking of the mirrored direction: what facets hide is lost,
/// so that the two add up to less than 1.
float rough_reflectance(Microfacet kind, float alpha, float ior, float cos);

}  // namespace ajar
