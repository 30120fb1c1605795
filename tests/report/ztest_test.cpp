// The z-test: as many false alarms as it may have and no more, and the differences that it must find.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "ajar/core/error.h"
#include "ajar/core/sampler.h"
#include "ajar/report/metrics.h"
#include "pictures.h"
#include "report/student.h"

namespace ajar {
namespace {

enum class Noise { gaussian, lognormal, rare };

struct Setting {
  Noise noise = Noise::gaussian;
  double spread = 1;  ///< standard deviation of a sample, of its logarithm, or the rare event's probability
  int width = 64, height = 64, spp = 64;
  bool noisy_reference = false;
};

double draw_gaussian(Sampler& sampler) {
  const Vec2 u = sampler.next2();
  return std::sqrt(-2 * std::log(1 - double(u.x))) * std::cos(2 * std::numbers::pi * double(u.y));
}

/// One sample of mean 1.
double draw(const Setting& setting, Sampler& sampler) {
  switch (setting.noise) {
    case Noise::gaussian:
      return 1 + setting.spread * draw_gaussian(sampler);
    case Noise::lognormal:
      return std::exp(setting.spread * draw_gaussian(sampler) - setting.spread * setting.spread / 2);
    case Noise::rare:
      return 0.7 + (double(sampler.next1()) < setting.spread ? 0.3 / setting.spread : 0);
  }
  return 0;
}

/// Radiance 0.2 to 1.2 from left to right, of the same noise in all channels, with the variance of the means as samples
/// show it.
Picture simulate(const Setting& setting, uint64_t seed) {
  Picture picture{setting.width, setting.height, {"R", "G", "B", "Variance.R", "Variance.G", "Variance.B"}, {}};
  for (int i = 0; i < setting.width * setting.height; ++i) {
    Sampler sampler = make_sampler(SamplerKind::independent, seed, Side::camera, uint64_t(i), 0);
    double mean = 0, squares = 0;
    for (int k = 1; k <= setting.spp; ++k) {
      const double value = draw(setting, sampler), step = value - mean;
      mean += step / k;
      squares += step * (value - mean);
    }
    const double level = 0.2 + i % setting.width / double(setting.width),
                 variance = squares / setting.spp / (setting.spp - 1);
    for (int c = 0; c < 3; ++c) picture.pixels.push_back(float(mean * level * (1 - 0.3 * c)));
    for (int c = 0; c < 3; ++c)
      picture.pixels.push_back(float(variance * level * level * (1 - 0.3 * c) * (1 - 0.3 * c)));
  }
  return picture;
}

Picture expectation(const Setting& setting) {
  Setting exact = setting;
  exact.spread = 0;
  exact.noise = Noise::gaussian;
  exact.spp = 2;
  return select(simulate(exact, 0), {"R", "G", "B"});
}

Picture scaled(Picture picture, int x, int y, int width, int height, float factor) {
  for (int row = y; row < y + height; ++row)
    for (int column = x; column < x + width; ++column)
      for (size_t c = 0; c < 3; ++c)
        picture.pixels[size_t(row * picture.width + column) * picture.names.size() + c] *= factor;
  return picture;
}

ZTest test_of(const Setting& setting, uint64_t seed) {
  const Picture image = simulate(setting, 2 * seed);
  return z_test(image, setting.noisy_reference ? simulate(setting, 2 * seed + 1) : expectation(setting));
}

TEST(Student, TailAgreesWithSciPy) {  // scipy.stats.t.sf, SciPy 1.10
  const double cases[][3] = {{0.5, 1, 0.3524163823495668},     {2, 3.5, 0.06306926128795674},
                             {10, 31, 1.6023977459154444e-11}, {6, 1000, 1.3776845866887337e-09},
                             {30, 31, 9.03680744482221e-25},   {5, 1e6, 2.8669989354453655e-07}};
  for (const auto& [t, dof, p] : cases) EXPECT_NEAR(student_tail(t, dof) / p, 1, 1e-9) << t << ' ' << dof;
  EXPECT_EQ(student_tail(0, 5), 0.5);
  EXPECT_EQ(student_tail(std::numeric_limits<double>::infinity(), 5), 0);
}

TEST(ZTest, PixelFiguresByHand) {
  // Differences 0.3, -0.1, 0.2 with variances 0.01, 0.04, 0.01 from both sides together; the other channels equal.
  Picture image{3, 1, {"R", "G", "B", "Variance.R", "Variance.G", "Variance.B"}, {}}, reference = image;
  const float difference[3] = {0.3f, -0.1f, 0.2f}, variance[3] = {0.006f, 0.04f, 0.01f}, other[3] = {0.004f, 0, 0};
  for (int i = 0; i < 3; ++i) {
    image.pixels.insert(image.pixels.end(), {1 + difference[i], 1, 1, variance[i], 0, 0});
    reference.pixels.insert(reference.pixels.end(), {1, 1, 1, other[i], 0, 0});
  }
  const ZTest z = z_test(image, reference);
  EXPECT_NEAR(z.mean, (3 - 0.5 + 2) / 3, 1e-3);
  EXPECT_NEAR(z.variance, 1.5 * 1.5 / 2 + 2 * 2 / 2.0 + 0.5 * 0.5 / 2, 2e-3);
  EXPECT_NEAR(z.worst, 3, 1e-3);
  EXPECT_EQ(z.worst_x, 0);
  EXPECT_EQ(z.worst_y, 0);
}

TEST(ZTest, NeedsAVariance) {
  const Picture grey = test::constant(4, 4, Rgb(1.0f));
  EXPECT_THROW(z_test(grey, grey), Error);
  EXPECT_FALSE(compare(grey, grey).has_z);
  EXPECT_TRUE(compare(grey, with_variance(grey, grey)).has_z) << "the reference's alone will do";
  EXPECT_THROW(with_variance(grey, test::constant(3, 4, Rgb(1.0f))), Error);
}

TEST(ZTest, WithVarianceTakesEitherName) {
  const Picture image = test::pattern(5, 4), variance = test::pattern(5, 4, 0.6);
  const Picture plain = with_variance(image, variance), named = with_variance(image, with_variance(image, variance));
  EXPECT_EQ(plain.pixels, named.pixels);
  EXPECT_EQ(select(plain, {"R", "G", "B"}).pixels, image.pixels);
  EXPECT_EQ(select(plain, {"Variance.R", "Variance.G", "Variance.B"}).pixels, variance.pixels);
  EXPECT_EQ(with_variance(plain, image).names, plain.names) << "older variance is replaced";
}

TEST(ZTest, NoVarianceAndNoDifferenceIsNoEvidence) {
  const Picture black = with_variance(test::constant(16, 16, Rgb(0.0f)), test::constant(16, 16, Rgb(0.0f)));
  EXPECT_EQ(z_test(black, black).p, 1);
  Picture rounded = with_variance(test::constant(16, 16, Rgb(12.0f)), test::constant(16, 16, Rgb(1e-14f)));
  const Picture exact = rounded;
  for (float& value : rounded.pixels)
    if (value == 12) value = std::nextafter(value, 13.0f);
  EXPECT_EQ(z_test(rounded, exact).p, 1) << "the last bit of a float is no difference";
  EXPECT_EQ(z_test(rounded, exact).worst, 0);
  EXPECT_EQ(z_test(scaled(black, 0, 0, 16, 16, 0), with_variance(test::constant(16, 16, Rgb(1.0f)), black)).p, 0)
      << "different without any noise";
}

TEST(ZTest, WhereNothingStandsOutTheRegionIsTheWholeImage) {
  Picture image{1, 1, {"R", "G", "B", "Variance.R", "Variance.G", "Variance.B"}, {1, 1, 1, 1, 1, 1}};
  const ZTest test = z_test(image, {1, 1, {"R", "G", "B"}, {1, 1, 1}});
  EXPECT_EQ(test.p, 1);
  EXPECT_EQ(test.width, 1);
  EXPECT_EQ(test.height, 1);
}

TEST(ZTest, PixelsThatMissedARareEventAreNotCertain) {
  // The left half saw none of what makes up 30 % of its light; its equal samples left a variance of rounding size.
  Picture image = test::constant(32, 32, Rgb(0.7f)), variance = test::constant(32, 32, Rgb(1e-16f));
  for (int y = 0; y < 32; ++y)
    for (int i = 3 * (32 * y + 16); i < 3 * (32 * y + 32); ++i) {
      image.pixels[size_t(i)] = 1.3f;
      variance.pixels[size_t(i)] = 100;
    }
  EXPECT_GT(z_test(with_variance(image, variance), test::constant(32, 32, Rgb(1.0f))).p, 0.05);
}

struct ZTestRate : testing::TestWithParam<Setting> {};

/// Bonferroni's bound makes the test conservative: of 100 images the binomial count of p < 0.05 stays below 5 + 3.3
/// sqrt(4.75).
TEST_P(ZTestRate, FalseAlarmsAreAtMostNominal) {
  const int trials = 100;
  int alarms = 0, grave = 0;
  for (int i = 0; i < trials; ++i) {
    const double p = test_of(GetParam(), uint64_t(i)).p;
    EXPECT_GE(p, 0);
    EXPECT_LE(p, 1);
    alarms += p < 0.05;
    grave += p < 1e-4;
  }
  EXPECT_LE(alarms, 12);
  EXPECT_EQ(grave, 0);
}

INSTANTIATE_TEST_SUITE_P(
    Noises, ZTestRate,
    testing::Values(Setting{Noise::gaussian, 1, 16, 16, 16}, Setting{Noise::gaussian, 1, 48, 40, 32, true},
                    Setting{Noise::lognormal, 1, 48, 48, 16}, Setting{Noise::lognormal, 1.5, 48, 48, 32},
                    Setting{Noise::lognormal, 2, 32, 32, 64}, Setting{Noise::lognormal, 2, 32, 32, 32, true},
                    Setting{Noise::rare, 0.1, 48, 48, 16}, Setting{Noise::rare, 0.02, 64, 64, 16},
                    Setting{Noise::rare, 0.002, 32, 32, 16, true}));

TEST(ZTestRate, PixelsAreStandardNormalForGaussianNoise) {
  const ZTest z = test_of({Noise::gaussian, 1, 96, 96, 200}, 3);
  EXPECT_NEAR(z.mean, 0, 4 / 96.0);
  EXPECT_NEAR(z.variance, 1, 0.01 + 4 * std::sqrt(2.0) / 96);
  EXPECT_LT(std::abs(z.worst), 6);
}

/// White noise spread over neighbours by a tent of radius 1, as splats are: the claimed variance of each pixel is
/// right, but that of a sum is 2.25 times the sum.
TEST(ZTestRate, SplatsThatNeighboursShareRaiseNoAlarm) {
  const double kernel[3] = {1.0 / 6, 4.0 / 6, 1.0 / 6};
  for (const int size : {16, 32, 64, 96}) {
    int alarms = 0, grave = 0;
    for (int trial = 0; trial < 60; ++trial) {
      std::vector<double> white;
      Sampler sampler = make_sampler(SamplerKind::independent, 5, Side::light, uint64_t(size), uint32_t(trial));
      for (int i = 0; i < (size + 2) * (size + 2); ++i) white.push_back(draw_gaussian(sampler));
      Picture image = test::constant(size, size, Rgb(10.0f));
      const Picture reference = image;
      for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
          for (int k = 0; k < 9; ++k)
            for (int c = 0; c < 3; ++c)
              image.pixels[size_t(3 * (y * size + x) + c)] +=
                  float(kernel[k / 3] * kernel[k % 3] * white[size_t((y + k / 3) * (size + 2) + x + k % 3)]);
      const double p = z_test(with_variance(image, test::constant(size, size, Rgb(0.25f))), reference).p;
      alarms += p < 0.05;
      grave += p < 1e-4;
    }
    EXPECT_LE(alarms, 9) << size;
    EXPECT_EQ(grave, 0) << size;
  }
}

/// Half a percent more everywhere; the mean's own deviation is 0.05 %.
TEST(ZTestPower, ShiftOfHalfAPercentIsFound) {
  for (const Noise noise : {Noise::gaussian, Noise::lognormal})
    for (const float shift : {1.005f, 0.995f}) {
      const Setting setting{noise, 0.8, 128, 128, 160};
      const ZTest z = z_test(scaled(simulate(setting, 11), 0, 0, 128, 128, shift), expectation(setting));
      EXPECT_LT(z.p, 1e-4) << shift;
      EXPECT_EQ(z.width * z.height, 128 * 128) << "the whole image tells most";
    }
}

/// 5 % in a sixteenth of the image, 0.3 % of the mean: only a region shows it, and the region found is that one.
TEST(ZTestPower, LocalDifferenceIsFoundAndPlaced) {
  const Setting setting{Noise::gaussian, 1, 128, 128, 64};
  const ZTest z = z_test(scaled(simulate(setting, 12), 64, 32, 32, 32, 1.05f), expectation(setting));
  EXPECT_LT(z.p, 1e-4);
  EXPECT_TRUE(z.x >= 64 && z.x + z.width <= 96 && z.y >= 32 && z.y + z.height <= 64)
      << fmt::format("{}x{} at ({}, {})", z.width, z.height, z.x, z.y);
}

TEST(ZTestPower, GrossErrorsOfSmallImagesAreFound) {
  for (const int size : {8, 16, 32}) {
    const Setting setting{Noise::gaussian, 1, size, size, 64};
    const Picture image = simulate(setting, 13);
    EXPECT_LT(z_test(scaled(image, 0, 0, size, size, 1.5f), expectation(setting)).p, 1e-4) << size;
    EXPECT_LT(z_test(scaled(image, 0, 0, size, size, 20), expectation(setting)).p, 1e-4) << size;
  }
}

}  // namespace
}  // namespace ajar
