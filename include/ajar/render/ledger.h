// Enters: joins and walks, one after another, as samples are traced.
// Leaves: what each strategy (s, t) brought, and what it cost.
#pragma once

#include <cstdint>

namespace ajar {

/// Joins of s light and t camera vertices.
struct StrategyCost {
  uint64_t joins = 0;    ///< tried
  uint64_t rays = 0;     ///< shadow rays among them: joins that would bring something
  uint64_t visible = 0;  ///< that brought something
  uint64_t ticks = 0;    ///< of the clock, in timed samples
  double energy = 0;     ///< luminance that they add to the image, weighted; summed over pixels and passes

  StrategyCost& operator+=(const StrategyCost& other);
};

/// Sums over the samples of an image. One sample in timed_samples is timed, part by part; what is not a join is charged
/// to the subpath that was walked, or to learning. Ticks are good for shares, and shares are of the timed samples.
struct Ledger {
  static constexpr int most = 8;  ///< the last row has s of so many and more, the last column t
  StrategyCost strategies[most + 1][most + 1];
  StrategyCost merges[most + 1][most + 1];     ///< of s light and t camera vertices, the one that they share counted in
                                               ///< both; joins: vertices merged. Ticks are those of s = 0, for all s
  uint64_t camera_ticks = 0, light_ticks = 0;  ///< of walking, the ray included
  uint64_t learn_ticks = 0;                    ///< of recording what was seen
  double caustics = 0;  ///< energy of splats (t = 1) of light that came there by way of a delta event

  StrategyCost& at(int s, int t) { return strategies[s < most ? s : most][t < most ? t : most]; }
  StrategyCost& merge_at(int s, int t) { return merges[s < most ? s : most][t < most ? t : most]; }
  Ledger& operator+=(const Ledger& other);
};

inline constexpr uint32_t timed_samples = 256;
/// A part that took more ticks was interrupted by something else, and is left out.
inline constexpr uint64_t interrupted_ticks = 1 << 18;

/// A clock that takes a few nanoseconds to read, at a steady pace of its own.
uint64_t clock_ticks();

/// All ticks, and the joins' among them.
uint64_t total_ticks(const Ledger& ledger);
uint64_t join_ticks(const Ledger& ledger);
double total_energy(const Ledger& ledger);

}  // namespace ajar
