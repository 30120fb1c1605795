#include "ajar/render/trials.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ajar {
namespace {

constexpr double exposed = 0.2;     // mean luminance of the image as it would be looked at
constexpr double dark = 0.01;       // of relMSE
constexpr double clip = 8;          // times what all saw about a pixel: what is brighter is a firefly
constexpr double least_miss = 0.1;  // of a block's light
constexpr double blind = 0.1;       // of the image's light, fireflies left aside: to see less is to see nothing
constexpr int block = 8;            // pixels
constexpr int around = 2;           // pixels

// Sums and sums of squares of the passes of a pixel; clipped: without what is above its bound.
struct Pixel {
  double mean = 0, variance = 0;  // of a sample
  double clipped_mean = 0, clipped_variance = 0;
  double fireflies = 0;
};

struct Block {
  double mean = 0, variance = 0;  // of the mean of clipped samples
  double fireflies = 0, error = 0, pixels = 0;
};

// Mean without the brightest thousandth, one at least, which a firefly may be; of a single pixel it is the pixel.
double usual_mean(std::vector<double> values) {
  const auto kept = values.end() - std::ptrdiff_t((values.size() + 998) / 1000);
  if (kept != values.end()) std::nth_element(values.begin(), kept, values.end());
  return std::accumulate(values.begin(), kept, 0.0) / double(kept - values.begin());
}

// How bright each pixel is, as all sights together saw it, exposed; empty: black.
std::vector<double> seen_by_all(const std::vector<Sight>& sights, double& scale) {
  double most = 0;
  std::vector<double> all(sights[0].sum.size());
  for (const Sight& s : sights) {
    const double n = double(s.passes.size());
    most = std::max(most, usual_mean(s.sum) / n);
    for (size_t i = 0; i < all.size(); ++i) all[i] += s.sum[i] / (n * double(sights.size()));
  }
  const double mean = std::accumulate(all.begin(), all.end(), 0.0) / double(all.size());
  if (!(mean > 0)) return {};
  if (!(most > 0)) most = mean;
  scale = exposed / most;
  for (double& x : all) x *= scale;
  return all;
}

std::vector<double> blurred(const std::vector<double>& image, int width, int height) {
  std::vector<double> out(image.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int xa = std::max(0, x - around), xb = std::min(width - 1, x + around);
      const int ya = std::max(0, y - around), yb = std::min(height - 1, y + around);
      double sum = 0;
      for (int py = ya; py <= yb; ++py)
        for (int px = xa; px <= xb; ++px) sum += image[size_t(py) * size_t(width) + size_t(px)];
      out[size_t(y) * size_t(width) + size_t(x)] = sum / ((xb - xa + 1) * (yb - ya + 1));
    }
  return out;
}

Pixel pixel_at(const Sight& sight, size_t i, double scale, double bound) {
  const double n = double(sight.passes.size());
  Pixel p;
  for (const std::vector<float>& pass : sight.passes) {
    const double value = double(pass[i]) * scale, clipped = std::min(value, bound);
    p.mean += value / n, p.clipped_mean += clipped / n;
    p.fireflies += value > bound;
  }
  for (const std::vector<float>& pass : sight.passes) {
    const double value = double(pass[i]) * scale;
    p.variance += sqr(value - p.mean) / (n - 1);
    p.clipped_variance += sqr(std::min(value, bound) - p.clipped_mean) / (n - 1);
  }
  return p;
}

// Mean of the errors without the worst thousandth, and its deviation.
void set_error(std::vector<double> errors, Judgement& j) {
  const auto kept = errors.end() - std::ptrdiff_t(errors.size() / 1000);
  if (kept != errors.end()) std::nth_element(errors.begin(), kept, errors.end());
  const double n = double(kept - errors.begin());
  const double mean = std::accumulate(errors.begin(), kept, 0.0) / n;
  const double square = std::accumulate(errors.begin(), kept, 0.0, [](double a, double e) { return a + sqr(e); });
  j.error = mean;
  j.deviation = std::sqrt(std::max(square / n - sqr(mean), 0.0) / n);
}

struct Blocks {
  std::vector<Block> all;
  Judgement judgement;
};

// Errors are held against what the others saw, so that a firefly does not excuse itself.
Blocks blocks_of(const Sight& sight, size_t count, const std::vector<double>& all, const std::vector<double>& level,
                 double scale) {
  const int across = (sight.width + block - 1) / block, down = (sight.height + block - 1) / block;
  Blocks out;
  out.all.resize(size_t(across) * size_t(down));
  const double n = double(sight.passes.size());
  std::vector<double> errors;
  for (int y = 0; y < sight.height; ++y)
    for (int x = 0; x < sight.width; ++x) {
      const size_t i = size_t(y) * size_t(sight.width) + size_t(x);
      const Pixel p = pixel_at(sight, i, scale, clip * level[i]);
      const double others = (all[i] * double(count) - p.mean) / double(count - 1);
      errors.push_back(p.variance / (sqr(others) + dark));
      Block& b = out.all[size_t(y / block) * size_t(across) + size_t(x / block)];
      b.mean += p.clipped_mean, b.variance += p.clipped_variance / n;
      b.fireflies += p.fireflies, b.error += errors.back(), ++b.pixels;
    }
  for (Block& b : out.all) b.mean /= b.pixels, b.variance /= sqr(b.pixels), b.error /= b.pixels;
  if (std::any_of(sight.sum.begin(), sight.sum.end(), [](double x) { return x > 0; }))
    set_error(std::move(errors), out.judgement);
  return out;
}

// Of one sample: where a block's samples saw less light than another trial's, fireflies of both left aside, and their
// spread does not explain it, the rest came in as many samples as there were fireflies, or in less than one of all that
// there were: it has the relative variance of that at least, seen or not.
double missed_error(const Block& mine, const Block& other, double passes) {
  const double missed = other.mean - mine.mean;
  if (missed < least_miss * other.mean || sqr(missed) < 9 * (mine.variance + other.variance)) return 0;
  const double rarity = mine.pixels * passes / std::max(mine.fireflies, 1.0);
  return std::max(sqr(missed) / (sqr(other.mean) + dark) * rarity - mine.error, 0.0);
}

}  // namespace

void look(const Film& film, Sight& sight) {
  sight.width = film.width, sight.height = film.height;
  sight.sum.resize(film.pixels());
  std::vector<float>& pass = sight.passes.emplace_back(film.pixels());
  for (size_t i = 0; i < film.pixels(); ++i) {
    const double sum = luminance(Rgb(film.camera_sum[i] + (film.splats ? film.splat_sum[i] : glm::dvec3(0))));
    pass[i] = float(sum - sight.sum[i]);
    sight.sum[i] = sum;
  }
}

std::vector<Judgement> judge(const std::vector<Sight>& sights) {
  std::vector<Judgement> out(sights.size());
  if (sights.size() < 2) return out;
  double scale = 0;
  const std::vector<double> all = seen_by_all(sights, scale);
  if (all.empty()) return out;
  const std::vector<double> level = blurred(all, sights[0].width, sights[0].height);
  std::vector<Blocks> blocks;
  for (const Sight& s : sights) blocks.push_back(blocks_of(s, sights.size(), all, level, scale));
  for (size_t k = 0; k < sights.size(); ++k) {
    const double passes = double(sights[k].passes.size());
    if (usual_mean(sights[k].sum) / passes * scale < blind * exposed) continue;
    out[k] = blocks[k].judgement;
    double sum = 0;
    for (size_t i = 0; i < blocks[k].all.size(); ++i) {
      double most = 0;
      for (const Blocks& other : blocks) most = std::max(most, missed_error(blocks[k].all[i], other.all[i], passes));
      sum += most * blocks[k].all[i].pixels;
    }
    out[k].unseen = sum / double(all.size());
  }
  return out;
}

double ray_cost(const std::string& integrator) {
  if (integrator == "path") return 0.23;
  if (integrator == "bdpt") return 0.245;
  if (integrator == "guided-path") return 0.42;
  return integrator == "guided-vcm" ? 0.75 : 0.54;
}

}  // namespace ajar
