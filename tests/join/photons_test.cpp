// The grid of light vertices against looking at all of them.
#include "ajar/join/photons.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <random>
#include <tuple>

namespace ajar {
namespace {

constexpr Merging widening = {100, {0.2f, -0.1f, 0.3f}, 0.1f, 1e-3f, 0.5f};

// Points around the eye, as dense near it as far from it, and on the other side of the origin too.
Photons scatter_photons(int n, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> decades(-3, 1);
  Photons out{size_t(n)};
  for (Photon& p : out) {
    const Vec3 d(normal(random), normal(random), normal(random));
    p.p = widening.eye + d * std::pow(10.0f, decades(random));
  }
  return out;
}

std::vector<Vec3> found(const PhotonMap& map, const Vec3& p, float radius) {
  std::vector<Vec3> out;
  for_each_near(map, p, radius, [&](const Photon& photon) { out.push_back(photon.p); });
  return out;
}

// Lists cut unevenly, some of them empty.
PhotonMap map_of(const Photons& photons, const Merging& merging) {
  std::vector<Photons> lists(7);
  for (size_t i = 0; i < photons.size(); ++i) lists[i * i % 5].push_back(photons[i]);
  std::vector<const Photons*> pointers;
  for (const Photons& l : lists) pointers.push_back(&l);
  PhotonMap map;
  fill(map, merging, pointers);
  return map;
}

void expect_all(int n, const Merging& merging) {
  const Photons photons = scatter_photons(n, uint64_t(n) + 1);
  const PhotonMap map = map_of(photons, merging);
  ASSERT_EQ(map.photons.size(), photons.size());
  const auto less = [](const Vec3& a, const Vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
  size_t all = 0;
  for (const Photon& at : scatter_photons(300, 99)) {
    const float radius = merge_radius(merging, at.p);
    std::vector<Vec3> near = found(map, at.p, radius), right;
    for (const Photon& p : photons)
      if (length2(p.p - at.p) < sqr(radius)) right.push_back(p.p);
    std::sort(near.begin(), near.end(), less), std::sort(right.begin(), right.end(), less);
    ASSERT_EQ(near, right);
    all += right.size();
  }
  if (n >= 1000) {
    EXPECT_GT(all, 100u) << "hardly any were there to be found";
  }
}

TEST(Photons, NoneAreFoundAmongNone) { expect_all(0, widening); }
TEST(Photons, One) { expect_all(1, widening); }
TEST(Photons, Two) { expect_all(2, widening); }
TEST(Photons, Many) { expect_all(20000, widening); }
TEST(Photons, ManyWhereTheRadiusIsSteep) { expect_all(20000, {100, widening.eye, steepest_radius, 1e-4f, 2}); }
TEST(Photons, ManyWithinOneRadius) { expect_all(3000, {100, Vec3(0), 0, 0.3f, 0.3f}); }

TEST(Photons, AtOnePlaceAllAreFound) {
  Photons photons(1000);
  for (Photon& p : photons) p.p = Vec3(0.25f);
  EXPECT_EQ(found(map_of(photons, widening), Vec3(0.25f), merge_radius(widening, Vec3(0.25f))).size(), 1000u);
}

TEST(Photons, ForgetsThoseBefore) {
  PhotonMap map = map_of(scatter_photons(100, 1), widening);
  const Photons none;
  fill(map, widening, {&none});
  EXPECT_TRUE(map.photons.empty());
  EXPECT_TRUE(found(map, Vec3(0), 10).empty());
}

#ifndef AJAR_SANITIZED
size_t peak_of_memory() {
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  return size_t(use.ru_maxrss) << 10;
}

// Ten million: as many as were put in come out, a box of them whole, and sorting takes what docs/method.md says.
TEST(Photons, TenMillion) {
  constexpr size_t all = 10'000'000, lists = 250;
  std::vector<Photons> cut(lists, Photons(all / lists));
  uint64_t random = 1;
  const auto next = [&] { return float(double((random = hash(random, 7)) >> 11) * 0x1p-53); };
  for (Photons& list : cut)
    for (Photon& p : list) p.p = {next(), next(), next()};
  std::vector<const Photons*> pointers;
  for (const Photons& l : cut) pointers.push_back(&l);
  const size_t before = peak_of_memory();
  PhotonMap map;
  fill(map, {100, Vec3(0), 0, 0.01f, 0.01f}, pointers);
  EXPECT_LT(peak_of_memory() - before, all * (sizeof(Photon) + 24) * 21 / 20 + (64 << 20));
  ASSERT_EQ(map.photons.size(), all);
  for (const Vec3& at : {Vec3(0.5f), Vec3(0.3f, 0.9f, 0.1f), Vec3(0, 0, 1)}) {
    size_t right = 0;
    for (const Photons& l : cut)
      for (const Photon& p : l) right += length2(p.p - at) < sqr(0.01f);
    EXPECT_EQ(found(map, at, 0.01f).size(), right);
    EXPECT_GT(right, 0u);
  }
}
#endif

TEST(Photons, RadiusZeroFindsNone) {
  const Merging still = {100, Vec3(0), 0, 0, 0};
  EXPECT_TRUE(found(map_of(scatter_photons(100, 1), still), Vec3(0), 0).empty());
}

}  // namespace
}  // namespace ajar
