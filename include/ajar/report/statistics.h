// Enters: error against time, one curve per seed.
// Leaves: what is said of many seeds: medians with their spread, slopes, ratios to a baseline, win or loss.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace ajar {

struct CurvePoint {
  double time = 0;   ///< of any unit, > 0
  double error = 0;  ///< >= 0; smaller is better
  double spp = 0;
};
/// In order of time.
using Curve = std::vector<CurvePoint>;

/// low and high are the quartiles, or least and greatest of fewer than 4 values.
struct Spread {
  double median = 0, low = 0, high = 0;
};
/// Quantiles interpolate linearly between the sorted values (Hyndman and Fan 1996, definition 7). Nothing of nothing.
std::optional<Spread> spread(std::vector<double> values);

/// Least-squares slope of log error over log time, over points of at least 4 spp; nothing where fewer than 3 such
/// points have a positive error, or no two differ in time.
std::optional<double> fitted_slope(const Curve& curve);

/// The error at a time within the curve, interpolated in log-log; nothing outside.
std::optional<double> error_at(const Curve& curve, double time);

/// How much smaller a curve's error is than the baseline's when the first of the two ends: baseline / curve. Nothing
/// without points in common, or where both errors are zero; the other's zero gives infinity or zero.
std::optional<double> error_ratio(const Curve& curve, const Curve& baseline);

/// When a curve came to an error for good: where it crosses the error for the last time, interpolated in log-log.
struct Reached {
  double time = 0;
  bool at_most = false;  ///< the first point is below the error already: it took no longer than this
};
/// Nothing where the last point is above the error: no curve is extrapolated.
std::optional<Reached> time_to(const Curve& curve, double error);

/// How many times as long the baseline needs to the error that both reach, which is the larger of their last. Nothing
/// where the slower one was there before its first point, since it may be the faster one.
struct TimeRatio {
  double value = 1;
  bool bound = false;  ///< the faster one was there before its first point: the truth is farther from 1
};
std::optional<TimeRatio> time_ratio(const Curve& curve, const Curve& baseline);

/// Of error ratios of several seeds: "win" where their spread is above 1, "loss" where below, and Student's t-test on
/// their logarithms gives equal methods less than 5 % for a mean as far off; else "tie", so always of one seed.
std::string verdict(const std::vector<double>& error_ratios);

}  // namespace ajar
