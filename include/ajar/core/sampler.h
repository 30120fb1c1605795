// Enters: seed, side, path and pass numbers.
// Leaves: numbers in [0,1), a pure function of those and of the dimension: the same for any number of threads.
#pragma once

#include "ajar/core/side.h"
#include "ajar/core/vec.h"

namespace ajar {

/// Strong 64-bit mixing (splitmix64's finaliser, Steele et al. 2014).
inline uint64_t mix64(uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}
inline uint64_t hash(uint64_t a, uint64_t b) { return mix64(a ^ mix64(b)); }

enum class SamplerKind : uint8_t { sobol, independent };
inline constexpr const char* sampler_names[] = {"sobol", "independent"};

/// Two numbers at once, in the halves of one word: bits reversed, each in its half.
inline uint64_t reverse_both(uint64_t x) {
  x = __builtin_bswap64(x);
  x = x << 32 | x >> 32;
  x = ((x & 0x0f0f0f0f0f0f0f0full) << 4) | ((x >> 4) & 0x0f0f0f0f0f0f0f0full);
  x = ((x & 0x3333333333333333ull) << 2) | ((x >> 2) & 0x3333333333333333ull);
  return ((x & 0x5555555555555555ull) << 1) | ((x >> 1) & 0x5555555555555555ull);
}
inline uint32_t reverse_bits(uint32_t x) { return uint32_t(reverse_both(x)); }

/// Owen scrambling of a bit-reversed number by hashing (Laine and Karras 2011, constants of Burley 2020).
inline uint32_t laine_karras(uint32_t x, uint32_t seed) {
  x += seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return x;
}

/// Second dimension of Sobol's (0,2)-sequence, bit-reversed: the Pascal matrix modulo 2 applied to the index.
inline uint32_t sobol_second_reversed(uint32_t i) {
  i ^= (i & 0xaaaaaaaau) >> 1;
  i ^= (i & 0xccccccccu) >> 2;
  i ^= (i & 0xf0f0f0f0u) >> 4;
  i ^= (i & 0xff00ff00u) >> 8;
  i ^= (i & 0xffff0000u) >> 16;
  return i;
}

inline float to_unit(uint32_t bits) { return std::min(float(bits) * 0x1p-32f, one_minus_epsilon); }

/// Owen-scrambled Sobol points in independently shuffled pairs of dimensions (padding, Burley 2020). Each path number
/// and side has two sequences, scrambled independently of each other, which even and odd passes take in turns: what the
/// two halves of an image differ by is then their true error. Or independent numbers, for comparison.
struct Sampler {
  uint64_t key = 0;    ///< of (seed, side, path), and of the half for sequences
  uint32_t index = 0;  ///< in the sequence, its bits reversed
  uint32_t pair = 0;   ///< dimensions are handed out in pairs
  SamplerKind kind = SamplerKind::sobol;

  /// The next pair of dimensions; skip sets it aside instead, for at to compute where it turns out to be needed.
  Vec2 next2() { return at(skip()); }
  float next1() { return next2().x; }
  uint32_t skip() { return ++pair; }
  Vec2 at(uint32_t number) const {
    const uint64_t stream = key + 0x9e3779b97f4a7c15ull * number;
    if (kind == SamplerKind::independent) {
      const uint64_t r = mix64(stream + 0xd1342543de82ef95ull * reverse_bits(index));
      return {to_unit(uint32_t(r)), to_unit(uint32_t(r >> 32))};
    }
    const uint64_t h = mix64(stream);
    // Shuffle the index in nested uniform blocks, so that pairs are independent of each other yet each stays a
    // (0,2)-sequence.
    const uint32_t shuffled = reverse_bits(laine_karras(index, uint32_t(h) ^ 0x5bd1e995u));
    const uint32_t x = laine_karras(shuffled, uint32_t(h >> 32));
    const uint32_t y = laine_karras(sobol_second_reversed(shuffled), uint32_t(h));
    const uint64_t both = reverse_both(uint64_t(y) << 32 | x);
    return {to_unit(uint32_t(both)), to_unit(uint32_t(both >> 32))};
  }
};

/// The numbers of one path of a side in one pass. Sobol: the pass's parity chooses the sequence, and half of its number
/// is the point in it; so passes are to come in pairs, each number once. Independent: every pass has its own.
Sampler make_sampler(SamplerKind kind, uint64_t seed, Side side, uint64_t path, uint32_t pass);

}  // namespace ajar
