#include "ajar/film/film.h"

#include <algorithm>
#include <numeric>

#include "ajar/core/parallel.h"
#include "ajar/core/sampler.h"
#include "ajar/film/fireflies.h"
#include "footprint.h"

namespace ajar {
namespace {

bool is_done(const Film& film, const glm::ivec2& shift, int x, int y) {
  const int column = (x + film.width - shift.x) % film.width / tile;
  const int row = (y + film.height - shift.y) % film.height / tile;
  return uint32_t(row * tiles_x(film) + column) < film.chunks;
}

// Share of the pass at work whose light subpaths are in.
double share_done(const Film& film) {
  const uint32_t n = chunk_count(film);
  if (film.chunks == 0 || film.chunks == n) return film.chunks == 0 ? 0 : 1;
  size_t done = 0;
  for (uint32_t i = 0; i < film.chunks; ++i) done += tile_bounds(film, i).pixels();
  return double(done) / double(film.pixels());
}

// From the spread of the passes, of which there are two or more.
glm::dvec3 variance_of_mean(const Film& film, size_t i, const glm::dvec3& mean) {
  const double n = film.passes;
  return glm::max((film.square_sum[i] / n - mean * mean) / (n - 1), glm::dvec3(0));
}

std::vector<glm::dvec3> means(const Film& film) {
  std::vector<glm::dvec3> mean = film.camera_sum;
  for (size_t i = 0; i < mean.size(); ++i)
    mean[i] = (mean[i] + (film.splats ? film.splat_sum[i] : glm::dvec3(0))) / double(film.passes);
  return mean;
}

// Of the pixels up to two away in x and y, without the pixel itself.
glm::dvec3 mean_around(const Film& film, const std::vector<glm::dvec3>& mean, int x, int y) {
  const int xa = std::max(0, x - 2), xb = std::min(film.width - 1, x + 2);
  const int ya = std::max(0, y - 2), yb = std::min(film.height - 1, y + 2);
  const int count = (xb - xa + 1) * (yb - ya + 1) - 1;
  const glm::dvec3 own = mean[size_t(y) * film.width + x];
  if (count == 0) return own;
  glm::dvec3 total = -own;
  for (int py = ya; py <= yb; ++py)
    for (int px = xa; px <= xb; ++px) total += mean[size_t(py) * film.width + px];
  return total / double(count);
}

// The mean of the even passes less that of the odd ones.
glm::dvec3 halves_apart(const Film& film, size_t i, const glm::dvec3& mean) {
  const double n = film.passes, a = (film.passes + 1) / 2, b = film.passes / 2;
  return film.half_sum[i] / a - (mean * n - film.half_sum[i]) / b;
}

// Mean over the channels of the squared error over that of the true value. A sample that makes a pixel wrong makes it
// bright too, and must not hide its error by that: so far as the passes disagree about the pixel, the neighbours have a
// say. epsilon: what a square is divided by at least.
double pixel_error(const Film& film, const std::vector<glm::dvec3>& mean, double epsilon, int x, int y) {
  const size_t i = size_t(y) * film.width + x;
  const double n = film.passes, a = (film.passes + 1) / 2, b = film.passes / 2;
  const glm::dvec3 near = mean_around(film, mean, x, y), v = variance_of_mean(film, i, mean[i]);
  const glm::dvec3 apart = halves_apart(film, i, mean[i]);
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    const double m = mean[i][c], square = apart[c] * apart[c] * a * b / (n * n);  // (E1)
    const double trust = m * m > 0 ? m * m / (m * m + 20 * v[c]) : 0;             // (E2)
    const double dim = std::min(m * m, near[c] * near[c]);
    sum += square * (trust / (m * m + epsilon) + (1 - trust) / (dim + epsilon));  // (E3)
  }
  return sum / 3;
}

}  // namespace

glm::ivec2 tile_shift(const Film& film) {
  const uint64_t h = hash(0x711e, film.dropped + film.passes);
  return {int(h % tile) % film.width, int((h >> 32) % tile) % film.height};
}

Film make_film(const Camera& camera, const Filter& filter, bool splats) {
  Film film;
  film.x0 = camera.crop_x, film.y0 = camera.crop_y;
  film.width = camera.crop_width, film.height = camera.crop_height;
  film.filter = filter;
  film.splats = splats;
  const size_t n = film.pixels();
  film.camera.resize(n);
  film.camera_sum.resize(n);
  film.half_sum.resize(n);
  film.square_sum.resize(n);
  if (splats) film.splat.resize(n), film.splat_sum.resize(n);
  return film;
}

void merge(Film& film, const std::vector<std::vector<Splat>>& chunks) {
  // Bands of rows in parallel; within a band, splats in the order of chunks and paths.
  const int bands = std::clamp(film.height / 32, 1, 16);
  parallel_for(bands, [&](int band) {
    const int from = film.height * band / bands, to = film.height * (band + 1) / bands;
    const float reach = film.filter.radius + 0.5f, lo = float(film.y0 + from) - reach, hi = float(film.y0 + to) + reach;
    for (const auto& chunk : chunks)
      for (const Splat& s : chunk)
        if (s.raster.y >= lo && s.raster.y <= hi)
          for_each_reached(film, s.raster, from, to,
                           [&](size_t i, float wx, float wy) { film.splat[i] += s.value * (wy * wx); });
  });
}

void drop_passes(Film& film) {
  for (auto* sums : {&film.camera_sum, &film.splat_sum, &film.half_sum, &film.square_sum})
    std::fill(sums->begin(), sums->end(), glm::dvec3(0));
  std::fill(film.brightest.begin(), film.brightest.end(), Film::Bright{});
  film.dropped += film.passes;
  film.passes = 0;
}

void finish_pass(Film& film) {
  const float scale = 1.0f / float(film.pixels());
  parallel_ranges(film.pixels(), 16384, [&](size_t from, size_t to) {
    for (size_t i = from; i < to; ++i) {
      glm::dvec3 x(film.camera[i]);
      film.camera_sum[i] += x;
      film.camera[i] = Rgb(0);
      if (film.splats) {
        const glm::dvec3 s(film.splat[i] * scale);
        film.splat_sum[i] += s;
        film.splat[i] = Rgb(0);
        x += s;
      }
      if (film.passes % 2 == 0) film.half_sum[i] += x;
      film.square_sum[i] += x * x;
      if (!film.brightest.empty()) note(film, i, Rgb(x));
    }
  });
  ++film.passes;
  film.chunks = 0;
}

Picture develop(const Film& film) {
  Picture out{film.width, film.height, {"R", "G", "B"}, std::vector<float>(3 * film.pixels())};
  const double share = share_done(film), per_path = 1.0 / double(film.pixels());
  const glm::ivec2 shift = tile_shift(film);
  const std::vector<float> most = film.brightest.empty() ? std::vector<float>() : limits(film);
  for (int y = 0; y < film.height; ++y)
    for (int x = 0; x < film.width; ++x) {
      const size_t i = size_t(y) * film.width + x;
      const bool done = is_done(film, shift, x, y);
      glm::dvec3 value(0);
      const double n = film.passes + (done ? 1.0 : 0.0);
      const Rgb now = most.empty() ? film.camera[i] : limited(film.camera[i], most[i]);
      if (n > 0) value += (film.camera_sum[i] + (done ? glm::dvec3(now) : glm::dvec3(0))) / n;
      if (film.splats && film.passes + share > 0)
        value += (film.splat_sum[i] + glm::dvec3(film.splat[i]) * per_path) / (film.passes + share);
      if (!most.empty() && n > 0) value -= excess(film, i, most[i]) / n;
      for (int c = 0; c < 3; ++c) out.pixels[3 * i + c] = float(value[c]);
    }
  return out;
}

Picture average(const Film& film, const std::vector<glm::dvec3>& sums, bool splats) {
  Picture out{film.width, film.height, {"R", "G", "B"}, std::vector<float>(3 * film.pixels())};
  const double splat_passes = film.passes + share_done(film);
  const glm::ivec2 shift = tile_shift(film);
  for (int y = 0; y < film.height; ++y)
    for (int x = 0; x < film.width; ++x) {
      const size_t i = size_t(y) * film.width + x;
      const double n = splats ? splat_passes : film.passes + (is_done(film, shift, x, y) ? 1.0 : 0.0);
      for (int c = 0; c < 3; ++c) out.pixels[3 * i + c] = n > 0 ? float(sums[i][c] / n) : 0;
    }
  return out;
}

Picture variance(const Film& film) {
  Picture out{
      film.width, film.height, {"Variance.R", "Variance.G", "Variance.B"}, std::vector<float>(3 * film.pixels())};
  if (film.passes < 2) return out;
  const std::vector<glm::dvec3> mean = means(film);
  for (size_t i = 0; i < film.pixels(); ++i) {
    const glm::dvec3 v = variance_of_mean(film, i, mean[i]);
    for (int c = 0; c < 3; ++c) out.pixels[3 * i + c] = float(v[c]);
  }
  return out;
}

namespace {
ErrorEstimate estimate(const Film& film, const std::vector<glm::dvec3>& mean, double epsilon) {
  if (std::all_of(mean.begin(), mean.end(), [](const glm::dvec3& m) { return m == glm::dvec3(0); })) return {};
  struct Pixel {
    double error, light;
  };
  std::vector<Pixel> pixels(film.pixels());
  parallel_for(film.height, [&](int y) {
    for (int x = 0; x < film.width; ++x) {
      const size_t i = size_t(y) * film.width + x;
      pixels[i] = {pixel_error(film, mean, epsilon, x, y), luminance(Rgb(mean[i]))};
    }
  });
  const auto add = [](const Pixel& a, const Pixel& b) { return Pixel{a.error + b.error, a.light + b.light}; };
  const auto kept = pixels.end() - std::ptrdiff_t(pixels.size() / 1000);
  const Pixel all = std::accumulate(pixels.begin(), pixels.end(), Pixel{}, add);
  if (kept != pixels.end())
    std::nth_element(pixels.begin(), kept, pixels.end(),
                     [](const Pixel& a, const Pixel& b) { return a.error < b.error; });
  const Pixel most = std::accumulate(pixels.begin(), kept, Pixel{}, add);
  const double more = film.passes / (film.passes + share_done(film));
  ErrorEstimate out;
  out.relmse = more * all.error / double(pixels.size());
  out.relmse_trimmed = more * most.error / double(kept - pixels.begin());
  out.trimmed_light = all.light > 0 ? std::clamp(1 - most.light / all.light, 0.0, 1.0) : 1;
  return out;
}
}  // namespace

ErrorEstimate estimate_error(const Film& film) {
  return film.passes < 2 ? ErrorEstimate{} : estimate(film, means(film), 0.01);
}

namespace {
// What is added to squares of radiance: 0.01 of an image exposed to a mean luminance of a fifth.
double exposed_epsilon(const std::vector<glm::dvec3>& mean) {
  double light = 0;
  for (const glm::dvec3& m : mean) light += luminance(Rgb(m));
  const double exposed = light / double(mean.size()) / 0.2;
  return 0.01 * exposed * exposed;
}
}  // namespace

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
  const double n = film.passes, a = (film.passes + 1) / 2, b = film.passes / 2;
  std::vector<double> out(mean.size());
  if (film.passes < 2) return out;
  for (size_t i = 0; i < mean.size(); ++i) out[i] = sqr(luminance(halves_apart(film, i, mean[i]))) * a * b / n;  // (E1)
  return out;
}

double trimmed_mean(std::vector<double> errors) {
  trim(errors);
  return std::accumulate(errors.begin(), errors.end(), 0.0) / double(errors.size());
}

}  // namespace ajar
