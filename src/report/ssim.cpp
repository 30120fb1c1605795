#include "ajar/film/tone.h"
#include "ajar/report/metrics.h"
#include "planes.h"

namespace ajar {
namespace {

Plane encoded_luminance(const Picture& picture) {
  Plane plane = luminance_plane(picture);
  for (double& value : plane.values) value = tone_curve(value);
  return plane;
}

/// Local mean of a product.
Plane local_mean(const Plane& a, const Plane& b, std::span<const double> along_x, std::span<const double> along_y) {
  Plane product = a;
  for (size_t i = 0; i < product.size(); ++i) product[i] *= b[i];
  return filter_separable(product, along_x, along_y);
}

}  // namespace

double ssim(const Picture& image, const Picture& reference) {
  require_same_size(image, reference);
  constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;  // (K L)^2 with L = 1
  const auto radius = [](int size) { return std::min(5, (size - 1) / 2); };
  const int rx = radius(image.width), ry = radius(image.height);
  const std::vector<double> kx = gaussian_kernel(1.5, rx), ky = gaussian_kernel(1.5, ry);

  const Plane a = encoded_luminance(image), b = encoded_luminance(reference);
  const Plane mean_a = filter_separable(a, kx, ky), mean_b = filter_separable(b, kx, ky);
  const Plane aa = local_mean(a, a, kx, ky), bb = local_mean(b, b, kx, ky), ab = local_mean(a, b, kx, ky);
  double sum = 0;
  for (int y = ry; y < image.height - ry; ++y)
    for (int x = rx; x < image.width - rx; ++x) {
      const size_t i = size_t(y) * size_t(image.width) + size_t(x);
      const double ma = mean_a[i], mb = mean_b[i];
      const double var_a = aa[i] - ma * ma, var_b = bb[i] - mb * mb, covariance = ab[i] - ma * mb;
      sum += (2 * ma * mb + c1) * (2 * covariance + c2) / ((ma * ma + mb * mb + c1) * (var_a + var_b + c2));
    }
  return sum / (double(image.width - 2 * rx) * double(image.height - 2 * ry));
}

}  // namespace ajar
