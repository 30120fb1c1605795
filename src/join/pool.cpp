#include "ajar/join/pool.h"

#include <algorithm>

namespace ajar {
namespace {

// Share of the choice that is even.
constexpr double evenly = 0.2;

struct Totals {
  double worth = 0, flux = 0, entries = 0;
};

Totals totals_of(const std::vector<const LightStore*>& stores) {
  Totals t;
  for (const LightStore* store : stores)
    for (const LightStore::Entry& at : store->entries) {
      const double counts = double(at.counts);
      t.worth += counts * double(at.worth), t.flux += counts * double(at.flux), t.entries += counts;
    }
  if (!(t.worth < infinity)) t.worth = 0;
  if (!(t.flux < infinity)) t.flux = 0;
  return t;
}

// What an entry is chosen by: its share of all.
double value_of(const LightStore::Entry& at, const Totals& all) {
  const double flux = all.flux > 0 ? by_flux : 0, worth = all.worth > 0 ? 1 - evenly - flux : 0;
  double value = (1 - flux - worth) / all.entries;
  if (flux > 0) value += flux * double(at.flux) / all.flux;
  if (worth > 0) value += worth * double(at.worth) / all.worth;
  return value * double(at.counts);
}

struct Choice {
  uint64_t order = 0;
  double value = 0;
  const LightStore* store = nullptr;
  LightStore::Entry at;  // its path counted through all stores
};

std::vector<Choice> choices_of(const std::vector<const LightStore*>& stores, const Totals& all) {
  std::vector<Choice> out;
  uint32_t paths = 0;
  Vec3 low(infinity), high(-infinity);
  for (const LightStore* store : stores) {
    for (LightStore::Entry at : store->entries) {
      const Vec3 p = store->vertex(at).p;
      low = glm::min(low, p), high = glm::max(high, p);
      out.push_back({0, value_of(at, all), store, at});
      out.back().at.path += paths;
    }
    paths += store->paths;
  }
  const Vec3 size = high - low;
  const float radius = std::max({size.x, size.y, size.z, 1e-30f}) / 2;
  for (Choice& c : out) c.order = morton_key(c.store->vertex(c.at), (low + high) / 2.0f, radius);
  std::stable_sort(out.begin(), out.end(), [](const Choice& a, const Choice& b) { return a.order < b.order; });
  return out;
}

uint64_t spread_bits(uint64_t x) {
  x = (x | x << 16) & 0x030000ff;
  x = (x | x << 8) & 0x0300f00f;
  x = (x | x << 4) & 0x030c30c3;
  return (x | x << 2) & 0x09249249;
}

}  // namespace

double find_threshold(std::vector<double> values, double count) {
  std::sort(values.begin(), values.end());
  double sum = 0;
  for (const double v : values) sum += v;
  size_t n = values.size();
  if (count >= double(n)) return 0;
  while (n > 0 && values[n - 1] * count > sum) sum -= values[--n], --count;  // these are sure to be kept
  return count > 0 ? sum / count : 0;
}

uint64_t morton_key(const Vertex& v, const Vec3& center, float radius) {
  const Vec3 q = glm::clamp((v.p - center) / (2 * radius) + 0.5f, 0.0f, 1.0f) * 1023.0f;
  const Vec3 n = v.guide.frame.n, a = glm::abs(n);
  const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  const uint64_t range = 2 * uint64_t(axis) + (n[axis] > 0);
  return range << 32 | spread_bits(uint64_t(q.x)) << 2 | spread_bits(uint64_t(q.y)) << 1 | spread_bits(uint64_t(q.z));
}

void subsample(LightStore& out, const std::vector<const LightStore*>& stores, double count, float u) {
  clear(out);
  for (const LightStore* store : stores) out.paths += store->paths;
  const std::vector<Choice> choices = choices_of(stores, totals_of(stores));
  std::vector<double> values;
  for (const Choice& c : choices) values.push_back(c.value);
  const double least = find_threshold(std::move(values), count);
  double sum = 0;
  for (const Choice& c : choices) {
    const double chance = least > 0 ? std::min(c.value / least, 1.0) : 1;
    sum += chance;
    if (!(double(out.entries.size()) + double(u) < sum)) continue;
    out.vertices.push_back(c.store->vertex(c.at));
    out.entries.push_back(c.at);
    out.entries.back().vertex = uint32_t(out.vertices.size() - 1);
    out.entries.back().counts /= float(chance);
  }
}

}  // namespace ajar
