#include "ajar/join/photons.h"

#include <bit>

#include "ajar/core/error.h"
#include "ajar/core/parallel.h"

namespace ajar {
namespace {

// A cell edge is 2^level; floats that are too small for a level of their own share the least.
constexpr int least_level = -60;
int level_of(float radius) {
  int level;
  std::frexp(std::max(2 * radius, std::ldexp(1.0f, least_level)), &level);
  return level;
}

uint32_t bucket_of(const PhotonMap& map, int level, const glm::ivec3& cell) {
  const uint64_t h =
      hash(uint64_t(uint32_t(cell.x)) << 32 | uint32_t(cell.y), uint64_t(uint32_t(cell.z)) << 32 | uint32_t(level));
  return uint32_t(h) & uint32_t(map.begin.size() - 2);
}

glm::ivec3 cell_of(const Vec3& p, int level) {
  const Vec3 at = glm::floor(p * std::ldexp(1.0f, -level));
  return glm::ivec3(glm::clamp(at, Vec3(-0x1p30f), Vec3(0x1p30f)));
}

void add_once(Buckets& near, uint32_t bucket) {
  for (int i = 0; i < near.n; ++i)
    if (near.of[size_t(i)] == bucket) return;
  near.of[size_t(near.n++)] = bucket;
}

// A photon's bucket, and where it stands in the lists.
struct Ref {
  uint32_t bucket = 0;
  const Photon* photon = nullptr;
};

// Photons are sorted in two steps, both parallel and both keeping order: into ranges of buckets, list by list, then
// within each range.
constexpr uint32_t most_ranges = 64;

}  // namespace

void add_photons(Photons& photons, const Subpath& light, Heuristic h, double inner, double share) {
  bool straight = true;
  for (int s = 2; s <= light.n; ++s) {
    const Vertex& v = light[s - 1];
    straight = straight && (s == 2 || light[s - 2].delta);
    // Where the normals disagree nothing scatters, but light arrives there all the same, and is merged beside it.
    if (!v.guide.bsdf.has_smooth || is_black(v.beta) || !(v.merge > 0)) continue;
    const Vertex& before = light[s - 2];
    Shares shares;
    shares.light_first = share, shares.inner = inner;
    const MergeSide side =
        merge_side(h, {s, v.own, 0, before.own, 0, before.delta, v.sum, v.merge}, v.back, shares, Side::light);
    Photon& p = photons.emplace_back();
    p.p = v.p, p.s = s;
    p.wi = v.guide.wo, p.beta = v.beta;
    p.fixed = float(std::min(side.fixed, 1e37)), p.slope = float(std::min(side.slope, 1e37));
    p.n = glm::dot(v.ng, v.guide.wo) < 0 ? -v.ng : v.ng;
    p.straight = straight;
  }
}

void fill(PhotonMap& map, const Merging& merging, const std::vector<const Photons*>& lists) {
  map.merging = merging;
  size_t all = 0;
  std::vector<size_t> first;
  for (const Photons* list : lists) first.push_back(all), all += list->size();
  if (all >= 1u << 31) throw Error("too many light vertices to merge at once: use a smaller --max-depth");
  const uint32_t buckets = std::bit_ceil(uint32_t(std::max<size_t>(all, 2))), ranges = std::min(buckets, most_ranges);
  map.begin.assign(buckets + 1, 0);
  const int shift = std::countr_zero(buckets / ranges);
  std::vector<uint32_t> of_photon(all);
  std::vector<uint32_t> counts(lists.size() * ranges, 0);
  parallel_for(lists.size(), [&](size_t l) {
    for (size_t i = 0; i < lists[l]->size(); ++i) {
      const Vec3& p = (*lists[l])[i].p;
      const int level = level_of(merge_radius(merging, p));
      const uint32_t bucket = bucket_of(map, level, cell_of(p, level));
      of_photon[first[l] + i] = bucket;
      ++counts[(bucket >> shift) * lists.size() + l];
    }
  });
  std::vector<uint32_t> starts(ranges + 1, 0);
  uint32_t sum = 0;
  for (uint32_t r = 0; r < ranges; ++r) {
    starts[r] = sum;
    for (size_t l = 0; l < lists.size(); ++l) {
      uint32_t& c = counts[r * lists.size() + l];
      const uint32_t n = c;
      c = sum, sum += n;
    }
  }
  starts[ranges] = sum;
  std::vector<Ref> refs(all);
  parallel_for(lists.size(), [&](size_t l) {
    for (size_t i = 0; i < lists[l]->size(); ++i) {
      const uint32_t bucket = of_photon[first[l] + i];
      refs[counts[(bucket >> shift) * lists.size() + l]++] = {bucket, &(*lists[l])[i]};
    }
  });
  map.photons.resize(all);
  parallel_for(ranges, [&](uint32_t r) {
    uint32_t* begin = map.begin.data() + (size_t(r) << shift);
    const uint32_t n = buckets / ranges, from = r << shift;
    std::vector<uint32_t> next(n, 0);
    for (uint32_t i = starts[r]; i < starts[r + 1]; ++i) ++next[refs[i].bucket - from];
    uint32_t at = starts[r];
    for (uint32_t b = 0; b < n; ++b) {
      begin[b] = at;
      at += next[b];
      next[b] = begin[b];
    }
    for (uint32_t i = starts[r]; i < starts[r + 1]; ++i) map.photons[next[refs[i].bucket - from]++] = *refs[i].photon;
  });
  map.begin[buckets] = uint32_t(all);
}

Buckets buckets_near(const PhotonMap& map, const Vec3& p, float radius) {
  Buckets near;
  // No photon within reach has a radius that differs by more: distances from the eye do not.
  const float change = map.merging.per_distance * radius * 1.001f;
  const int low = level_of(std::max(radius - change, map.merging.least)), high = level_of(radius + change);
  for (int level = low; level <= high; ++level) {
    const glm::ivec3 from = cell_of(p - radius, level), to = cell_of(p + radius, level);
    for (int z = from.z; z <= to.z; ++z)
      for (int y = from.y; y <= to.y; ++y)
        for (int x = from.x; x <= to.x; ++x) add_once(near, bucket_of(map, level, {x, y, z}));
  }
  return near;
}

}  // namespace ajar
