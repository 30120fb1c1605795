// Enters: which entries of a store a group of camera vertices near each other saw, join by join.
// Leaves: the chance that the next of them sees an entry.
#pragma once

#include <array>
#include <vector>

#include "ajar/join/store.h"

namespace ajar {

/// Learned from what was seen of the entry itself, of those beside it in the order of the store (its block), and of
/// all.
struct Visibility {
  struct Block {
    std::array<float, LightStore::width> chance{}, tried{}, seen{};
    float all_tried = 0, all_seen = 0;
  };
  std::vector<Block> blocks;
  float tried = 0, seen = 0;
};

/// Nothing is known of the entries of this store, which were put in order: each chance is a half.
void start(const LightStore& store, Visibility& visibility);
/// entry: its number in the store. (I5)
void learn(Visibility& visibility, uint32_t entry, bool seen);

}  // namespace ajar
