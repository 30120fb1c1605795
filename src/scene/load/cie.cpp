#include <algorithm>
#include <array>
#include <cmath>

#include "loader.h"

namespace ajar {
namespace {

constexpr double first = 360, last = 830, step = 10;
constexpr int count = 48;

// CIE 1931 2 degree colour matching functions, 360 to 830 nm in steps of 10 nm (CIE 015:2018, table 1).
constexpr double matching[count][3] = {{0.0001299, 0.000003917, 0.0006061},
                                       {0.0004149, 0.00001239, 0.001946},
                                       {0.001368, 0.000039, 0.00645},
                                       {0.004243, 0.00012, 0.02005},
                                       {0.01431, 0.000396, 0.06785},
                                       {0.04351, 0.00121, 0.2074},
                                       {0.13438, 0.004, 0.6456},
                                       {0.2839, 0.0116, 1.3856},
                                       {0.34828, 0.023, 1.74706},
                                       {0.3362, 0.038, 1.77211},
                                       {0.2908, 0.06, 1.6692},
                                       {0.19536, 0.09098, 1.28764},
                                       {0.09564, 0.13902, 0.81295},
                                       {0.03201, 0.20802, 0.46518},
                                       {0.0049, 0.323, 0.272},
                                       {0.0093, 0.503, 0.1582},
                                       {0.06327, 0.71, 0.07825},
                                       {0.1655, 0.862, 0.04216},
                                       {0.2904, 0.954, 0.0203},
                                       {0.43345, 0.99495, 0.00875},
                                       {0.5945, 0.995, 0.0039},
                                       {0.7621, 0.952, 0.0021},
                                       {0.9163, 0.87, 0.00165},
                                       {1.0263, 0.757, 0.0011},
                                       {1.0622, 0.631, 0.0008},
                                       {1.0026, 0.503, 0.00034},
                                       {0.85445, 0.381, 0.00019},
                                       {0.6424, 0.265, 0.00005},
                                       {0.4479, 0.175, 0.00002},
                                       {0.2835, 0.107, 0},
                                       {0.1649, 0.061, 0},
                                       {0.0874, 0.032, 0},
                                       {0.04677, 0.017, 0},
                                       {0.0227, 0.00821, 0},
                                       {0.011359, 0.004102, 0},
                                       {0.00579, 0.002091, 0},
                                       {0.002899, 0.001047, 0},
                                       {0.00144, 0.00052, 0},
                                       {0.00069, 0.000249, 0},
                                       {0.000332, 0.00012, 0},
                                       {0.000166, 0.00006, 0},
                                       {0.000083, 0.00003, 0},
                                       {0.0000415, 0.000015, 0},
                                       {0.0000207, 0.0000075, 0},
                                       {0.0000103, 0.0000037, 0},
                                       {0.0000051, 0.0000018, 0},
                                       {0.0000025, 0.0000009, 0},
                                       {0.0000013, 0.0000005, 0}};

// CIE standard illuminant D65, the same wavelengths (ISO/CIE 11664-2).
constexpr double d65[count] = {46.6383, 52.0891, 49.9755, 54.6482, 82.7549, 91.486,  93.4318, 86.6823, 104.865, 117.008,
                               117.812, 114.861, 115.923, 108.811, 109.354, 107.802, 104.79,  107.689, 104.405, 104.046,
                               100,     96.3342, 95.788,  88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268,
                               80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.349,  61.604,  69.8856, 75.087,  63.5927,
                               46.4182, 66.8054, 63.3828, 64.304,  59.4519, 51.959,  57.4406, 60.3125};

// Cubic through the table (Catmull and Rom 1974): linear would flatten the peaks by half a percent.
DVec3 matching_at(double nm) {
  const double x = (nm - first) / step;
  const int i = std::clamp(int(x), 0, count - 2);
  const double t = x - i;
  const auto at = [](int k) {
    const double* row = matching[std::clamp(k, 0, count - 1)];
    return DVec3(row[0], row[1], row[2]);
  };
  const DVec3 a = at(i - 1), b = at(i), c = at(i + 1), d = at(i + 2);
  return glm::max(0.5 * (2.0 * b + t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)))),
                  DVec3(0));
}

double d65_at(double nm) {  // linear, as the standard says
  const double x = (nm - first) / step;
  const int i = std::clamp(int(x), 0, count - 2);
  return d65[i] + (x - i) * (d65[i + 1] - d65[i]);
}

// XYZ to linear RGB of the sRGB primaries and white (IEC 61966-2-1).
DVec3 to_rgb(const DVec3& c) {
  return {3.2404542 * c.x - 1.5371385 * c.y - 0.4985314 * c.z, -0.9692660 * c.x + 1.8760108 * c.y + 0.0415560 * c.z,
          0.0556434 * c.x - 0.2040259 * c.y + 1.0572252 * c.z};
}

// Integral of value(nm) under the colour matching functions. Light: divided by the integral of y, so that a flat
// spectrum has luminance 1. Surfaces: under D65 and divided by what white gives, so that a flat one is grey.
template <class Value>
DVec3 integrate(const Value& value, Colour kind) {
  DVec3 sum(0), white(0);
  for (double nm = first + 0.5; nm < last; nm += 1) {
    const DVec3 weight = matching_at(nm) * (kind == Colour::emission ? 1.0 : d65_at(nm));
    sum += value(nm) * weight;
    white += weight;
  }
  return kind == Colour::emission ? to_rgb(sum) / white.y : to_rgb(sum) / to_rgb(white);
}

}  // namespace

Rgb rgb_of_list(std::vector<std::pair<double, double>> list, Colour kind) {
  std::stable_sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  const auto value = [&](double nm) {
    if (list.empty() || nm < list.front().first || nm > list.back().first) return 0.0;
    const auto above =
        std::upper_bound(list.begin(), list.end(), nm, [](double x, const auto& p) { return x < p.first; });
    if (above == list.end() || above == list.begin()) return list.back().second;
    const auto below = above - 1;
    return below->second + (above->second - below->second) * (nm - below->first) / (above->first - below->first);
  };
  return Rgb(integrate(value, kind));
}

Rgb rgb_of_blackbody(double kelvin) {
  constexpr double h = 6.62607015e-34, c = 299792458, k = 1.380649e-23;
  return Rgb(integrate(
      [&](double nm) {
        const double m = nm * 1e-9;
        return 2 * h * c * c / (m * m * m * m * m) / std::expm1(h * c / (m * k * kelvin)) * 1e-9;  // Planck 1901
      },
      Colour::emission));
}

}  // namespace ajar
