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

ViewTallies start_tallies(const Views& views) { return {std::vector<uint32_t>(2 * pair_count(views.regions))}; }

void record_join(const Views& views, ViewTallies& tallies, uint32_t a, uint32_t b, bool free) {
  if (a >= views.regions || b >= views.regions) return;
  const size_t at = 2 * pair_index(a, b);
  count(tallies.counts[at]);
  if (free) count(tallies.counts[at + 1]);
}

Views learn_views(const Views& views, const ViewTallies& tallies, uint32_t regions, float kept) {
  Views next;
  next.regions = std::min(regions, most_regions);
  const size_t size = pair_count(next.regions);
  next.tried.resize(size), next.seen.resize(size), next.chance.assign(size, 255);
  for (size_t i = 0; i < pair_count(views.regions); ++i) {
    next.tried[i] = kept * views.tried[i] + float(tallies.counts[2 * i]);
    next.seen[i] = kept * views.seen[i] + float(tallies.counts[2 * i + 1]);
    next.seen[i] = std::min(next.seen[i], next.tried[i]);  // counts start again after 2^32
    const float chance = std::sqrt((next.seen[i] + 1) / (next.tried[i] + 1));
    next.chance[i] = uint8_t(std::lround(255 * std::max(chance, least_chance)));
  }
  return next;
}

}  // namespace ajar
