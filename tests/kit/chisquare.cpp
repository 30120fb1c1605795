#include "kit/chisquare.h"

#include <fmt/format.h>

#include <numeric>
#include <vector>

#include "ajar/core/sampler.h"

namespace ajar::kit {
namespace {

// Regularised incomplete gamma Q(a, x) by series or continued fraction (Abramowitz and Stegun 6.5.29, 6.5.31).
double gamma_q(double a, double x) {
  if (x <= 0) return 1;
  const double front = std::exp(-x + a * std::log(x) - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (double n = a + 1; std::abs(term) > 1e-15 * std::abs(sum); ++n) sum += term *= x / n;
    return 1 - sum * front;
  }
  double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
  for (int i = 1; i < 100000; ++i) {
    const double an = -i * (i - a);
    b += 2;
    d = 1 / (an * d + b);
    c = b + an / c;
    h *= d * c;
    if (std::abs(d * c - 1) < 1e-14) break;
  }
  return front * h;
}

ChiSquare evaluate(std::vector<double> observed, std::vector<double> expected, double drawn, const ChiOptions& o) {
  ChiSquare r;
  r.mass = std::accumulate(expected.begin(), expected.end(), 0.0) / o.samples;
  r.drawn = drawn / o.samples;
  // Cells in order of expectation; those that expect little are pooled so that the statistic is chi-square distributed.
  std::vector<size_t> order(expected.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return expected[a] < expected[b]; });
  double pooled_o = 0, pooled_e = 0;
  for (const size_t i : order) {
    pooled_o += observed[i];
    pooled_e += expected[i];
    if (pooled_e < 10) continue;
    r.statistic += (pooled_o - pooled_e) * (pooled_o - pooled_e) / pooled_e;
    ++r.dof;
    pooled_o = pooled_e = 0;
  }
  if (pooled_e > 0.5 || pooled_o > 5)
    r.statistic += (pooled_o - pooled_e) * (pooled_o - pooled_e) / std::max(pooled_e, 0.5), ++r.dof;
  r.p = r.dof > 0 ? gamma_q(r.dof / 2.0, r.statistic / 2) : 1;
  const double sigma = std::sqrt(std::max(r.drawn * (1 - r.drawn), 1e-6) / o.samples);
  const bool mass_ok = std::abs(r.mass - r.drawn) < 5 * sigma + 2e-3;
  r.ok = r.p > o.level && mass_ok;
  r.message = fmt::format("chi2 = {:.1f}, dof = {}, p = {:.3g}, mass = {:.5f}, drawn = {:.5f}", r.statistic, r.dof, r.p,
                          r.mass, r.drawn);
  return r;
}

template <class Locate, class Draw, class Cell>
ChiSquare run(const ChiOptions& o, const Draw& draw, const Locate& locate, const Cell& cell_mass) {
  const size_t n = size_t(o.rows) * o.columns;
  std::vector<double> observed(n), expected(n);
  double drawn = 0;
  Sampler sampler = make_sampler(SamplerKind::independent, o.seed, Side::camera, 0, 0);
  for (int i = 0; i < o.samples; ++i) {
    const Vec2 u = sampler.next2();
    const auto sample = draw(u, sampler.next1());
    if (!sample) continue;
    ++drawn;
    observed[locate(*sample)] += 1;
  }
  for (size_t i = 0; i < n; ++i) {
    const int row = int(i) / o.columns, column = int(i) % o.columns;
    // Where many samples fell a peak may hide between the points of the first grid.
    const int least = observed[i] > 0.01 * o.samples ? 2 : 0;
    expected[i] =
        o.samples * cell_mass(double(column) / o.columns, double(row) / o.rows, 1.0 / o.columns, 1.0 / o.rows, least);
  }
  return evaluate(std::move(observed), std::move(expected), drawn, o);
}

// Midpoint rule over the rectangle at (a, b), in the coordinates of the unit square.
template <class F>
double midpoints(int n, double a, double b, double width, double height, const F& f) {
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) sum += f(a + (j + 0.5) / n * width, b + (i + 0.5) / n * height);
  return sum * width * height / (double(n) * n);
}

// The same, quartered until it no longer changes by what the test could see.
template <class F>
double integrate(const ChiOptions& o, double a, double b, double width, double height, int least, const F& f,
                 int depth = 0) {
  const int n = o.quadrature;
  const double coarse = midpoints(n, a, b, width, height, f), fine = midpoints(2 * n, a, b, width, height, f);
  const bool settled = depth >= least && std::abs(fine - coarse) < 0.03 / o.samples + 1e-3 * fine;
  if (settled || depth == 8) return fine;
  double sum = 0;
  for (int i = 0; i < 4; ++i)
    sum += integrate(o, a + (i & 1) * width / 2, b + (i >> 1) * height / 2, width / 2, height / 2, least, f, depth + 1);
  return sum;
}

}  // namespace

double chi_square_tail(double x, double dof) { return gamma_q(dof / 2, x / 2); }

ChiSquare chi_square_sphere(const DrawDirection& draw, const DirectionPdf& pdf, const ChiOptions& o) {
  // The poles, where cells are thin slivers, lie on the x axis: most densities peak near z, and break at the horizon z
  // = 0, which so becomes an edge between cells.
  const auto locate = [&](const Vec3& w) {
    const int row = std::clamp(int((1 - w.x) / 2 * o.rows), 0, o.rows - 1);
    double phi = std::atan2(w.z, w.y) / (2 * std::numbers::pi);
    if (phi < 0) phi += 1;
    return size_t(row) * o.columns + std::clamp(int(phi * o.columns), 0, o.columns - 1);
  };
  const auto at = [&](double a, double b) {
    const double x = 1 - 2 * b, s = std::sqrt(std::max(0.0, 1 - x * x)), phi = 2 * std::numbers::pi * a;
    return 4 * std::numbers::pi * pdf(Vec3(float(x), float(s * std::cos(phi)), float(s * std::sin(phi))));
  };
  const auto cell = [&](double a, double b, double width, double height, int least) {
    return integrate(o, a, b, width, height, least, at);
  };
  return run(o, draw, locate, cell);
}

ChiSquare chi_square_square(const DrawPoint& draw, const PointPdf& pdf, const ChiOptions& o) {
  const auto locate = [&](const Vec2& p) {
    return size_t(std::clamp(int(p.y * o.rows), 0, o.rows - 1)) * o.columns +
           std::clamp(int(p.x * o.columns), 0, o.columns - 1);
  };
  const auto at = [&](double a, double b) { return pdf(Vec2(float(a), float(b))); };
  const auto cell = [&](double a, double b, double width, double height, int least) {
    return integrate(o, a, b, width, height, least, at);
  };
  return run(
      o, [&](const Vec2& u, float) { return draw(u); }, locate, cell);
}

}  // namespace ajar::kit
