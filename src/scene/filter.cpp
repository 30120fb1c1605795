#include "ajar/scene/filter.h"

#include <fmt/format.h>

#include "ajar/core/error.h"
#include "ajar/core/warp.h"

namespace ajar {
namespace {

constexpr int table_size = 512;

double sinc(double x) { return x == 0 ? 1 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x); }

// Mitchell and Netravali 1988, Reconstruction Filters in Computer Graphics, equation 8; support 2.
double cubic(double x, double B, double C) {
  x = std::abs(x);
  if (x >= 2) return 0;
  if (x < 1) return ((12 - 9 * B - 6 * C) * x * x * x + (-18 + 12 * B + 6 * C) * x * x + (6 - 2 * B)) / 6;
  return ((-B - 6 * C) * x * x * x + (6 * B + 30 * C) * x * x + (-12 * B - 48 * C) * x + (8 * B + 24 * C)) / 6;
}

// The kernel's formula, not normalised. A radius other than the usual one stretches the cubics and cuts the others.
double formula(const Filter& f, double x) {
  switch (f.kind) {
    case FilterKind::gaussian: {
      const double k = -0.5 / (double(f.a) * f.a), r = f.radius;
      return std::exp(k * x * x) - std::exp(k * r * r);
    }
    case FilterKind::mitchell:
      return cubic(2 * x / f.radius, f.a, f.b);
    case FilterKind::catmullrom:
      return cubic(2 * x / f.radius, 0, 0.5);
    case FilterKind::lanczos:
      return std::abs(x) >= f.a ? 0 : sinc(x) * sinc(x / f.a);
    default:
      return 1;
  }
}

float usual_parameter(FilterKind kind) {
  switch (kind) {
    case FilterKind::gaussian:
      return 0.5f;
    case FilterKind::mitchell:
      return 1.0f / 3;
    case FilterKind::lanczos:
      return 3;
    default:
      return 0;
  }
}

float usual_radius(FilterKind kind, float a) {
  switch (kind) {
    case FilterKind::box:
      return 0.5f;
    case FilterKind::tent:
      return 1;
    case FilterKind::gaussian:
      return 4 * a;
    case FilterKind::lanczos:
      return a;
    default:
      return 2;
  }
}

// Integral of the absolute value of a line from a to b over a unit interval.
double absolute_area(double a, double b) {
  return a * b < 0 ? (a * a + b * b) / (2 * std::abs(a - b)) : std::abs(a + b) / 2;
}

void fill_tables(Filter& f) {
  std::vector<double> values(table_size + 1);
  for (int i = 0; i <= table_size; ++i) values[i] = formula(f, (2.0 * i / table_size - 1) * f.radius);
  const double step = 2.0 * f.radius / table_size;
  double area = 0, absolute = 0;
  for (int i = 0; i < table_size; ++i) {
    area += (values[i] + values[i + 1]) / 2 * step;
    absolute += absolute_area(values[i], values[i + 1]) * step;
  }
  f.table.resize(table_size + 1);
  f.cdf.resize(table_size + 1);
  f.sign_norm = float(absolute / area);
  double sum = 0;
  for (int i = 0; i <= table_size; ++i) {
    f.table[i] = float(values[i] / area);
    f.cdf[i] = float(sum / absolute);
    if (i < table_size) sum += absolute_area(values[i], values[i + 1]) * step;
  }
  f.cdf[table_size] = 1;
}

// Place in [0,1] up to which a line from a >= 0 to b >= 0 over the unit interval has the share u of its integral.
float invert_line(float a, float b, float u) {
  const float root = std::sqrt(a * a + u * (b * b - a * a));
  return a + root > 0 ? u * (a + b) / (a + root) : u;
}

// The same for the absolute value, where the line may cross zero.
float invert_absolute_line(float a, float b, float u) {
  if (a * b >= 0) return invert_line(std::abs(a), std::abs(b), u);
  const float zero = a / (a - b), first = a * a / (a * a + b * b);
  return u < first ? zero * invert_line(1, 0, u / first)
                   : zero + (1 - zero) * invert_line(0, 1, (u - first) / (1 - first));
}

float sample_table(const Filter& f, float u, float& weight) {
  uint32_t i = 0;
  for (uint32_t half = table_size / 2; half > 0; half /= 2) i += f.cdf[i + half] <= u ? half : 0;
  const float a = f.table[i], b = f.table[i + 1], share = (u - f.cdf[i]) / (f.cdf[i + 1] - f.cdf[i]);
  const float in_bin = std::clamp(invert_absolute_line(a, b, share), 0.0f, 1.0f);
  weight *= a + (b - a) * in_bin < 0 ? -f.sign_norm : f.sign_norm;
  return ((float(i) + in_bin) * (2.0f / table_size) - 1) * f.radius;
}

void require_within(const char* what, float value, float least, float most) {
  if (!(value >= least && value <= most))
    throw Error(fmt::format("filter: its {} is {}; give it {} to {}", what, value, least, most));
}

void check_filter(const Filter& f) {
  if (f.kind == FilterKind::gaussian) require_within("stddev", f.a, 0.05f, 16);
  if (f.kind == FilterKind::lanczos) require_within("number of lobes", f.a, 1, 16);
  if (f.kind == FilterKind::mitchell) require_within("B", f.a, -4, 4), require_within("C", f.b, -4, 4);
}

}  // namespace

Filter make_filter(FilterKind kind, float radius, std::optional<float> a, std::optional<float> b) {
  Filter f;
  f.kind = kind;
  f.a = a.value_or(usual_parameter(kind));
  f.b = b.value_or(kind == FilterKind::mitchell ? usual_parameter(kind) : 0);
  check_filter(f);
  if (radius != 0) require_within("radius", radius, 0.05f, 16);
  f.radius = radius != 0 ? radius : usual_radius(kind, f.a);
  if (kind != FilterKind::box && kind != FilterKind::tent) fill_tables(f);
  return f;
}

float eval(const Filter& f, float x) {
  if (f.kind == FilterKind::box) return x >= -f.radius && x < f.radius ? 0.5f / f.radius : 0;
  if (f.kind == FilterKind::tent) return std::max(0.0f, f.radius - std::abs(x)) / (f.radius * f.radius);
  const float at = (x / f.radius + 1) * (table_size / 2);
  if (!(at >= 0 && at < table_size)) return 0;
  const int i = int(at);
  return f.table[i] + (f.table[i + 1] - f.table[i]) * (at - float(i));
}

Vec2 sample(const Filter& f, const Vec2& u, float& weight) {
  weight = 1;
  if (f.kind == FilterKind::box) return (2.0f * u - 1.0f) * f.radius;
  if (f.kind == FilterKind::tent) return Vec2(to_tent(u.x), to_tent(u.y)) * f.radius;
  const float x = sample_table(f, u.x, weight);
  return {x, sample_table(f, u.y, weight)};
}

}  // namespace ajar
