#include "ajar/render/render.h"

#include <fmt/format.h>

#include <bit>

#include "ajar/core/error.h"
#include "ajar/core/parallel.h"
#include "ajar/field/portals.h"
#include "ajar/field/walls.h"
#include "batch.h"
#include "chunk.h"
#include "integrators.h"
#include "pass.h"
#include "place.h"
#include "start.h"
#include "takeover.h"

namespace ajar {
namespace {

// Of a time limit: what passes that only train may take.
constexpr double training_share = 0.5;

// What threads trace with, kept from batch to batch.
struct Workshop {
  std::vector<Scratch> scratches;
  Batch batch;
  Vpls vpls;
};

// Whether the target is looked at after so many passes: even numbers with at most four significant bits. Looks thin out
// as the error falls, so that few of them get the chance to be lucky, and are the same ones when a render is resumed.
bool is_checked(uint32_t passes) { return passes >= 8 && passes % std::max(2u, std::bit_floor(passes) / 8) == 0; }

bool is_quiet(const RenderOptions& options, const Film& film) {
  return options.noise > 0 && film.chunks == 0 && is_checked(film.passes) && estimated_error(film) <= options.noise;
}

// Black has no relative error, so that no target for it is ever reached.
bool stays_black(const RenderOptions& options, const Scene& scene, const Film& film) {
  const uint32_t passes = scene.lights.empty() ? 8 : 1024;
  return ends_by_noise(options) && film.chunks == 0 && film.passes >= passes && is_black(film);
}

bool is_finished(const RenderOptions& options, const Job& job, const RenderState& state) {
  const Film& film = state.film;
  if (in_training(state.learning) || film.passes == 0) return false;  // no image yet
  if (const uint32_t most = most_passes(options); most > 0 && film.passes >= most) return true;
  // No pass of a few pixels is left over.
  return is_quiet(options, film) || stays_black(options, *job.scene, film) ||
         (traced_one_in(job, film) == 1 && is_over(options, state.stats, 1));
}

// What fields know of the scene before anything is traced.
void prepare_fields(const Scene& scene, const Accel& accel, Learning& learning) {
  Fields& fields = learning.fields;
  if (fields.structure == Structure::adaptive && fields.table.compartments.empty())
    cut_along_walls(scene, accel, fields.table);
  if (add_portals(fields)) learning.training = start_training(fields);
}

void trace(Pass& pass, Film& film, Workshop& shop) {
  const uint32_t from = film.chunks;
  start(shop.batch, pass.chunks, pass.job.light_half != nullptr);
  if (pass.job.vpls) {
    place_vpls(pass.job, film, shop.scratches);
    std::copy_n(shop.vpls.splats.begin() + from, pass.chunks, shop.batch.splats.begin());
  }
  if (pass.job.light_half)
    trace_in_halves(pass.job, film, from, shop.batch, shop.scratches);
  else
    trace_whole(pass.job, film, from, shop.batch, shop.scratches);
}

void note_rejected(RenderStats& stats, const std::vector<uint64_t>& pixels, const Film& film, uint64_t seed) {
  for (const uint64_t path : pixels)
    if (path != Scratch::no_path && stats.replay.size() < 5) {
      const uint64_t p = path % film.pixels(), width = uint64_t(film.width);
      stats.replay.push_back(
          fmt::format("pixel {},{} pass {} seed {}", p % width, p / width, film.dropped + film.passes, seed));
    }
}

// The same of what is traced for all pixels, once.
void note_rejected(RenderStats& stats, Vpls& vpls, uint64_t seed) {
  if (vpls.rejected_at == none || stats.replay.size() >= 5) return;
  stats.replay.push_back(fmt::format("light subpath {} pass {} seed {}", vpls.rejected_at, *vpls.pass, seed));
  vpls.rejected_at = none;
}

// What the batch found goes to the film and to the sums, tile by tile.
void take_in(const Pass& pass, const Batch& batch, RenderState& state) {
  Film& film = state.film;
  if (film.splats) merge(film, batch.splats);
  if (pass.job.techniques) merge(state.pyramid, film, batch.strategies);
  for (const Ledger& ledger : batch.ledgers) {
    state.stats.ledger += ledger;
    state.stats.ticks.all += total_ticks(ledger), state.stats.ticks.learn += ledger.learn_ticks;
  }
  note_rejected(state.stats, batch.rejected_at, film, pass.job.seed);
  film.chunks += pass.chunks;
}

// What the threads counted meanwhile.
void take_counts(const Job& job, std::vector<Scratch>& scratches, RenderState& state) {
  for (Scratch& s : scratches) {
    gather(state.learning.sightings, s.sightings);
    state.stats.counters += s.counters;
    if (job.beyond) state.balance.work += s.counters;
    state.stats.rejected += s.rejected;
    s.counters = {}, s.rejected = 0;
  }
}

void teach(const Scene& scene, const RenderOptions& options, float light_rate, RenderState& state) {
  Stopwatch watch;
  const uint32_t dropped = state.film.dropped;
  end_pass(scene, state.learning, learn_options(options), light_rate, state.film);
  if (state.film.dropped != dropped) state.pyramid.layers.clear(), state.stats.ledger = {};
  watch.add_to(state.stats.learn_seconds, state.stats.learn_cpu_seconds);
}

// What a pass counts for: its camera samples of a pixel, in the mean. Images of strategies take all passes alike.
double weight_of(const Job& job) { return job.adaptive && !job.techniques ? mean_count(*job.adaptive) : 1; }

// The next chunks of the pass at hand, and what follows it if it is over.
void trace_next(const Job& job, const RenderOptions& options, Workshop& shop, RenderState& state) {
  Film& film = state.film;
  try_plain(job, options, shop.scratches, state);
  Pass pass = plan_pass(job, options, state);
  trace(pass, film, shop);
  take_in(pass, shop.batch, state);
  note_rejected(state.stats, shop.vpls, pass.job.seed);
  take_counts(pass.job, shop.scratches, state);
  if (film.chunks < chunk_count(film)) return;
  if (pass.job.adaptive) note_pass(film, state.adaptive);
  finish_pass(film, weight_of(pass.job));
  if (pass.job.beyond) ++state.balance.passes;
  if (job.learning && !pass.plain) teach(*job.scene, options, pass.job.light_rate, state);
}

}  // namespace

void render(const Scene& scene, const Accel& accel, const RenderOptions& options, RenderState& state,
            const Monitor& monitor) {
  check_state(scene, options, state);
  if (!accel.fits(scene))
    throw Error(
        "render: the accelerator is of another scene, or of this one before it changed; make one of this scene");
  if (!may_leave_out(options)) state.plain.with_merging = {};
  Stopwatch watch;
  const auto read_clock = [&] { watch.add_to(state.stats.seconds, state.stats.cpu_seconds); };
  Threads threads(options.threads);
  Workshop shop;
  shop.scratches.resize(size_t(threads.count()));
  Job job = make_job(scene, accel, options, state);
  if (find_integrator(options.integrator).vpls)
    shop.vpls = make_vpls(scene, state.film, job.guided), job.vpls = &shop.vpls;
  if (job.learning) threads.run([&] { prepare_fields(scene, accel, state.learning); });
  read_clock();
  bool goes_on = true;
  while (goes_on) {
    threads.run([&] {
      goes_on = !is_finished(options, job, state);
      if (goes_on) trace_next(job, options, shop, state);
    });
    read_clock();
    if (is_over(options, state.stats, training_share)) end_training(state.learning);
    goes_on = goes_on && (!monitor || monitor(state));
    watch = {};  // who watches, measuring errors perhaps, does so on his own time
  }
}

}  // namespace ajar
