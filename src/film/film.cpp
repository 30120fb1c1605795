#include "ajar/film/film.h"

#include <fmt/format.h>

#include <algorithm>

#include "ajar/core/error.h"
#include "ajar/core/parallel.h"
#include "ajar/core/sampler.h"
#include "ajar/film/fireflies.h"
#include "footprint.h"

namespace ajar {
namespace {

bool is_done(const Film& film, const glm::ivec2& shift, int x, int y) {
  const int column = (x + film.width - shift.x) % film.width / tile;
  const int row = (y + film.height - shift.y) % film.height / tile;
  return uint32_t(row * tiles_x(film) + column) < film.chunks;
}

// What makes of a sum of n passes one of n + 1 with the weighted mean.   (A2)
struct Turn {
  double keep = 1, add = 1;
};
Turn turn(double weight, double own, double n) {
  if (n == 0) return {};
  return {weight * (n + 1) / ((weight + own) * n), own * (n + 1) / (weight + own)};
}

}  // namespace

double share_of_pass(const Film& film) {
  const uint32_t n = chunk_count(film);
  if (film.chunks == 0 || film.chunks == n) return film.chunks == 0 ? 0 : 1;
  size_t done = 0;
  for (uint32_t i = 0; i < film.chunks; ++i) done += tile_bounds(film, i).pixels();
  return double(done) / double(film.pixels());
}

glm::ivec2 tile_shift(const Film& film) {
  const uint64_t h = hash(0x711e, film.dropped + film.passes);
  return {int(h % tile) % film.width, int((h >> 32) % tile) % film.height};
}

Film make_film(const Camera& camera, const Filter& filter, bool splats) {
  if (camera.crop_width < 1 || camera.crop_height < 1)
    throw Error(fmt::format("film: {}x{} pixels are none; give the camera a crop of one or more each way",
                            camera.crop_width, camera.crop_height));
  if (const bool exact = filter.kind == FilterKind::box || filter.kind == FilterKind::tent;
      !(filter.radius > 0 && filter.radius < infinity) || (!exact && filter.table.empty()))
    throw Error("film: the filter has no radius or no table; make it by make_filter");
  Film film;
  film.x0 = camera.crop_x, film.y0 = camera.crop_y;
  film.width = camera.crop_width, film.height = camera.crop_height;
  film.filter = filter;
  film.splats = splats;
  const size_t n = film.pixels();
  film.camera.resize(n);
  film.camera_sum.resize(n);
  film.half_sum.resize(n);
  film.square_sum.resize(n);
  if (splats) film.splat.resize(n), film.splat_sum.resize(n);
  return film;
}

void merge(Film& film, const std::vector<std::vector<Splat>>& chunks) {
  // Bands of rows in parallel; within a band, splats in the order of chunks and paths.
  const int bands = std::clamp(film.height / 32, 1, 16);
  parallel_for(bands, [&](int band) {
    const int from = film.height * band / bands, to = film.height * (band + 1) / bands;
    const float reach = film.filter.radius + 0.5f, lo = float(film.y0 + from) - reach, hi = float(film.y0 + to) + reach;
    for (const auto& chunk : chunks)
      for (const Splat& s : chunk)
        if (s.raster.y >= lo && s.raster.y <= hi)
          for_each_reached(film, s.raster, from, to,
                           [&](size_t i, float wx, float wy) { film.splat[i] += s.value * (wy * wx); });
  });
}

Film frame_of(const Film& film) {
  Film frame;
  frame.x0 = film.x0, frame.y0 = film.y0, frame.width = film.width, frame.height = film.height;
  frame.filter = film.filter, frame.splats = film.splats;
  return frame;
}

void drop_passes(Film& film) {
  for (auto* sums : {&film.camera_sum, &film.splat_sum, &film.half_sum, &film.square_sum})
    std::fill(sums->begin(), sums->end(), glm::dvec3(0));
  std::fill(film.brightest.begin(), film.brightest.end(), Film::Bright{});
  film.weight = film.half_weight = 0;
  film.dropped += film.passes;
  film.passes = 0;
}

void finish_pass(Film& film, double weight) {
  const float scale = 1.0f / float(film.pixels());
  const uint32_t n = film.passes;
  const bool even = n % 2 == 0;
  const Turn all = turn(film.weight, weight, n), half = turn(film.half_weight, weight, n / 2);
  const auto add = [](glm::dvec3& sum, const Turn& by, const glm::dvec3& x) { sum = sum * by.keep + x * by.add; };
  parallel_ranges(film.pixels(), 16384, [&](size_t from, size_t to) {
    for (size_t i = from; i < to; ++i) {
      glm::dvec3 x(film.camera[i]);
      add(film.camera_sum[i], all, x);
      film.camera[i] = Rgb(0);
      if (film.splats) {
        const glm::dvec3 s(film.splat[i] * scale);
        add(film.splat_sum[i], all, s);
        film.splat[i] = Rgb(0);
        x += s;
      }
      if (even) add(film.half_sum[i], half, x);
      add(film.square_sum[i], all, x * x);
      if (!film.brightest.empty()) note(film, i, Rgb(x), float(weight));
    }
  });
  film.weight += weight;
  if (even) film.half_weight += weight;
  ++film.passes;
  film.chunks = 0;
}

glm::dvec3 sum_since(const Summed& of_now, const Summed& of_then, const glm::dvec3& now, const glm::dvec3& then) {
  const double scale = (of_now.passes - of_then.passes) / (of_now.weight - of_then.weight);
  return scale * (of_now.weight / of_now.passes * now - of_then.weight / of_then.passes * then);
}

Picture develop(const Film& film) {
  if (film.width < 1 || film.height < 1 || film.camera.size() != film.pixels())
    throw Error("develop: a film without pixels; render one");
  Picture out{film.width, film.height, {"R", "G", "B"}, std::vector<float>(3 * film.pixels())};
  const double share = share_of_pass(film);
  const float per_path = 1 / float(film.pixels());
  const glm::ivec2 shift = tile_shift(film);
  const std::vector<float> most = film.brightest.empty() ? std::vector<float>() : limits(film);
  for (int y = 0; y < film.height; ++y)
    for (int x = 0; x < film.width; ++x) {
      const size_t i = size_t(y) * film.width + x;
      const bool done = is_done(film, shift, x, y);
      glm::dvec3 value(0);
      const double n = film.passes + (done ? 1.0 : 0.0);
      const Rgb camera = done ? film.camera[i] : Rgb(0);
      const Rgb splat = film.splats ? film.splat[i] * per_path : Rgb(0);
      const double kept = most.empty() ? 1 : double(kept_share(camera + splat, most[i]));  // of the pass at work
      if (n > 0) value += (film.camera_sum[i] + glm::dvec3(camera) * kept) / n;
      if (film.splats && film.passes + share > 0)
        value += (film.splat_sum[i] + glm::dvec3(splat) * kept) / (film.passes + share);
      if (!most.empty() && n > 0) value -= excess(film, i, most[i]) / n;
      for (int c = 0; c < 3; ++c) out.pixels[3 * i + c] = float(value[c]);
    }
  return out;
}

Picture average(const Film& film, const std::vector<glm::dvec3>& sums, bool splats) {
  Picture out{film.width, film.height, {"R", "G", "B"}, std::vector<float>(3 * film.pixels())};
  const double splat_passes = film.passes + share_of_pass(film);
  const glm::ivec2 shift = tile_shift(film);
  for (int y = 0; y < film.height; ++y)
    for (int x = 0; x < film.width; ++x) {
      const size_t i = size_t(y) * film.width + x;
      const double n = splats ? splat_passes : film.passes + (is_done(film, shift, x, y) ? 1.0 : 0.0);
      for (int c = 0; c < 3; ++c) out.pixels[3 * i + c] = n > 0 ? float(sums[i][c] / n) : 0;
    }
  return out;
}

}  // namespace ajar
