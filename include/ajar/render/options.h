// Enters: what the user asked for.
// Leaves: options that the pass loop reads, with defaults that suit most scenes.
#pragma once

#include <string>
#include <vector>

#include "ajar/field/learn.h"
#include "ajar/path/walk.h"

namespace ajar {

inline constexpr uint32_t default_spp = 64;

struct RenderOptions {
  std::string integrator = "bdpt";  ///< one of integrator_names()
  // Limits, of which the first that is reached ends the render; 0: none. Without any, default_spp.
  uint32_t spp = 0;        ///< passes
  double seconds = 0;      ///< wall
  double cpu_seconds = 0;  ///< of the whole process, while it renders: the host's other threads count too
  double noise = 0;        ///< estimated relMSE
  uint64_t seed = 0;
  int threads = 0;         ///< 0: all
  int max_depth = -1;      ///< edges of a path: 1 sees lights alone; -1: unlimited
  int roulette_depth = 5;  ///< edges of a subpath that are traced without roulette; 0: all may end by it
  Heuristic heuristic = Heuristic::power;
  SamplerKind sampler = SamplerKind::sobol;
  bool next_event = true;  ///< next-event estimation; only integrators without light subpaths can do without
  float merge_radius = 5;  ///< of vcm, guided-vcm and photon, in the first pass [pixels]; 0: nothing is merged
  int final_gather = 0;    ///< of photon: rays that bring indirect light to the first vertex; 0: light vertices there
  LearnOptions learn;      ///< guided integrators, and others that learn lights
  bool learn_lights = false;  ///< path and bdpt: learn which lights cells see (LearnOptions::lights), and nothing else
  bool leaves_out = false;    ///< see may_leave_out
  bool even = false;  ///< as many camera samples in all pixels; else guided integrators give noisy ones more (A1)
  bool limit_fireflies = false;  ///< of the developed image (film/fireflies.h)
  bool techniques = false;       ///< keep an image of every (s, t) with s + t <= most_vertices
};

/// Throws Error, with the field's name, for a number that cannot be meant: below 0, NaN, a mix of 1. start_render and
/// render ask it.
void check(const RenderOptions& options);

inline bool has_time_limit(const RenderOptions& o) { return o.seconds > 0 || o.cpu_seconds > 0; }
inline bool is_limited(const RenderOptions& o) { return o.spp > 0 || has_time_limit(o) || o.noise > 0; }
/// Passes after which a render ends, whatever else may end it before; 0: as many as the other limits allow.
inline uint32_t most_passes(const RenderOptions& o) { return is_limited(o) ? o.spp : default_spp; }

/// Whether a target for the noise alone ends it.
inline bool ends_by_noise(const RenderOptions& o) { return o.noise > 0 && o.spp == 0 && !has_time_limit(o); }

/// Path depth at which tracing stops even when it is unlimited: no scene needs it, and it bounds memory.
inline constexpr int deepest = 4096;

std::vector<std::string> integrator_names();
/// Whether it learns fields; throws Error for an unknown integrator.
bool is_guided(const std::string& integrator);
/// Whether anything is learned; throws Error for an unknown integrator, as the next.
bool learns(const RenderOptions& options);
/// Whether path tracing takes over from a guided integrator where it is seen to need less time to equal error (L2):
/// RenderOptions::leaves_out, as long as nobody asks for images of strategies, or for fields of another kind. Never
/// from vpl.
bool may_leave_out(const RenderOptions& options);
/// Whether it merges light vertices with camera vertices; throws Error for an unknown integrator.
bool is_merging(const std::string& integrator);
/// Whether it tells by which strategy light was found; throws Error for an unknown integrator.
bool has_strategies(const std::string& integrator);
/// Whether several of its strategies find a path, so that RenderOptions::heuristic matters; throws Error for an unknown
/// integrator.
bool weighs_strategies(const std::string& integrator);
/// What its fields are learned with: an integrator without light subpaths guides the camera's alone. Throws Error for
/// an unknown integrator.
LearnOptions learn_options(const RenderOptions& options);

}  // namespace ajar
