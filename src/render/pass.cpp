#include "pass.h"

#include <bit>

#include "chunk.h"
#include "integrators.h"
#include "place.h"
#include "takeover.h"

namespace ajar {
namespace {

// Chunks traced between two merges: bounds the memory of splats and the time to the next look at the clock.
constexpr uint32_t batch_chunks = 256;

// Fewest, so that every thread finds work.
constexpr uint32_t least_chunks = 16;

// Chunks that the rest of a time budget suffices for, at the pace so far; few to begin with. How many are traced
// between two merges changes no result.
uint32_t affordable_chunks(const RenderOptions& options, const RenderState& state) {
  if (!has_time_limit(options)) return batch_chunks;
  const double done = double(state.film.passes) * chunk_count(state.film) + state.film.chunks;
  double affordable = done > 0 ? batch_chunks : least_chunks;
  const auto limit = [&](double budget, double used) {
    if (budget > 0 && used > 0) affordable = std::min(affordable, (budget - used) / used * done);
  };
  limit(options.seconds, state.stats.seconds);
  limit(options.cpu_seconds, state.stats.cpu_seconds);
  return std::max(uint32_t(std::max(affordable, 0.0)), least_chunks);
}

// Chunks whose light vertices are joined: enough for many threads, and few enough to end when the time is over.
constexpr uint32_t pool_chunks = 128;

// Chunks of a batch whose light subpaths are joined or merged: as few batches of a pass as the bound allows, and alike.
uint32_t equal_chunks(const Film& film, uint32_t most) {
  const uint32_t all = chunk_count(film), batches = (all + most - 1) / most;
  return (all + batches - 1) / batches;
}

// Light subpaths of chunks from .. from + count - 1.
double light_paths_of(const Film& film, uint32_t from, uint32_t count, float rate) {
  double sum = 0;
  for (uint32_t chunk = from; chunk < from + count; ++chunk)
    sum += double(light_halves(tile_bounds(film, chunk).pixels(), rate));
  return sum;
}

// What a sample's error is (estimate_sample_error), above which an image is noisy, and below which it is quiet; share
// of the light that is caustics, which light subpaths alone find, and where they are to be twice as many as pixels.
// Measured (docs/results/joins.md).
constexpr double noisy = 0.25, quiet = 0.15, shining = 0.01, twice = 0.25;

// What merges has half as many light subpaths as pixels, as many where caustics shine (docs/results/merging.md).
float light_rate(const Film& film, const Ledger& ledger, bool merges) {
  const double caustics = ledger.caustics / total_energy(ledger);
  if (merges) return caustics > shining ? RenderState::caustic_light : RenderState::noisy_light;
  if (caustics > shining) {
    const double rate = std::exp2(std::floor(std::log2(2 * caustics / twice)));
    return std::clamp(float(rate), RenderState::caustic_light, RenderState::most_light);  // (J5)
  }
  const double error = estimate_sample_error(film);
  if (error < quiet) return RenderState::least_light;
  return error < noisy ? RenderState::usual_light : RenderState::noisy_light;
}

// What joins of a guided vertex that the lens sees count for in the weights, where joins have a small share of the
// light, and where they have all (J7). Beyond, all that a camera subpath finds hangs on the one walk that came there,
// so that many joins tell hardly more than one; measured (docs/results/joins.md).
constexpr double least_seen_joins = 16, most_seen_joins = 1000;

// What is spent on joins: by the share of the image's light that they and merges bring. The root, since the error of
// what they bring falls with what is spent; measured (docs/results/joins.md).
float effort_for(const Ledger& ledger) {
  double joined = 0;
  for (int s = 2; s <= Ledger::most; ++s)
    for (int t = 2; t <= Ledger::most; ++t) joined += ledger.strategies[s][t].energy + ledger.merges[s][t].energy;
  const double all = total_energy(ledger);
  return all > 0 && all < infinity ? std::clamp(float(std::sqrt(joined / all)), RenderState::least_effort, 1.0f)
                                   : 0;  // (J8)
}

// Whether passes are looked at before the next one: after so many, and whenever there are twice as many.
bool is_due(const Film& film, uint32_t first) {
  return film.chunks == 0 && film.passes >= first && std::has_single_bit(film.passes);
}

// How many light subpaths are traced, and how much their joins may cost. Where camera vertices choose among those of
// many tiles, a few are as good as many. While fields know little, all of them teach.
void plan_light(bool merges, RenderState& state, Pass& pass) {
  const Film& film = state.film;
  Job& job = pass.job;
  const bool chosen = job.guided && job.light_half && !job.vpls;
  const bool looks = !pass.plain && is_due(film, 1);
  if (chosen && looks && film.passes >= 8) state.light_rate = light_rate(film, state.stats.ledger, merges);
  if (const float effort = looks ? effort_for(state.stats.ledger) : 0; effort > 0) state.effort = effort;
  job.effort = state.effort;
  if (job.guided && job.light_half)
    job.walk.counts.seen = std::max(most_seen_joins * sqr(double(state.effort)), least_seen_joins);
  job.light_rate = chosen && !pass.plain && knows_enough(state.learning) ? state.light_rate : 1;
  job.walk.counts.light_paths = film.splats ? light_paths_of(film, 0, chunk_count(film), job.light_rate) : 0;
}

// How many camera subpaths go on. While fields know too little for the image, as many as they say.
void balance_pass(RenderState& state, Pass& pass) {
  const Film& film = state.film;
  Balance& balance = state.balance;
  const bool told = pass.job.guided && !pass.job.vpls && !pass.plain && knows_enough(state.learning);
  if (told && is_due(film, 4)) rebalance(film, balance);
  if (told && balance.found.empty()) balance.found.resize(film.pixels());
  pass.job.walk.goes_on = balance.goes_on;
  pass.job.beyond = told ? balance.found.data() : nullptr;
}

// How many camera samples each pixel has.
void adapt_pass(const RenderOptions& options, RenderState& state, Pass& pass) {
  const Film& film = state.film;
  Adaptive& adaptive = state.adaptive;
  if (!pass.job.guided || options.even || in_training(state.learning) || !knows_enough(state.learning)) return;
  pass.job.adaptive = &adaptive;
  if (adaptive.spread.empty()) {
    adaptive.spread.resize(film.pixels());
    adaptive.first = film.dropped + (film.passes + 1) / 2 * 2;
  } else if (is_due(film, 4)) {
    allot(film, adaptive);
  }
}

// What merges beyond the first vertex at which a camera subpath is merged count for (K3). They share the walk that
// found it, so that many of them tell hardly more than one; measured (docs/results/merging.md).
constexpr double merge_inner = 0.01;

// Largest radius, of the scene's: what is far from the eye must not be merged across rooms.
constexpr float most_of_scene = 0.02f;

// Radii of the pass that the film is at: areas shrink with the cube root of the passes, so that bias and variance both
// vanish (Knaus and Zwicker 2011, alpha = 2/3).
Merging merging_of(const Job& job, float radius, const Film& film) {
  const Camera& camera = job.scene->camera;
  const uint32_t count = std::min(equal_chunks(film, batch_chunks), chunk_count(film) - film.chunks);
  const float pixels = radius * std::pow(float(film.passes + 1), -1.0f / 6);
  Merging m;
  m.paths = light_paths_of(film, film.chunks, count, job.light_rate);
  m.paths /= traced_one_in(job, film);
  const CameraRay ray = generate(camera, Vec2(camera.width, camera.height) * 0.5f, Vec2(0.5f));
  m.eye = ray.o;
  const float pixel = 1 / std::sqrt(raster_factor(camera, Vec3(0), ray.d));
  m.most = most_of_scene * job.scene->radius;
  if (camera.kind == CameraKind::orthographic)
    m.least = m.most = std::min(pixels * pixel, m.most);
  else
    m.per_distance = std::min(pixels * pixel, steepest_radius);
  return m;
}

// Virtual point lights are placed through fields; while those are still trained, there are none.
void plan_vpls(const RenderState& state, Job& job) {
  if (in_training(state.learning)) {
    job.trace = trace_bdpt, job.vpls = nullptr;
    return;
  }
  job.light_half = nullptr;
  job.walk.counts.light_paths = job.vpls->paths;
  job.walk.counts.inner = job.walk.counts.seen = 0;  // the other weights are of s = 0, s = 1 and t = 1 alone
}

}  // namespace

Pass plan_pass(const Job& job, const RenderOptions& options, RenderState& state) {
  const Film& film = state.film;
  const bool merges = merges_still(options, state.plain);
  Pass pass{job, may_leave_out(options) && state.plain.taken};
  plan_light(merges, state, pass);
  balance_pass(state, pass);
  adapt_pass(options, state, pass);
  if (merges) {
    pass.job.walk.merging = merging_of(pass.job, options.merge_radius, film);
    pass.job.walk.counts.merge_inner = merge_inner;
  }
  if (job.vpls) plan_vpls(state, pass.job);
  if (pass.plain) pass.job = plainly(pass.job);
  pass.chunks = pass.job.light_half ? equal_chunks(film, merges ? batch_chunks : pool_chunks)
                                    : std::min(affordable_chunks(options, state), batch_chunks);
  pass.chunks = std::min(pass.chunks, chunk_count(film) - film.chunks);
  return pass;
}

}  // namespace ajar
