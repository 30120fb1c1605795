// Reconstruction filters: integral 1, the right shape, and samples that follow the kernel with its sign.
#include "ajar/scene/filter.h"

#include <gtest/gtest.h>

#include "ajar/core/error.h"
#include "ajar/core/sampler.h"

namespace ajar {
namespace {

const FilterKind kinds[] = {FilterKind::box,      FilterKind::tent,       FilterKind::gaussian,
                            FilterKind::mitchell, FilterKind::catmullrom, FilterKind::lanczos};

std::vector<Filter> filters() {
  std::vector<Filter> all;
  for (const FilterKind k : kinds) all.push_back(make_filter(k));
  all.push_back(make_filter(FilterKind::box, 1.5f));
  all.push_back(make_filter(FilterKind::tent, 0.7f));
  all.push_back(make_filter(FilterKind::gaussian, 0, 0.8f));
  all.push_back(make_filter(FilterKind::mitchell, 2, 0.2f, 0.6f));
  all.push_back(make_filter(FilterKind::lanczos, 0, 2));
  return all;
}

template <class F>
double integrate(const Filter& f, const F& g) {
  constexpr int n = 200'000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double x = ((i + 0.5) / n * 2 - 1) * f.radius;
    sum += double(eval(f, float(x))) * g(x) * 2 * f.radius / n;
  }
  return sum;
}

TEST(Filter, IntegralIsOneAndNothingOutside) {
  for (const Filter& f : filters()) {
    EXPECT_NEAR(integrate(f, [](double) { return 1.0; }), 1, 1e-4) << int(f.kind);
    EXPECT_NEAR(integrate(f, [](double x) { return x; }), 0, 1e-4) << int(f.kind);
    EXPECT_EQ(eval(f, f.radius * 1.0001f), 0);
    EXPECT_EQ(eval(f, -f.radius * 1.0001f), 0);
    EXPECT_EQ(eval(f, infinity), 0);
  }
}

TEST(Filter, HasTheUsualShape) {
  const Filter gauss = make_filter(FilterKind::gaussian);
  EXPECT_EQ(gauss.radius, 2);
  const double low = std::exp(-8.0);
  EXPECT_NEAR(eval(gauss, 0.6f) / eval(gauss, 0), (std::exp(-0.72) - low) / (1 - low), 1e-4);
  const Filter mitchell = make_filter(FilterKind::mitchell);
  EXPECT_EQ(mitchell.radius, 2);
  EXPECT_NEAR(eval(mitchell, 0), 8.0 / 9, 1e-4);
  EXPECT_NEAR(eval(mitchell, 1), 1.0 / 18, 1e-4);
  const Filter hermite = make_filter(FilterKind::mitchell, 0, 0, 0);
  EXPECT_NEAR(eval(hermite, 0), 1, 1e-4);
  EXPECT_NEAR(eval(hermite, 1), 0, 1e-4);
  const Filter catmullrom = make_filter(FilterKind::catmullrom);
  EXPECT_NEAR(eval(catmullrom, 0), 1, 1e-4);
  EXPECT_NEAR(eval(catmullrom, 1), 0, 1e-4);
  EXPECT_NEAR(eval(catmullrom, 1.5f), -0.0625, 1e-4);
  const Filter lanczos = make_filter(FilterKind::lanczos);
  EXPECT_EQ(lanczos.radius, 3);
  EXPECT_NEAR(eval(lanczos, 1.5f) / eval(lanczos, 0), std::sin(1.5 * pi) / (1.5 * pi) / (pi / 2), 1e-4);
  EXPECT_NEAR(eval(make_filter(FilterKind::tent), 0.25f), 0.75, 1e-6);
  EXPECT_NEAR(eval(make_filter(FilterKind::box), 0.25f), 1, 1e-6);
}

// A splat on the edge between two pixels must not count twice.
TEST(Filter, BoxDividesThePlane) {
  const Filter box = make_filter(FilterKind::box);
  EXPECT_EQ(eval(box, 0.5f) + eval(box, -0.5f), 1);
}

// Mean of values and the deviation of that mean.
std::pair<double, double> mean_and_error(const std::vector<double>& values) {
  const double n = double(values.size());
  double mean = 0, square = 0;
  for (const double v : values) mean += v / n;
  for (const double v : values) square += (v - mean) * (v - mean);
  return {mean, std::sqrt(square / (n - 1) / n)};
}

// The sampled mean of any function is its integral against the kernel, sign included. The spread of eight independent
// sequences says how far off it may be: six deviations are a Student's t that chance exceeds once in 2000 cases; what
// is added is the rounding of floats, for filters that the sequence integrates to less than that.
TEST(Filter, SamplesFollowTheKernel) {
  constexpr uint32_t n = 1 << 15, sequences = 8;
  const auto g = [](double x) { return std::cos(2 * x) + 0.5 * x + 0.3 * x * x * x; };
  const auto h = [](double y) { return std::exp(y); };
  for (const Filter& f : filters()) {
    std::vector<double> means(sequences), weights(sequences);
    for (uint32_t s = 0; s < sequences; ++s)
      for (uint32_t i = 0; i < n; ++i) {
        float w;
        const Vec2 at = sample(f, make_sampler(SamplerKind::sobol, s, Side::camera, 0, i).next2(), w);
        ASSERT_TRUE(std::abs(at.x) <= f.radius && std::abs(at.y) <= f.radius);
        ASSERT_NEAR(std::abs(w), f.sign_norm * f.sign_norm, 1e-5f);
        means[s] += w * g(at.x) * h(at.y) / n;
        weights[s] += double(w) / n;
      }
    const auto [mean, error] = mean_and_error(means);
    EXPECT_NEAR(mean, integrate(f, g) * integrate(f, h), 6 * error + 1e-4) << int(f.kind);
    const auto [weight, weight_error] = mean_and_error(weights);
    EXPECT_NEAR(weight, 1, 6 * weight_error + 1e-5) << int(f.kind);
    if (f.kind <= FilterKind::gaussian) {
      EXPECT_EQ(f.sign_norm, 1);
    }
  }
}

// Frequencies of samples in narrow bins against |kernel|.
TEST(Filter, SampleDensityIsTheAbsoluteKernel) {
  for (const Filter& f : filters()) {
    constexpr int bins = 60, n = 1 << 18;
    std::vector<double> count(bins), expected(bins);
    for (int i = 0; i < n; ++i) {
      float w;
      const Vec2 at = sample(f, Vec2((float(i) + 0.5f) / n, 0.5f), w);
      count[size_t(std::clamp(int((at.x / f.radius + 1) / 2 * bins), 0, bins - 1))] += 1.0 / n;
      const double x = ((i + 0.5) / n * 2 - 1) * f.radius;
      expected[size_t(i * bins / n)] += std::abs(eval(f, float(x))) / f.sign_norm * 2 * f.radius / n;
    }
    for (int b = 0; b < bins; ++b)
      EXPECT_NEAR(count[b], expected[b], 3e-5 + 1e-3 * expected[b]) << int(f.kind) << " " << b;
  }
}

// What would make a table of no numbers, or one that a film cannot hold.
TEST(Filter, ParametersThatCannotBeMeantAreErrors) {
  const float nan = std::nanf("");
  for (const float bad : {0.0f, -1.0f, 1e-3f, 17.0f, 1e9f, nan, infinity}) {
    EXPECT_THROW(make_filter(FilterKind::gaussian, 2, bad), Error) << bad;
    EXPECT_THROW(make_filter(FilterKind::lanczos, 0, bad), Error) << bad;
    for (const FilterKind k : kinds) {
      EXPECT_THROW(make_filter(k, bad != 0 ? bad : -1), Error) << int(k) << " " << bad;
    }
  }
  for (const float bad : {100.0f, -5.0f, nan}) {
    EXPECT_THROW(make_filter(FilterKind::mitchell, 0, bad), Error);
    EXPECT_THROW(make_filter(FilterKind::mitchell, 0, 0.3f, bad), Error);
  }
}

TEST(Filter, EndsOfTheRandomNumbersAreSafe) {
  for (const Filter& f : filters())
    for (const float u : {0.0f, 0.5f, one_minus_epsilon, 1e-30f, 0x1p-32f}) {
      float w;
      const Vec2 at = sample(f, {u, 1 - u >= 1 ? one_minus_epsilon : 1 - u}, w);
      EXPECT_TRUE(std::isfinite(at.x + at.y + w));
      EXPECT_LE(std::abs(at.x), f.radius);
    }
}

}  // namespace
}  // namespace ajar
