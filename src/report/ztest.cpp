// The test that two images differ by noise only (docs/notation.md, "The z-test"): regions of all sizes, from the whole
// image to some tens of pixels, each asked whether its summed difference is within its summed variance.
#include <fmt/format.h>

#include "ajar/core/error.h"
#include "ajar/report/metrics.h"
#include "planes.h"
#include "student.h"

namespace ajar {
namespace {

constexpr double rounding = 1e-5;     // relative difference that sums of floats may make
constexpr double fewest_pixels = 16;  // effective number of pixels that makes a region

struct Region {
  int x, y, width, height;
};

/// Difference, its variance, and the magnitude that rounding is relative to; one colour channel.
struct Comparison {
  Plane difference, variance, magnitude;
};

struct Sums {
  double difference = 0, variance = 0, variance2 = 0, magnitude = 0;
};

Sums sum_region(const Comparison& channel, const Region& region) {
  Sums s;
  for (int y = region.y; y < region.y + region.height; ++y)
    for (int x = region.x; x < region.x + region.width; ++x) {
      const size_t i = size_t(y) * size_t(channel.difference.width) + size_t(x);
      const double d = channel.difference[i], v = channel.variance[i];
      s.difference += d;
      s.variance += v;
      s.variance2 += v * v;
      s.magnitude += channel.magnitude[i];
    }
  return s;
}

/// Kish's effective number: how many pixels of equal variance would be as good.
double effective_pixels(const Sums& s) { return s.variance2 > 0 ? s.variance * s.variance / s.variance2 : 0; }

double beyond_rounding(double difference, double magnitude) {
  return std::copysign(std::max(std::abs(difference) - rounding * magnitude, 0.0), difference);
}

/// Two-sided p-value of a region: Student's t with the effective number of pixels.
double region_p(const Sums& s, double inflation) {
  const double difference = std::abs(beyond_rounding(s.difference, s.magnitude));
  if (difference == 0) return 1;
  if (s.variance <= 0) return 0;
  const double t = difference / std::sqrt(s.variance * inflation);
  return std::min(2 * student_tail(t, std::max(effective_pixels(s) - 1, 1.0)), 1.0);
}

/// What neighbouring pixels share (a reconstruction filter's splats) makes a region's sum vary more than the sum of
/// variances says: by the median of squared differences between z of adjacent blocks, over that of independent numbers.
/// At least 1.
double correlation_inflation(const Comparison& channel) {
  constexpr double median_chi2 = 0.45493642311957283;  // of chi-square with one degree of freedom
  constexpr size_t fewest = 12;
  const int width = channel.difference.width, height = channel.difference.height;
  const int side = std::min(width, height) >= 64 ? 8 : 4;
  const int columns = width / side, rows = height / side;
  Plane z = make_plane(columns, rows);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const Sums s = sum_region(channel, {x * side, y * side, side, side});
      z[size_t(y * columns + x)] = s.variance > 0 ? s.difference / std::sqrt(s.variance) : 0;
    }
  std::vector<double> squares;
  const auto add = [&](double a, double b) {
    if (a != 0 && b != 0) squares.push_back((a - b) * (a - b) / 2);
  };
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const size_t i = size_t(y * columns + x);
      if (x + 1 < columns) add(z[i], z[i + 1]);
      if (y + 1 < rows) add(z[i], z[i + size_t(columns)]);
    }
  if (squares.size() < fewest) return 1;
  const auto middle = squares.begin() + ptrdiff_t(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  return std::max(*middle / median_chi2, 1.0);
}

/// The regions of one size.
struct Level {
  double count = 0, least_p = 1;
  Region region{};
  char channel = 'R';
};

/// Tests a region, then its halves while both have pixels enough.
void descend(const Comparison& channel, char name, double inflation, const Region& region, const Sums& sums,
             size_t depth, std::vector<Level>& levels) {
  if (levels.size() <= depth) levels.resize(depth + 1);
  Level& level = levels[depth];
  ++level.count;
  const double p = region_p(sums, inflation);
  if (p < level.least_p || level.count == 1) {
    level.least_p = p;
    level.region = region;
    level.channel = name;
  }
  Region first = region, second = region;
  if (region.width >= region.height) {
    first.width /= 2;
    second.x += first.width;
    second.width -= first.width;
  } else {
    first.height /= 2;
    second.y += first.height;
    second.height -= first.height;
  }
  const Sums a = sum_region(channel, first), b = sum_region(channel, second);
  if (effective_pixels(a) < fewest_pixels || effective_pixels(b) < fewest_pixels) return;
  descend(channel, name, inflation, first, a, depth + 1, levels);
  descend(channel, name, inflation, second, b, depth + 1, levels);
}

/// Per-pixel figures.
void pixel_figures(const std::array<Comparison, 3>& channels, ZTest& test) {
  double count = 0, sum = 0, squares = 0;
  for (const Comparison& channel : channels)
    for (size_t i = 0; i < channel.variance.size(); ++i) {
      if (channel.variance[i] <= 0) continue;
      const double z = beyond_rounding(channel.difference[i], channel.magnitude[i]) / std::sqrt(channel.variance[i]);
      ++count;
      sum += z;
      squares += z * z;
      if (std::abs(z) > std::abs(test.worst)) {
        test.worst = z;
        test.worst_x = int(i % size_t(channel.variance.width));
        test.worst_y = int(i / size_t(channel.variance.width));
      }
    }
  if (count > 0) test.mean = sum / count;
  if (count > 1) test.variance = (squares - sum * sum / count) / (count - 1);
}

void add_variance(const Picture& picture, std::array<Comparison, 3>& channels) {
  if (!has_variance(picture)) return;
  const Picture variance = variance_of(picture);
  for (size_t c = 0; c < 3; ++c)
    for (size_t i = 0; i < channels[c].variance.size(); ++i)
      channels[c].variance[i] += double(variance.pixels[3 * i + c]);
}

}  // namespace

std::vector<std::string> lacking_variance(const Picture& picture) {
  std::vector<std::string> lacking;
  for (const char* name : variance_channels)
    if (std::find(picture.names.begin(), picture.names.end(), name) == picture.names.end()) lacking.emplace_back(name);
  return lacking;
}

Picture variance_of(const Picture& picture) {
  return select(picture, {variance_channels.begin(), variance_channels.end()});
}

bool has_variance(const Picture& picture) { return lacking_variance(picture).empty(); }

Picture with_variance(const Picture& image, const Picture& variance) {
  if (image.width != variance.width || image.height != variance.height)
    throw Error(fmt::format("the image has {}x{} pixels, its variance {}x{}; give the variance of this image",
                            image.width, image.height, variance.width, variance.height));
  const Picture from = has_variance(variance) ? variance_of(variance) : select(variance, {"R", "G", "B"});
  Picture both{image.width, image.height, {}, {}};
  std::vector<size_t> kept;
  for (size_t c = 0; c < image.names.size(); ++c)
    if (!image.names[c].starts_with("Variance.")) {
      kept.push_back(c);
      both.names.push_back(image.names[c]);
    }
  both.names.insert(both.names.end(), variance_channels.begin(), variance_channels.end());
  for (size_t i = 0; i < from.pixels.size() / 3; ++i) {
    for (const size_t c : kept) both.pixels.push_back(image.pixels[i * image.names.size() + c]);
    both.pixels.insert(both.pixels.end(), {from.pixels[3 * i], from.pixels[3 * i + 1], from.pixels[3 * i + 2]});
  }
  return both;
}

namespace {

std::array<Comparison, 3> comparisons_of(const Picture& image, const Picture& reference) {
  const std::array<Plane, 3> a = rgb_planes(image), b = rgb_planes(reference);
  std::array<Comparison, 3> channels;
  for (size_t c = 0; c < 3; ++c) {
    channels[c].difference = channels[c].variance = channels[c].magnitude = make_plane(image.width, image.height);
    for (size_t i = 0; i < a[c].size(); ++i) {
      channels[c].difference[i] = a[c][i] - b[c][i];
      channels[c].magnitude[i] = std::max(std::abs(a[c][i]), std::abs(b[c][i]));
    }
  }
  add_variance(image, channels);
  add_variance(reference, channels);
  // A deviation below rounding is what rounding left of none: the samples were equal, which is no measure of noise.
  for (Comparison& channel : channels)
    for (size_t i = 0; i < channel.variance.size(); ++i)
      if (const double least = rounding * channel.magnitude[i]; channel.variance[i] <= least * least)
        channel.variance[i] = 0;
  return channels;
}

// Bonferroni: level k may use the share 1 / ((k + 1)(k + 2)) of the significance (they sum to less than 1), half of it
// the whole image; within a level all regions and channels alike.
void most_significant(const std::vector<Level>& levels, const Region& whole, ZTest& test) {
  test.p = 2;  // more than any probability: where nothing stands out, the region is the whole image
  test.width = whole.width, test.height = whole.height;
  for (size_t k = 0; k < levels.size(); ++k) {
    const double p = levels[k].least_p * levels[k].count * double((k + 1) * (k + 2));
    if (p >= test.p) continue;
    const Region& r = levels[k].region;
    test.p = p;
    test.x = r.x, test.y = r.y, test.width = r.width, test.height = r.height;
    test.channel = levels[k].channel;
  }
  test.p = std::min(test.p, 1.0);
}

}  // namespace

ZTest z_test(const Picture& image, const Picture& reference) {
  require_same_size(image, reference);
  if (!has_variance(image) && !has_variance(reference))
    throw Error("no image has channels Variance.R, Variance.G, Variance.B; render with variance, or name its file");
  const std::array<Comparison, 3> channels = comparisons_of(image, reference);
  ZTest test;
  pixel_figures(channels, test);
  std::vector<Level> levels;
  const Region whole{0, 0, image.width, image.height};
  for (size_t c = 0; c < 3; ++c)
    descend(channels[c], "RGB"[c], correlation_inflation(channels[c]), whole, sum_region(channels[c], whole), 0,
            levels);
  most_significant(levels, whole, test);
  return test;
}

}  // namespace ajar
