#include "agreement.h"

#include <cmath>

#include "student.h"

namespace ajar {
namespace {

constexpr double of_halves = 1e-5;  // relative difference that sums of floats and of half-floats may make
constexpr int finest = 8;           // blocks to a side of the finest level
constexpr int least_side = 8;       // pixels to a side of a block

struct Block {
  int x, y, width, height;
};

Block block_of(const Picture& image, int level, int index) {
  const int column = index % level, row = index / level;
  const int x = image.width * column / level, y = image.height * row / level;
  return {x, y, image.width * (column + 1) / level - x, image.height * (row + 1) / level - y};
}

double mean_of(const Picture& image, const Block& b, int channel) {
  double sum = 0;
  for (int y = b.y; y < b.y + b.height; ++y)
    for (int x = b.x; x < b.x + b.width; ++x) sum += image.pixels[size_t(y * image.width + x) * 3 + size_t(channel)];
  return sum / (double(b.width) * b.height);
}

/// value(batch): a number of each. The weighted mean and the usual unbiased estimate of its variance.
template <class Value>
Estimate estimate(const Batches& batches, const Value& value) {
  double weight = 0, sum = 0, squares = 0;
  for (const ReferenceBatch& batch : batches) weight += batch.spp, sum += batch.spp * value(batch);
  const double mean = sum / weight;
  for (const ReferenceBatch& batch : batches) squares += batch.spp * (value(batch) - mean) * (value(batch) - mean);
  return {mean, squares / (weight * double(batches.size() - 1))};
}

/// Estimates of all blocks of a level, one channel. No block is taken for surer than the average of its parent's
/// children: what is rare and large may have missed a block, which then looks bright by luck or dark and quiet; its
/// neighbours know better how much it varies.
std::vector<Estimate> estimate_level(const Batches& batches, int level, int channel,
                                     const std::vector<Estimate>& parents) {
  std::vector<Estimate> estimates;
  for (int i = 0; i < level * level; ++i) {
    const Block block = block_of(batches[0].image, level, i);
    Estimate e = estimate(batches, [&](const ReferenceBatch& b) { return mean_of(b.image, block, channel); });
    if (level > 1) {
      const Estimate& parent = parents[size_t(i / level / 2 * (level / 2) + i % level / 2)];
      e.variance = std::max(e.variance, 4 * parent.variance);
    }
    estimates.push_back(e);
  }
  return estimates;
}

/// Welch's test.
void test(BlockTest& b, double batches_first, double batches_second) {
  const double difference = b.first.mean - b.second.mean;
  const double beyond = std::abs(difference) - of_halves * std::max(std::abs(b.first.mean), std::abs(b.second.mean));
  const double v1 = b.first.variance, v2 = b.second.variance, v = v1 + v2;
  if (beyond <= 0) return;
  if (v <= 0) {
    b.t = std::copysign(infinity, difference), b.p = 0;
    return;
  }
  const double dof = v * v / (v1 * v1 / (batches_first - 1) + v2 * v2 / (batches_second - 1));
  b.t = std::copysign(beyond / std::sqrt(v), difference);
  b.p = std::min(2 * student_tail(std::abs(b.t), dof), 1.0);
}

/// Mean over pixels and channels of variance / (R^2 + 0.01).
double relative_error(const Batches& batches, const Picture& reference) {
  double sum = 0;
  for (size_t i = 0; i < reference.pixels.size(); ++i) {
    const double r = reference.pixels[i];
    sum +=
        estimate(batches, [&](const ReferenceBatch& b) { return double(b.image.pixels[i]); }).variance / (r * r + 0.01);
  }
  return sum / double(reference.pixels.size());
}

Picture mean_image(const Batches& batches) {
  Picture mean = batches[0].image;
  for (size_t i = 0; i < mean.pixels.size(); ++i)
    mean.pixels[i] = float(estimate(batches, [&](const ReferenceBatch& b) { return double(b.image.pixels[i]); }).mean);
  return mean;
}

Picture mix(const Picture& a, const Picture& b, double share_of_a) {
  Picture image = a;
  for (size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = float(share_of_a * double(a.pixels[i]) + (1 - share_of_a) * double(b.pixels[i]));
  return image;
}

}  // namespace

Agreement agree(const Batches& first, const Batches& second) {
  const Picture& image = first[0].image;
  Agreement result;
  double levels = 0, corrected = infinity;
  for (int level = 1; level <= finest && std::min(image.width, image.height) >= level * least_side; level *= 2)
    ++levels;
  levels = std::max(levels, 1.0);
  for (int channel = 0; channel < 3; ++channel) {
    std::vector<Estimate> parents[2];
    for (int level = 1; level < 1 << int(levels); level *= 2) {
      parents[0] = estimate_level(first, level, channel, parents[0]);
      parents[1] = estimate_level(second, level, channel, parents[1]);
      for (int i = 0; i < level * level; ++i) {
        const Block at = block_of(image, level, i);
        BlockTest b{at.x, at.y, at.width, at.height, "RGB"[channel], parents[0][size_t(i)], parents[1][size_t(i)]};
        test(b, double(first.size()), double(second.size()));
        // Bonferroni: every level has the same share, within it every block and channel.
        const double p = b.p * levels * 3 * level * level;
        if (level == 1 && (channel == 0 || b.p < result.whole.p)) result.whole = b;
        if (p < corrected) corrected = p, result.worst = b;
      }
    }
  }
  result.p = std::min(corrected, 1.0);
  return result;
}

Combined combine(const Batches& first, const Batches& second) {
  const Picture means[2] = {mean_image(first), mean_image(second)};
  Combined c;
  c.weight = {0.5, 0.5};
  for (int round = 0; round < 2; ++round) {  // the first with equal weights, to have something to be relative to
    c.image = mix(means[0], means[1], c.weight[0]);
    c.relmse = {relative_error(first, c.image), relative_error(second, c.image)};
    const double sum = c.relmse[0] + c.relmse[1];
    if (sum > 0) c.weight = {c.relmse[1] / sum, c.relmse[0] / sum};
  }
  c.image = mix(means[0], means[1], c.weight[0]);
  c.relmse_both = c.weight[0] * c.weight[0] * c.relmse[0] + c.weight[1] * c.weight[1] * c.relmse[1];
  return c;
}

}  // namespace ajar
