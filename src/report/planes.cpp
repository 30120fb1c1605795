#include "planes.h"

#include <fmt/format.h>

#include "ajar/core/error.h"

namespace ajar {
namespace {

void filter_rows(const Plane& in, std::span<const double> kernel, Plane& out) {
  const size_t width = size_t(in.width), radius = kernel.size() / 2;
  std::vector<double> row(width + 2 * radius);
  for (size_t y = 0; y < size_t(in.height); ++y) {
    const double* from = &in.values[y * width];
    std::fill_n(row.begin(), radius, from[0]);
    std::copy_n(from, width, row.begin() + ptrdiff_t(radius));
    std::fill_n(row.end() - ptrdiff_t(radius), radius, from[width - 1]);
    double* to = &out.values[y * width];
    for (size_t k = 0; k < kernel.size(); ++k)
      for (size_t x = 0; x < width; ++x) to[x] += kernel[k] * row[x + k];
  }
}

void filter_columns(const Plane& in, std::span<const double> kernel, Plane& out) {
  const size_t width = size_t(in.width);
  const int radius = int(kernel.size() / 2);
  for (int y = 0; y < in.height; ++y) {
    double* to = &out.values[size_t(y) * width];
    for (int k = -radius; k <= radius; ++k) {
      const double* from = &in.values[size_t(std::clamp(y + k, 0, in.height - 1)) * width];
      const double weight = kernel[size_t(k + radius)];
      for (size_t x = 0; x < width; ++x) to[x] += weight * from[x];
    }
  }
}

}  // namespace

std::array<Plane, 3> rgb_planes(const Picture& picture) {
  const std::array<size_t, 3> from = rgb_channels(picture);
  std::array<Plane, 3> planes;
  for (size_t c = 0; c < 3; ++c) {
    planes[c] = make_plane(picture.width, picture.height);
    for (size_t i = 0; i < planes[c].size(); ++i) planes[c][i] = picture.pixels[i * picture.names.size() + from[c]];
  }
  return planes;
}

Plane luminance_plane(const Picture& picture) {
  const std::array<Plane, 3> rgb = rgb_planes(picture);
  Plane plane = make_plane(picture.width, picture.height);
  for (size_t i = 0; i < plane.size(); ++i)
    plane[i] = 0.212671 * rgb[0][i] + 0.715160 * rgb[1][i] + 0.072169 * rgb[2][i];
  return plane;
}

void require_same_size(const Picture& image, const Picture& reference) {
  if (image.width != reference.width || image.height != reference.height)
    throw Error(fmt::format("the image has {}x{} pixels, the reference {}x{}; compare images of one size", image.width,
                            image.height, reference.width, reference.height));
  if (image.width <= 0 || image.height <= 0) throw Error("the images have no pixels; compare images that have some");
  require_sound("the image", image), require_sound("the reference", reference);
}

Plane filter_separable(const Plane& in, std::span<const double> along_x, std::span<const double> along_y) {
  Plane rows = make_plane(in.width, in.height), out = make_plane(in.width, in.height);
  filter_rows(in, along_x, rows);
  filter_columns(rows, along_y, out);
  return out;
}

std::vector<double> gaussian_kernel(double deviation, int radius) {
  std::vector<double> kernel;
  double sum = 0;
  for (int i = -radius; i <= radius; ++i) sum += kernel.emplace_back(std::exp(-i * i / (2 * deviation * deviation)));
  for (double& weight : kernel) weight /= sum;
  return kernel;
}

}  // namespace ajar
