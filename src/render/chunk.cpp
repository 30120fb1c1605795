// One tile of the film in one pass: its samples, their light halves, their camera halves.

#include "chunk.h"

#include <cmath>

#include "ajar/join/pool.h"
#include "contribution.h"
#include "place.h"

namespace ajar {

LightHalves light_halves_at(float rate) { return {size_t(std::max(1 / rate, 1.0f)), size_t(std::max(rate, 1.0f))}; }

size_t light_halves(size_t samples, float rate) {
  const auto [step, each] = light_halves_at(rate);
  return (samples + step - 1) / step * each;
}

uint32_t traced_one_in(const Job& job, const Film& film) {
  return job.guided && job.learning ? traced_one_in(*job.learning, film) : 1;
}

namespace {

uint64_t index_of(const Film& film, int x, int y) { return uint64_t(y) * uint64_t(film.width) + uint64_t(x); }

// The numbers of a pixel's k-th sample in a pass: those that come next. Even passes and odd ones have sequences of
// their own.
Stream pixel_numbers(const Job& job, uint64_t pixel, uint32_t pass, uint32_t k) {
  uint32_t point = pass;
  if (job.adaptive) point = job.adaptive->first + 2 * (job.adaptive->spread[pixel].counts[pass % 2] + k) + pass % 2;
  return make_stream(job.sampler, job.seed, Side::camera, pixel, point);
}

// Of a sample's pairs of numbers, the one that says where in its pixel it looks, and where the lens passes it.
constexpr uint32_t raster_pair = 1, lens_pair = 2;

bool has_lens(const Job& job) { return job.scene->camera.kind == CameraKind::thinlens; }

// The k-th sample of a pixel in the pass; the first one may teach.
void begin(const Job& job, const Film& film, int x, int y, uint32_t k, Sample& s) {
  s.x = x, s.y = y;
  const uint64_t pixel = index_of(film, x, y);
  s.path = pixel + k * film.pixels();
  s.pass = film.dropped + film.passes;
  s.number = k, s.count = count_of(job.adaptive, pixel);
  s.teaches = k == 0 && job.learning && is_recorded(*job.learning, pixel, s.pass, recorded_one_in(*job.learning, film));
  s.stream = pixel_numbers(job, pixel, s.pass, k);
  if (has_lens(job)) s.lens = Sampler(s.stream).at(lens_pair);
}

// Where in its pixel the sample looks; numbers go on with those of its subpath.
void aim(const Job& job, const Film& film, Sample& s, Sampler& numbers) {
  numbers.start(s.stream, has_lens(job) ? lens_pair : raster_pair);
  const Vec2 centre(float(film.x0 + s.x) + 0.5f, float(film.y0 + s.y) + 0.5f);
  s.raster = centre + ajar::sample(film.filter, numbers.at(raster_pair), s.weight);
  s.weight *= float(traced_one_in(job, film)) / float(s.count);
}

bool is_traced(const Job& job, const Film& film, int x, int y) {
  const uint32_t n = traced_one_in(job, film);
  return n == 1 || hash(hash(job.seed, film.dropped + film.passes), index_of(film, x, y)) % n == 0;
}

// A pixel's samples in the pass but for the first one.
void add_further(const Job& job, const Film& film, std::vector<Halves::Part>& samples) {
  const size_t pixels = samples.size();
  for (size_t i = 0; i < pixels; ++i)
    for (uint32_t k = 1; k < samples[i].sample.count; ++k)
      begin(job, film, samples[i].sample.x, samples[i].sample.y, k, samples.emplace_back().sample);
}

// Not those that are recorded more than others.
bool is_timed(const Sample& s) { return hash(0x71c5 + s.path, s.pass) % timed_samples == 0; }

// The light half of a sample, of which one in so many is recorded; whether it brought something.
bool trace_half(const Job& job, Sample sample, uint32_t recorded, Scratch& scratch) {
  const size_t splats = scratch.splats->size();
  sample.teaches = job.learning && is_recorded(*job.learning, sample.path, sample.pass, recorded);
  scratch.clock = is_timed(sample) ? clock_ticks() : 0;
  job.light_half(job, sample, scratch);
  return scratch.splats->size() > splats;
}

// Notes what one sample of a pixel brought.
void note(PixelSpread& spread, uint32_t pass, float brought) {
  spread.sum += brought, spread.square += sqr(brought), ++spread.samples;
  ++spread.counts[pass % 2];
}

// What the sample brings its pixel, filtered.
Rgb trace_pixel(const Job& job, const Film& film, Sample& sample, bool splat, Scratch& scratch) {
  const size_t splats = scratch.splats->size();
  scratch.clock = is_timed(sample) ? clock_ticks() : 0;
  aim(job, film, sample, scratch.numbers);
  job.trace(job, sample, scratch);
  if (!accept(sample.value, sample.path, scratch)) sample.value = Rgb(0);
  ++scratch.counters.camera_paths;
  scratch.counters.zero_paths += is_black(sample.value) && !splat && scratch.splats->size() == splats;
  return sample.value * sample.weight;
}

// Which pool a sample joins: neighbours others, and others from pass to pass, so that what a pool has too much of is
// grain rather than blotches. (J10)
uint32_t pool_of(const Job& job, const Sample& sample, uint32_t pools) {
  return uint32_t(hash(hash(job.seed, 0x3f0d), hash(sample.pass, sample.path)) % pools);
}

}  // namespace

float number_of(const Job& job, const Film& film, uint32_t chunk) {
  return to_unit(uint32_t(hash(hash(job.seed, 0x6a32), hash(film.dropped + film.passes, chunk)) >> 32));
}

void begin_samples(const Job& job, Film& film, uint32_t chunk, Scratch& scratch) {
  const TileBounds bounds = tile_bounds(film, chunk);
  Halves& halves = *scratch.halves;
  scratch.rejected_at = Scratch::no_path;
  halves.samples.clear();
  const glm::ivec2 shift = tile_shift(film);
  for (int row = bounds.y0; row < bounds.y1; ++row)
    for (int column = bounds.x0; column < bounds.x1; ++column) {
      const int x = (column + shift.x) % film.width, y = (row + shift.y) % film.height;
      film.camera[index_of(film, x, y)] = Rgb(0);
      if (is_traced(job, film, x, y)) begin(job, film, x, y, 0, halves.samples.emplace_back().sample);
    }
  halves.pixels = halves.samples.size();
  add_further(job, film, halves.samples);
  halves.splat_counts = float(traced_one_in(job, film));
  if (halves.pixels > 0)
    halves.splat_counts *= float(double(halves.pixels) / double(light_halves(halves.pixels, job.light_rate)));
}

void trace_light_halves(const Job& job, const Film& film, uint32_t chunk, double kept, Scratch& scratch) {
  Halves& halves = *scratch.halves;
  clear(halves.store), clear(scratch.traced);
  halves.photons.clear(), halves.few.clear();
  const uint32_t recorded = job.learning ? light_recorded_one_in(*job.learning, film, job.light_rate) : 1;
  const auto [step, each] = light_halves_at(job.light_rate);
  for (size_t i = 0; i < halves.pixels; i += step)
    for (size_t k = 0; k < each; ++k) {
      Sample sample = halves.samples[i].sample;
      sample.path += k * film.pixels();  // numbers of its own
      halves.samples[i].splat |= trace_half(job, sample, recorded, scratch);
    }
  subsample(halves.store, {&scratch.traced}, kept, number_of(job, film, chunk));
}

void trace_camera_halves(const Job& job, Film& film, OfPool of, Scratch& scratch) {
  if (job.vpls && !job.guided) start(job.vpls->store, scratch.visibility);
  for (auto& [sample, splat] : scratch.halves->samples)
    if (of.pools == 1 || pool_of(job, sample, of.pools) == of.pool) {
      const Rgb value = trace_pixel(job, film, sample, splat, scratch);
      const uint64_t pixel = index_of(film, sample.x, sample.y);
      film.camera[pixel] += value;
      if (job.adaptive) note(job.adaptive->spread[pixel], sample.pass, luminance(value) * float(sample.count));
    }
}

Rgb trace_alone(const Job& job, const Film& film, uint32_t pixel, Scratch& scratch) {
  Sample sample;
  begin(job, film, int(pixel) % film.width, int(pixel) / film.width, 0, sample);
  return trace_pixel(job, film, sample, false, scratch);
}

}  // namespace ajar
