#include "ajar/render/ledger.h"

#include <chrono>

namespace ajar {
namespace {

// Over joins and merges of every (s, t).
template <class T>
T sum_of(const Ledger& ledger, T StrategyCost::*part) {
  T sum = 0;
  for (const auto* table : {&ledger.strategies, &ledger.merges})
    for (const auto& row : *table)
      for (const StrategyCost& cost : row) sum += cost.*part;
  return sum;
}

}  // namespace

StrategyCost& StrategyCost::operator+=(const StrategyCost& o) {
  joins += o.joins, rays += o.rays, visible += o.visible, ticks += o.ticks, energy += o.energy;
  return *this;
}

Ledger& Ledger::operator+=(const Ledger& o) {
  for (int s = 0; s <= most; ++s)
    for (int t = 0; t <= most; ++t) strategies[s][t] += o.strategies[s][t], merges[s][t] += o.merges[s][t];
  camera_ticks += o.camera_ticks, light_ticks += o.light_ticks, learn_ticks += o.learn_ticks;
  caustics += o.caustics;
  return *this;
}

uint64_t clock_ticks() {
#if defined(__x86_64__)
  return __builtin_ia32_rdtsc();
#else
  return uint64_t(std::chrono::steady_clock::now().time_since_epoch().count());
#endif
}

uint64_t join_ticks(const Ledger& ledger) { return sum_of(ledger, &StrategyCost::ticks); }

uint64_t total_ticks(const Ledger& ledger) {
  return join_ticks(ledger) + ledger.camera_ticks + ledger.light_ticks + ledger.learn_ticks;
}

double total_energy(const Ledger& ledger) { return sum_of(ledger, &StrategyCost::energy); }

}  // namespace ajar
