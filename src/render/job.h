// Enters: scene, accelerator, options.
// Leaves: what one path's tracing reads (Job) and writes (Scratch, and what Job holds that is not const), the same for
// every integrator.
#pragma once

#include <optional>

#include "ajar/accel/sight.h"
#include "ajar/film/pyramid.h"
#include "ajar/join/connect.h"
#include "ajar/join/photons.h"
#include "ajar/join/store.h"
#include "ajar/join/visibility.h"
#include "ajar/path/record.h"
#include "ajar/render/adaptive.h"
#include "ajar/render/balance.h"
#include "ajar/render/learning.h"
#include "ajar/render/ledger.h"
#include "ajar/render/options.h"

namespace ajar {

struct Job;
struct PhotonMaps;
struct Vpls;
struct Sample;
struct Scratch;
/// Traces one sample; what it finds depends on the sample alone, and on the light halves traced before. Of a camera
/// half scratch.numbers are those that come after what aims it.
using Trace = void (*)(const Job&, Sample&, Scratch&);

struct Job {
  const Scene* scene = nullptr;
  const Accel* accel = nullptr;
  WalkOptions walk;
  SamplerKind sampler = SamplerKind::sobol;
  uint64_t seed = 0;
  bool techniques = false;
  bool next_event = true;
  Trace trace = nullptr;
  Trace light_half = nullptr;           ///< what is traced before, of all samples of a chunk or batch; null: nothing
  const PhotonMaps* photons = nullptr;  ///< light vertices to merge with (merge.h); null: none
  float effort = 1;                     ///< how much is spent on joins (J8)
  Adaptive* adaptive = nullptr;         ///< camera samples of each pixel in a pass; null: one
  Beyond* beyond = nullptr;             ///< per pixel, see Balance; null: not looked at
  bool merges_alone = false;            ///< nothing but merges brings light, so they need no weights
  int final_gather = 0;                 ///< of photon, see RenderOptions
  Vpls* vpls = nullptr;                 ///< place.h
  float light_rate = 1;                 ///< light halves for each sample of a chunk, a power of two
  bool guided = false;                  ///< fields guide subpaths, and learn from them; else lights alone are learned
  const Learning* learning = nullptr;   ///< null: nothing is learned
  Training* training = nullptr;
};

/// One camera sample of pixel (x, y) of the film in one pass: where it looks, which numbers it draws, and what it
/// found.
struct Sample {
  int x = 0, y = 0;
  uint64_t path = 0;  ///< index of the pixel; of its further samples so many times the number of pixels more
  uint32_t number = 0, count = 1;  ///< among how many of the pixel in the pass
  uint32_t pass = 0;
  Vec2 lens{0};
  Stream stream;         ///< of its numbers: the first pair aims it, the second is lens where there is one
  Vec2 raster{0};        ///< set, as weight, when its camera half begins
  float weight = 1;      ///< what the filter makes of the camera path's radiance, over their number, times that for how
                         ///< many samples of the pass it stands, where not all are traced
  bool teaches = false;  ///< what its subpaths see is recorded
  uint32_t gathers = 0;  ///< rays of a final gather so far
  Rgb value{0};          ///< radiance found by the camera path, unfiltered
};

/// What the light halves of a chunk's samples leave for the camera halves.
struct Halves {
  struct Part {
    Sample sample;
    bool splat = false;  ///< its light subpath brought something
  };
  std::vector<Part> samples;  ///< first of each pixel one, then further ones of some
  size_t pixels = 0;          ///< how many have one
  float splat_counts = 1;  ///< for how many light subpaths each one's splats stand, as if there were one for each pixel
  LightStore store;        ///< of what the chunk's light subpaths left, what goes into its pool
  Photons photons, few;
};

/// A light vertex near a camera vertex, what it brings, with its weight, and what all up to it bring.
struct NearPhoton {
  const Photon* photon = nullptr;
  Rgb found{0};
  float weight = 0, sum = 0;
};

/// Storage of one thread at work on one chunk; kept from chunk to chunk. Threads share no cache line.
struct alignas(64) Scratch {
  Subpath camera, light;
  Sampler numbers;       ///< of the camera half at work
  LightStore traced;     ///< light subpaths of the chunk at work
  Expectation expected;  ///< of choices
  std::vector<StoreChoice> choices;
  Visibility visibility;             ///< of lights, from what the lens sees of a chunk, in this pass
  std::vector<NearPhoton> near;      ///< to the vertex at hand
  Halves* halves = nullptr;          ///< of the chunk
  const LightStore* pool = nullptr;  ///< light vertices to join, of many subpaths; null: those of one's own
  Halves own_halves;                 ///< where those of one chunk are enough
  Counters counters;
  Sightings sightings;
  uint64_t rejected = 0;
  uint64_t rejected_at = no_path;               ///< path of the chunk's first rejected value
  std::vector<Splat>* splats = nullptr;         ///< of the chunk
  Ledger* ledger = nullptr;                     ///< of the chunk
  uint64_t clock = 0;                           ///< when the part at work began; 0: the sample is not timed
  std::vector<Strategy>* strategies = nullptr;  ///< of the chunk, null unless asked for

  static constexpr uint64_t no_path = ~0ull;
};

/// One camera sample with its light subpath, at work.
struct Work {
  const Job& job;
  Sample& sample;
  Scratch& scratch;
  std::optional<float> pixel;  ///< radiance that the pixel is expected to have, if asked for; 0: fields do not know
};

}  // namespace ajar
