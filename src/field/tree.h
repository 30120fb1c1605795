// Enters: a cell's strata and what passes recorded in them.
// Leaves: the tree of strata as the next fields keep it: new means and evidence, heavy strata divided, light ones
// joined.
#pragma once

#include "ajar/field/learn.h"

namespace ajar {

// A tree at work: children by index into the same vector, -1 at leaves, which hold the values.
struct TreeNode {
  float mean[16], weight[16], mass[16];
  int32_t child[16];
};
using Tree = std::vector<TreeNode>;

// Appends what hangs below a field's node, with the evidence of its records (G3). Returns its place.
int32_t take(const Field& field, const Tallies& tallies, float forget, uint32_t node, Tree& tree);
// Fills the masses, with `floor` of radiance added to each stratum; returns the sum for the projected hemisphere.
float weigh(Tree& tree, Structure structure, float floor);
// Largest mean of all strata; sum of their evidence.
float most_radiance(const Tree& tree);
float evidence(const Tree& tree);
// What a field is worth as a guide: its mean square over the square of its mean, over the projected hemisphere; 1 where
// it is even. Of masses without a floor, as weigh left them.
float contrast(const Tree& tree);
// Half the sum, over the strata of a field's node, of what their shares differ by from those of the tree that was taken
// from it, of masses as weigh left them: 0 where they are alike, at most 1.
double difference(const Field& field, uint32_t node, const Tree& tree);
// Divides heavy strata, if any are to be divided, and joins light ones. total: what weigh returned.
void reshape(Tree& tree, float total, const LearnOptions& options, bool divides);

// Finished trees. The children of a node follow each other.
struct Trees {
  std::vector<StrataNode> nodes;
  std::vector<UFloat16> mean, weight;
};
// Returns the root.
uint32_t append(Trees& out, const Tree& tree, Structure structure);
// The same with the shares of the field's node that the tree was taken from: its means and evidence alone are new.
uint32_t append_evidence(Trees& out, const Tree& tree, const Field& field, uint32_t node);

// Appends a cell with the strata of cell `from` and a quarter of its evidence, or with blank strata where it is none.
void add_cell(Field& field, uint32_t from, Structure structure);

}  // namespace ajar
