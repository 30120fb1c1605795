// Enters: a scene, its accelerator, options, a film (new, or from a checkpoint).
// Leaves: the film after as many passes as the budget allows, with statistics.
#pragma once

#include <functional>

#include "ajar/film/pyramid.h"
#include "ajar/render/adaptive.h"
#include "ajar/render/balance.h"
#include "ajar/render/clock.h"
#include "ajar/render/learning.h"
#include "ajar/render/ledger.h"
#include "ajar/render/options.h"
#include "ajar/render/plain.h"

namespace ajar {

/// Of the clock, in timed samples of all passes, also of those that are not in the image.
struct TimedTicks {
  uint64_t all = 0, learn = 0;  ///< learn: of these, recording what was seen
};

struct RenderStats {
  Counters counters;
  Ledger ledger;  ///< of what is in the image: without dropped passes
  TimedTicks ticks;
  uint64_t rejected = 0;                            ///< values dropped for not being finite and non-negative
  std::vector<std::string> replay;                  ///< what replays the first of them
  double seconds = 0, cpu_seconds = 0;              ///< of tracing, merging and learning; sums over resumed parts
  double learn_seconds = 0, learn_cpu_seconds = 0;  ///< of these, learning between passes
};

/// Everything that a render needs in order to go on, and all that it has made.
struct RenderState {
  std::string integrator;  ///< that it was started for
  Film film;
  Pyramid pyramid;  ///< filled when RenderOptions::techniques
  RenderStats stats;
  Learning learning;  ///< of guided integrators
  /// Light subpaths for each pixel, a power of two, where camera subpaths choose among those of many, or merge. Looked
  /// at anew after 8, 16, 32 ... passes.
  float light_rate = noisy_light;
  static constexpr float least_light = 0.125f, usual_light = 0.25f, noisy_light = 0.5f, caustic_light = 1,
                         most_light = 4;
  /// Spent on joins, of what may be: by the share of the light that they bring (J8). Looked at anew after 1, 2, 4 ...
  /// passes.
  float effort = 0.5f;
  static constexpr float least_effort = 1.0f / 16;
  Balance balance;    ///< of guided integrators
  Adaptive adaptive;  ///< likewise, unless RenderOptions::even
  Plain plain;        ///< when RenderOptions::leaves_out
};

/// Seen between batches of chunks, a few times a second at most for large images; return false to stop. Its own time
/// counts towards no limit. May be empty.
using Monitor = std::function<bool(const RenderState&)>;

/// Throws Error for an unknown integrator, options that check refuses, a scene that is not finished, a film without
/// pixels, and a filter that make_filter did not make.
RenderState start_render(const Scene& scene, const RenderOptions& options);
/// Traces until spp, budget or noise target is reached or the monitor says stop; without it, never less than one whole
/// pass of those that count. The target is looked at after 8, 10, 12, 14, 16, 18, 20 ... 32, 36 ... passes; where it is
/// the only limit, an image that is black after 1024 passes, or after 8 without lights, ends too. Deterministic for spp
/// and noise: the same bytes with any number of threads, and when stopped and called again with the same state. Throws
/// Error for an accelerator of another scene, for a state of another size, filter or integrator than scene and options
/// ask for, of other techniques or limit_fireflies, or with fields of other lights, and where next_event is false and
/// light subpaths are traced.
void render(const Scene& scene, const Accel& accel, const RenderOptions& options, RenderState& state,
            const Monitor& monitor);

/// Saves the state with a key that names scene and options; written aside and renamed. Throws Error.
void save_checkpoint(const std::string& path, const std::string& key, const RenderState& state);
/// Fills a state that start_render made for the same scene and options. Throws Error when the file is damaged, of
/// another version, key or integrator, or lacks the images of strategies that the state keeps; the state is as it was
/// then. Whether it is of the same scene the key has to say (scene_key in field/store.h is a part of one): render
/// refuses a state whose film or lights are of another, and takes all else for the scene's.
void load_checkpoint(const std::string& path, const std::string& key, RenderState& state);
/// The key that a checkpoint was saved with. Throws Error where the file is none, or of another version.
std::string read_checkpoint_key(const std::string& path);

/// First-hit features, averaged over a few jittered samples per pixel: "Albedo.R" ..., "N.X" ... (world shading
/// normal), "P.X" ... (world position); zero where nothing is hit. Channel names are pbrt's. Throws Error for a scene
/// that is not finished, an accelerator of another one, and less than a sample.
Picture render_features(const Scene& scene, const Accel& accel, uint64_t seed, int samples = 16);

/// For who stops a render: where merging was left out, the image with it as long as it has more passes. The state is
/// not to be gone on from then.
void show_merged(RenderState& state);

/// Whether a share of a time limit is over, wall or CPU.
bool is_over(const RenderOptions& options, const RenderStats& stats, double share);

}  // namespace ajar
