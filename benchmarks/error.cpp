// How far the error estimate of the film can be trusted, and what its two independently scrambled sequences cost.
// Renders 2 PASSES passes with SEEDS seeds; the truth for each is the mean of all the others, whose own error is taken
// off. Prints for 4, 16, 64 ... PASSES:
//   cost       relMSE of the image over that of as many points of a single sequence
//   estimate   mean over seeds of the estimate over the mean of the true relMSE, and the 1/8 and 7/8 quantiles of
//   single images trimmed    the same for relMSE without the worst pixels passes     what the spread of the passes says
//   over the truth, and so for half differences within a single sequence: of even/odd, Thue-Morse and first/last passes
//
//   bench_error SCENE.xml INTEGRATOR [SEEDS [PASSES [WIDTH HEIGHT [NAME=VALUE...]]]]

#include <fmt/format.h>

#include <bit>
#include <cstdlib>

#include "ajar/core/error.h"
#include "ajar/render/render.h"
#include "ajar/scene/load.h"

namespace {

using namespace ajar;
using Values = std::vector<double>;  // of pixels and channels

enum Split { even_odd, thue_morse, first_last, splits };

struct Look {  // at an image of n passes, and at n points of the first of the two sequences
  Values image, single, spread;
  std::array<Values, splits> difference;  // half of that of the halves
  ErrorEstimate estimate;
};

Values flat(const std::vector<glm::dvec3>& from, double scale) {
  Values out;
  for (const glm::dvec3& v : from)
    for (int c = 0; c < 3; ++c) out.push_back(v[c] * scale);
  return out;
}

Values total(const Film& film) {
  Values out = flat(film.camera_sum, 1.0 / film.passes);
  if (!film.splats) return out;
  const Values splat = flat(film.splat_sum, 1.0 / film.passes);
  for (size_t i = 0; i < out.size(); ++i) out[i] += splat[i];
  return out;
}

struct Run {
  std::vector<Look> looks;
  Values last;  // the image of 2 n passes
};

// What the one even pass after `before` brought: the next point of the first of the two sequences.
Values since(const Film& film, const Film& before) {
  if (before.passes == 0) return flat(film.half_sum, 1);
  std::vector<glm::dvec3> added(film.half_sum);
  for (size_t i = 0; i < added.size(); ++i)
    added[i] = sum_since(even_passes(film), even_passes(before), added[i], before.half_sum[i]);
  return flat(added, 1);
}

Run run(const Scene& scene, const Accel& accel, const RenderOptions& o, const std::vector<uint32_t>& at) {
  RenderState state = start_render(scene, o);
  const size_t n = 3 * state.film.pixels();
  Run out{std::vector<Look>(at.size()), {}};
  Film before;  // as it was at the point before
  Values all;   // points so far
  std::array<Values, splits> sum;
  std::vector<Values> at_power;
  render(scene, accel, o, state, [&](const RenderState& s) {
    const uint32_t passes = s.film.passes, point = (passes - 1) / 2;
    const auto fresh = std::find(at.begin(), at.end(), passes), old = std::find(at.begin(), at.end(), point + 1);
    if (fresh != at.end()) {
      Look& look = out.looks[size_t(fresh - at.begin())];
      look.image = total(s.film);
      look.estimate = estimate_error(s.film);
      const Picture spread = variance(s.film);
      look.spread.assign(spread.pixels.begin(), spread.pixels.end());
    }
    if (passes % 2 == 0) return true;  // else the single sequence has a new point
    if (point == 0) before = Film(), all = Values(n), sum.fill(all), at_power.clear();  // what was before was dropped
    const Values now = since(s.film, before);
    before = s.film;
    for (size_t i = 0; i < n; ++i) {
      all[i] += now[i];
      if (point % 2 == 0) sum[even_odd][i] += now[i];
      if (std::popcount(point) % 2 == 0) sum[thue_morse][i] += now[i];
    }
    if (std::has_single_bit(point + 1)) at_power.push_back(all);
    if (old == at.end()) return true;
    Look& look = out.looks[size_t(old - at.begin())];
    look.single = all;
    for (double& x : look.single) x /= point + 1;
    sum[first_last] = at_power[at_power.size() - 2];
    for (int k = 0; k < splits; ++k) {
      look.difference[k].resize(n);
      for (size_t i = 0; i < n; ++i) look.difference[k][i] = 2 * sum[k][i] / (point + 1) - look.single[i];
    }
    return true;
  });
  out.last = total(state.film);
  return out;
}

// Mean over pixels of squares over those of the truth; trimmed without the largest thousandth.
double relative(const Values& square, const Values& truth, bool trimmed = false) {
  Values e(square.size() / 3);
  for (size_t i = 0; i < square.size(); ++i) e[i / 3] += square[i] / (truth[i] * truth[i] + 0.01) / 3;
  std::sort(e.begin(), e.end());
  if (trimmed) e.resize(e.size() - e.size() / 1000);
  double sum = 0;
  for (const double v : e) sum += v;
  return sum / double(e.size());
}

double error(const Values& image, const Values& truth, bool trimmed = false) {
  Values square(image);
  for (size_t i = 0; i < image.size(); ++i) square[i] = sqr(image[i] - truth[i]);
  return relative(square, truth, trimmed);
}

double mean(const Values& v) {
  double sum = 0;
  for (const double x : v) sum += x;
  return sum / double(v.size());
}

void print(uint32_t passes, size_t look, const std::vector<Run>& runs, const std::vector<Values>& truths, double off,
           double off_trimmed) {
  const size_t n = runs.size();
  Values image(n), single(n), spread(n), trimmed(n), estimate(n), estimate_trimmed(n), ratio(n);
  std::array<Values, splits> split;
  split.fill(Values(n));
  for (size_t i = 0; i < n; ++i) {
    const Look& l = runs[i].looks[look];
    image[i] = error(l.image, truths[i]) - off;
    trimmed[i] = error(l.image, truths[i], true) - off_trimmed;
    single[i] = error(l.single, truths[i]) - off;
    spread[i] = relative(l.spread, truths[i]);
    for (int k = 0; k < splits; ++k) {
      Values square(l.difference[k]);
      for (double& d : square) d *= d;
      split[k][i] = relative(square, truths[i]);
    }
    estimate[i] = l.estimate.relmse, estimate_trimmed[i] = l.estimate.relmse_trimmed;
    ratio[i] = estimate[i] / image[i];
  }
  std::sort(ratio.begin(), ratio.end());
  const double truth = mean(image), alone = mean(single);
  fmt::print(
      "{:5} spp  relMSE {:.2e}  cost {:.2f}  estimate {:.2f} ({:.2f} to {:.2f})  trimmed {:.2f}  passes {:.2f}  "
      "even/odd {:.2f}  Thue-Morse {:.2f}  first/last {:.2f}\n",
      passes, truth, truth / alone, mean(estimate) / truth, ratio[n / 8], ratio[n - 1 - n / 8],
      mean(estimate_trimmed) / mean(trimmed), mean(spread) / truth, mean(split[even_odd]) / alone,
      mean(split[thue_morse]) / alone, mean(split[first_last]) / alone);
}

void bench(int count, char** a) {
  const auto number = [&](int i, int otherwise) { return count > i ? std::max(1, std::atoi(a[i])) : otherwise; };
  LoadOptions load;
  for (int i = 7; i < count; ++i) {
    const std::string define = a[i];
    load.defines[define.substr(0, define.find('='))] = define.substr(define.find('=') + 1);
  }
  Scene scene = load_scene(a[1], load);
  Camera& c = scene.camera;
  c.width = c.crop_width = number(5, 48), c.height = c.crop_height = number(6, 32);
  c.crop_x = c.crop_y = 0;
  c.plane.y = c.plane.x * float(c.height) / float(c.width);
  const Accel accel(scene);
  std::vector<uint32_t> at;
  for (uint32_t n = 4; n <= uint32_t(number(4, 256)); n *= 4) at.push_back(n);
  if (at.empty()) throw Error("bench_error: PASSES is 4 or more");
  RenderOptions o;
  o.integrator = a[2], o.max_depth = 12, o.spp = 2 * at.back();
  std::vector<Run> runs(size_t(std::max(2, number(3, 16))));
  for (size_t i = 0; i < runs.size(); ++i) o.seed = 1000 + i, runs[i] = run(scene, accel, o, at);
  std::vector<Values> truths;
  const double others = double(runs.size() - 1);
  double off = 0, off_trimmed = 0;  // the error of a truth
  for (const Run& mine : runs) {
    Values& truth = truths.emplace_back(mine.last.size());
    for (const Run& r : runs)
      for (size_t i = 0; &r != &mine && i < truth.size(); ++i) truth[i] += r.last[i] / others;
    off += error(mine.last, truth) / sqr(others + 1);
    off_trimmed += error(mine.last, truth, true) / sqr(others + 1);
  }
  for (size_t k = 0; k < at.size(); ++k) print(at[k], k, runs, truths, off, off_trimmed);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    fmt::print(stderr, "usage: {} SCENE.xml INTEGRATOR [SEEDS [PASSES [WIDTH HEIGHT [NAME=VALUE...]]]]\n", argv[0]);
    return 2;
  }
  try {
    bench(argc, argv);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}: {}\n", argv[0], e.what());
    return 2;
  }
}
