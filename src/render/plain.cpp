#include "ajar/render/plain.h"

#include <algorithm>
#include <bit>

#include "ajar/core/parallel.h"
#include "ajar/render/render.h"
#include "chunk.h"
#include "integrators.h"
#include "job.h"
#include "takeover.h"

namespace ajar {
namespace {

constexpr uint32_t first_look = 4, last_look = 64;  // passes
constexpr uint32_t least_squares = 32, most_squares = 128;
constexpr double fastest = 16;  // of path tracing: passes for one of the guided integrator
// Quotients below which path tracing takes over: what guides errs a little less with every pass to come, and a first
// look misses what is rare.
double little(uint32_t passes) { return passes == first_look ? 0.25 : 0.8; }
// Quotients above which it is not looked at again, after so many passes: what guides errs less with every pass.
double too_much(uint32_t passes) { return passes == first_look ? 8 : passes < 16 ? 2 : passes < 32 ? 1.4 : 1.1; }
// Factor on the error of what merges: blur within squares is not seen. By errors against references
// (docs/results/plan.md).
constexpr double blur = 1.5;
// relMSE of a sample. Above, samples are so uneven that a few thousand pixels do not tell their error, and path tracing
// is not what the scene needs.
constexpr double tame = 1.5, wild = 4;
// Once path tracing took over, above this it gives the render back, until there are so many times the passes.
constexpr double turned_wild = 3;
constexpr uint32_t doubted = 64;
// Share of a time limit, after which there is no time to begin an image anew.
constexpr double late = 1.0 / 3;
// Passes, at most, by which what it missed then counts: where the guided image is too bright by chance, it stays so.
constexpr double rarest = 32;

// CPU time of a ray with all that hangs on it [us], about: benchmarks/ray_cost.sh; that of photon maps of images larger
// than those (docs/results/plan.md). Costs are reckoned from it, so that what is decided does not depend on the clock.
constexpr double path_ray = 0.25;
double ray_cost(bool merges) { return merges ? 0.75 : 0.39; }

uint64_t ray_count(const Counters& n) { return n.camera_rays + n.light_rays + n.shadow_rays; }

uint32_t square_count(const Film& film) {
  return uint32_t(film.width / plain_side) * uint32_t(film.height / plain_side);
}

// First pixel of each of some squares, spread over the film.
std::vector<uint32_t> spread_squares(const Film& film, uint32_t count) {
  const uint32_t across = uint32_t(film.width / plain_side), all = square_count(film);
  std::vector<uint32_t> out;
  for (uint32_t k = 0; k < count; ++k) {
    const uint32_t i = uint32_t((uint64_t(k) * 2 + 1) * all / (2 * count));
    out.push_back((i / across * uint32_t(film.width) + i % across) * plain_side);
  }
  return out;
}

std::vector<uint32_t> squares_to_look_at(const Film& film) {
  const uint32_t all = square_count(film), count = std::clamp(all / 16, least_squares, most_squares);
  return spread_squares(film, std::min(count, all));
}

// Whether path tracing is looked at before the next pass.
bool is_look_due(const Film& film, const Plain& plain) {
  const bool due = std::has_single_bit(film.passes) && film.passes >= first_look && film.passes <= last_look;
  return due && !plain.settled && film.chunks == 0 && plain.passes != film.passes;
}

uint32_t pixel_of(const Film& film, uint32_t first, uint32_t k) {
  return first + k / plain_side * uint32_t(film.width) + k % plain_side;
}

// Path tracing of the passes that are not there yet.
void trace_to(uint32_t passes, const Job& job, const Film& film, const std::vector<uint32_t>& squares,
              std::vector<Scratch>& scratches, Plain& plain) {
  Film at = frame_of(film);  // the numbers of a pass, without an image
  at.dropped = film.dropped;
  std::vector<Splat> no_splats;
  std::vector<Ledger> ledgers(scratches.size());
  for (size_t i = 0; i < scratches.size(); ++i) {
    scratches[i].splats = &no_splats, scratches[i].strategies = nullptr;
    scratches[i].ledger = &ledgers[i];
  }
  plain.seen.sum.resize(squares.size() * plain_pixels), plain.seen.half.resize(squares.size() * plain_pixels);
  for (at.passes = plain.seen.passes; at.passes < passes; ++at.passes)
    parallel_for(uint32_t(squares.size()), [&](uint32_t i) {
      for (uint32_t k = 0; k < plain_pixels; ++k) {
        const Rgb value = trace_alone(job, at, pixel_of(film, squares[i], k), scratches[thread_slot()]);
        plain.seen.sum[i * plain_pixels + k] += value;
        if (at.passes % 2 == 0) plain.seen.half[i * plain_pixels + k] += value;
      }
    });
  plain.seen.passes = at.passes;
  for (Scratch& s : scratches) {
    plain.rays += ray_count(s.counters);
    s.counters = {}, s.rejected = 0;
    s.splats = nullptr, s.ledger = nullptr;
  }
}

// Path tracing of some squares for as long as the guided integrator took, about.
void trace_as_long(const Job& job, const std::vector<uint32_t>& squares, bool merges, std::vector<Scratch>& scratches,
                   RenderState& state) {
  Plain& plain = state.plain;
  const Film& film = state.film;
  Job without = plainly(job);
  without.seed = hash(job.seed, 0x91a1);  // what one looks at is in no image
  trace_to(film.passes, without, film, squares, scratches, plain);
  const Counters& n = state.stats.counters;
  const double cost =
      ray_cost(merges) * double(ray_count(n)) / double(n.camera_paths) * samples_of_pass(film, state.adaptive);
  const double samples = double(plain.seen.passes) * double(plain.seen.sum.size());
  const double pace = std::clamp(cost * samples / (path_ray * double(plain.rays)), 1.0, fastest);
  trace_to(uint32_t(pace * film.passes / 2) * 2, without, film, squares, scratches, plain);
}

PassHalves halves_of(const Film& film, const std::vector<uint32_t>& squares) {
  PassHalves out;
  out.passes = film.passes;
  for (const uint32_t first : squares)
    for (uint32_t k = 0; k < plain_pixels; ++k) {
      const size_t i = pixel_of(film, first, k);
      out.sum.push_back(film.camera_sum[i] + (film.splats ? film.splat_sum[i] : glm::dvec3(0)));
      out.half.push_back(film.half_sum[i]);
    }
  return out;
}

// From path tracing's error, its deviation, and the guided integrator's. A single firefly may be all that there is to
// see in a first look: then there is a second one.
void decide(double error, double deviation, double guided, double samples, uint32_t passes, Plain& plain) {
  const bool first = passes == first_look;
  const double most = error + 2 * deviation, least = first ? error - 2 * deviation : most;
  plain.passes = passes, plain.pace = samples / passes;
  plain.guided_error = guided * passes, plain.plain_error = error * samples;
  plain.ratio = guided > 0 ? most / guided : 0;
  plain.taken = plain.ratio > 0 && plain.ratio < little(passes) && most * samples < tame;
  plain.settled = plain.taken || passes == last_look || least > too_much(passes) * guided || least * samples > wild;
}

// The same from what a look saw.
void judge(const PlainLook& look, bool merges, uint32_t passes, Plain& plain) {
  const double samples = plain.seen.passes, guided = merges ? blur * (look.guided + look.bias) : look.guided;
  // Twice the samples would have shown what was missed before.
  plain.missed = std::max(missed_by_plain(look, merges) * samples, 0.5 * plain.missed);
  decide(look.plain + plain.missed / samples, look.deviation, guided, samples, passes, plain);
}

// Those of a film since it was as another one.
PassHalves halves_since(const Film& film, const Film& before, const std::vector<uint32_t>& squares) {
  PassHalves out = halves_of(film, squares);
  const PassHalves old = halves_of(before, squares);
  out.passes -= old.passes;
  for (size_t i = 0; i < out.sum.size(); ++i) {
    out.sum[i] = sum_since(all_passes(film), all_passes(before), out.sum[i], old.sum[i]);
    out.half[i] = sum_since(even_passes(film), even_passes(before), out.half[i], old.half[i]);
  }
  return out;
}

SetAside set_aside(const RenderState& state) { return {state.film, state.stats.ledger}; }

void put_back(SetAside& image, RenderState& state) {
  state.film = std::move(image.film), state.stats.ledger = image.ledger;
}

// Where path tracing does better than what merges, so does guided-bdpt, mostly, whose fields are there. It begins an
// image of its own, without what merging blurred, and is looked at in turn; or goes on with the image as it is.
void leave_out_merging(bool anew, RenderState& state) {
  state.plain = {};
  state.plain.merged = state.film.passes, state.plain.settled = !anew;
  if (!anew) return;
  state.plain.with_merging = set_aside(state);
  drop_passes(state.film);
  state.stats.ledger = {};
  forget_sums(state.balance), forget_sums(state.adaptive);
}

// Path tracing that took over: its passes of the whole film are there to be held against the guided image, at no cost.
// What lies in a few squares shows here, and what it finds in one sample of many thousands.
void doubt_plain(bool merges, RenderState& state) {
  Plain& plain = state.plain;
  Film& film = state.film;
  if (film.chunks > 0 || film.passes == plain.passes || !std::has_single_bit(film.passes)) return;
  const std::vector<uint32_t> all = spread_squares(film, square_count(film));
  const PassHalves guided = halves_of(plain.guided.film, all);
  const PassHalves since = halves_since(film, plain.guided.film, all);
  const PlainLook look = compare_halves(guided, since);
  const double passes = since.passes;
  plain.taken = (look.plain + 2 * look.deviation) * passes + missed_by_plain(look, merges) * std::min(passes, rarest) <=
                turned_wild;
  if (!plain.taken) {
    put_back(plain.guided, state);
    plain.returned = since.passes;
    state.adaptive = std::move(plain.adaptive);
  }
  if (!plain.taken || film.passes >= doubted * plain.passes) plain.guided = {}, plain.adaptive = {};
}

}  // namespace

void show_merged(RenderState& state) {
  if (state.plain.with_merging.film.passes <= state.film.passes) return;
  put_back(state.plain.with_merging, state);
  state.plain = {};
}

Job plainly(Job job) {
  job.trace = trace_path, job.light_half = nullptr;
  job.beyond = nullptr;
  job.guided = false, job.learning = nullptr, job.training = nullptr;
  job.walk.fields = nullptr, job.walk.merging = {}, job.walk.counts.inner = job.walk.counts.seen = 0;
  return job;
}

bool merges_still(const RenderOptions& options, const Plain& plain) {
  return is_merging(options.integrator) && options.merge_radius > 0 && (plain.merged == 0 || !may_leave_out(options));
}

void try_plain(const Job& job, const RenderOptions& options, std::vector<Scratch>& scratches, RenderState& state) {
  if (!may_leave_out(options) || !knows_enough(state.learning)) return;
  Plain& plain = state.plain;
  const bool merges = merges_still(options, plain);
  const Film& film = state.film;
  if (film.passes >= plain.with_merging.film.passes) plain.with_merging = {};
  if (plain.guided.film.passes > 0) return doubt_plain(merges, state);
  if (!is_look_due(film, plain)) return;
  const std::vector<uint32_t> squares = squares_to_look_at(film);
  if (squares.empty()) return;
  trace_as_long(job, squares, merges, scratches, state);
  judge(compare_halves(halves_of(film, squares), plain.seen), merges, film.passes, plain);
  if (plain.taken && merges) return leave_out_merging(!is_over(options, state.stats, late), state);
  if (plain.settled) plain.seen = {};
  if (plain.taken && film.splats) plain.guided = set_aside(state), plain.adaptive = state.adaptive;
}

}  // namespace ajar
