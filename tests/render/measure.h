// Enters: a scene, render options.
// Leaves: images with their spread over independent renders, exact images, and comparisons of them.
#pragma once

#include <map>

#include "ajar/render/render.h"
#include "kit/ztest.h"

namespace ajar {

struct Repeats {
  int batches = 16;      ///< independent renders; their spread is the variance
  uint32_t passes = 64;  ///< of each
  uint64_t seed = 1;     ///< of the first
};

/// Options of the statistical tests: independent numbers, so that the spread of renders is their variance, and fields
/// that guide wherever they may.
RenderOptions statistical(const std::string& integrator, int max_depth = -1);
/// Renders to the end; fails the test when a value was rejected. walls: a table with those of another render of the
/// scene, which are the same for all; without any they are found.
RenderState rendered(const Scene& scene, const Accel& accel, const RenderOptions& options,
                     const CellTable* walls = nullptr);
/// What six passes of guided-bdpt learn of the scene.
Fields learned(const Scene& scene);
kit::Estimate measure(const Scene& scene, const RenderOptions& options, const Repeats& plan = {});
/// The raw image of every strategy (s, t).
std::map<std::pair<int, int>, kit::Estimate> measure_techniques(const Scene& scene, RenderOptions options,
                                                                const Repeats& plan = {});
/// A picture known without noise.
kit::Estimate exact(const Picture& picture);
/// Mean over all pixels and channels.
double mean(const kit::Estimate& estimate);
/// Fails the test when the two differ by more than noise.
void expect_same(const kit::Estimate& a, const kit::Estimate& b, const std::string& what);

}  // namespace ajar
