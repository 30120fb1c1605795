// Enters: non-negative weights.
// Leaves: discrete and piecewise-constant distributions: sample, pdf, exact inverse of each other.
#pragma once

#include <span>
#include <vector>

#include "ajar/core/vec.h"

namespace ajar {

/// Discrete distribution over n entries by cumulative sums. All-zero weights give the uniform distribution; non-finite
/// and negative weights count as zero. An entry of weight zero is never chosen unless all are zero; an entry of
/// positive weight always can be (up to 2^23 entries), however small its share.
struct Distribution {
  std::vector<float> cdf;  ///< n + 1 entries, 0 .. 1, multiples of 2^-24: what a float in [0,1) can tell apart
  double sum = 0;          ///< of the weights given

  Distribution() = default;
  explicit Distribution(std::span<const float> weights);
  uint32_t size() const { return cdf.empty() ? 0 : uint32_t(cdf.size() - 1); }
  float pdf(uint32_t i) const { return cdf[i + 1] - cdf[i]; }
  /// Index for u in [0,1); u is remapped to the position inside the entry, again uniform in [0,1).
  uint32_t sample(float& u) const;
};

/// Piecewise constant over the unit square, rows of equal height; density with respect to the area of the square.
/// Weights in rows, row 0 at y = 0. The same promises as above, for rows and for the cells of each row.
struct Distribution2D {
  int width = 0, height = 0;
  Distribution rows;
  std::vector<float> columns;  ///< height * (width + 1) cumulative

  Distribution2D() = default;
  Distribution2D(std::span<const float> weights, int width, int height);
  Vec2 sample(const Vec2& u, float& pdf) const;
  float pdf(const Vec2& at) const;

  struct Cell {
    int x = 0, y = 0;
  };
  /// Cell for u in [0,1)^2; u is remapped to the position inside the cell, again uniform in [0,1)^2.
  Cell sample_cell(Vec2& u) const;
  /// Probability of a cell.
  float mass(const Cell& c) const {
    const float* row = columns.data() + size_t(c.y) * (size_t(width) + 1);
    return rows.pdf(uint32_t(c.y)) * (row[c.x + 1] - row[c.x]);
  }
};

}  // namespace ajar
