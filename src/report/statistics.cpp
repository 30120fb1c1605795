#include "ajar/report/statistics.h"

#include <algorithm>
#include <cmath>

#include "student.h"

namespace ajar {
namespace {

constexpr double fewest_spp = 4;  // below, the sampler's first points and unfinished passes show, not its rate

double quantile(const std::vector<double>& sorted, double share) {
  const double at = share * double(sorted.size() - 1);
  const size_t below = size_t(at), above = std::min(below + 1, sorted.size() - 1);
  if (sorted[below] == sorted[above]) return sorted[below];  // also infinities
  return sorted[below] + (at - double(below)) * (sorted[above] - sorted[below]);
}

/// y at x on the line through two points, all in logarithms; the ends exactly, also where an error is zero.
double interpolate(double x, double x0, double y0, double x1, double y1) {
  if (x == x0) return y0;
  if (x == x1) return y1;
  const double share = std::log(x / x0) / std::log(x1 / x0);
  if (y0 > 0 && y1 > 0) return y0 * std::pow(y1 / y0, share);
  return y0 + share * (y1 - y0);
}

/// Two-sided p-value of the t-test that the mean logarithm is zero; 1 of fewer than two.
double probability_of_equal(const std::vector<double>& ratios) {
  const double n = double(ratios.size());
  if (n < 2) return 1;
  double mean = 0, squares = 0;
  for (const double r : ratios) mean += std::log(r) / n;
  if (!std::isfinite(mean)) return 0;  // an error of zero: the spread alone decides
  for (const double r : ratios) squares += (std::log(r) - mean) * (std::log(r) - mean);
  if (squares == 0) return mean == 0 ? 1 : 0;
  return 2 * student_tail(std::abs(mean) / std::sqrt(squares / (n * (n - 1))), n - 1);
}

}  // namespace

std::optional<Spread> spread(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const bool few = values.size() < 4;
  return Spread{quantile(values, 0.5), few ? values.front() : quantile(values, 0.25),
                few ? values.back() : quantile(values, 0.75)};
}

std::optional<double> fitted_slope(const Curve& curve) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const CurvePoint& p : curve) {
    if (p.spp < fewest_spp || !(p.error > 0) || !(p.time > 0)) continue;
    const double a = std::log(p.time), b = std::log(p.error);
    ++n, x += a, y += b, xx += a * a, xy += a * b;
  }
  const double spread = n * xx - x * x;
  if (n < 3 || spread <= 1e-12 * n * xx) return {};
  return (n * xy - x * y) / spread;
}

std::optional<double> error_at(const Curve& curve, double time) {
  for (size_t i = 0; i < curve.size(); ++i) {
    if (curve[i].time == time) return curve[i].error;
    if (i > 0 && curve[i - 1].time < time && time < curve[i].time)
      return interpolate(time, curve[i - 1].time, curve[i - 1].error, curve[i].time, curve[i].error);
  }
  return {};
}

std::optional<double> error_ratio(const Curve& curve, const Curve& baseline) {
  if (curve.empty() || baseline.empty()) return {};
  const double end = std::min(curve.back().time, baseline.back().time);
  const auto own = error_at(curve, end), other = error_at(baseline, end);
  if (!own || !other || (*own == 0 && *other == 0)) return {};
  return *other / *own;
}

std::optional<Reached> time_to(const Curve& curve, double error) {
  if (curve.empty() || curve.back().error > error) return {};
  size_t i = curve.size() - 1;
  while (i > 0 && curve[i - 1].error <= error) --i;
  if (i == 0) return Reached{curve[0].time, curve[0].error < error};
  const CurvePoint &above = curve[i - 1], &below = curve[i];
  // The same line as error_at, asked the other way round.
  double share = (above.error - error) / (above.error - below.error);
  if (below.error > 0) share = std::log(above.error / error) / std::log(above.error / below.error);
  return Reached{above.time * std::pow(below.time / above.time, share), false};
}

std::optional<TimeRatio> time_ratio(const Curve& curve, const Curve& baseline) {
  if (curve.empty() || baseline.empty()) return {};
  const double error = std::max(curve.back().error, baseline.back().error);
  const auto own = time_to(curve, error), other = time_to(baseline, error);
  if (!own || !other || !(own->time > 0)) return {};
  const auto [faster, slower] = own->time < other->time ? std::pair(own, other) : std::pair(other, own);
  if (slower->at_most) return {};
  return TimeRatio{other->time / own->time, faster->at_most};
}

std::string verdict(const std::vector<double>& error_ratios) {
  const auto s = spread(error_ratios);
  if (!s || (s->low <= 1 && s->high >= 1) || probability_of_equal(error_ratios) >= 0.05) return "tie";
  return s->low > 1 ? "win" : "loss";
}

}  // namespace ajar
