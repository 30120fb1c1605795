#include "ajar/join/visibility.h"

#include <algorithm>

namespace ajar {

void start(const LightStore& store, Visibility& v) {
  Visibility::Block fresh;
  fresh.chance.fill(0.5f);
  v.blocks.assign(store.blocks.size(), fresh);
  v.tried = v.seen = 0;
}

void learn(Visibility& v, uint32_t entry, bool seen) {
  Visibility::Block& b = v.blocks[entry / LightStore::width];
  const uint32_t i = entry % LightStore::width;
  const float one = seen;
  v.tried += 1, b.all_tried += 1, b.tried[i] += 1;
  v.seen += one, b.all_seen += one, b.seen[i] += one;
  // Of the block as if two of its entries had been seen as often as all are, of the entry as if one more.
  const float of_all = (v.seen + 1) / (v.tried + 2), of_block = (b.all_seen + 2 * of_all) / (b.all_tried + 2);
  for (uint32_t k = 0; k < LightStore::width; ++k)
    b.chance[k] = std::max((b.seen[k] + of_block) / (b.tried[k] + 1), 0.1f * of_all);
}

}  // namespace ajar
