#include "ajar/render/balance.h"

#include <algorithm>
#include <cmath>

namespace ajar {
namespace {

constexpr float least_step = 0.5f, most_step = 2;  // from look to look

// Of so many samples, per pixel. Sums that are full tell nothing (light of 10^19 and more), nor do those of squares
// that are too small for a float.
std::vector<double> variances_of(const std::vector<Beyond>& found, double samples) {
  std::vector<double> out;
  for (const Beyond& b : found) {
    const double square = b.square < infinity ? double(b.square) : 0;
    out.push_back(std::max(square - sqr(double(b.sum)) / samples, 0.0) / (samples - 1));
  }
  return out;
}

}  // namespace

void rebalance(const Film& film, Balance& balance) {
  const Counters& work = balance.work;
  const double error = estimate_sample_error(film), samples = balance.passes;
  if (balance.found.empty() || !(samples >= 2) || !(error > 0) || !(error < infinity)) return;
  if (work.beyond > 0) {
    const double of_variance = trimmed_mean(relative_to(film, variances_of(balance.found, samples))) / error;
    const double of_work = double(work.beyond) / double(work.camera_rays + work.light_rays + work.joins);
    const float step = std::clamp(float(std::sqrt(of_variance / of_work)), least_step, most_step);  // (G16)
    balance.goes_on = std::clamp(balance.goes_on * step, Balance::least, Balance::most);
  }
  forget_sums(balance);
}

void forget_sums(Balance& balance) {
  balance.work = {}, balance.passes = 0;
  balance.found.assign(balance.found.size(), {});
}

}  // namespace ajar
