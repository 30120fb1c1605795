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

inline uint32_t reverse_bits(uint32_t x) {
  x = x << 16 | x >> 16;
  x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

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

/// Which numbers a path of a side draws in one pass: Owen-scrambled Sobol points in independently shuffled pairs of
/// dimensions (padding, Burley 2020). Each path number and side has two sequences, scrambled independently of each
/// other, which even and odd passes take in turns: what the two halves of an image differ by is then their true error.
/// Or independent numbers, for comparison.
struct Stream {
  uint64_t key = 0;    ///< of (seed, side, path), and of the half for sequences
  uint32_t index = 0;  ///< in the sequence, its bits reversed
  SamplerKind kind = SamplerKind::sobol;
};

/// Sobol: the pass's parity chooses the sequence, and half of its number is the point in it; so passes are to come in
/// pairs, each number once. Independent: every pass has its own.
Stream make_stream(SamplerKind kind, uint64_t seed, Side side, uint64_t path, uint32_t pass);
/// Of one of its pairs.
inline uint64_t key_of(const Stream& stream, uint32_t pair) { return stream.key + 0x9e3779b97f4a7c15ull * pair; }

/// Pairs of Sobol numbers that follow each other in a stream.
struct PairBlock {
  static constexpr uint32_t size = 16;
  float x[size], y[size];
};
/// From pair number first on.
void fill(const Stream& stream, uint32_t first, PairBlock& out);

/// Hands out the numbers of a stream, in pairs, the first of which is number 1. Sobol pairs are computed by the block:
/// all of one, in vectors, take little longer than a single pair.
struct Sampler {
  Stream stream;
  uint32_t pair = 0;              ///< number of the last one handed out
  uint32_t first = far_from_all;  ///< number of the block's first pair
  PairBlock block;                ///< unset until a number is asked for

  static constexpr uint32_t far_from_all = 0xfffffff0u;  ///< nobody draws so many that one is in a block from there

  Sampler() {}  // NOLINT: leaves the block open
  explicit Sampler(const Stream& of, uint32_t handed_out = 0) { start(of, handed_out); }
  void start(const Stream& of, uint32_t handed_out = 0) { stream = of, pair = handed_out, first = far_from_all; }

  /// The next pair of dimensions; skip sets it aside instead, for at to compute where it turns out to be needed.
  Vec2 next2() { return at(skip()); }
  float next1() { return next2().x; }
  uint32_t skip() { return ++pair; }
  Vec2 at(uint32_t number) {
    if (stream.kind == SamplerKind::independent) {
      const uint64_t r = mix64(key_of(stream, number) + 0xd1342543de82ef95ull * reverse_bits(stream.index));
      return {to_unit(uint32_t(r)), to_unit(uint32_t(r >> 32))};
    }
    if (number - first >= PairBlock::size) {
      first = number - 1;  // the one before may have been set aside
      fill(stream, first, block);
    }
    return {block.x[number - first], block.y[number - first]};
  }
};

inline Sampler make_sampler(SamplerKind kind, uint64_t seed, Side side, uint64_t path, uint32_t pass) {
  return Sampler(make_stream(kind, seed, side, path, pass));
}

}  // namespace ajar
