#include "ajar/join/photons.h"

#include <bit>
#include <utility>

#include "ajar/core/error.h"
#include "ajar/core/parallel.h"
#include "ajar/join/connect.h"

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
struct Sorting {
  const std::vector<const Photons*>& lists;
  std::vector<size_t> first;  // photon of each list, among all
  uint32_t ranges = 1;
  int shift = 0;                    // a range has 2^shift buckets
  std::vector<uint32_t> of_photon;  // its bucket
  std::vector<uint32_t> places;     // by range, then list: how many photons there are, then where the next one goes
  std::vector<uint32_t> starts;     // of ranges, and the end of the last one
  std::vector<Ref> refs;            // all photons, range by range

  uint32_t& place(uint32_t bucket, size_t list) { return places[(bucket >> shift) * lists.size() + list]; }
};

void find_buckets(const PhotonMap& map, Sorting& s) {
  s.places.assign(s.lists.size() * s.ranges, 0);
  parallel_for(s.lists.size(), [&](size_t l) {
    for (size_t i = 0; i < s.lists[l]->size(); ++i) {
      const Vec3& p = (*s.lists[l])[i].p;
      const int level = level_of(merge_radius(map.merging, p));
      const uint32_t bucket = bucket_of(map, level, cell_of(p, level));
      s.of_photon[s.first[l] + i] = bucket;
      ++s.place(bucket, l);
    }
  });
}

void find_places(Sorting& s) {
  uint32_t sum = 0;
  for (size_t i = 0; i < s.places.size(); ++i) {
    if (i % s.lists.size() == 0) s.starts.push_back(sum);
    sum += std::exchange(s.places[i], sum);
  }
  s.starts.resize(s.ranges + 1, sum);
}

void deal(Sorting& s) {
  parallel_for(s.lists.size(), [&](size_t l) {
    for (size_t i = 0; i < s.lists[l]->size(); ++i) {
      const uint32_t bucket = s.of_photon[s.first[l] + i];
      s.refs[s.place(bucket, l)++] = {bucket, &(*s.lists[l])[i]};
    }
  });
}

void sort_range(const Sorting& s, uint32_t range, PhotonMap& map) {
  const uint32_t first = range << s.shift, from = s.starts[range], to = s.starts[range + 1];
  std::vector<uint32_t> next(size_t(1) << s.shift, 0);  // of each bucket
  for (uint32_t i = from; i < to; ++i) ++next[s.refs[i].bucket - first];
  uint32_t at = from;
  for (size_t b = 0; b < next.size(); ++b) {
    map.begin[first + b] = at;
    at += std::exchange(next[b], at);
  }
  for (uint32_t i = from; i < to; ++i) map.photons[next[s.refs[i].bucket - first]++] = *s.refs[i].photon;
}

}  // namespace

void add_photons(Photons& photons, const Subpath& light, Heuristic h, const SampleCounts& counts) {
  bool straight = true;
  for (int s = 2; s <= light.n; ++s) {
    const Vertex& v = light[s - 1];
    straight = straight && (s == 2 || light[s - 2].delta);
    // Where the normals disagree nothing scatters, but light arrives there all the same, and is merged beside it.
    if (!v.guide.bsdf.has_smooth || is_black(v.beta) || !(v.merge > 0)) continue;
    const MergeSide side = merge_side(h, end_at(light.first(s), 0, 0), v.back, light.nee_ratio, counts);
    Photon& p = photons.emplace_back();
    p.p = v.p, p.s = s;
    p.wi = v.guide.wo, p.beta = v.beta;
    p.fixed = float(std::min(side.fixed, 1e37)), p.slope = float(std::min(side.slope, 1e37));
    p.n = facing(v.ng, v.guide.wo);
    p.straight = straight;
  }
}

void fill(PhotonMap& map, const Merging& merging, const std::vector<const Photons*>& lists) {
  Sorting sorting{lists};
  size_t all = 0;
  for (const Photons* list : lists) sorting.first.push_back(all), all += list->size();
  if (all >= 1u << 31) throw Error("too many light vertices to merge at once: use a smaller --max-depth");
  const uint32_t buckets = std::bit_ceil(uint32_t(std::max<size_t>(all, 2)));
  sorting.ranges = std::min(buckets, most_ranges), sorting.shift = std::countr_zero(buckets / sorting.ranges);
  sorting.of_photon.resize(all), sorting.refs.resize(all);
  map.merging = merging;
  map.begin.assign(buckets + 1, uint32_t(all));
  map.photons.resize(all);
  find_buckets(map, sorting);
  find_places(sorting);
  deal(sorting);
  parallel_for(sorting.ranges, [&](uint32_t range) { sort_range(sorting, range, map); });
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
