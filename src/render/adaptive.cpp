#include "ajar/render/adaptive.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "ajar/core/sampler.h"
#include "ajar/film/pixels.h"

namespace ajar {
namespace {

double count(const PixelSpread& s) { return double(s.counts[0]) + s.counts[1]; }

// Sums that are full tell nothing (light of 10^19 and more).
double variance_of(const PixelSpread& s) {
  const double n = count(s);
  if (!(n > 1) || !(s.square < infinity)) return 0;
  return std::max(double(s.square) - sqr(double(s.sum)) / n, 0.0) / (n - 1);
}

std::vector<double> variances_of(const std::vector<PixelSpread>& spread) {
  std::vector<double> out;
  for (const PixelSpread& s : spread) out.push_back(variance_of(s));
  return out;
}

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
std::vector<double> shares_left(const Film& film, const std::vector<double>& seen) {
  const std::vector<double> found = relative_to(film, half_differences(film));
  return each_pixel(film, [&](int x, int y) { return share_left(found, seen, film, x, y); });
}

double count_for(double scale, double deviation) { return std::clamp(scale * deviation, 1.0, Adaptive::most); }

// Counts of so many times the deviation, and what error times samples is by them, over that of even ones.
struct Scale {
  double scale = 0, quotient = 1;
};

// That of the least quotient, and of more samples only where they bring a hundredth: where noise is in proportion to
// the counts and there is no rest, twice as many are as good, and rounding would choose. `rest` is what more samples do
// not mend; `share`, of their variance what the error shows.
Scale best_scale(const std::vector<double>& deviations, double rest, double share) {
  std::vector<double> sorted = deviations;
  const auto middle = sorted.begin() + std::ptrdiff_t(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double typical = *middle > 0 ? *middle : *std::max_element(middle, sorted.end());
  if (!(typical > 0)) return {};
  const double pixels = double(deviations.size());
  const auto product = [&](double scale) {
    double samples = 0, left = 0;
    for (const double d : deviations) {
      const double n = count_for(scale, d);
      samples += n, left += d * d / n;
    }
    return (rest + share * left / pixels) * samples;
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
// what a little gain brings. Not where an image errs by more than its samples mostly say: where there are sparks no
// sequence converges. Measured (docs/results/adaptive.md).
double worthwhile(double error, double sampled) { return error > 1.2 * sampled ? 0.97 : 0.85; }

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
  for (const PixelSpread& s : adaptive.spread) samples += count(s);
  for (uint32_t chunk = 0; chunk < film.chunks; ++chunk) pixels += double(tile_bounds(film, chunk).pixels());
  return samples > 0 && pixels > 0 ? samples / pixels : 1;
}

uint32_t passes_drawn(const Film& film, const Adaptive& adaptive) {
  uint32_t drawn = 0;  // of even and odd numbers in turn
  for (const PixelSpread& s : adaptive.spread)
    drawn = std::max({drawn, 2 * s.counts[0] - (s.counts[0] > 0), 2 * s.counts[1]});
  return std::max(film.dropped + film.passes + (film.chunks > 0), adaptive.first + drawn);
}

void allot(const Film& film, Adaptive& adaptive) {
  const double error = estimate_sample_error(film);
  if (adaptive.spread.empty() || !(error > 0) || !(error < infinity)) return;
  const std::vector<double> errors = relative_to(film, variances_of(adaptive.spread));
  // What samples' variance was in a pass, which had this many of them.
  std::vector<double> seen = errors;
  for (size_t i = 0; i < seen.size(); ++i) seen[i] *= adaptive.passes / std::max(count(adaptive.spread[i]), 1.0);
  const double bound = worthwhile(error, trimmed_mean(seen));
  const std::vector<double> shares = shares_left(film, seen);
  for (size_t i = 0; i < seen.size(); ++i) seen[i] *= shares[i];
  const double sampled = trimmed_mean(seen);
  if (!(sampled > 0)) return;
  // Sparks are in the error and not in what was trimmed: the rest is not taken for more than what samples bring.
  const double rest = std::clamp(error - sampled, 0.0, sampled), share = std::min(error / sampled, 1.0);
  const std::vector<double> deviations = each_pixel(
      film, [&](int x, int y) { return std::sqrt(near(errors, film, x, y) * shares[size_t(y) * film.width + x]); });
  const Scale best = best_scale(deviations, rest, share);
  if (best.quotient > bound)
    adaptive.counts.clear();
  else
    adaptive.counts = draw_counts(best.scale, deviations);
}

}  // namespace ajar
