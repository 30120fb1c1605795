#include "kit/ztest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kit/chisquare.h"

namespace ajar::kit {
namespace {

constexpr int reach = 2;  // neighbourhood: 5 x 5 blocks

// A number with its noise. squares is variance^2 / degrees of freedom, for Satterthwaite's formula.
struct Noisy {
  double value = 0, variance = 0, squares = 0;
  Noisy& operator+=(const Noisy& o) {
    value += o.value, variance += o.variance, squares += o.squares;
    return *this;
  }
};

// Two numbers to be compared: what the difference needs.
struct Pair {
  Noisy a, b;
  Pair& operator+=(const Pair& o) {
    a += o.a, b += o.b;
    return *this;
  }
  double variance() const { return a.variance + b.variance; }
  double brightness() const { return std::max(a.value, b.value); }
  double dof() const { return a.squares + b.squares > 0 ? variance() * variance() / (a.squares + b.squares) : 1e9; }
};

struct Grid {
  int columns = 0, rows = 0, block = 1;
  size_t size() const { return size_t(columns) * size_t(rows); }
  size_t of_pixel(int x, int y) const { return size_t(y / block) * size_t(columns) + size_t(x / block); }
};

Noisy from_runs(const std::vector<double>& values) {
  const auto n = double(values.size());
  double mean = 0, spread = 0;
  for (const double v : values) mean += v / n;
  for (const double v : values) spread += (v - mean) * (v - mean);
  const double variance = spread / (n * (n - 1));
  return {mean, variance, variance * variance / (n - 1)};
}

// One channel of an estimate, pooled in blocks; with runs, the sums of every run: sums[block][run].
struct Pooled {
  std::vector<Noisy> blocks;
  std::vector<std::vector<double>> sums;
};

Pooled pool(const Estimate& e, const Grid& grid, int channel) {
  Pooled r;
  r.blocks.resize(grid.size());
  if (!e.runs.empty()) r.sums.assign(grid.size(), std::vector<double>(e.runs.size()));
  for (int y = 0; y < e.height; ++y)
    for (int x = 0; x < e.width; ++x) {
      const size_t i = (size_t(y) * size_t(e.width) + size_t(x)) * 3 + size_t(channel), b = grid.of_pixel(x, y);
      if (e.runs.empty()) r.blocks[b] += {e.mean[i], e.variance[i], e.variance[i] * e.variance[i] / e.dof};
      for (size_t k = 0; k < e.runs.size(); ++k) r.sums[b][k] += e.runs[k][i];
    }
  for (size_t b = 0; b < r.sums.size(); ++b) r.blocks[b] = from_runs(r.sums[b]);
  return r;
}

// The blocks' sum, each times its weight.
Noisy total(const Pooled& pooled, const std::vector<double>& weights) {
  Noisy sum;
  if (pooled.sums.empty()) {
    for (size_t i = 0; i < weights.size(); ++i) {
      const double w = weights[i], w2 = w * w;
      const Noisy& n = pooled.blocks[i];
      sum += {w * n.value, w2 * n.variance, w2 * w2 * n.squares};
    }
    return sum;
  }
  std::vector<double> runs(pooled.sums[0].size());
  for (size_t i = 0; i < weights.size(); ++i)
    for (size_t k = 0; k < runs.size(); ++k) runs[k] += weights[i] * pooled.sums[i][k];
  return from_runs(runs);
}

// Mean over a block's neighbourhood; its mean squared brightness beside it.
struct Around {
  Pair mean;
  double brightness2 = 0;
};

Around around(const std::vector<Pair>& pairs, const Grid& grid, int x, int y) {
  Around r;
  int n = 0;
  for (int v = std::max(0, y - reach); v <= std::min(grid.rows - 1, y + reach); ++v)
    for (int u = std::max(0, x - reach); u <= std::min(grid.columns - 1, x + reach); ++u, ++n) {
      const Pair& p = pairs[size_t(v) * size_t(grid.columns) + size_t(u)];
      r.mean += p;
      r.brightness2 += p.brightness() * p.brightness();
    }
  for (Noisy* side : {&r.mean.a, &r.mean.b}) side->value /= n, side->variance /= n, side->squares /= double(n) * n;
  r.brightness2 /= n;
  return r;
}

// The normal deviate as rare as Student's t with nu degrees of freedom (Wallace 1959, Bounds on Normal Approximations
// to Student's and the Chi-Square Distributions).
double normal_of_student(double t, double nu) {
  const double z = std::sqrt(nu * std::log1p(t * t / nu)) * (8 * nu + 1) / (8 * nu + 3);
  return std::copysign(std::isfinite(t) ? z : 1e9, t);
}

// A difference against its noise; equal numbers agree however sure they are.
double deviate(const Pair& p, double variance, double nu, double allowed) {
  const double difference = p.a.value - p.b.value;
  if (difference == 0) return 0;
  return normal_of_student(difference / std::sqrt(variance + allowed * allowed), std::max(nu, 1.0));
}

double two_sided(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }
// At least one of n independent tests has this p-value.
double one_of(double p, double n) { return p >= 1 ? 1 : -std::expm1(n * std::log1p(-p)); }

bool finite(const std::vector<double>& values, size_t n) {
  return values.size() == n && std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); });
}

bool valid(const Estimate& e) {
  if (e.width <= 0 || e.height <= 0 || e.runs.size() == 1) return false;
  const size_t n = size_t(e.width) * size_t(e.height) * 3;
  return finite(e.mean, n) && finite(e.variance, n) &&
         std::all_of(e.variance.begin(), e.variance.end(), [](double x) { return x >= 0; }) &&
         std::all_of(e.runs.begin(), e.runs.end(), [n](const auto& run) { return finite(run, n); });
}

// The tests of one channel; returns the statistic of chi-square and the z of the mean, keeps the worst block.
struct Verdict {
  double chi = 0, lean = 0;
};

Verdict test_channel(const Estimate& ea, const Estimate& eb, const Grid& grid, int channel, const Slack& slack,
                     ZTest& out) {
  const Pooled a = pool(ea, grid, channel), b = pool(eb, grid, channel);
  std::vector<Pair> pairs(grid.size());
  double brightness = 0;
  for (size_t i = 0; i < pairs.size(); ++i) {
    pairs[i] = {a.blocks[i], b.blocks[i]};
    brightness += pairs[i].brightness() / double(pairs.size());
  }
  Verdict r;
  const std::vector<double> plain(grid.size(), 1);
  std::vector<double> relative;
  for (int y = 0; y < grid.rows; ++y)
    for (int x = 0; x < grid.columns; ++x) {
      const Pair& p = pairs[size_t(y) * size_t(grid.columns) + size_t(x)];
      const Around n = around(pairs, grid, x, y);
      relative.push_back(1 / (n.mean.brightness() + 1e-2 * brightness + 1e-300));
      const double usual = n.brightness2 > 0 ? n.mean.variance() / n.brightness2 * p.brightness() * p.brightness() : 0;
      const double allowed = slack.relative * p.brightness() + slack.faint * brightness;
      const double z =
          deviate(p, std::max(p.variance(), usual), usual > p.variance() ? n.mean.dof() : p.dof(), allowed);
      r.chi += z * z;
      if (std::abs(z) <= std::abs(out.worst_z)) continue;
      out.worst_z = z, out.worst_x = x * grid.block, out.worst_y = y * grid.block, out.worst_channel = channel;
    }
  for (const auto& weights : {plain, relative}) {
    const Pair sum{total(a, weights), total(b, weights)};
    const double z = deviate(sum, sum.variance(), sum.dof(), slack.relative * sum.brightness());
    if (std::abs(z) > std::abs(r.lean)) r.lean = z;
  }
  return r;
}

}  // namespace

Estimate estimate(int width, int height, std::vector<std::vector<double>> runs) {
  Estimate e{width, height, {}, {}, std::max(1.0, double(runs.size()) - 1), std::move(runs)};
  const size_t n = e.runs.empty() ? 0 : e.runs[0].size();
  std::vector<double> values(e.runs.size());
  for (size_t i = 0; i < n; ++i) {
    for (size_t k = 0; k < values.size(); ++k) values[k] = e.runs[k].at(i);
    const Noisy noisy = from_runs(values);
    e.mean.push_back(noisy.value);
    e.variance.push_back(noisy.variance);
  }
  return e;
}

ZTest z_test(const Estimate& a, const Estimate& b, double level, int block, const Slack& slack) {
  ZTest r;
  if (!valid(a) || !valid(b) || a.width != b.width || a.height != b.height) {
    r.p = r.p_max = r.p_chi = r.p_mean = 0;
    r.message = "images of different sizes, a single run, or values that are not finite (or negative variances)";
    return r;
  }
  const Grid grid{(a.width + block - 1) / block, (a.height + block - 1) / block, block};
  double lean = 0;
  for (int channel = 0; channel < 3; ++channel) {
    const Verdict v = test_channel(a, b, grid, channel, slack, r);
    r.p_chi = std::min(r.p_chi, chi_square_tail(v.chi, double(grid.size())));
    if (std::abs(v.lean) > std::abs(lean)) lean = v.lean;
  }
  r.p_chi = one_of(r.p_chi, 3);
  r.p_max = one_of(two_sided(r.worst_z), 3 * double(grid.size()));
  r.p_mean = one_of(two_sided(lean), 6);
  r.p = one_of(std::min({r.p_max, r.p_chi, r.p_mean}), 3);
  r.ok = r.p >= level;
  r.message = fmt::format(
      "p = {:.3g} (max {:.3g}, chi-square {:.3g}, mean {:.3g}, z of mean {:+.2f}); worst block: {} at pixel ({}, {}), "
      "z = {:+.2f}",
      r.p, r.p_max, r.p_chi, r.p_mean, lean, "RGB"[r.worst_channel], r.worst_x, r.worst_y, r.worst_z);
  return r;
}

}  // namespace ajar::kit
