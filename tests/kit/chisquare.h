// Enters: a sampler of directions (or of points of a square) and the density that it claims.
// Leaves: Pearson's chi-square test of one against the other.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "ajar/core/vec.h"

namespace ajar::kit {

struct ChiSquare {
  double statistic = 0;
  int dof = 0;
  double p = 1;      ///< probability of a statistic at least as large if sampler and density agree
  double mass = 0;   ///< integral of the density over the domain
  double drawn = 0;  ///< share of draws that gave a sample
  bool ok = false;   ///< p above the level, and mass equal to the share drawn within the noise
  std::string message;
};

struct ChiOptions {
  int rows = 24, columns = 48;  ///< cells: cosine to the x axis x angle about it, or y x x of the square
  int samples = 1'000'000;
  int quadrature = 12;  ///< midpoint rule points per cell side to begin with; cells are quartered as needed
  double level = 1e-4;  ///< of significance, already divided by the number of tests in a suite
  uint64_t seed = 1;
};

using DrawDirection = std::function<std::optional<Vec3>(const Vec2& u, float extra)>;
using DirectionPdf = std::function<double(const Vec3&)>;  ///< per solid angle
ChiSquare chi_square_sphere(const DrawDirection& draw, const DirectionPdf& pdf, const ChiOptions& options = {});

using DrawPoint = std::function<std::optional<Vec2>(const Vec2& u)>;
using PointPdf = std::function<double(const Vec2&)>;  ///< per area of the unit square
ChiSquare chi_square_square(const DrawPoint& draw, const PointPdf& pdf, const ChiOptions& options = {});

/// Upper tail of the chi-square distribution, Q(dof / 2, x / 2).
double chi_square_tail(double x, double dof);

}  // namespace ajar::kit
