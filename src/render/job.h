// Enters: scene, accelerator, options.
// Leaves: what one path's tracing reads (Job) and writes (Scratch), the same for every integrator.
#pragma once

#include "ajar/film/pyramid.h"
#include "ajar/join/connect.h"
#include "ajar/render/options.h"

namespace ajar {

struct Job {
  const Scene* scene = nullptr;
  const Accel* accel = nullptr;
  WalkOptions walk;
  SamplerKind sampler = SamplerKind::sobol;
  uint64_t seed = 0;
  bool techniques = false;
};

/// Storage of one thread at work on one chunk; kept from chunk to chunk.
struct Scratch {
  Subpath camera, light;
  Counters counters;
  uint64_t rejected = 0;
  std::vector<Splat>* splats = nullptr;         ///< of the chunk
  std::vector<Strategy>* strategies = nullptr;  ///< of the chunk, null unless asked for
};

/// One sample of pixel (x, y) of the film in one pass: which numbers it draws and where it looks.
struct PixelSample {
  int x = 0, y = 0;
  uint64_t path = 0;  ///< index of the pixel
  uint32_t pass = 0;
};

/// Traces one sample and returns the radiance of its camera path; splats go to the scratch.
using Trace = Rgb (*)(const Job&, const PixelSample&, const Vec2& raster, const Vec2& lens, Sampler& camera, Scratch&);

Rgb trace_path(const Job&, const PixelSample&, const Vec2&, const Vec2&, Sampler&, Scratch&);
Rgb trace_bdpt(const Job&, const PixelSample&, const Vec2&, const Vec2&, Sampler&, Scratch&);
Rgb trace_light(const Job&, const PixelSample&, const Vec2&, const Vec2&, Sampler&, Scratch&);

/// Law 6: only finite, non-negative values may go on; others are counted.
inline bool accept(const Rgb& value, Scratch& scratch) {
  if (value.x >= 0 && value.y >= 0 && value.z >= 0 && value.x + value.y + value.z < infinity) return true;
  ++scratch.rejected;
  return false;
}

}  // namespace ajar
