// Enters: scene, accelerator, options.
// Leaves: what one path's tracing reads (Job) and writes (Scratch), the same for every integrator.
#pragma once

#include "ajar/film/pyramid.h"
#include "ajar/join/connect.h"
#include "ajar/path/record.h"
#include "ajar/render/learning.h"
#include "ajar/render/options.h"

namespace ajar {

struct Job {
  const Scene* scene = nullptr;
  const Accel* accel = nullptr;
  WalkOptions walk;
  SamplerKind sampler = SamplerKind::sobol;
  uint64_t seed = 0;
  bool techniques = false;
  const Learning* learning = nullptr;  ///< null: unguided
  Training* training = nullptr;
};

/// One camera sample of pixel (x, y) of the film in one pass: where it looks, which numbers it draws, and what it
/// found.
struct Sample {
  int x = 0, y = 0;
  uint64_t path = 0;  ///< index of the pixel
  uint32_t pass = 0;
  Vec2 raster{0}, lens{0};
  float filter = 1;  ///< what the filter makes of the camera path's radiance
  Sampler sampler;
  bool teaches = false;  ///< what its subpaths see is recorded
  Rgb value{0};  ///< radiance found by the camera path, unfiltered
};

/// Storage of one thread at work on one chunk; kept from chunk to chunk. Threads share no cache line.
struct alignas(64) Scratch {
  Subpath camera, light;
  Counters counters;
  Sightings sightings;
  uint64_t rejected = 0;
  uint64_t rejected_at = no_path;               ///< path of the chunk's first rejected value
  std::vector<Splat>* splats = nullptr;         ///< of the chunk
  std::vector<Strategy>* strategies = nullptr;  ///< of the chunk, null unless asked for

  static constexpr uint64_t no_path = ~0ull;
};

/// Traces one sample; what it finds depends on the sample alone.
using Trace = void (*)(const Job&, Sample&, Scratch&);

void trace_path(const Job&, Sample&, Scratch&);
void trace_bdpt(const Job&, Sample&, Scratch&);
void trace_light(const Job&, Sample&, Scratch&);

/// Law 6: only finite, non-negative values may go on; others are counted.
inline bool accept(const Rgb& value, const Sample& sample, Scratch& scratch) {
  if (value.x >= 0 && value.y >= 0 && value.z >= 0 && value.x + value.y + value.z < infinity) return true;
  ++scratch.rejected;
  if (scratch.rejected_at == Scratch::no_path) scratch.rejected_at = sample.path;
  return false;
}

}  // namespace ajar
