#include "ajar/field/views.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>

namespace ajar {
namespace {

// However often a join was blocked, it is tried now and then.
constexpr float least_chance = 0.05f;

void count(uint32_t& n) { std::atomic_ref<uint32_t>(n).fetch_add(1, std::memory_order_relaxed); }

}  // namespace

ViewTallies start_tallies(const Views& views) {
  return {std::vector<uint32_t>(2 * size_t(views.regions) * views.regions)};
}

void record_join(const Views& views, ViewTallies& tallies, uint32_t a, uint32_t b, bool free) {
  if (a >= views.regions || b >= views.regions) return;
  const size_t at = 2 * (size_t(std::min(a, b)) * views.regions + std::max(a, b));
  count(tallies.counts[at]);
  if (free) count(tallies.counts[at + 1]);
}

Views learn_views(const Views& views, const ViewTallies& tallies, uint32_t regions, float kept) {
  Views next;
  next.regions = std::min(regions, most_regions);
  const size_t size = size_t(next.regions) * next.regions;
  next.tried.resize(size), next.seen.resize(size), next.chance.assign(size, 1);
  for (uint32_t a = 0; a < views.regions; ++a)
    for (uint32_t b = a; b < views.regions; ++b) {
      const size_t old = size_t(a) * views.regions + b, at = size_t(a) * next.regions + b,
                   mirrored = size_t(b) * next.regions + a;
      const float tried = kept * views.tried[old] + float(tallies.counts[2 * old]);
      const float seen = kept * views.seen[old] + float(tallies.counts[2 * old + 1]);
      next.tried[at] = next.tried[mirrored] = tried;
      next.seen[at] = next.seen[mirrored] = seen;
      next.chance[at] = next.chance[mirrored] = std::max(std::sqrt((seen + 1) / (tried + 1)), least_chance);
    }
  return next;
}

}  // namespace ajar
