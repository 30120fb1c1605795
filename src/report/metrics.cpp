#include "ajar/report/metrics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "ajar/core/error.h"
#include "ajar/film/film.h"
#include "ajar/film/tone.h"
#include "planes.h"

namespace ajar {
namespace {

void pixel_metrics(const std::array<Plane, 3>& image, const std::array<Plane, 3>& reference, Metrics& metrics) {
  const size_t pixels = image[0].size();
  std::vector<double> errors(pixels);
  for (size_t i = 0; i < pixels; ++i)
    for (size_t c = 0; c < 3; ++c) {
      const double a = image[c][i], r = reference[c][i], square = (a - r) * (a - r);
      metrics.mean += a;
      metrics.mean_reference += r;
      metrics.mse += square;
      errors[i] += square / (r * r + 0.01) / 3;
      metrics.mape += std::abs(a - r) / (std::abs(r) + 0.01);
    }
  for (const double error : errors) metrics.relmse += error;
  metrics.relmse /= double(pixels);
  for (double* sum : {&metrics.mean, &metrics.mean_reference, &metrics.mse, &metrics.mape}) *sum /= 3 * double(pixels);
  metrics.relmse_trimmed = trimmed_mean(std::move(errors));
}

// All three, or none.
void require_whole_variance(const Picture& picture, const std::string& file) {
  const std::vector<std::string> missing = lacking_variance(picture);
  if (!missing.empty() && missing.size() < 3)
    throw Error(fmt::format("{}: lacks {} of the three channels of its variance; write it with all, or with none", file,
                            fmt::join(missing, " and ")));
}

// Whether it has a variance above 0 in any pixel: after one pass none is known.
bool tells_noise(const Picture& picture) {
  if (!has_variance(picture)) return false;
  const Picture variance = variance_of(picture);
  return std::any_of(variance.pixels.begin(), variance.pixels.end(), [](float v) { return v > 0; });
}

}  // namespace

double mean_of(const Picture& picture) {
  double sum = 0;
  for (const float value : picture.pixels) sum += value;
  return sum / double(picture.pixels.size());
}

void require_comparable(const Picture& picture, const std::string& file, const char* cure) {
  std::array<size_t, 3> rgb;
  try {
    rgb = rgb_channels(picture);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", file, error.what()));
  }
  require_whole_variance(picture, file);
  for (size_t i = 0; i < picture.pixels.size(); ++i) {
    const size_t pixel = i / picture.names.size(), channel = i % picture.names.size();
    const std::string& name = picture.names[channel];
    const float value = picture.pixels[i];
    const bool colour = std::find(rgb.begin(), rgb.end(), channel) != rgb.end();
    const bool variance = name == "Variance.R" || name == "Variance.G" || name == "Variance.B";
    if ((!colour && !variance) || (std::isfinite(value) && (value >= 0 || !variance))) continue;
    throw Error(fmt::format("{}: channel {} of pixel ({}, {}) is {}; {}", file, name, pixel % size_t(picture.width),
                            pixel / size_t(picture.width), value, cure));
  }
}

Metrics compare(const Picture& image, const Picture& reference, bool with_flip) {
  require_same_size(image, reference);
  require_comparable(image, "the image");
  require_comparable(reference, "the reference");
  Metrics metrics;
  pixel_metrics(rgb_planes(image), rgb_planes(reference), metrics);
  metrics.ssim = ssim(image, reference);
  if (with_flip) metrics.flip = mean_of(flip(image, reference));
  metrics.has_z = tells_noise(image) || tells_noise(reference);
  if (metrics.has_z) metrics.z = z_test(image, reference);
  return metrics;
}

std::string to_json(const Metrics& m) {
  std::string line = fmt::format(
      R"({{"mean":{},"mean_reference":{},"mse":{},"relmse":{},"relmse_trimmed":{},"mape":{},"ssim":{},"flip":{},)",
      m.mean, m.mean_reference, m.mse, m.relmse, m.relmse_trimmed, m.mape, m.ssim, m.flip);
  if (!m.has_z)
    return line + R"("z_mean":null,"z_variance":null,"z_worst":null,"z_worst_pixel":null,"z_p":null,"z_region":null})";
  return line +
         fmt::format(R"("z_mean":{},"z_variance":{},"z_worst":{},"z_worst_pixel":[{},{}],"z_p":{},)", m.z.mean,
                     m.z.variance, m.z.worst, m.z.worst_x, m.z.worst_y, m.z.p) +
         fmt::format(R"("z_region":{{"channel":"{}","x":{},"y":{},"width":{},"height":{}}}}})", m.z.channel, m.z.x,
                     m.z.y, m.z.width, m.z.height);
}

Picture difference_picture(const Picture& image, const Picture& reference) {
  require_same_size(image, reference);
  const Plane a = luminance_plane(image), r = luminance_plane(reference);
  // sRGB-encoded: ends of ColorBrewer's RdBu, and white.
  constexpr double brighter[3] = {178, 24, 43}, darker[3] = {33, 102, 172}, white[3] = {255, 255, 255};
  Picture out{image.width, image.height, {"R", "G", "B"}, {}};
  out.pixels.reserve(3 * a.size());
  for (size_t i = 0; i < a.size(); ++i) {
    const double relative = (a[i] - r[i]) / (std::abs(r[i]) + 0.01),
                 tint = std::sqrt(std::min(std::abs(relative), 1.0));
    const double* end = relative > 0 ? brighter : darker;
    for (int c = 0; c < 3; ++c) out.pixels.push_back(float(decode_srgb((white[c] + tint * (end[c] - white[c])) / 255)));
  }
  return out;
}

}  // namespace ajar
