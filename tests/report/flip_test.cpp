// FLIP against a direct evaluation of its definition, and against numbers of the authors' own.

#include <gtest/gtest.h>

#include "ajar/core/error.h"
#include "ajar/film/tone.h"
#include "ajar/report/metrics.h"
#include "pictures.h"

namespace ajar {
namespace {

using test::constant, test::pattern;

double mean(const Picture& picture) {
  double sum = 0;
  for (const float value : picture.pixels) sum += value;
  return sum / double(picture.pixels.size());
}

// --- The definition, step by step: YCxCz, two-dimensional kernels, no shortcuts ---

struct Colour {
  double r, g, b;
};

Colour to_xyz(const Colour& c) {
  return {0.4123865632529917 * c.r + 0.35759149092062537 * c.g + 0.18045049120356368 * c.b,
          0.21263682167732384 * c.r + 0.7151829818412507 * c.g + 0.07218019648142547 * c.b,
          0.019330620152483987 * c.r + 0.11919716364020845 * c.g + 0.9503725870054354 * c.b};
}
constexpr Colour white{0.950428545, 1, 1.088900371};

/// Solves to_xyz by Cramer's rule.
Colour to_rgb(const Colour& xyz) {
  const Colour x = to_xyz({1, 0, 0}), y = to_xyz({0, 1, 0}), z = to_xyz({0, 0, 1});
  const auto det = [](const Colour& a, const Colour& b, const Colour& c) {
    return a.r * (b.g * c.b - b.b * c.g) - b.r * (a.g * c.b - a.b * c.g) + c.r * (a.g * b.b - a.b * b.g);
  };
  const double d = det(x, y, z);
  return {det(xyz, y, z) / d, det(x, xyz, z) / d, det(x, y, xyz) / d};
}

Colour to_ycxcz(const Colour& rgb) {
  const Colour c = to_xyz(rgb);
  const double x = c.r / white.r, y = c.g / white.g, z = c.b / white.b;
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Colour from_ycxcz(const Colour& c) {
  const double y = (c.r + 16) / 116;
  return to_rgb({(y + c.g / 500) * white.r, y * white.g, (y - c.b / 200) * white.b});
}

Colour hunt_lab(const Colour& rgb) {
  const auto f = [](double t) { return t > 216.0 / 24389 ? std::pow(t, 1.0 / 3) : 841.0 / 108 * t + 4.0 / 29; };
  const Colour c = to_xyz(rgb);
  const double x = f(c.r / white.r), y = f(c.g / white.g), z = f(c.b / white.b), l = 116 * y - 16;
  return {l, 0.01 * l * 500 * (x - y), 0.01 * l * 200 * (y - z)};
}

double distance(const Colour& p, const Colour& q) {
  return std::abs(p.r - q.r) + std::sqrt((p.g - q.g) * (p.g - q.g) + (p.b - q.b) * (p.b - q.b));
}

struct Kernel {
  int radius;
  std::vector<double> weights;
};

Kernel sensitivity_kernel(double ppd, double a1, double b1, double a2, double b2) {
  const double pi2 = std::numbers::pi * std::numbers::pi;
  Kernel k{int(std::ceil(3 * std::sqrt(0.04 / (2 * pi2)) * ppd)), {}};
  double sum = 0;
  for (int j = -k.radius; j <= k.radius; ++j)
    for (int i = -k.radius; i <= k.radius; ++i) {
      const double square = (i * i + j * j) / (ppd * ppd);
      sum += k.weights.emplace_back(a1 * std::sqrt(std::numbers::pi / b1) * std::exp(-pi2 * square / b1) +
                                    a2 * std::sqrt(std::numbers::pi / b2) * std::exp(-pi2 * square / b2));
    }
  for (double& w : k.weights) w /= sum;
  return k;
}

Kernel feature_kernel(double ppd, bool point, bool along_y) {
  const double s = 0.5 * 0.082 * ppd;
  Kernel k{int(std::ceil(3 * s)), {}};
  double positive = 0, negative = 0;
  for (int j = -k.radius; j <= k.radius; ++j)
    for (int i = -k.radius; i <= k.radius; ++i) {
      const double u = along_y ? j : i, g = std::exp(-(i * i + j * j) / (2 * s * s));
      const double w = k.weights.emplace_back(point ? (u * u / (s * s) - 1) * g : -u * g);
      (w > 0 ? positive : negative) += w;
    }
  for (double& w : k.weights) w /= w > 0 ? positive : -negative;
  return k;
}

template <typename Value>
double filtered(const Picture& p, int x, int y, const Kernel& k, const Value& value) {
  double sum = 0;
  size_t n = 0;
  for (int j = -k.radius; j <= k.radius; ++j)
    for (int i = -k.radius; i <= k.radius; ++i)
      sum += k.weights[n++] *
             value(size_t(std::clamp(y + j, 0, p.height - 1) * p.width + std::clamp(x + i, 0, p.width - 1)));
  return sum;
}

std::vector<Colour> opponent(const Picture& p) {
  std::vector<Colour> out;
  for (size_t i = 0; i < p.pixels.size(); i += 3) {
    // As the paper takes them: from the encoded picture of a screen.
    const auto screen = [&](size_t c) { return decode_srgb(tone_curve(p.pixels[i + c])); };
    out.push_back(to_ycxcz({screen(0), screen(1), screen(2)}));
  }
  return out;
}

std::vector<double> slow_flip(const Picture& a, const Picture& b, double ppd) {
  const Kernel ka = sensitivity_kernel(ppd, 1, 0.0047, 0, 1e-5), kr = sensitivity_kernel(ppd, 1, 0.0053, 0, 1e-5),
               kb = sensitivity_kernel(ppd, 34.1, 0.04, 13.5, 0.025);
  const std::vector<Colour> opponents[2] = {opponent(a), opponent(b)};
  const double largest = std::pow(distance(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), 0.7);
  std::vector<double> out;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      Colour lab[2];
      double features[2][2];
      for (int n = 0; n < 2; ++n) {
        const auto& o = opponents[n];
        const Colour seen = from_ycxcz({filtered(a, x, y, ka, [&](size_t i) { return o[i].r; }),
                                        filtered(a, x, y, kr, [&](size_t i) { return o[i].g; }),
                                        filtered(a, x, y, kb, [&](size_t i) { return o[i].b; })});
        lab[n] = hunt_lab({std::clamp(seen.r, 0.0, 1.0), std::clamp(seen.g, 0.0, 1.0), std::clamp(seen.b, 0.0, 1.0)});
        for (const bool point : {false, true}) {
          const auto luma = [&](size_t i) { return (o[i].r + 16) / 116; };
          features[n][point] = std::hypot(filtered(a, x, y, feature_kernel(ppd, point, false), luma),
                                          filtered(a, x, y, feature_kernel(ppd, point, true), luma));
        }
      }
      const double power = std::pow(distance(lab[0], lab[1]), 0.7), knee = 0.4 * largest;
      const double colour = power < knee ? 0.95 / knee * power : 0.95 + 0.05 * (power - knee) / (largest - knee);
      const double edge = std::abs(features[0][0] - features[1][0]), point = std::abs(features[0][1] - features[1][1]);
      out.push_back(std::pow(colour, 1 - std::sqrt(std::max(edge, point) / std::sqrt(2.0))));
    }
  return out;
}

TEST(Flip, AgreesWithTheDefinition) {
  const Picture a = pattern(31, 22, 0.6), b = pattern(31, 22);
  for (const double ppd : {3840 * std::numbers::pi / 180, 25.0}) {
    const Picture fast = flip(a, b, ppd);
    const std::vector<double> slow = slow_flip(a, b, ppd);
    for (size_t i = 0; i < slow.size(); ++i) EXPECT_NEAR(fast.pixels[i], slow[i], 2e-6) << i;
  }
}

// Computed with the operations of the authors' published NumPy evaluation (version 1.2) on the same encoded pictures.
TEST(Flip, AgreesWithTheAuthorsEvaluation) {
  const Picture map = flip(pattern(64, 48, 0.6), pattern(64, 48));
  EXPECT_NEAR(mean(map), 0.14832639873334438, 1e-6);
  EXPECT_NEAR(map.pixels[0], 0.14295401755483333, 1e-6);
  EXPECT_NEAR(map.pixels[30 * 64 + 20], 0.1400640074476112, 1e-6);
  EXPECT_NEAR(mean(flip(pattern(64, 48, 0.6), pattern(64, 48), 40)), 0.20088589160571257, 1e-6);
  EXPECT_NEAR(mean(flip(constant(16, 16, Rgb(1.0f)), constant(16, 16, Rgb(0.0f)))), 0.9673797634560747, 1e-6);
}

TEST(Flip, BlackAndWhiteByHand) {
  // No features, no chroma: only L* differs, by 100. Green and blue give the largest distance: Hunt-adjusted Lab
  // (87.736, -75.610, 72.981) and (32.298, 25.578, -34.836), so 55.438 + 147.864 = 203.302.
  const double largest = std::pow(203.302, 0.7), power = std::pow(100, 0.7), knee = 0.4 * largest;
  const Picture map = flip(constant(20, 20, Rgb(1.0f)), constant(20, 20, Rgb(0.0f)));
  for (const float value : map.pixels) EXPECT_NEAR(value, 0.95 + 0.05 * (power - knee) / (largest - knee), 1e-5);
}

TEST(Flip, RangeIdentitySymmetry) {
  const Picture a = pattern(40, 30, 2), b = pattern(40, 30);
  const Picture ab = flip(a, b), ba = flip(b, a);
  for (size_t i = 0; i < ab.pixels.size(); ++i) {
    EXPECT_GE(ab.pixels[i], 0);
    EXPECT_LE(ab.pixels[i], 1);
    EXPECT_EQ(ab.pixels[i], ba.pixels[i]);
  }
  for (const float value : flip(a, a).pixels) EXPECT_EQ(value, 0);
  for (const float value : flip(constant(9, 9, {0, 1, 0}), constant(9, 9, {0, 0, 1})).pixels)
    EXPECT_NEAR(value, 1, 1e-6);
}

TEST(Flip, ALostPointIsSeenWhereItWas) {
  const Picture lost = constant(61, 61, Rgb(0.1f));
  Picture reference = lost;
  for (size_t c = 0; c < 3; ++c) reference.pixels[3 * (30 * 61 + 30) + c] = 1;
  const Picture map = flip(lost, reference);
  EXPECT_GT(map.pixels[30 * 61 + 30], 0.2);
  EXPECT_EQ(*std::max_element(map.pixels.begin(), map.pixels.end()), map.pixels[30 * 61 + 30]);
  EXPECT_LT(map.pixels[0], 1e-6) << "beyond the filters' reach nothing differs";
}

TEST(Flip, NeedsAResolution) {
  const Picture p = test::constant(4, 4, Rgb(0.5f));
  for (const double bad : {0.0, -1.0, double(infinity), std::nan("")}) EXPECT_THROW(flip(p, p, bad), Error) << bad;
}

TEST(Flip, OnePixelAndOneRow) {
  EXPECT_NEAR(flip(constant(1, 1, Rgb(1.0f)), constant(1, 1, Rgb(0.0f))).pixels[0], 0.96738, 1e-5);
  EXPECT_EQ(flip(constant(50, 1, Rgb(1.0f)), constant(50, 1, Rgb(1.0f))).pixels.size(), 50u);
}

}  // namespace
}  // namespace ajar
