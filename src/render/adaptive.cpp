#include "ajar/render/adaptive.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ajar/core/parallel.h"
#include "ajar/core/sampler.h"
#include "ajar/film/pixels.h"

namespace ajar {
namespace {

// Sums that are full tell nothing (light of 10^19 and more).
double variance_of(const PixelSpread& s) {
  const double n = s.samples;
  if (!(n > 1) || !(s.square < infinity)) return 0;
  return std::max(double(s.square) - sqr(double(s.sum)) / n, 0.0) / (n - 1);
}

std::vector<double> variances_of(const std::vector<PixelSpread>& spread) {
  std::vector<double> out;
  for (const PixelSpread& s : spread) out.push_back(variance_of(s));
  return out;
}

bool has_right(const Film& film, size_t pixel) { return (pixel + 1) % size_t(film.width) > 0; }

// The others of the square around a pixel: it has no say in its own count.
void others_around(const Film& film, int x, int y, int reach, const auto& use) {
  const size_t own = size_t(y) * film.width + x;
  for_each_around(film, x, y, reach, [&](size_t i) {
    if (i != own) use(i);
  });
}

// Mean of the eight around one, without the greatest: a single firefly is not worth samples.
double near(const std::vector<double>& values, const Film& film, int x, int y) {
  double sum = 0, most = 0;
  int n = 0;
  others_around(film, x, y, 1, [&](size_t i) { sum += values[i], most = std::max(most, values[i]), ++n; });
  return n > 1 ? (sum - most) / (n - 1) : sum;
}

constexpr int reach = 3;  // of the square in which what the image varies by is held against what samples vary by

// Share of it that is left, at most all: points of a sequence that lie evenly err less together than apart.
double share_left(const std::vector<double>& found, const std::vector<double>& seen, const Film& film, int x, int y) {
  double left = 0, all = 0;
  others_around(film, x, y, reach, [&](size_t i) { left += found[i], all += seen[i]; });
  const double share = left / all;
  return share < 1 ? share : 1;
}

// Of what samples varied by in a pass, the share that is left in the image.
std::vector<double> shares_left(const Film& film, const std::vector<double>& found, const std::vector<double>& seen) {
  return each_pixel(film, [&](int x, int y) { return share_left(found, seen, film, x, y); });
}

// Of what passes bring a pixel and the one to its right. Sums that are full tell nothing.
double covariance(const PixelSpread& s, const PixelSpread& right, double passes) {
  const double found = (double(s.beside) - double(s.mean) * double(right.mean) / passes) / (passes - 1);
  return std::abs(found) < infinity ? found : 0;
}

// What the samples of a pass have in common with those of the pixel beside them, relative to the image: noise of the
// light vertices that both join, which more samples do not mend.
double shared_noise(const Film& film, const Adaptive& adaptive) {
  const std::vector<double> relative = relative_to(film, std::vector<double>(film.pixels(), 1.0));
  std::vector<double> shared;
  for (size_t i = 0; i + 1 < film.pixels(); ++i)
    if (has_right(film, i))
      shared.push_back(covariance(adaptive.spread[i], adaptive.spread[i + 1], adaptive.passes) *
                       std::sqrt(relative[i] * relative[i + 1]));
  if (shared.empty()) return 0;
  trim(shared);
  for (double& x : shared) x = -x;
  return std::max(-trimmed_mean(std::move(shared)), 0.0);
}

// What one camera sample varies by, relative to the image, as far as that is left in it; and what a pass errs by
// however many it has.
struct Noise {
  std::vector<double> around;  // root of the former by the pixels around one, which tell how many samples it is to have
  std::vector<double> own;     // the former by its own samples, which tell what that brings
  double rest = 0;             // the latter
  double share = 1;            // of what samples vary by that the image shows
};

double count_for(double scale, double deviation) { return std::clamp(scale * deviation, 1.0, Adaptive::most); }

double greatest_kept(std::vector<double> values) {
  trim(values);
  return *std::max_element(values.begin(), values.end());
}

// Counts of so many times the deviation, and what error times samples is by them, over that of even ones.
struct Scale {
  double scale = 0, quotient = 1;
};

// That of the least quotient, and of more samples only where they bring a hundredth: where noise is in proportion to
// the counts and there is no rest, twice as many are as good, and rounding would choose.
Scale best_scale(const Noise& noise) {
  std::vector<double> sorted = noise.around;
  const auto middle = sorted.begin() + std::ptrdiff_t(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double typical = *middle > 0 ? *middle : *std::max_element(middle, sorted.end());
  if (!(typical > 0)) return {};
  const double most = greatest_kept(noise.own);
  const auto product = [&](double scale) {
    double samples = 0, left = 0, kept = 0;
    for (size_t i = 0; i < noise.own.size(); ++i) {
      const double n = count_for(scale, noise.around[i]);
      samples += n;
      if (noise.own[i] <= most) left += noise.own[i] / n, ++kept;
    }
    return (noise.rest + noise.share * left / kept) * samples;
  };
  const double even = product(0);
  Scale best;
  for (int step = -24; step <= 24; ++step) {
    const double scale = std::exp2(step / 4.0) / typical, quotient = product(scale) / even;
    if (quotient < 0.99 * best.quotient) best = {scale, quotient};
  }
  return best;
}

// Quotient above which pixels are left even: counts that change, and that are no powers of two, take from sequences
// what a little gain brings. Less of it where an image errs by more than its samples mostly say: where there are sparks
// no sequence converges. Measured (docs/results/adaptive.md).
double worthwhile(double error, double sampled) { return error > 1.2 * sampled ? 0.92 : 0.88; }

// Whole numbers that are so many times the deviation in the mean, the same at every look.
std::vector<uint8_t> draw_counts(double scale, const std::vector<double>& deviations) {
  std::vector<uint8_t> counts;
  for (size_t i = 0; i < deviations.size(); ++i) {
    const float u = to_unit(uint32_t(hash(0xada, i) >> 32));
    counts.push_back(uint8_t(count_for(scale, deviations[i]) + double(u)));
  }
  return counts;
}

}  // namespace

double mean_count(const Adaptive& adaptive) {
  const std::vector<uint8_t>& counts = adaptive.counts;
  return counts.empty() ? 1 : std::accumulate(counts.begin(), counts.end(), 0.0) / double(counts.size());
}

double samples_of_pass(const Film& film, const Adaptive& adaptive) {
  double samples = 0, pixels = double(adaptive.passes) * double(adaptive.spread.size());
  for (const PixelSpread& s : adaptive.spread) samples += s.samples;
  for (uint32_t chunk = 0; chunk < film.chunks; ++chunk) pixels += double(tile_bounds(film, chunk).pixels());
  return samples > 0 && pixels > 0 ? samples / pixels : 1;
}

uint32_t passes_drawn(const Film& film, const Adaptive& adaptive) {
  uint32_t drawn = 0;  // of even and odd numbers in turn
  for (const PixelSpread& s : adaptive.spread)
    drawn = std::max({drawn, 2 * s.counts[0] - (s.counts[0] > 0), 2 * s.counts[1]});
  return std::max(film.dropped + film.passes + (film.chunks > 0), adaptive.first + drawn);
}

void note_pass(const Film& film, Adaptive& adaptive) {
  ++adaptive.passes;
  parallel_ranges(adaptive.spread.size(), 16384, [&](size_t from, size_t to) {
    for (size_t i = from; i < to; ++i) {
      PixelSpread& s = adaptive.spread[i];
      const float own = luminance(film.camera[i]);
      s.mean += own;
      if (has_right(film, i)) s.beside += own * luminance(film.camera[i + 1]);
    }
  });
}

void forget_sums(Adaptive& adaptive) {
  adaptive.passes = 0;
  for (PixelSpread& s : adaptive.spread) s = {.counts = {s.counts[0], s.counts[1]}};
}

void allot(const Film& film, Adaptive& adaptive) {
  if (adaptive.spread.empty() || adaptive.passes < 2) return;
  const double error = estimate_sample_error(film);
  Noise noise;
  noise.own = relative_to(film, variances_of(adaptive.spread));
  // What samples' variance was in a pass, which had this many of them.
  std::vector<double> seen = noise.own;
  for (size_t i = 0; i < seen.size(); ++i)
    seen[i] *= adaptive.passes / std::max(double(adaptive.spread[i].samples), 1.0);
  const double bound = worthwhile(error, trimmed_mean(seen));
  const std::vector<double> found = relative_to(film, half_differences(film)), shares = shares_left(film, found, seen);
  noise.around = each_pixel(
      film, [&](int x, int y) { return std::sqrt(near(noise.own, film, x, y) * shares[size_t(y) * film.width + x]); });
  for (size_t i = 0; i < seen.size(); ++i) seen[i] *= shares[i], noise.own[i] *= shares[i];
  const double sampled = trimmed_mean(std::move(seen)), all = trimmed_mean(found);
  if (!(sampled > 0) || !(all > 0) || !(all < infinity)) return;
  // Of what is shared, what samples vary by has a part, but divided by their number.
  const double shared = shared_noise(film, adaptive),
               beyond = all - sampled - shared * (1 - 1 / samples_of_pass(film, adaptive));
  noise.rest = std::min(std::max(beyond, 0.0) + shared, all);  // (A3)
  noise.share = std::min((all - noise.rest) / sampled, 1.0);
  const Scale best = best_scale(noise);
  if (best.quotient > bound)
    adaptive.counts.clear();
  else
    adaptive.counts = draw_counts(best.scale, noise.around);
}

}  // namespace ajar
