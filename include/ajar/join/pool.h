// Enters: the light vertices of many subpaths.
// Leaves: a few of them that stand for all.
#pragma once

#include "ajar/join/store.h"

namespace ajar {

/// Share of a choice among light vertices that goes by flux, whatever the fields say.
inline constexpr double by_flux = 0.05;

/// The threshold c with which keeping each value with the probability min(1, value / c) keeps `count` on average; 0 if
/// there are no more than `count`. (J2)
double find_threshold(std::vector<double> values, double count);

/// Along a Morton curve over the places within a radius of a centre, one curve for each of six ranges of normals, so
/// that vertices near each other in the order are alike.
uint64_t morton_key(const Vertex& v, const Vec3& center, float radius);

/// Fills a store with about `count` of the entries of others, or with all where there are fewer, by what the fields
/// expect each to bring to the image; a part of the choice goes by flux, a part is even, and all of that where fields
/// know nothing. What is kept stands for what is not: Entry::counts (J2). u in [0, 1): systematic sampling, in the
/// order of morton_key, in which the kept ones are left: so they are spread as evenly as all are. Blocks are not
/// made yet.
void subsample(LightStore& out, const std::vector<const LightStore*>& stores, double count, float u);

}  // namespace ajar
