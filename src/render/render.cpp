#include "ajar/render/render.h"

#include <fmt/format.h>

#include <bit>
#include <chrono>
#include <ctime>

#include "ajar/core/error.h"
#include "ajar/core/parallel.h"
#include "ajar/field/portals.h"
#include "ajar/field/walls.h"
#include "ajar/film/fireflies.h"
#include "batch.h"
#include "chunk.h"

namespace ajar {
namespace {

struct Integrator {
  const char* name;
  Trace trace;
  bool splats;
  bool guided = false;
  Trace light_half = nullptr;  // what is traced before, of all samples of a chunk or batch
  bool merges = false;
  bool vpls = false;  // trains its fields by trace_bdpt first, if it is guided
};
constexpr Integrator integrators[] = {{"path", trace_path, false},
                                      {"bdpt", trace_bdpt, true},
                                      {"light", trace_light, true},
                                      {"guided-path", trace_bdpt, false, true},
                                      {"guided-bdpt", trace_bdpt, true, true, trace_light_half},
                                      {"vcm", trace_bdpt, true, false, trace_light_half, true},
                                      {"guided-vcm", trace_bdpt, true, true, trace_light_half, true},
                                      {"photon", trace_photon, false, false, trace_light_half, true},
                                      {"vpl", trace_vpl, true, true, trace_light_half, false, true},
                                      {"plain-vpl", trace_vpl, true, false, nullptr, false, true}};

const Integrator& find_integrator(const std::string& name) {
  for (const Integrator& i : integrators)
    if (name == i.name) return i;
  throw Error(fmt::format("--integrator {}: unknown; known are {}", name, fmt::join(integrator_names(), ", ")));
}

// Chunks traced between two merges: bounds the memory of splats and the time to the next look at the clock.
constexpr uint32_t batch_chunks = 256;

// Passes that teach fields before light vertices are placed through them.
constexpr uint32_t vpl_training = 8;

// Fewest, so that every thread finds work.
constexpr uint32_t least_chunks = 16;

Job make_job(const Scene& scene, const Accel& accel, const RenderOptions& options) {
  Job job;
  job.scene = &scene;
  job.accel = &accel;
  job.walk.max_edges = options.max_depth < 0 ? deepest : std::min(options.max_depth, deepest);
  job.walk.roulette_from = options.roulette_depth;
  job.walk.heuristic = options.heuristic;
  job.sampler = options.sampler;
  job.seed = options.seed;
  job.techniques = options.techniques;
  job.next_event = options.next_event;
  return job;
}

// Whether the target is looked at after so many passes: even numbers with at most four significant bits. Looks thin out
// as the error falls, so that few of them get the chance to be lucky, and are the same ones when a render is resumed.
bool is_checked(uint32_t passes) { return passes >= 8 && passes % std::max(2u, std::bit_floor(passes) / 8) == 0; }

// Chunks that the rest of a time budget suffices for, at the pace so far; few to begin with. How many are traced
// between two merges changes no result.
uint32_t affordable_chunks(const RenderOptions& options, const RenderState& state) {
  if (options.seconds <= 0 && options.cpu_seconds <= 0) return batch_chunks;
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

// Batches of which a pass is made when light subpaths are joined or merged: as few as the bound allows, and alike.
uint32_t equal_chunks(uint32_t all, uint32_t most) {
  const uint32_t batches = (all + most - 1) / most;
  return (all + batches - 1) / batches;
}

// Light subpaths of chunks from .. from + count - 1.
double light_paths_of(const Film& film, uint32_t from, uint32_t count, float rate) {
  double sum = 0;
  for (uint32_t chunk = from; chunk < from + count; ++chunk)
    sum += light_halves(tile_bounds(film, chunk).pixels(), rate);
  return sum;
}

// What a sample's error is (estimate_sample_error), above which an image is noisy, and below which it is quiet; share
// of the light that is caustics, which light subpaths alone find, and where they are to be twice as many as pixels.
// Measured (docs/results/joins.md).
constexpr double noisy = 0.25, quiet = 0.15, shining = 0.01, twice = 0.25;

float light_rate(const Film& film, const Ledger& ledger) {
  const double caustics = ledger.caustics / total_energy(ledger);
  if (caustics > shining) {
    const double rate = std::exp2(std::floor(std::log2(2 * caustics / twice)));
    return std::clamp(float(rate), RenderState::caustic_light, RenderState::most_light);  // (J5)
  }
  const double error = estimate_sample_error(film);
  if (error < quiet) return RenderState::least_light;
  return error < noisy ? RenderState::usual_light : RenderState::noisy_light;
}

// What joins of a guided vertex count for in the weights: about as many are made of each, where it matters (J3).
constexpr double guided_joins = 2;
// What next-event estimation counts for where the lens sees its vertex: several rays that lie evenly. (J7)
constexpr double guided_first = 2;
// Those at vertices that the lens sees, where joins have a small share of the light, and where they have all (J7).
// Beyond, all that a camera subpath finds hangs on the one walk that came there, so that many joins tell hardly more
// than one; measured (docs/results/joins.md).
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

// How many camera subpaths go on. While fields know too little for the image, as many as they say.
void balance_pass(bool plain, RenderState& state, Job& job) {
  const Film& film = state.film;
  Balance& balance = state.balance;
  const bool told =
      job.guided && job.trace == trace_bdpt && !plain && state.learning.fields.generation >= blind_generations;
  if (told && film.chunks == 0 && film.passes >= 4 && std::has_single_bit(film.passes)) rebalance(film, balance);
  if (told && balance.found.empty()) balance.found.resize(film.pixels());
  job.walk.goes_on = balance.goes_on;
  job.beyond = told ? balance.found.data() : nullptr;
}

// How many camera samples each pixel has in the pass at hand.
void adapt_pass(const RenderOptions& options, RenderState& state, Job& job) {
  const Film& film = state.film;
  Adaptive& adaptive = state.adaptive;
  const bool told = job.guided && !options.even && !in_training(state.learning) &&
                    state.learning.fields.generation >= blind_generations;
  job.adaptive = told ? &adaptive : nullptr;
  if (!told) return;
  if (adaptive.spread.empty()) {
    adaptive.spread.resize(film.pixels());
    adaptive.first = film.dropped + (film.passes + 1) / 2 * 2;
  } else if (film.chunks == 0 && film.passes >= 4 && std::has_single_bit(film.passes)) {
    allot(film, adaptive);
  }
}

// How many light subpaths are traced in the pass at hand, and how much their joins may cost. Where camera vertices
// choose among those of many tiles, a few are as good as many. While fields know little, all of them teach; a photon
// map has use for all.
void plan_pass(bool joined, bool plain, RenderState& state, Job& job) {
  const Film& film = state.film;
  const bool looks = !plain && film.chunks == 0 && std::has_single_bit(film.passes);
  if (joined && looks && film.passes >= 8) state.light_rate = light_rate(film, state.stats.ledger);
  if (const float effort = looks ? effort_for(state.stats.ledger) : 0; effort > 0) state.effort = effort;
  job.effort = state.effort;
  if (job.guided && job.light_half)
    job.walk.seen_share = std::max(most_seen_joins * sqr(double(state.effort)), least_seen_joins);
  const bool knows = joined && !plain && state.learning.fields.generation >= blind_generations;
  job.light_rate = knows ? state.light_rate : 1;
  job.walk.light_paths = film.splats ? light_paths_of(film, 0, chunk_count(film), job.light_rate) : 0;
}

// What merges beyond the first vertex at which a camera subpath is merged count for (K3). They share the walk that
// found it, so that many of them tell hardly more than one; measured (docs/results/merging.md).
constexpr double merge_inner = 0.01;

// Largest radius, of the scene's: what is far from the eye must not be merged across rooms.
constexpr float most_of_scene = 0.02f;

// Radii of the pass that the film is at: areas shrink with the cube root of the passes, so that bias and variance both
// vanish (Knaus and Zwicker 2011, alpha = 2/3).
Merging merging_of(const Scene& scene, const RenderOptions& options, const Film& film, uint32_t chunks) {
  const Camera& camera = scene.camera;
  const uint32_t count = std::min(chunks, chunk_count(film) - film.chunks);
  const float pixels = options.merge_radius * std::pow(float(film.passes + 1), -1.0f / 6);
  Merging m;
  m.paths = light_paths_of(film, film.chunks, count, 1);
  m.inner = merge_inner;
  const CameraRay ray = generate(camera, Vec2(camera.width, camera.height) * 0.5f, Vec2(0.5f));
  m.eye = ray.o;
  const float pixel = 1 / std::sqrt(raster_factor(camera, ray.o, ray.o + ray.d));
  m.most = most_of_scene * scene.radius;
  if (camera.kind == CameraKind::orthographic)
    m.least = m.most = std::min(pixels * pixel, m.most);
  else
    m.per_distance = std::min(pixels * pixel, steepest_radius);
  return m;
}

void note_rejected(RenderStats& stats, const std::vector<uint64_t>& pixels, const Film& film, uint64_t seed) {
  for (const uint64_t path : pixels)
    if (path != Scratch::no_path && stats.replay.size() < 5) {
      const uint64_t p = path % film.pixels(), width = uint64_t(film.width);
      stats.replay.push_back(
          fmt::format("pixel {},{} pass {} seed {}", p % width, p / width, film.dropped + film.passes, seed));
    }
}

// What was traced does not count: it is in no image, or was counted before.
void forget_counts(std::vector<Scratch>& scratches) {
  for (Scratch& s : scratches) s.counters = {}, s.rejected = 0;
}

// The job of a pass that joins virtual point lights, which it places.
Job with_vpls(Job job, const Film& film, std::vector<Scratch>& scratches, Vpls& vpls) {
  job.vpls = &vpls;
  job.light_half = nullptr;
  job.walk.light_paths = vpls.paths,
  job.walk.inner_share = job.walk.seen_share = 0;  // the other weights are of s = 0, s = 1 and t = 1 alone
  vpls.camera = job.walk;
  vpls.camera.fields = nullptr;
  const uint32_t pass = film.dropped + film.passes;
  if (vpls.pass == Vpls{}.pass && job.guided) {
    measure_lights(job, scratches, vpls);
    forget_counts(scratches);
  }
  if (vpls.pass != pass) {
    place_vpls(job, pass, scratches, vpls);
    if (film.chunks > 0) forget_counts(scratches);  // a pass that is gone on with
  }
  vpls.pass = pass;
  return job;
}

void teach(const Scene& scene, RenderState& state, const RenderOptions& options) {
  const double wall = wall_seconds(), cpu = process_cpu_seconds();
  const uint32_t dropped = state.film.dropped;
  end_pass(scene, state.learning, learn_options(options), state.film);
  if (state.film.dropped != dropped) state.pyramid.layers.clear(), state.stats.ledger = {};
  state.stats.learn_seconds += wall_seconds() - wall;
  state.stats.learn_cpu_seconds += process_cpu_seconds() - cpu;
}

// Throws Error where a state was not started for this scene and these options.
void check_state(const Scene& scene, const RenderOptions& options, const RenderState& state) {
  const Integrator& integrator = find_integrator(options.integrator);
  const Camera& c = scene.camera;
  const Film& f = state.film;
  if (f.width != c.crop_width || f.height != c.crop_height || f.x0 != c.crop_x || f.y0 != c.crop_y)
    throw Error(fmt::format(
        "render: the film is of {}x{} pixels from {},{} on, the camera's are {}x{} from {},{} on; start_render makes a "
        "state for each size",
        f.width, f.height, f.x0, f.y0, c.crop_width, c.crop_height, c.crop_x, c.crop_y));
  if (f.splats != integrator.splats)
    throw Error(fmt::format(
        "render: the film takes {} light subpaths, and {} {}; start_render makes a state for each integrator",
        f.splats ? "what comes by" : "nothing of", options.integrator,
        integrator.splats ? "brings it by them" : "brings none"));
  if (learns(options) && state.learning.fields.starts.cuts.empty())
    throw Error(fmt::format("render: {} learns, and the state has no fields; start_render makes one with these options",
                            options.integrator));
  if (!options.next_event && (integrator.splats || integrator.light_half))
    throw Error(
        fmt::format("render: {} needs next-event estimation; leave next_event true, or take path or guided-path",
                    options.integrator));
}

}  // namespace

std::vector<std::string> integrator_names() {
  std::vector<std::string> names;
  for (const Integrator& i : integrators) names.emplace_back(i.name);
  return names;
}

bool is_guided(const std::string& integrator) { return find_integrator(integrator).guided; }

bool may_leave_out(const RenderOptions& o) {
  const Integrator& integrator = find_integrator(o.integrator);
  const LearnOptions usual;
  const bool as_usual = o.learn.train == 0 && o.learn.guided == usual.guided && o.learn.rule == usual.rule &&
                        o.learn.structure == usual.structure && o.learn.forget == usual.forget;
  return o.leaves_out && integrator.guided && !integrator.vpls && !o.techniques && as_usual;
}

bool learns(const RenderOptions& options) { return is_guided(options.integrator) || options.learn_lights; }
bool is_merging(const std::string& integrator) { return find_integrator(integrator).merges; }
bool has_strategies(const std::string& integrator) {
  const Trace trace = find_integrator(integrator).trace;
  return trace != trace_path && trace != trace_light;
}
bool weighs_strategies(const std::string& integrator) {
  const Trace trace = find_integrator(integrator).trace;
  return trace != trace_light && trace != trace_photon;
}

// Where no light vertices are joined, which bring what a cosine lobe finds badly: strata that could halve its variance
// guide (G14).
constexpr float alone_contrast = 2;

LearnOptions learn_options(const RenderOptions& options) {
  LearnOptions o = options.learn;
  const Integrator& integrator = find_integrator(options.integrator);
  if (!integrator.guided)
    o.guided = Guided::neither;
  else if (!integrator.splats)
    o.guided = Guided::camera, o.least_contrast = std::min(o.least_contrast, alone_contrast);
  else if (integrator.vpls)
    o.guided = Guided::light;  // walks are short, and the price of a guide is not
  return o;
}

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double process_cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

bool is_over(const RenderOptions& options, const RenderStats& stats, double share) {
  return (options.seconds > 0 && stats.seconds >= share * options.seconds) ||
         (options.cpu_seconds > 0 && stats.cpu_seconds >= share * options.cpu_seconds);
}

RenderState start_render(const Scene& scene, const RenderOptions& options) {
  RenderState state;
  const Integrator& integrator = find_integrator(options.integrator);
  state.film = make_film(scene.camera, scene.filter, integrator.splats);
  if (options.limit_fireflies) limit_fireflies(state.film);
  state.pyramid.kept = options.techniques;
  if (!learns(options)) return state;
  LearnOptions learn = options.learn;
  if (integrator.vpls && learn.train == 0) learn.train = vpl_training;
  state.learning = start_learning(scene, state.film, learn);
  return state;
}

void render(const Scene& scene, const Accel& accel, const RenderOptions& options, RenderState& state,
            const Monitor& monitor) {
  check_state(scene, options, state);
  const Integrator& integrator = find_integrator(options.integrator);
  Film& film = state.film;
  RenderStats& stats = state.stats;
  Job job = make_job(scene, accel, options);
  job.trace = integrator.trace, job.light_half = integrator.light_half;
  job.merges_alone = integrator.trace == trace_photon;
  if (job.merges_alone) job.final_gather = options.final_gather;
  if (learns(options)) {
    job.learning = &state.learning, job.training = &state.learning.training;
    job.walk.fields = &state.learning.fields;
  }
  if (is_guided(options.integrator)) {
    job.guided = true;
    job.walk.inner_share = film.splats ? guided_joins : 0;
    job.walk.seen_share = job.walk.inner_share;  // more where they choose among many, see plan_pass
    job.walk.first_seen = guided_first;
  }
  const bool leaving_out = may_leave_out(options);
  if (!leaving_out) state.plain.with_merging = {};
  double wall0 = 0, cpu0 = 0;
  const auto start_clocks = [&] {
    wall0 = wall_seconds() - stats.seconds;
    cpu0 = process_cpu_seconds() - stats.cpu_seconds;
  };
  const auto read_clocks = [&] {
    stats.seconds = wall_seconds() - wall0;
    stats.cpu_seconds = process_cpu_seconds() - cpu0;
  };
  start_clocks();
  const uint32_t most = most_passes(options);
  Threads threads(options.threads);
  std::vector<Scratch> scratches(size_t(threads.count()));
  Fields& fields = state.learning.fields;
  if (job.learning && fields.structure == Structure::adaptive && fields.table.compartments.empty())
    threads.run([&] { cut_along_walls(scene, accel, fields.table); });
  if (job.learning && add_portals(fields)) state.learning.training = start_training(fields);
  Batch batch;
  Vpls vpls;
  if (integrator.vpls) vpls = make_vpls(scene, film, integrator.guided);
  const uint32_t all = chunk_count(film);
  const auto out_of_budget = [&] {
    read_clocks();
    if (in_training(state.learning) || film.passes == 0) return false;  // no image yet
    if (most > 0 && film.passes >= most) return true;
    if (options.noise > 0) {
      double error = infinity;
      if (film.chunks == 0 && is_checked(film.passes)) threads.run([&] { error = estimated_error(film); });
      if (error <= options.noise) return true;
    }
    return share_of(job, film) == 1 && is_over(options, stats, 1);  // no pass of a few pixels is left over
  };
  while (!out_of_budget()) {
    const uint32_t from = film.chunks;
    if (leaving_out && state.learning.fields.generation >= blind_generations)
      threads.run([&] { try_plain(job, options, scratches, state); });
    const bool plain = leaving_out && state.plain.taken;
    const bool merges = merges_still(options, state.plain);
    const bool joined = integrator.guided && integrator.light_half && !merges && !integrator.vpls;
    job.walk.merging = merges && !plain ? merging_of(scene, options, film, equal_chunks(all, batch_chunks)) : Merging{};
    job.walk.merging.paths /= share_of(job, film);
    threads.run([&] {
      plan_pass(joined, plain, state, job);
      balance_pass(plain, state, job);
      adapt_pass(options, state, job);
    });
    const bool joins_vpls = integrator.vpls && !in_training(state.learning);
    const bool in_halves = integrator.light_half && !plain && !joins_vpls;
    const uint32_t most_at_once =
        in_halves ? equal_chunks(all, merges ? batch_chunks : pool_chunks) : affordable_chunks(options, state);
    const uint32_t count = std::min({batch_chunks, all - from, most_at_once});
    start(batch, count, in_halves);
    const Trace trace = integrator.vpls && !joins_vpls ? trace_bdpt : integrator.trace;
    threads.run([&] {
      Job job_now = joins_vpls ? with_vpls(job, film, scratches, vpls) : job;
      job_now.trace = trace;
      if (plain) job_now = plainly(job_now);
      if (joins_vpls) std::copy_n(vpls.splats.begin() + from, count, batch.splats.begin());
      if (in_halves)
        trace_in_halves(job_now, film, from, batch, scratches);
      else
        trace_whole(job_now, film, from, batch, scratches);
      if (film.splats) merge(film, batch.splats);
      if (job.techniques) merge(state.pyramid, film, batch.strategies);
      for (const Ledger& ledger : batch.ledgers) stats.ledger += ledger;
      note_rejected(stats, batch.rejected_at, film, options.seed);
      film.chunks += count;
      if (film.chunks == all) finish_pass(film);
    });
    for (Scratch& s : scratches) {
      gather(state.learning.sightings, s.sightings);
      stats.counters += s.counters;
      if (job.beyond) state.balance.work += s.counters;
      stats.rejected += s.rejected;
      s.counters = {};
      s.rejected = 0;
    }
    if (film.chunks == 0 && job.beyond) ++state.balance.passes;
    if (film.chunks == 0 && job.adaptive) ++state.adaptive.passes;
    if (job.learning && !plain && film.chunks == 0) threads.run([&] { teach(scene, state, options); });
    // Who watches, measuring errors perhaps, does so on his own time.
    read_clocks();
    const bool go_on = !monitor || monitor(state);
    start_clocks();
    if (!go_on) break;
  }
  read_clocks();
}

}  // namespace ajar
