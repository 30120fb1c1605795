// Random numbers: stratified as Sobol's sequence promises, independent between pairs, the same bytes for ever.
#include "ajar/core/sampler.h"

#include <gtest/gtest.h>

#include <vector>

#include "kit/chisquare.h"

namespace ajar {
namespace {

Sampler at(uint64_t path, uint32_t pass, uint32_t pair, SamplerKind kind = SamplerKind::sobol) {
  Sampler s = make_sampler(kind, 11, Side::camera, path, pass);
  s.pair = pair;
  return s;
}

// Each elementary interval of area 2^-m holds exactly one of 2^m consecutive points (Niederreiter: a (0,m,2)-net).
bool is_net(const std::vector<Vec2>& points) {
  const int m = std::countr_zero(points.size());
  for (int a = 0; a <= m; ++a) {
    std::vector<int> count(points.size());
    for (const Vec2& p : points) {
      const size_t x = size_t(p.x * float(1 << a)), y = size_t(p.y * float(1 << (m - a)));
      if (++count[(y << a) + x] > 1) return false;
    }
  }
  return true;
}

TEST(Sampler, EveryPairIsANet) {
  for (uint32_t pair = 0; pair < 8; ++pair)
    for (int m = 0; m <= 10; ++m) {
      std::vector<Vec2> first, second;
      for (uint32_t i = 0; i < 1u << m; ++i) {  // each half of the passes has a sequence of its own
        first.push_back(at(pair * 3, 2 * i + pair % 2, pair).next2());
        second.push_back(at(pair * 3, 2 * (i + (5u << m)), pair).next2());  // any aligned block, not only the first
      }
      EXPECT_TRUE(is_net(first)) << "pair " << pair << ", 2^" << m << " points";
      EXPECT_TRUE(is_net(second)) << "pair " << pair << ", 2^" << m << " points, later";
    }
}

TEST(Sampler, EveryPathSeedAndSideHasItsOwnNumbers) {
  std::vector<Vec2> seen;
  for (uint64_t seed = 0; seed < 3; ++seed)
    for (const Side side : {Side::camera, Side::light})
      for (uint64_t path = 0; path < 50; ++path)
        for (const SamplerKind kind : {SamplerKind::sobol, SamplerKind::independent})
          seen.push_back(make_sampler(kind, seed, side, path, 0).next2());
  std::sort(seen.begin(), seen.end(), [](const Vec2& a, const Vec2& b) { return a.x < b.x; });
  for (size_t i = 1; i < seen.size(); ++i) EXPECT_NE(seen[i - 1], seen[i]);
}

// Over paths at a fixed pass and pair, numbers are uniform and independent: across dimensions of one pair, across
// pairs, and across passes.
void expect_uniform(const std::function<Vec2(uint32_t)>& point, const char* what) {
  kit::ChiOptions o;
  o.rows = o.columns = 16;
  o.samples = 50'000;
  uint32_t i = 0;
  const auto r = kit::chi_square_square([&](const Vec2&) { return std::optional<Vec2>(point(i++)); },
                                        [](const Vec2&) { return 1.0; }, o);
  EXPECT_TRUE(r.ok) << what << ": " << r.message;
}

TEST(Sampler, IsUniformAndIndependent) {
  for (const SamplerKind kind : {SamplerKind::sobol, SamplerKind::independent})
    for (const uint32_t pass : {0u, 1u, 2u, 77u, 4096u}) {
      expect_uniform([=](uint32_t i) { return at(i, pass, 2, kind).next2(); }, "one pair");
      expect_uniform([=](uint32_t i) { return Vec2(at(i, pass, 2, kind).next1(), at(i, pass, 3, kind).next1()); },
                     "x of two pairs");
      expect_uniform([=](uint32_t i) { return Vec2(at(i, pass, 0, kind).next2().y, at(i, pass, 1, kind).next2().x); },
                     "y and x of two pairs");
      expect_uniform(
          [=](uint32_t i) { return Vec2(at(2 * i, pass, 1, kind).next1(), at(2 * i + 1, pass, 1, kind).next1()); },
          "neighbouring paths");
    }
  // The two halves, at the same place of their sequences and at the next.
  for (const uint32_t pass : {0u, 1u, 76u, 77u, 4095u})
    expect_uniform([=](uint32_t i) { return Vec2(at(i, pass, 2).next1(), at(i, pass + 1, 2).next1()); }, "halves");
  // Along passes two pairs of one path must not march in step either.
  expect_uniform([](uint32_t i) { return Vec2(at(5, i, 0).next1(), at(5, i, 1).next1()); }, "pairs along passes");
  expect_uniform([](uint32_t i) { return Vec2(at(5, i, 3).next2().y, at(5, i, 9).next2().y); }, "pairs along passes");
}

TEST(Sampler, NumbersStayBelowOne) {
  EXPECT_EQ(to_unit(0), 0);
  EXPECT_EQ(to_unit(~0u), one_minus_epsilon);
  EXPECT_LT(to_unit(0xffffff80u), 1);
}

// What is rendered from a seed must not change from version to version without notice.
TEST(Sampler, BytesAreGolden) {
  const auto bits = [](const Vec2& v) { return (uint64_t(v.x * 0x1p32f) << 32) | uint64_t(v.y * 0x1p32f); };
  Sampler s = make_sampler(SamplerKind::sobol, 1, Side::light, 42, 7);
  EXPECT_EQ(bits(s.next2()), 0x156b3680b8516900u);
  EXPECT_EQ(bits(s.next2()), 0xc4fda90020b702c0u);
  Sampler i = make_sampler(SamplerKind::independent, 1, Side::light, 42, 7);
  EXPECT_EQ(bits(i.next2()), 0xe243d1004a134900u);
  EXPECT_EQ(hash(1, 2), 0xe06dd043328bd285u);
}

// Sobol numbers come by the block: which are asked for, in which order, and what was asked before changes none.
TEST(Sampler, NumbersDoNotDependOnWhatElseIsAskedFor) {
  const auto alone = [](uint64_t path, uint32_t number) {
    return make_sampler(SamplerKind::sobol, 3, Side::light, path, 5).at(number);
  };
  Sampler in_turn = make_sampler(SamplerKind::sobol, 3, Side::light, 8, 5);
  for (uint32_t i = 1; i <= 5 * PairBlock::size; ++i) ASSERT_EQ(in_turn.next2(), alone(8, i)) << i;
  Sampler leaping = make_sampler(SamplerKind::sobol, 3, Side::light, 8, 5);
  for (const uint32_t i : {40u, 39u, 54u, 55u, 1u, 17u, 16u, 0x7fffffffu, 2u})
    ASSERT_EQ(leaping.at(i), alone(8, i)) << i;
  leaping.start(make_stream(SamplerKind::sobol, 3, Side::light, 9, 5), 1);
  EXPECT_EQ(leaping.next2(), alone(9, 2)) << "numbers of the stream before";
}

struct Integrand {
  double (*f)(const Vec2& a, const Vec2& b);
  double exact;
};
const double e1 = 1 - std::exp(-1.0);
// Smooth in the two dimensions of one pair; in four, with products across the pairs.
const Integrand in_two{[](const Vec2& a, const Vec2&) { return std::exp(-double(a.x + a.y)); }, e1* e1};
const Integrand in_four{
    [](const Vec2& a, const Vec2& b) { return std::exp(-double(a.x + a.y)) * (1 + double(b.x) * b.y) + b.x; },
    e1* e1 * 1.25 + 0.5};

// Root mean square error of the mean over n points, over many paths.
double error_of(const Integrand& integrand, SamplerKind kind, uint32_t n) {
  double sum = 0;
  constexpr int paths = 64;
  for (uint64_t path = 0; path < paths; ++path) {
    double mean = 0;
    for (uint32_t i = 0; i < n; ++i) {
      Sampler s = make_sampler(kind, 5, Side::camera, path, i);
      const Vec2 a = s.next2();
      mean += integrand.f(a, s.next2()) / n;
    }
    sum += (mean - integrand.exact) * (mean - integrand.exact) / paths;
  }
  return std::sqrt(sum);
}

TEST(Sampler, SobolBeatsIndependentNumbers) {
  // Sixteen times the points: independent numbers are 4 times better, a scrambled net about 16^1.5 = 64 times.
  const double drawn = error_of(in_two, SamplerKind::independent, 1024);
  const double few = error_of(in_two, SamplerKind::sobol, 64), many = error_of(in_two, SamplerKind::sobol, 1024);
  EXPECT_NEAR(error_of(in_two, SamplerKind::independent, 64) / drawn, 4, 1.5);
  EXPECT_GT(few / many, 30);
  EXPECT_GT(drawn / many, 100);
  // Products across pairs converge no faster than drawn points; everything else does.
  EXPECT_GT(error_of(in_four, SamplerKind::independent, 1024), 4 * error_of(in_four, SamplerKind::sobol, 1024));
}

}  // namespace
}  // namespace ajar
