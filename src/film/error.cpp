// How much a film errs, as its passes tell: from their spread, and from what two halves of them differ by.

#include <algorithm>
#include <limits>
#include <numeric>

#include "ajar/film/film.h"
#include "ajar/film/pixels.h"

namespace ajar {
namespace {

// From the spread of the passes, of which there are two or more.
glm::dvec3 variance_of_mean(const Film& film, size_t i, const glm::dvec3& mean) {
  const double n = film.passes;
  return glm::max((film.square_sum[i] / n - mean * mean) / (n - 1), glm::dvec3(0));
}

bool is_all_zero(const std::vector<glm::dvec3>& values) {
  return std::all_of(values.begin(), values.end(), [](const glm::dvec3& v) { return v == glm::dvec3(0); });
}

std::vector<glm::dvec3> means(const Film& film) {
  std::vector<glm::dvec3> mean = film.camera_sum;
  for (size_t i = 0; i < mean.size(); ++i)
    mean[i] = (mean[i] + (film.splats ? film.splat_sum[i] : glm::dvec3(0))) / double(film.passes);
  return mean;
}

// Of the pixels up to two away in x and y, without the pixel itself.
glm::dvec3 mean_around(const Film& film, const std::vector<glm::dvec3>& mean, int x, int y) {
  const glm::dvec3 own = mean[size_t(y) * film.width + x];
  glm::dvec3 total = -own;
  int count = -1;
  for_each_around(film, x, y, 2, [&](size_t i) { total += mean[i], ++count; });
  return count > 0 ? total / double(count) : own;
}

// The mean of the even passes less that of the odd ones.
glm::dvec3 halves_apart(const Film& film, size_t i, const glm::dvec3& mean) {
  const Summed even = even_passes(film);
  return film.half_sum[i] / even.passes -
         (film.weight * mean - even.weight / even.passes * film.half_sum[i]) / (film.weight - even.weight);
}

// Of the square by which the halves are apart, what is the error's. (E1)
double share_of_halves(const Film& film) {
  return film.half_weight * (film.weight - film.half_weight) / sqr(film.weight);
}

// Mean over the channels of the squared error over that of the true value. A sample that makes a pixel wrong makes it
// bright too, and must not hide its error by that: so far as the passes disagree about the pixel, the neighbours have a
// say, within what the passes leave no doubt of. epsilon: what a square is divided by at least.
double pixel_error(const Film& film, const std::vector<glm::dvec3>& mean, double epsilon, int x, int y) {
  const size_t i = size_t(y) * film.width + x;
  const glm::dvec3 near = mean_around(film, mean, x, y), v = variance_of_mean(film, i, mean[i]);
  const glm::dvec3 apart = halves_apart(film, i, mean[i]);
  const double share = share_of_halves(film);
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    const double m = mean[i][c], square = apart[c] * apart[c] * share;  // (E1)
    const double trust = m * m > 0 ? m * m / (m * m + 20 * v[c]) : 0;   // (E2)
    const double sure = std::max(m - 2 * std::sqrt(v[c]), 0.0);
    const double dim = std::max(std::min(m * m, near[c] * near[c]), sure * sure);
    sum += square * (trust / (m * m + epsilon) + (1 - trust) / (dim + epsilon));  // (E3)
  }
  return sum / 3;
}

ErrorEstimate estimate(const Film& film, const std::vector<glm::dvec3>& mean, double epsilon) {
  if (is_all_zero(mean)) return {};
  std::vector<double> errors = each_pixel(film, [&](int x, int y) { return pixel_error(film, mean, epsilon, x, y); });
  const double more = film.passes / (film.passes + share_of_pass(film));
  ErrorEstimate out;
  out.relmse = more * std::accumulate(errors.begin(), errors.end(), 0.0) / double(errors.size());
  out.relmse_trimmed = more * trimmed_mean(std::move(errors));
  return out;
}

// What is added to squares of radiance: 0.01 of an image exposed to a mean luminance of a fifth.
double exposed_epsilon(const std::vector<glm::dvec3>& mean) {
  double light = 0;
  for (const glm::dvec3& m : mean) light += luminance(Rgb(m));
  const double exposed = light / double(mean.size()) / 0.2;
  return 0.01 * exposed * exposed;
}

}  // namespace

Picture variance(const Film& film) {
  Picture out{
      film.width, film.height, {"Variance.R", "Variance.G", "Variance.B"}, std::vector<float>(3 * film.pixels())};
  if (film.passes < 2) return out;
  constexpr double most = std::numeric_limits<float>::max();
  const std::vector<glm::dvec3> mean = means(film);
  for (size_t i = 0; i < film.pixels(); ++i) {
    const glm::dvec3 v = variance_of_mean(film, i, mean[i]);
    for (int c = 0; c < 3; ++c) out.pixels[3 * i + c] = float(std::min(v[c], most));
  }
  return out;
}

bool is_black(const Film& film) { return is_all_zero(film.camera_sum) && is_all_zero(film.splat_sum); }

ErrorEstimate estimate_error(const Film& film) {
  return film.passes < 2 ? ErrorEstimate{} : estimate(film, means(film), 0.01);
}

double estimate_sample_error(const Film& film) {
  if (film.passes < 2) return infinity;
  const std::vector<glm::dvec3> mean = means(film);
  return estimate(film, mean, exposed_epsilon(mean)).relmse_trimmed * film.passes;
}

void trim(std::vector<double>& errors) {
  const auto kept = errors.end() - std::ptrdiff_t(errors.size() / 1000);
  if (kept != errors.end()) std::nth_element(errors.begin(), kept, errors.end());
  errors.erase(kept, errors.end());
}

std::vector<double> relative_to(const Film& film, std::vector<double> variances) {
  const std::vector<glm::dvec3> mean = means(film);
  const double epsilon = exposed_epsilon(mean);
  if (!(epsilon > 0)) return std::vector<double>(variances.size());
  for (size_t i = 0; i < mean.size(); ++i) variances[i] /= sqr(double(luminance(Rgb(mean[i])))) + epsilon;
  return variances;
}

std::vector<double> half_differences(const Film& film) {
  const std::vector<glm::dvec3> mean = means(film);
  std::vector<double> out(mean.size());
  if (film.passes < 2) return out;
  const double share = share_of_halves(film) * film.passes;
  for (size_t i = 0; i < mean.size(); ++i) out[i] = sqr(luminance(halves_apart(film, i, mean[i]))) * share;
  return out;
}

double trimmed_mean(std::vector<double> errors) {
  trim(errors);
  return std::accumulate(errors.begin(), errors.end(), 0.0) / double(errors.size());
}

}  // namespace ajar
