// Enters: scene, accelerator, options.
// Leaves: what one path's tracing reads (Job) and writes (Scratch), the same for every integrator.
#pragma once

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

struct Plain;
struct RenderState;
struct Job;
struct Sample;
struct Scratch;
/// Traces one sample; what it finds depends on the sample alone, and on the light halves traced before.
using Trace = void (*)(const Job&, Sample&, Scratch&);

/// The light vertices of a pass as virtual point lights, the same for all pixels.
struct Vpls {
  LightStore store;
  uint32_t pass = ~0u;          ///< that they are of
  uint32_t paths = 256;         ///< light subpaths of a pass
  double even = 0;              ///< vertices per area and light subpath; read where no field tells
  int joins = 8;                ///< at the first surface of a camera subpath
  WalkOptions camera;           ///< of camera subpaths: fields are read for the lights alone
  uint32_t most = 0;            ///< lights that are kept, about
  double least = 0;             ///< a light that brings this to the image, or more, is sure to be kept; 0: all are
  double per_flux = 0;          ///< what a light is taken to bring, beside what the field says
  uint32_t rejected_at = none;  ///< light subpath of the pass's first rejected value
  std::vector<std::vector<Splat>> splats;  ///< of the pass's light subpaths, per chunk of the film
};

struct Job {
  const Scene* scene = nullptr;
  const Accel* accel = nullptr;
  WalkOptions walk;
  SamplerKind sampler = SamplerKind::sobol;
  uint64_t seed = 0;
  bool techniques = false;
  bool next_event = true;
  Trace trace = nullptr;
  Trace light_half = nullptr;          ///< what is traced before, of all samples of a chunk or batch; null: nothing
  const PhotonMap* photons = nullptr;  ///< light vertices to merge with: of all light subpaths of the batch, and of
                                       ///< one in inner_photons; null: none
  double kept = 0;                     ///< light vertices of a chunk that go into its pool, about
  float effort = 1;                    ///< how much is spent on joins (J8)
  Adaptive* adaptive = nullptr;        ///< camera samples of each pixel in a pass; null: one
  Beyond* beyond = nullptr;            ///< per pixel, see Balance; null: not looked at
  bool merges_alone = false;           ///< nothing but merges brings light, so they need no weights
  int final_gather = 0;                ///< of photon, see RenderOptions
  const Vpls* vpls = nullptr;
  float light_rate = 1;                ///< light halves for each sample of a chunk, a power of two
  bool guided = false;                 ///< fields guide subpaths, and learn from them; else lights alone are learned
  const Learning* learning = nullptr;  ///< null: nothing is learned
  Training* training = nullptr;
};

/// One camera sample of pixel (x, y) of the film in one pass: where it looks, which numbers it draws, and what it
/// found.
struct Sample {
  int x = 0, y = 0;
  uint64_t path = 0;  ///< index of the pixel; of its further samples so many times the number of pixels more
  uint32_t number = 0, count = 1;  ///< among how many of the pixel in the pass
  uint32_t pass = 0;
  Vec2 raster{0}, lens{0};
  float filter = 1;  ///< what the filter makes of the camera path's radiance, over their number, times that for how
                     ///< many samples of the pass it stands, where not all are traced
  Sampler sampler;
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
  float splat_counts = 1;  ///< for how many light subpaths each one's splats stand, where fewer than pixels are traced
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
  double light_share = 1;  ///< of the light walk, for s = 2
  float pixel = -1;        ///< radiance that the pixel is expected to have; 0: fields do not know; -1: not asked yet
};

void trace_path(const Job&, Sample&, Scratch&);
void trace_bdpt(const Job&, Sample&, Scratch&);
void trace_light(const Job&, Sample&, Scratch&);
/// Follows the scratch's light subpath, which was started, to its next vertex; false where it ends or escapes (Walk).
bool follow_light(const Job&, Sampler&, Scratch&, Walk&, Surface&);
void trace_vpl(const Job&, Sample&, Scratch&);
/// How many lights and joins there are to be.
Vpls make_vpls(const Scene&, const Film&, bool guided);
/// Whether a vertex may be a light: what it scatters is not so narrow that hardly any pixel ever sees it. The same from
/// both sides of what light goes through: joins and walks, which may come from different ones, must agree.
bool can_light(const Scene& scene, const Surface& surface, const Guide& y);
/// Lights per area at a point of a surface, on the side of direction w: of all that are kept, as far as fields know. A
/// function of the place, whatever the pass's lights are.
double density_of_lights(const Job& job, const Vec3& p, const Vec3& ng, const Vec3& w);
/// Has the lights be those of the film's pass at hand: traces its light subpaths, and before the first ones others,
/// which tell how much a light must bring to be kept.
void place_vpls(const Job&, const Film&, std::vector<Scratch>&, Vpls&);
/// The light subpath of one sample, put into the chunk's store and among what is merged. trace_bdpt is the second half,
/// or trace_photon, which joins nothing.
void trace_light_half(const Job&, Sample&, Scratch&);

void trace_photon(const Job&, Sample&, Scratch&);

/// The job of path tracing in a guided integrator's place: as path would have it, on the same film.
Job plainly(Job job);
/// Whether the next pass merges: not where the radius is 0, nor once that was left out, unless nothing may be.
bool merges_still(const RenderOptions& options, const Plain& plain);
/// After 4, 8, 16 ... 64 passes of a guided integrator: whether path tracing takes over, in RenderState::plain (L2);
/// after 8, 16, 32 ..., where it did: whether it gives the render back, which then is as it was. Does nothing where
/// nothing may be left out, or fields know too little. job: of the render. Scratches' counters are left empty.
void try_plain(const Job& job, const RenderOptions& options, std::vector<Scratch>& scratches, RenderState& state);

/// Beyond the first vertex at which a camera subpath is merged, it is merged with one light subpath in so many: those
/// merges share what found the vertex, and more of them do not help.
inline constexpr uint32_t inner_photons = 16;
/// Whether the sample is one of every n; other ones from pass to pass.
bool is_one_in(uint32_t n, const Sample& sample);
/// Puts the light subpath's vertices among those that the batch merges with. share: of the walk.
void keep_photons(const Job& job, const Sample& sample, double share, Scratch& scratch);
/// s >= 2: all light vertices near the last vertex of the camera subpath.
void join_merged(const Job& job, Sample& sample, Scratch& scratch);

}  // namespace ajar
