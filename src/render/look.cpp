// How the squares of a guided image and those of path tracing compare, by eye.

#include <algorithm>
#include <numeric>

#include "ajar/render/plain.h"

namespace ajar {
namespace {

constexpr double exposed = 0.2;     // mean luminance of the lit image as it would be looked at
constexpr double dark = 0.01;       // of relMSE
constexpr double least_miss = 0.1;  // of a square's light

// One half of the passes less the other: what the sum is off by, in expectation.
glm::dvec3 difference(const PassHalves& h, size_t pixel) { return 2.0 * h.half[pixel] - h.sum[pixel]; }

glm::dvec3 squared(const glm::dvec3& x) { return x * x; }

struct Square {
  glm::dvec3 radiance{0};
  double mean = 0, variance = 0;  // of its luminance
};

Square square_of(const PassHalves& h, size_t first) {
  const double samples = double(h.passes) * plain_pixels;
  Square s;
  for (size_t i = first; i < first + plain_pixels; ++i) {
    s.radiance += h.sum[i] / samples;
    s.variance += sqr(luminance(difference(h, i)) / samples);
  }
  s.mean = luminance(s.radiance);
  return s;
}

struct Mean {
  double value = 0, deviation = 0;  // standard deviation of the mean
};

Mean mean_of(const std::vector<double>& x) {
  const double n = double(x.size()), mean = std::accumulate(x.begin(), x.end(), 0.0) / n;
  const double square_sum = std::accumulate(x.begin(), x.end(), 0.0, [](double a, double e) { return a + sqr(e); });
  return {mean, std::sqrt(std::max(square_sum / n - sqr(mean), 0.0) / n)};
}

// Scale with which to look at these squares. What is whiter than white counts as white: a lamp in view
// must not make all else dark.
double exposure(const std::vector<Square>& squares) {
  std::vector<double> luminances;
  for (const Square& s : squares)
    if (s.mean > 0) luminances.push_back(s.mean);
  std::sort(luminances.begin(), luminances.end());
  const double wanted = exposed * double(luminances.size());
  double rest = std::accumulate(luminances.begin(), luminances.end(), 0.0);
  for (size_t k = luminances.size(); k > 0; --k) {  // this many are not white
    const double scale = (wanted - double(luminances.size() - k)) / rest;
    if (scale * luminances[k - 1] <= 1) return scale;
    rest -= luminances[k - 1];
  }
  return 0;
}

}  // namespace

PlainLook compare_halves(const PassHalves& guided, const PassHalves& plain) {
  PlainLook out;
  const double pixels = double(guided.sum.size()), n = guided.passes;
  std::vector<Square> squares;
  for (size_t first = 0; first < guided.sum.size(); first += plain_pixels) squares.push_back(square_of(guided, first));
  const double scale = exposure(squares);
  if (!(scale > 0) || !(scale < infinity)) return out;
  std::vector<double> errors[2], biases;
  for (size_t first = 0; first < guided.sum.size(); first += plain_pixels) {
    const Square &a = squares[first / plain_pixels], b = square_of(plain, first);
    const double level = scale * a.mean;
    // A pixel counts half, so that fireflies hardly excuse themselves.
    for (size_t i = first; i < first + plain_pixels; ++i) {
      const glm::dvec3 of = squared(0.5 * scale * (a.radiance + guided.sum[i] / n)) + dark;
      errors[0].push_back(mean(squared(scale * difference(guided, i) / n) / of));
      errors[1].push_back(mean(squared(scale * difference(plain, i) / double(plain.passes)) / of));
    }
    const double off = a.mean - b.mean, variance = a.variance + b.variance;
    biases.push_back(sqr(scale) * (sqr(off) - variance) / (sqr(level) + dark));
    // It came in no sample of the square, or in few: so rare it is.
    if (std::abs(off) > least_miss * a.mean && sqr(off) > 9 * variance)
      out.missed += std::copysign(sqr(scale * off), off) / (sqr(level) + dark) * sqr(double(plain_pixels)) / pixels;
  }
  trim(errors[0]), trim(errors[1]);
  const Mean own = mean_of(errors[0]), other = mean_of(errors[1]), bias = mean_of(biases);
  out.guided = own.value, out.plain = other.value, out.deviation = other.deviation;
  out.missed = std::max(out.missed, 0.0), out.bias = std::max(bias.value - bias.deviation, 0.0);
  return out;
}

double missed_by_plain(const PlainLook& look, bool merges) {
  return merges ? std::max(look.missed - plain_pixels * look.bias, 0.0) : look.missed;
}

}  // namespace ajar
