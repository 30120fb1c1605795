#include "ajar/core/distribution.h"

namespace ajar {
namespace {

constexpr double steps = 1 << 24;
constexpr size_t most_entries = 1 << 23;  // of positive weight, each of which is sure of a step

double clean(float w) { return w > 0 && w < infinity ? double(w) : 0; }

// Writes n + 1 cumulative sums and returns the total. Positive weights get at least one step: rounded sums first,
// pushed apart upwards, then back downwards from 1.
double cumulate(std::span<const float> weights, float* cdf) {
  const size_t n = weights.size();
  double total = 0;
  size_t positive = 0;
  for (const float w : weights) total += clean(w), positive += clean(w) > 0;
  cdf[0] = 0;
  if (total == 0) {
    for (size_t i = 1; i < n; ++i) cdf[i] = float(std::floor(double(i) / double(n) * steps) / steps);
    cdf[n] = 1;
    return 0;
  }
  const uint32_t least = positive <= most_entries ? 1 : 0;
  std::vector<uint32_t> in_steps(n + 1, 0);
  double sum = 0;
  for (size_t i = 0; i < n; ++i) {
    const double w = clean(weights[i]);
    sum += w;
    in_steps[i + 1] = std::max(uint32_t(std::lround(sum / total * steps)), in_steps[i] + (w > 0 ? least : 0));
  }
  in_steps[n] = uint32_t(steps);
  for (size_t i = n; i-- > 1;)
    in_steps[i] = std::min(in_steps[i], in_steps[i + 1] - (clean(weights[i]) > 0 ? least : 0));
  for (size_t i = 1; i <= n; ++i) cdf[i] = float(in_steps[i]) * float(1 / steps);
  return total;
}

// Last of n entries whose cumulative sum does not exceed u: never one of width zero, as cdf[n] = 1 > u. Without
// branches.
uint32_t find(const float* cdf, uint32_t n, float u) {
  uint32_t first = 0;
  while (n > 1) {
    const uint32_t half = n / 2;
    first += cdf[first + half] <= u ? half : 0;
    n -= half;
  }
  return first;
}

uint32_t find_and_remap(const float* cdf, uint32_t n, float& u) {
  const uint32_t i = find(cdf, n, u);
  u = std::min((u - cdf[i]) / (cdf[i + 1] - cdf[i]), one_minus_epsilon);
  return i;
}

}  // namespace

Distribution::Distribution(std::span<const float> weights) {
  if (weights.empty()) return;
  cdf.resize(weights.size() + 1);
  sum = cumulate(weights, cdf.data());
}

uint32_t Distribution::sample(float& u) const { return find_and_remap(cdf.data(), size(), u); }

Distribution2D::Distribution2D(std::span<const float> weights, int w, int h) : width(w), height(h) {
  const size_t n = size_t(w);
  columns.resize(size_t(h) * (n + 1));
  std::vector<float> sums(static_cast<size_t>(h));
  for (size_t y = 0; y < size_t(h); ++y)
    sums[y] = float(std::min(cumulate(weights.subspan(y * n, n), &columns[y * (n + 1)]),
                             double(std::numeric_limits<float>::max())));
  rows = Distribution(sums);
}

Distribution2D::Cell Distribution2D::sample_cell(Vec2& u) const {
  const int y = int(rows.sample(u.y));
  const int x = int(find_and_remap(columns.data() + size_t(y) * (size_t(width) + 1), uint32_t(width), u.x));
  return {x, y};
}

Vec2 Distribution2D::sample(const Vec2& u, float& pdf) const {
  Vec2 in_cell = u;
  const Cell c = sample_cell(in_cell);
  pdf = mass(c) * float(width) * float(height);
  return {std::min((float(c.x) + in_cell.x) / float(width), one_minus_epsilon),
          std::min((float(c.y) + in_cell.y) / float(height), one_minus_epsilon)};
}

float Distribution2D::pdf(const Vec2& at) const {
  if (!(at.x >= 0 && at.x < 1 && at.y >= 0 && at.y < 1)) return 0;
  return mass({std::min(int(at.x * float(width)), width - 1), std::min(int(at.y * float(height)), height - 1)}) *
         float(width) * float(height);
}

}  // namespace ajar
