// Enters: non-negative numbers.
// Leaves: the same in fixed point, with which sums do not depend on their order.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

namespace ajar {

inline constexpr double weight_step = 0x1p-12, value_step = 0x1p-24;
/// Records heavier than this count as this: what teaches may be clamped, images never are.
inline constexpr double largest_weight = 64;

inline int64_t to_fixed(double x, double step) {
  constexpr double most = 0x1p50;
  const double n = x / step;
  return int64_t(n < most ? n + 0.5 : most);
}

/// Sums end here: what goes beyond is taken back.
inline constexpr int64_t fullest = int64_t(1) << 62;

/// amount: of to_fixed, or a count. Threads may add to the same sum at once. In any order it becomes the least of the
/// total and fullest: what found the sum below fullest was never taken back, the first to pass it leaves it full, and
/// all after that leave nothing. What is yet to be taken back is at most 2^50 of each thread.
inline void add(int64_t& to, int64_t amount) {
  std::atomic_ref<int64_t> sum(to);
  const int64_t before = sum.fetch_add(amount, std::memory_order_relaxed), over = before + amount - fullest;
  if (over > 0) [[unlikely]]
    sum.fetch_sub(std::min(over, amount), std::memory_order_relaxed);
}

}  // namespace ajar
