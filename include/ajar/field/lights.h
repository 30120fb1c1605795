// Enters: what next-event rays, and light subpaths, from each piece of the light tree brought.
// Leaves: per cell, a cut through the tree with learned weights (V); the same once for where light subpaths start
// (docs/method.md, "Many lights").
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ajar/scene/lighttree.h"

namespace ajar {

/// A node of the tree that a cut holds.
struct LightEntry {
  uint32_t node = 0;
  uint32_t first = 0;  ///< its first piece; entries of a cut follow each other in the order of their pieces
  float weight = 1;    ///< V: what comes from it, over what the tree takes for granted; relative to the other entries
  float before = 0;    ///< share of the entries before it, as it was when learned
};
/// What stands behind an entry.
struct LightEvidence {
  float square = 0;  ///< sum of squares of what it brought over what the tree promised
  float hits = 0;    ///< that brought something
  float tried = 0;   ///< older ones count less
};
/// One cell's cut: its entries hold every piece once.
struct LightCut {
  uint32_t first = 0, count = 0;
  float asks = 1;  ///< probability of a next-event ray at all
  /// Under a sky: its lights are taken whole, by power (LightTree::sky), since entries gain too little.
  uint32_t plain = 1;
};
struct LearnedLights {
  std::vector<LightCut> cuts;
  std::vector<LightEntry> entries;
  std::vector<LightEvidence> evidence;  ///< beside the entries
  double unit = 1;                      ///< of what is brought over what was promised
};

/// Sums per entry since the last lesson.
struct LightTallies {
  std::vector<int64_t> square, hits, tried;
};

/// What is shared out evenly among all entries of a cut that may be chosen, whatever was promised and learned.
inline constexpr float least_share = 0.05f;
/// Entries of the cut by which light subpaths start.
inline constexpr uint32_t most_starts = 512;

struct LightRules {
  float mix = 0.9f;          ///< share of what was learned in a weight, at most
  float forget = 0.5f;       ///< share of older evidence that is kept
  float divide = 1 / 16.0f;  ///< share of its cut above which an entry is divided
  uint32_t most = 32;        ///< entries of a cut
  float least_asks = 1;      ///< of cells that see no light
  bool by_power = false;     ///< entries promise their power, whoever asks
};

/// Index of the cut's entry that holds a piece.
uint32_t entry_of(const LearnedLights& v, const LightCut& cut, uint32_t place);
inline float share_of(const LearnedLights& v, const LightCut& cut, uint32_t entry) {
  return (entry + 1 < cut.first + cut.count ? v.entries[entry + 1].before : 1) - v.entries[entry].before;
}
/// Entry of a cut by its shares; u becomes uniform again.
uint32_t choose_entry(const LearnedLights& v, const LightCut& cut, float& u);
/// Number of the piece after an entry's last.
inline uint32_t end_of(const LightTree& tree, const LearnedLights& v, uint32_t entry) {
  return tree.nodes[v.entries[entry].node].last;
}

LightTallies start_tallies(const LearnedLights& v);
/// brought: by the entry, all of it as if it were always chosen, over what it promised; not negative; 0 if nothing.
void record(const LearnedLights& v, LightTallies& tallies, uint32_t entry, float brought);
/// A cut that knows nothing, or a copy of another whose evidence counts a quarter.
void add_cut(LearnedLights& v, uint32_t from);
/// cells: where the cuts' vertices are, on the whole; empty: nowhere.
LearnedLights learn_lights(const LightTree& tree, const LearnedLights& v, const LightTallies& tallies,
                           const LightRules& rules, std::span<const Receiver> cells = {});
/// Whether all cuts are cuts of this tree.
bool fits(const LearnedLights& v, const LightTree& tree);
size_t bytes(const LearnedLights& v);

}  // namespace ajar
