// Enters: a camera subpath that arrives at a vertex where it can be joined with many light subpaths.
// Leaves: what strategies that join before it count for, and whether it is worth the joins and what follows.
#pragma once

#include "ajar/path/walk.h"

namespace ajar {

/// Sum of what all strategies with fewer camera vertices count for, if a light subpath reached the last vertex and
/// scattered there as from a matt surface; relative to that subpath's density, and not raised.
double count_before(const WalkOptions& options, const Subpath& camera);
/// Roulette at the last vertex, before its joins: false where the subpath ends; else its throughput counts for those
/// that do, and is raised to the window's times that of the start at the most. Takes one pair of numbers. (G15)
bool is_worth_it(const WalkOptions& options, Sampler& sampler, Subpath& camera, Walk& walk);

}  // namespace ajar
