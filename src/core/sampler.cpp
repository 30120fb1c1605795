#include "ajar/core/sampler.h"

namespace ajar {
namespace {

// Loops without branches, over arrays of one kind: compilers make vectors of them. In a program for all processors
// those of the one that it runs on, since the oldest of them multiply no vectors of integers. (Called in this file
// alone: clang makes such functions only where no declaration went before.)
#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__AVX2__)
__attribute__((target_clones("default", "avx2")))
#endif
void set_pairs(const Stream& stream, uint32_t first, PairBlock& out) {
  constexpr uint32_t n = PairBlock::size;
  uint64_t h[n];
  uint32_t low[n], high[n];
  for (uint32_t i = 0; i < n; ++i) h[i] = mix64(key_of(stream, first + i));
  for (uint32_t i = 0; i < n; ++i) low[i] = uint32_t(h[i]), high[i] = uint32_t(h[i] >> 32);
  for (uint32_t i = 0; i < n; ++i) {
    // Shuffle the index in nested uniform blocks, so that pairs are independent of each other yet each stays a
    // (0,2)-sequence.
    const uint32_t shuffled = reverse_bits(laine_karras(stream.index, low[i] ^ 0x5bd1e995u));
    out.x[i] = to_unit(reverse_bits(laine_karras(shuffled, high[i])));
    out.y[i] = to_unit(reverse_bits(laine_karras(sobol_second_reversed(shuffled), low[i])));
  }
}

}  // namespace

Stream make_stream(SamplerKind kind, uint64_t seed, Side side, uint64_t path, uint32_t pass) {
  const uint64_t key = hash(hash(seed, uint64_t(side) + 1), path);
  if (kind == SamplerKind::independent) return {key, reverse_bits(pass), kind};
  return {hash(key, pass % 2), reverse_bits(pass / 2), kind};
}

void fill(const Stream& stream, uint32_t first, PairBlock& out) { set_pairs(stream, first, out); }

}  // namespace ajar
