// What is said of many seeds, against values worked out by hand.

#include "ajar/report/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ajar {
namespace {

/// error = scale / time, from 1 s to the end, doubling.
Curve curve(double scale, double end, double power = 1) {
  Curve c;
  for (double t = 1; t <= end; t *= 2) c.push_back({t, scale / std::pow(t, power), 4 * t});
  return c;
}

TEST(Spread, QuartilesFromFourValuesOn) {
  EXPECT_FALSE(spread({}));
  const auto one = spread({3});
  EXPECT_EQ(one->low, 3);
  EXPECT_EQ(one->median, 3);
  EXPECT_EQ(one->high, 3);
  const auto three = spread({9, 1, 4});
  EXPECT_EQ(three->low, 1);
  EXPECT_EQ(three->median, 4);
  EXPECT_EQ(three->high, 9);
  const auto four = spread({8, 1, 4, 2});  // sorted 1 2 4 8: at 0.75, 1.5 and 2.25
  EXPECT_DOUBLE_EQ(four->low, 1.75);
  EXPECT_DOUBLE_EQ(four->median, 3);
  EXPECT_DOUBLE_EQ(four->high, 5);
  const auto five = spread({5, 3, 1, 2, 4});
  EXPECT_EQ(five->low, 2);
  EXPECT_EQ(five->median, 3);
  EXPECT_EQ(five->high, 4);
}

TEST(Spread, InfinitiesStayNumbers) {
  const double inf = std::numeric_limits<double>::infinity();
  const auto s = spread({inf, inf, 1, inf});
  EXPECT_EQ(s->median, inf);
  EXPECT_EQ(s->high, inf);
}

TEST(Slope, OfPowerLawsIsTheirPower) {
  EXPECT_NEAR(*fitted_slope(curve(0.3, 64)), -1, 1e-12);
  EXPECT_NEAR(*fitted_slope(curve(7, 64, 0.5)), -0.5, 1e-12);
  // Log2 of times 0 1 2, of errors 0 -2 -1: slope -1/2.
  EXPECT_NEAR(*fitted_slope({{1, 1, 4}, {2, 0.25, 8}, {4, 0.5, 16}}), -0.5, 1e-12);
}

TEST(Slope, LeavesOutTheFirstSamplesAndZeros) {
  Curve c = curve(1, 16);
  c.insert(c.begin(), {0.1, 1e6, 3.9});
  c.push_back({32, 0, 128});
  EXPECT_NEAR(*fitted_slope(c), -1, 1e-12);
  EXPECT_FALSE(fitted_slope(curve(1, 2))) << "two points";
  EXPECT_FALSE(fitted_slope({{2, 1, 4}, {2, 2, 4}, {2, 3, 4}})) << "all at one time";
}

TEST(ErrorAt, InterpolatesInLogarithmsAndNotBeyond) {
  const Curve c = {{1, 8, 1}, {4, 2, 4}, {16, 0, 16}};
  EXPECT_EQ(*error_at(c, 1), 8);
  EXPECT_EQ(*error_at(c, 16), 0);
  EXPECT_NEAR(*error_at(c, 2), 4, 1e-12);
  EXPECT_NEAR(*error_at(c, 8), 1, 1e-12) << "to zero there is no power law: linear in log time";
  EXPECT_FALSE(error_at(c, 0.9));
  EXPECT_FALSE(error_at(c, 17));
  EXPECT_FALSE(error_at({}, 1));
}

TEST(ErrorRatio, IsTakenWhereTheFirstEnds) {
  EXPECT_NEAR(*error_ratio(curve(1, 16), curve(3, 16)), 3, 1e-12);
  EXPECT_NEAR(*error_ratio(curve(1, 16), curve(3, 64)), 3, 1e-12);  // baseline at 16, not its last at 64
  Curve late = curve(1, 16);
  late.back().time = 20;  // 1/16 at 20; at 16, between (8, 1/8) and (20, 1/16)
  EXPECT_NEAR(*error_ratio(late, curve(3, 16)), 3.0 / 16 / (0.125 * std::pow(0.5, std::log(2) / std::log(2.5))), 1e-12);
  EXPECT_FALSE(error_ratio({}, curve(1, 4)));
  EXPECT_FALSE(error_ratio({{1, 0, 1}}, {{1, 0, 1}}));
  EXPECT_FALSE(error_ratio({{1, 1, 1}}, {{2, 1, 1}, {3, 1, 1}})) << "nothing in common";
}

TEST(TimeTo, IsTheLastCrossing) {
  const Curve c = {{1, 16, 1}, {2, 1, 2}, {4, 8, 4}, {8, 2, 8}};  // a firefly between 2 and 8
  EXPECT_NEAR(time_to(c, 4)->time, 4 * std::sqrt(2), 1e-12);
  EXPECT_NEAR(time_to(c, 2)->time, 8, 1e-12);
  EXPECT_FALSE(time_to(c, 4)->at_most);
  EXPECT_FALSE(time_to(c, 1.9)) << "not extrapolated";
  EXPECT_TRUE(time_to(c, 20)->at_most);
  EXPECT_EQ(time_to(c, 20)->time, 1);
  EXPECT_FALSE(time_to(c, 16)->at_most) << "exactly there at the first point";
  EXPECT_NEAR(time_to({{1, 4, 1}, {4, 0, 4}}, 2)->time, 2, 1e-12) << "inverse of error_at";
  EXPECT_FALSE(time_to({}, 1));
}

TEST(TimeRatio, ComparesTimesToTheErrorThatBothReach) {
  EXPECT_NEAR(time_ratio(curve(1, 16), curve(4, 16))->value, 4, 1e-12);
  EXPECT_NEAR(time_ratio(curve(4, 16), curve(1, 16))->value, 0.25, 1e-12);
  EXPECT_NEAR(time_ratio(curve(1, 16, 0.5), curve(2, 16, 0.5))->value, 4, 1e-12);
  EXPECT_FALSE(time_ratio(curve(1, 16), curve(4, 16))->bound);
  const auto bound = time_ratio(curve(1, 16), curve(1000, 16));
  EXPECT_TRUE(bound->bound);
  EXPECT_NEAR(bound->value, 16, 1e-12) << "there at the first point, after 1 s at most; the baseline after 16 s";
  EXPECT_FALSE(time_ratio({}, curve(1, 4)));
  const Curve quick = {{1, 16, 1}, {2, 1, 2}}, late = {{8, 0.5, 8}, {16, 1, 16}};
  EXPECT_FALSE(time_ratio(quick, late)) << "the other may have been there sooner than its first point";
  EXPECT_FALSE(time_ratio(late, quick));
}

TEST(Verdict, NeedsTheWholeSpreadOnOneSide) {
  EXPECT_EQ(verdict({1.1, 1.2, 1.15}), "win");
  EXPECT_EQ(verdict({0.8, 0.9, 0.85}), "loss");
  EXPECT_EQ(verdict({0.99, 1.2, 1.2}), "tie");
  EXPECT_EQ(verdict({1, 1, 1}), "tie");
  EXPECT_EQ(verdict({0.999, 1.3, 1.3, 1.3, 1.3, 1.3}), "win") << "quartiles of six";
  EXPECT_EQ(verdict({5}), "tie") << "one seed shows nothing";
  EXPECT_EQ(verdict({}), "tie");
  EXPECT_EQ(verdict({std::numeric_limits<double>::infinity(), 3}), "win") << "an error of zero";
}

TEST(Verdict, NeedsMoreThanChance) {
  // Logarithms 1 and 3 about their mean 2 with deviation 1: t = 2; tan gives the tail for one degree of freedom, 14.8 %
  // on either side. Narrower, 1.9 and 2.1: t = 20, 1.6 %.
  EXPECT_EQ(verdict({std::exp(1), std::exp(3)}), "tie");
  EXPECT_EQ(verdict({std::exp(1.9), std::exp(2.1)}), "win");
  EXPECT_EQ(verdict({std::exp(-1.9), std::exp(-2.1)}), "loss");
  EXPECT_EQ(verdict({0.5, 1.2, 1.3, 1.4, 1.5}), "tie") << "quartiles above 1, but t = 0.49";
}

}  // namespace
}  // namespace ajar
