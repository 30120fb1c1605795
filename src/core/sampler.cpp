#include "ajar/core/sampler.h"

namespace ajar {

Sampler make_sampler(SamplerKind kind, uint64_t seed, Side side, uint64_t path, uint32_t pass) {
  const uint64_t key = hash(hash(seed, uint64_t(side) + 1), path);
  if (kind == SamplerKind::independent) return {key, reverse_bits(pass), 0, kind};
  return {hash(key, pass % 2), reverse_bits(pass / 2), 0, kind};
}

}  // namespace ajar
