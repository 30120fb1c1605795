#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ajar/core/bytes.h"
#include "ajar/core/error.h"
#include "ajar/render/render.h"

namespace ajar {
namespace {

constexpr FileKind checkpoint_kind = {"AJARck29", "checkpoint", "render once with --checkpoint",
                                      "start again without --resume"};

// One list of fields for both ways.
template <class Io, class State>
void film_fields(Io& io, State& film) {
  io.value(film.width), io.value(film.height), io.value(film.passes), io.value(film.dropped), io.value(film.chunks);
  io.array(film.camera), io.array(film.splat);
  io.array(film.camera_sum), io.array(film.splat_sum), io.array(film.half_sum), io.array(film.square_sum);
  io.array(film.brightest), io.value(film.weight), io.value(film.half_weight);
}

template <class Io, class State>
void stats_fields(Io& io, State& stats) {
  io.value(stats.counters), io.value(stats.rejected), io.value(stats.seconds), io.value(stats.cpu_seconds);
  io.value(stats.learn_seconds), io.value(stats.learn_cpu_seconds), io.value(stats.ledger);
  io.value(stats.ticks);
}

void write(Writer& w, const std::vector<std::string>& texts) {
  w.value(uint64_t(texts.size()));
  for (const std::string& t : texts) w.text(t);
}

void read(Reader& r, std::vector<std::string>& texts) {
  texts.resize(r.count(sizeof(uint64_t)));
  for (std::string& t : texts) r.text(t);
}

void write(Writer& w, const Learning& l) {
  w.value(l.passes), w.value(l.train), w.value(l.first);
  write(w, l.fields);
  write(w, l.training);
  write(w, l.sightings);
}

void read(Reader& r, Learning& l) {
  r.value(l.passes), r.value(l.train), r.value(l.first);
  read(r, l.fields);
  read(r, l.fields, l.training);
  read(r, l.sightings);
}

template <class Io, class State>
void adaptive_fields(Io& io, State& adaptive) {
  io.array(adaptive.spread), io.value(adaptive.passes), io.array(adaptive.counts), io.value(adaptive.first);
}

template <class Io, class State>
void set_aside_fields(Io& io, State& image) {
  film_fields(io, image.film), io.value(image.ledger);
}

template <class Io, class State>
void plain_fields(Io& io, State& plain) {
  io.value(plain.taken), io.value(plain.settled), io.value(plain.passes), io.value(plain.ratio);
  io.value(plain.pace), io.value(plain.guided_error), io.value(plain.plain_error);
  io.value(plain.missed), io.value(plain.rays), io.value(plain.seen.passes), io.array(plain.seen.sum),
      io.array(plain.seen.half);
  io.value(plain.returned), io.value(plain.merged);
  set_aside_fields(io, plain.guided), adaptive_fields(io, plain.adaptive);
  set_aside_fields(io, plain.with_merging);
}

template <class Io, class State>
void balance_fields(Io& io, State& balance) {
  io.value(balance.goes_on), io.value(balance.passes), io.value(balance.work), io.array(balance.found);
}

bool is_sound(const Adaptive& a, size_t pixels) {
  const auto some = [](uint8_t count) { return count >= 1 && count <= Adaptive::most; };
  return (a.spread.empty() || a.spread.size() == pixels) && (a.counts.empty() || a.counts.size() == pixels) &&
         std::all_of(a.counts.begin(), a.counts.end(), some) && a.first % 2 == 0;
}

void read(Reader& r, Pyramid& pyramid) {
  for (size_t n = r.count(2 * sizeof(int)); n > 0; --n) {
    std::pair<int, int> st;
    r.value(st.first), r.value(st.second);
    Pyramid::Layer& layer = pyramid.layers[st];
    r.array(layer.raw), r.array(layer.weighted);
  }
}

// Whether so many passes may count for that.
bool may_count_for(double weight, uint32_t passes) {
  return weight >= 0.999 * passes && weight <= 1.001 * Adaptive::most * passes;  // differences are rounded
}

bool is_sound(const Film& film, size_t pixels) {
  const size_t splats = film.splats ? pixels : 0;
  return film.pixels() == pixels && film.camera.size() == pixels && film.camera_sum.size() == pixels &&
         film.half_sum.size() == pixels && film.square_sum.size() == pixels && film.splat.size() == splats &&
         film.splat_sum.size() == splats &&
         (film.brightest.empty() || film.brightest.size() == Film::brightest_kept * pixels) &&
         film.chunks < chunk_count(film) && film.dropped % 2 == 0 &&
         may_count_for(film.half_weight, (film.passes + 1) / 2) &&
         may_count_for(film.weight - film.half_weight, film.passes / 2);
}

// Throws Error unless the file is of this render.
void check_made_for(Reader& r, const std::string& key, const std::string& integrator) {
  std::string stored, begun;
  r.key(stored), r.key(begun);
  if (begun != integrator)
    throw Error(fmt::format("{}: a checkpoint of {}, not of {}; go on with that, or {}", r.path, begun, integrator,
                            checkpoint_kind.cure));
  if (stored != key)
    throw Error(fmt::format("{}: made with another scene or other options: {}; give what it was made with, or {}",
                            r.path, difference(stored, key), checkpoint_kind.cure));
}

// Film, counts, and images of strategies.
void read_image(Reader& r, RenderState& state) {
  const size_t pixels = state.film.pixels();
  film_fields(r, state.film);
  r.require(is_sound(state.film, pixels));
  stats_fields(r, state.stats);
  read(r, state.stats.replay);
  uint8_t kept = 0;
  r.value(kept);
  if (state.pyramid.kept && kept == 0)
    throw Error(r.path + ": made without --techniques, whose images would lack its passes; leave --techniques out");
  read(r, state.pyramid);
  for (const auto& [st, layer] : state.pyramid.layers)
    r.require(layer.raw.size() == pixels && layer.weighted.size() == pixels);
  if (!state.pyramid.kept) state.pyramid = {};
}

// What a file of this state has to agree with, and what is not in it.
RenderState frame_of(const RenderState& state) {
  RenderState frame;
  frame.integrator = state.integrator;
  frame.film = frame_of(state.film);
  frame.pyramid.kept = state.pyramid.kept;
  frame.learning = state.learning;
  return frame;
}

// What decides how the next passes are traced, but for what is learned.
void read_steering(Reader& r, RenderState& state) {
  const size_t pixels = state.film.pixels();
  r.value(state.light_rate), r.value(state.effort);
  r.require(state.effort >= RenderState::least_effort && state.effort <= 1);
  r.require(state.light_rate >= RenderState::least_light && state.light_rate <= RenderState::most_light &&
            std::exp2(std::round(std::log2(state.light_rate))) == state.light_rate);
  balance_fields(r, state.balance);
  r.require(state.balance.goes_on >= Balance::least && state.balance.goes_on <= Balance::most);
  r.require(state.balance.found.empty() || state.balance.found.size() == pixels);
  adaptive_fields(r, state.adaptive);
  r.require(is_sound(state.adaptive, pixels));
  state.plain.guided.film = state.plain.with_merging.film = frame_of(state.film);
  plain_fields(r, state.plain);
  r.require(state.plain.seen.half.size() == state.plain.seen.sum.size());
  r.require(is_sound(state.plain.adaptive, pixels));
  for (const Film* film : {&state.plain.guided.film, &state.plain.with_merging.film})
    r.require(film->passes == 0 || is_sound(*film, pixels));
}

}  // namespace

void save_checkpoint(const std::string& path, const std::string& key, const RenderState& state) {
  write_file(path, checkpoint_kind, [&](Writer& w) {
    w.key(key), w.key(state.integrator);
    film_fields(w, state.film);
    stats_fields(w, state.stats);
    write(w, state.stats.replay);
    w.value(uint8_t(state.pyramid.kept)), w.value(uint64_t(state.pyramid.layers.size()));
    for (const auto& [st, layer] : state.pyramid.layers)
      w.value(st.first), w.value(st.second), w.array(layer.raw), w.array(layer.weighted);
    w.value(state.light_rate), w.value(state.effort);
    balance_fields(w, state.balance);
    adaptive_fields(w, state.adaptive);
    plain_fields(w, state.plain);
    write(w, state.learning);
  });
}

std::string read_checkpoint_key(const std::string& path) {
  Reader r(path, checkpoint_kind);
  std::string key;
  r.key(key);
  return key;
}

void load_checkpoint(const std::string& path, const std::string& key, RenderState& state) {
  Reader r(path, checkpoint_kind);
  check_made_for(r, key, state.integrator);
  RenderState stored = frame_of(state);
  read_image(r, stored);
  read_steering(r, stored);
  read(r, stored.learning);
  r.finish();
  if (state.learning.fields.table.slots.empty()) stored.learning = {};  // nothing is learned
  state = std::move(stored);
}

}  // namespace ajar
