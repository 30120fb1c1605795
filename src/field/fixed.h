// Enters: non-negative numbers.
// Leaves: the same in fixed point, with which sums do not depend on their order.
#pragma once

#include <atomic>
#include <cstdint>

namespace ajar {

inline constexpr double weight_step = 0x1p-12, value_step = 0x1p-24;
/// Records heavier than this count as this: training data may be clamped (law 7).
inline constexpr double largest_weight = 64;

inline int64_t to_fixed(double x, double step) {
  constexpr double most = 0x1p50;  // room for thousands of the largest
  const double n = x / step;
  return int64_t(n < most ? n + 0.5 : most);
}

/// Threads may add to the same sum at once.
inline void add(int64_t& to, int64_t amount) {
  std::atomic_ref<int64_t>(to).fetch_add(amount, std::memory_order_relaxed);
}

}  // namespace ajar
