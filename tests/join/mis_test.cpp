// mis_weight and the prefix sums of walks against the oracle, on densities of no scene at all.
#include "ajar/join/mis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "ajar/core/sampler.h"
#include "kit/oracle.h"

namespace ajar {
namespace {

using kit::OraclePath;
using kit::OracleVertex;

// One side's view of a path: a_0 is its own end; what a walk of all its vertices would store.
struct SideView {
  std::vector<double> own, other;
  std::vector<bool> delta, seen;
  std::vector<double> merge;
  std::vector<double> sums;  // S_i
};

SideView view(const OraclePath& path, Side side, Heuristic h) {
  const size_t n = path.vertices.size();
  SideView v;
  bool straight = true;  // deltas alone between the lens and the vertex
  for (size_t i = 0; i < n; ++i) {
    const OracleVertex& x = path.vertices[side == Side::light ? i : n - 1 - i];
    const bool lens = side == Side::camera ? i == 0 : i == n - 1;
    const double light = double(x.light), camera = lens ? 1.0 : double(x.camera);
    v.own.push_back(side == Side::light ? light : camera);
    v.other.push_back(side == Side::light ? camera : light);
    v.delta.push_back(x.delta);
    straight = straight && (i < 2 || path.vertices[n - i].delta);
    v.seen.push_back(side == Side::camera && i > 0 && straight);
    const bool inside = i > 0 && i < n - 1;
    v.merge.push_back(inside ? double(x.merge * (side == Side::light || straight ? 1 : path.merge_inner)) : 0);
  }
  const bool light = side == Side::light;
  const double first = light ? double(path.nee / path.vertices[0].light) : double(path.light_paths);
  v.sums.push_back(light && path.hittable ? 1 : 0);
  for (size_t i = 1; i < n; ++i) {
    const double join = double(v.seen[i - 1] ? path.seen : path.inner);
    double share = v.delta[i] || v.delta[i - 1] ? 0 : raise(h, i == 1 ? first : join);
    if (!v.delta[i]) share += merge_at(h, v.own[i], v.merge[i] * (light ? double(path.merge_inner) : 1));
    v.sums.push_back(extend(share, raise(h, ratio(v.other[i - 1], v.own[i - 1])), v.sums[i - 1]));
  }
  return v;
}

End end_of(const SideView& v, int n) {
  if (n == 0) return {};
  const auto i = size_t(n - 1);
  if (n == 1) return {1, v.own[0], v.other[0], 1, 0, false, v.sums[0]};
  return {n,          v.own[i],  v.other[i],   v.own[i - 1], v.other[i - 1], v.delta[i - 1], v.sums[i - 1],
          v.merge[i], v.seen[i], v.seen[i - 1]};
}

// Weights of all strategies by the fast way, 0 for those that cannot make the path.
std::vector<double> fast_weights(const OraclePath& path, Heuristic h) {
  const int n = int(path.vertices.size());
  const SideView light = view(path, Side::light, h), camera = view(path, Side::camera, h);
  const auto possible = kit::densities(path);
  const NextEvent nee{double(path.nee / path.vertices[0].light), double(path.next_events)};
  const SampleCounts counts{double(path.light_paths), double(path.inner), double(path.seen), double(path.first_seen),
                            double(path.merge_inner)};
  std::vector<double> out(2 * size_t(n), 0.0);
  for (int s = 0; s < n; ++s)
    if (possible[size_t(s)] > 0) out[size_t(s)] = mis_weight(h, end_of(light, s), end_of(camera, n - s), nee, counts);
  for (int j = 1; j < n - 1; ++j) {
    if (!(possible[size_t(n + j)] > 0)) continue;
    // The densities of the vertices before come last, once both directions at the merge are known.
    End l = end_of(light, j + 1), c = end_of(camera, n - j);
    MergeSide a = merge_side(h, l, 1, nee.ratio, counts);
    const MergeSide b = merge_side(h, c, 1, counts.light_paths, counts);
    if (c.seen) a.fixed *= seen_factor(h, counts, l.n);
    out[size_t(n + j)] = merge_weight(h, c.merge, a, l.other_before, b, c.other_before);
  }
  return out;
}

struct Maker {
  std::mt19937_64 random;
  double decades;  // densities within 10^+-decades

  double uniform() { return std::uniform_real_distribution<double>(0, 1)(random); }
  double density() { return std::pow(10.0, decades * (2 * uniform() - 1)); }

  // A path of n vertices; deltas come singly and in chains, never at the ends.
  OraclePath path(int n, double delta_share) {
    OraclePath p;
    for (int i = 0; i < n; ++i)
      p.vertices.push_back({density(), density(), i > 0 && i < n - 1 && uniform() < delta_share});
    p.hittable = uniform() < 0.7;
    p.nee = p.hittable ? static_cast<long double>(density()) : p.vertices[0].light;
    p.light_paths = uniform() < 0.5 ? 1 : std::floor(1 + 1e6 * uniform());
    p.inner = uniform() < 0.5 ? 1 : 2 * uniform();
    p.seen = uniform() < 0.5 ? p.inner : static_cast<long double>(20 * uniform());
    p.merge_inner = uniform() < 0.3 ? 0 : uniform();
    p.first_seen = uniform() < 0.5 ? 1 : 4 * uniform();
    p.next_events = uniform() < 0.5 ? 1 : std::floor(1 + 16 * uniform());
    if (uniform() < 0.5)
      for (OracleVertex& x : p.vertices) x.merge = density();
    return p;
  }
};

// Compares every strategy and the sum; returns how many strategies could make the path.
int expect_oracle(const OraclePath& path, Heuristic h, double tolerance) {
  const auto fast = fast_weights(path, h);
  const auto slow = kit::weights(path, h == Heuristic::power ? 2 : 1);
  const auto possible = int(std::count_if(slow.begin(), slow.end(), [](long double w) { return w > 0; }));
  for (size_t s = 0; s < fast.size(); ++s)
    EXPECT_NEAR(fast[s], double(slow[s]), tolerance * double(slow[s]) + 1e-300)
        << "s = " << s << " of " << path.vertices.size() << " vertices, merges after them";
  if (possible > 0) {
    EXPECT_NEAR(std::accumulate(fast.begin(), fast.end(), 0.0), 1, 1e-9);
  }
  return possible;
}

void many_paths(double decades, double delta_share, int most_vertices) {
  Maker make{std::mt19937_64(uint64_t(decades * 100 + delta_share * 10) + 1), decades};
  int strategies = 0;
  for (int n = 2; n <= most_vertices; ++n)
    for (int i = 0; i < 100 && !testing::Test::HasFailure(); ++i) {
      const OraclePath path = make.path(n, delta_share);
      for (const Heuristic h : {Heuristic::balance, Heuristic::power}) strategies += expect_oracle(path, h, 1e-9);
    }
  EXPECT_GT(strategies, 100 * most_vertices);
}

TEST(Mis, AgreesWithTheOracle) { many_paths(1, 0, 21); }
TEST(Mis, AgreesWithTheOracleAcrossDeltas) { many_paths(1, 0.3, 21); }
TEST(Mis, AgreesWithTheOracleInDeltaChains) { many_paths(1, 0.8, 21); }
TEST(Mis, AgreesWithTheOracleForDensitiesFarApart) { many_paths(6, 0.3, 21); }
// Ratios up to 1e60, raised to 1e120: short paths, so that the products stay within double.
TEST(Mis, AgreesWithTheOracleForExtremeDensities) { many_paths(30, 0.3, 4); }

// What no double holds must still give weights between 0 and 1, never NaN.
TEST(Mis, StaysANumberBeyondTheRangeOfDouble) {
  Maker make{std::mt19937_64(7), 60};
  for (int i = 0; i < 2000; ++i) {
    const OraclePath path = make.path(3 + i % 30, 0.3);
    for (const Heuristic h : {Heuristic::balance, Heuristic::power})
      for (const double w : fast_weights(path, h)) ASSERT_TRUE(w >= 0 && w <= 1) << w;
  }
}

TEST(Mis, StaysANumberForZeroAndInfiniteDensities) {
  const double values[] = {0, 1e-320, 1e-200, 1, 1e200, double(infinity)};
  for (const double own : values)
    for (const double other : values)
      for (const double sum : values)
        for (const Heuristic h : {Heuristic::balance, Heuristic::power}) {
          const double extended = extend(1, raise(h, ratio(other, own)), sum);
          ASSERT_TRUE(extended >= 0) << own << ' ' << other << ' ' << sum;
          const End end{3, own, other, own, other, false, sum};
          const double w = mis_weight(h, end, end, {}, {});
          ASSERT_TRUE(w >= 0 && w <= 1) << own << ' ' << other << ' ' << sum;
        }
}

// Zero times infinity is nothing, not the largest ratio there is.
TEST(Mis, RatiosAreNumbers) {
  const double inf = INFINITY;
  EXPECT_EQ(ratio(inf * 0, 1), 0);
  EXPECT_EQ(ratio(inf, inf), 0);
  EXPECT_EQ(ratio(inf, 1), largest_ratio);
  EXPECT_EQ(ratio(1, 0), 0);
  EXPECT_EQ(ratio(3, 2), 1.5);
}

TEST(Mis, PointLightSeenByOneStrategyHasAllTheWeight) {
  // Point light, mirror, diffuse wall, lens: neither hitting the light nor next-event estimation can make it, and the
  // wall is joined to the lens or, from a longer camera path, to nothing else.
  OraclePath path{{{1, 1, false}, {2, 3, true}, {5, 7, false}, {1, 1, false}}, false, 1, 1000};
  const auto w = fast_weights(path, Heuristic::power);
  EXPECT_EQ(w[0], 0);
  EXPECT_EQ(w[1], 0);
  EXPECT_EQ(w[2], 0);
  EXPECT_EQ(w[3], 1);
}

TEST(Mis, MoreLightPathsGiveTheSplatMoreWeight) {
  OraclePath path{{{1, 1, false}, {1, 1, false}, {1, 1, false}}, true, 1, 1};
  double before = 0;
  for (const double n : {1.0, 10.0, 100.0}) {
    path.light_paths = n;
    const auto w = fast_weights(path, Heuristic::balance);  // densities 1 (hit), 1 (next event), n (splat)
    EXPECT_NEAR(w[2], n / (n + 2), 1e-12);
    EXPECT_GT(w[2], before);
    before = w[2];
  }
}

}  // namespace
}  // namespace ajar
