#include "student.h"

#include <cmath>
#include <initializer_list>

namespace ajar {
namespace {

/// Continued fraction of the incomplete beta function (DLMF 8.17.22), by Lentz's method; converges fast for
/// x < (a + 1) / (a + b + 2).
double beta_fraction(double x, double a, double b) {
  constexpr double tiny = 1e-300, precision = 1e-15;
  double c = 1, d = 1 - (a + b) * x / (a + 1);
  d = 1 / (std::abs(d) < tiny ? tiny : d);
  double value = d;
  for (int m = 1; m < 10000; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    double factor = 1;
    for (const double term : {even, odd}) {
      d = 1 + term * d;
      d = 1 / (std::abs(d) < tiny ? tiny : d);
      c = 1 + term / c;
      if (std::abs(c) < tiny) c = tiny;
      factor = c * d;
      value *= factor;
    }
    if (std::abs(factor - 1) < precision) break;
  }
  return value;
}

/// Regularised incomplete beta function I_x(a, b), with y = 1 - x given so that neither loses digits.
double incomplete_beta(double x, double y, double a, double b) {
  if (x <= 0) return 0;
  if (y <= 0) return 1;
  const double log_front = a * std::log(x) + b * std::log(y) + std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b);
  if (x < (a + 1) / (a + b + 2)) return std::exp(log_front) * beta_fraction(x, a, b) / a;
  return 1 - std::exp(log_front) * beta_fraction(y, b, a) / b;
}

}  // namespace

double student_tail(double t, double dof) {
  // DLMF has no t; P(|T| > t) = I_x(dof / 2, 1 / 2) at x = dof / (dof + t^2) (Abramowitz and Stegun 26.7.1, 26.5.27).
  const double square = t * t, x = dof / (dof + square), y = square / (dof + square);
  return 0.5 * incomplete_beta(x, y, dof / 2, 0.5);
}

}  // namespace ajar
