// Enters: pictures.
// Leaves: planes of doubles, filtered; the parts that the figures of difference are made of.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "ajar/film/picture.h"

namespace ajar {

/// One channel in rows from the top.
struct Plane {
  int width = 0, height = 0;
  std::vector<double> values;

  size_t size() const { return values.size(); }
  double& operator[](size_t i) { return values[i]; }
  double operator[](size_t i) const { return values[i]; }
};

inline Plane make_plane(int width, int height) {
  return {width, height, std::vector<double>(size_t(width) * size_t(height))};
}

/// Of rgb_channels; throws Error without them.
std::array<Plane, 3> rgb_planes(const Picture& picture);
/// Relative luminance of the three, linear.
Plane luminance_plane(const Picture& picture);
/// Names of the channels of an image's variance.
inline constexpr std::array variance_channels = {"Variance.R", "Variance.G", "Variance.B"};
/// Of these, those that a picture lacks.
std::vector<std::string> lacking_variance(const Picture& picture);
/// A picture of them alone; throws Error where one is missing.
Picture variance_of(const Picture& picture);
/// Throws Error that names both sizes where they differ.
void require_same_size(const Picture& image, const Picture& reference);

/// Odd-sized kernels applied to rows and columns (as correlations); the border's values continue outside.
Plane filter_separable(const Plane& in, std::span<const double> along_x, std::span<const double> along_y);
/// Gaussian of the given standard deviation in pixels at -radius ... radius, normalised to sum 1.
std::vector<double> gaussian_kernel(double deviation, int radius);

}  // namespace ajar
