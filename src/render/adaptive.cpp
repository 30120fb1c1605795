#include "ajar/render/adaptive.h"

#include <algorithm>
#include <cmath>

#include "ajar/core/parallel.h"
#include "ajar/core/sampler.h"

namespace ajar {
namespace {

double count(const PixelSpread& s) { return double(s.counts[0]) + s.counts[1]; }

// Sums that are full tell nothing (light of 10^19 and more).
double variance_of(const PixelSpread& s) {
  const double n = count(s);
  if (!(n > 1) || !(s.square < infinity)) return 0;
  return std::max(double(s.square) - sqr(double(s.sum)) / n, 0.0) / (n - 1);
}

// Mean of the pixels around one, without the greatest: a single firefly is not worth samples.
double around(const std::vector<double>& values, const Film& film, int x, int y) {
  double sum = 0, most = 0;
  int n = 0;
  for (int py = std::max(y - 1, 0); py <= std::min(y + 1, film.height - 1); ++py)
    for (int px = std::max(x - 1, 0); px <= std::min(x + 1, film.width - 1); ++px) {
      if (px == x && py == y) continue;
      const double value = values[size_t(py) * film.width + px];
      sum += value, most = std::max(most, value), ++n;
    }
  return n > 1 ? (sum - most) / (n - 1) : sum;
}

// Standard deviation of a sample, relative to the image.
std::vector<double> deviations(const Film& film, const std::vector<double>& errors) {
  std::vector<double> out(errors.size());
  parallel_for(film.height, [&](int y) {
    for (int x = 0; x < film.width; ++x) out[size_t(y) * film.width + x] = std::sqrt(around(errors, film, x, y));
  });
  return out;
}

double count_for(double scale, double deviation) { return std::clamp(scale * deviation, 1.0, Adaptive::most); }

// Counts of scale times the deviation: the scale at which a pass's error times its samples is least, and more of them
// only where they bring a hundredth: where all pixels are alike, and there is no rest, any number is as good, and
// rounding would choose. `rest` is what more of them do not mend; `share`, of their variance what the error shows.
double best_scale(const std::vector<double>& deviations, double rest, double share) {
  std::vector<double> sorted = deviations;
  const auto middle = sorted.begin() + std::ptrdiff_t(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double typical = *middle > 0 ? *middle : *std::max_element(middle, sorted.end());
  if (!(typical > 0)) return 0;
  double best = 0, least = infinity;
  for (int step = -24; step <= 24; ++step) {
    const double scale = std::exp2(step / 4.0) / typical;
    double samples = 0, left = 0;
    for (const double d : deviations) {
      const double n = count_for(scale, d);
      samples += n, left += d * d / n;
    }
    const double pixels = double(deviations.size());
    const double product = (rest + share * left / pixels) * samples;
    if (product < 0.99 * least) least = product, best = scale;
  }
  return best;
}

}  // namespace

double samples_of_pass(const Film& film, const Adaptive& adaptive) {
  double samples = 0, pixels = double(adaptive.passes) * double(adaptive.spread.size());
  for (const PixelSpread& s : adaptive.spread) samples += count(s);
  for (uint32_t chunk = 0; chunk < film.chunks; ++chunk) pixels += double(tile_bounds(film, chunk).pixels());
  return samples > 0 && pixels > 0 ? samples / pixels : 1;
}

uint32_t passes_drawn(const Film& film, const Adaptive& adaptive) {
  uint32_t most = 0;
  for (const PixelSpread& s : adaptive.spread) most = std::max({most, s.counts[0], s.counts[1]});
  return std::max(film.dropped + film.passes + (film.chunks > 0), adaptive.first + 2 * most);
}

void allot(const Film& film, Adaptive& adaptive) {
  const double error = estimate_sample_error(film);
  if (adaptive.spread.empty() || !(error > 0) || !(error < infinity)) return;
  std::vector<double> variances;
  for (const PixelSpread& s : adaptive.spread) variances.push_back(variance_of(s));
  const std::vector<double> errors = relative_to(film, variances);
  // What the samples' variance was in a pass, which had this many of them.
  std::vector<double> seen = errors;
  for (size_t i = 0; i < seen.size(); ++i) seen[i] *= adaptive.passes / std::max(count(adaptive.spread[i]), 1.0);
  const double sampled = trimmed_mean(seen);
  if (!(sampled > 0)) return;
  // Sparks are in the error and not in what was trimmed: the rest is not taken for more than what samples bring.
  const double rest = std::clamp(error - sampled, 0.0, sampled), share = std::min(error / sampled, 1.0);
  const std::vector<double> wanted = deviations(film, errors);
  const double scale = best_scale(wanted, rest, share);
  adaptive.counts.resize(wanted.size());
  for (size_t i = 0; i < wanted.size(); ++i) {
    const float u = to_unit(uint32_t(hash(hash(0xada, adaptive.passes), i) >> 32));
    adaptive.counts[i] = uint8_t(count_for(scale, wanted[i]) + double(u));
  }
}

}  // namespace ajar
