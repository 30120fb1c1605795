#include "ajar/join/pool.h"

#include <algorithm>

namespace ajar {
namespace {

// Shares of the choice that go by flux, and that are even, whatever the fields say.
constexpr double by_flux = 0.05, evenly = 0.2;

struct Totals {
  double worth = 0, flux = 0, places = 0;
};

Totals totals_of(const std::vector<const LightStore*>& stores) {
  Totals t;
  for (const LightStore* store : stores)
    for (const LightStore::Place& at : store->places) {
      const double counts = double(at.counts);
      t.worth += counts * double(at.worth), t.flux += counts * double(at.flux), t.places += counts;
    }
  if (!(t.worth < infinity)) t.worth = 0;
  if (!(t.flux < infinity)) t.flux = 0;
  return t;
}

// What a place is chosen by: its share of all.
double value_of(const LightStore::Place& at, const Totals& all) {
  const double flux = all.flux > 0 ? by_flux : 0, worth = all.worth > 0 ? 1 - evenly - flux : 0;
  double value = (1 - flux - worth) / all.places;
  if (flux > 0) value += flux * double(at.flux) / all.flux;
  if (worth > 0) value += worth * double(at.worth) / all.worth;
  return value * double(at.counts);
}

// Copies a place, and of its subpath what is not there yet: places of a subpath follow each other.
class Copier {
 public:
  Copier(LightStore& out, const LightStore& from) : out_(out), from_(from) {}
  void copy(LightStore::Place at, uint32_t paths_before) {
    if (at.first != first_) first_ = at.first, copied_ = 0, start_ = uint32_t(out_.vertices.size());
    const auto begin = from_.vertices.begin() + ptrdiff_t(first_);
    if (at.s > copied_) out_.vertices.insert(out_.vertices.end(), begin + copied_, begin + at.s), copied_ = at.s;
    at.first = start_, at.path += paths_before;
    out_.places.push_back(at);
  }

 private:
  LightStore& out_;
  const LightStore& from_;
  uint32_t first_ = ~0u, start_ = 0;
  int copied_ = 0;
};

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

void keep(LightStore& out, const std::vector<const LightStore*>& stores, double count, float u) {
  clear(out);
  const Totals all = totals_of(stores);
  std::vector<double> values;
  for (const LightStore* store : stores)
    for (const LightStore::Place& at : store->places) values.push_back(value_of(at, all));
  const double least = find_threshold(values, count);
  double sum = 0;
  size_t i = 0;
  for (const LightStore* store : stores) {
    Copier copier(out, *store);
    for (LightStore::Place at : store->places) {
      const double chance = least > 0 ? std::min(values[i++] / least, 1.0) : 1;
      sum += chance;
      if (!(double(out.places.size()) + double(u) < sum)) continue;
      at.counts /= float(chance);
      copier.copy(at, out.paths);
    }
    out.paths += store->paths;
  }
}

}  // namespace ajar
