// Enters: what the camera samples of a pass bring each pixel, and splats.
// Leaves: the running estimate with its variance, pass by pass.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "ajar/film/picture.h"
#include "ajar/scene/camera.h"
#include "ajar/scene/filter.h"

namespace ajar {

/// What a light subpath leaves on the film: value as if a pass had one light subpath for each pixel, and not yet
/// divided by their number; raster in pixels of the full image.
struct Splat {
  Vec2 raster{0};
  Rgb value{0};
};

/// Estimate of every pixel of the crop window, rows from the top. Sums are over finished passes; the pass at work
/// stands apart, so that an interrupted render can be developed, or continued to the same bytes. Where passes do not
/// count alike, sums are those of so many passes that do, with the same mean.
struct Film {
  int x0 = 0, y0 = 0, width = 0, height = 0;
  Filter filter;
  bool splats = false;             ///< whether light subpaths reach this film at all
  std::vector<Rgb> camera, splat;  ///< the pass at work
  std::vector<glm::dvec3> camera_sum, splat_sum;
  std::vector<glm::dvec3> half_sum;    ///< of (camera + splat) over even passes: one of two independent halves
  std::vector<glm::dvec3> square_sum;  ///< of (camera + splat) per pass
  /// What passes brought a pixel at their brightest (camera + splat), so many of each pixel, in order of luminance, the
  /// rest black; empty: fireflies are not limited (fireflies.h).
  static constexpr int brightest_kept = 4;
  struct Bright {
    Rgb value{0};
    uint32_t pass = 0;
    float weight = 1;  ///< what the pass counts for
  };
  std::vector<Bright> brightest;
  double weight = 0;       ///< what finished passes count for, all together
  double half_weight = 0;  ///< the same of even ones
  uint32_t passes = 0;     ///< finished
  uint32_t dropped = 0;    ///< passes before those, no longer in the sums; even
  uint32_t chunks = 0;     ///< of the pass at work that are done

  size_t pixels() const { return size_t(width) * size_t(height); }
};

/// Pixels are traced in square tiles, the unit of parallel work; chunk i is tile i in rows.
inline constexpr int tile = 16;
/// Tiles in a row; those at the right and lower edges may be cut.
inline int tiles_x(const Film& film) { return (film.width + tile - 1) / tile; }
inline uint32_t chunk_count(const Film& film) {
  return uint32_t(tiles_x(film)) * uint32_t((film.height + tile - 1) / tile);
}
/// Columns and rows of a tile, before the grid is moved (tile_shift).
struct TileBounds {
  int x0, y0, x1, y1;  ///< x1, y1: one past the last
  size_t pixels() const { return size_t(x1 - x0) * size_t(y1 - y0); }
};
inline TileBounds tile_bounds(const Film& film, uint32_t chunk) {
  const int x = int(chunk) % tiles_x(film) * tile, y = int(chunk) / tiles_x(film) * tile;
  return {x, y, std::min(x + tile, film.width), std::min(y + tile, film.height)};
}
/// The grid of tiles in the pass at work lies so far to the right and below, round the film's edges: another place in
/// every pass, since what the samples of a tile have in common would show as squares.
glm::ivec2 tile_shift(const Film& film);
/// Samples per pixel, with the part of the pass at work.
inline double spp_of(const Film& film) { return film.passes + double(film.chunks) / chunk_count(film); }
/// Of the pass at work, how much is done, by pixels.
double share_of_pass(const Film& film);

Film make_film(const Camera& camera, const Filter& filter, bool splats);
/// A film of the same place and filter, without pixels.
Film frame_of(const Film& film);
/// Adds the splats of consecutive chunks, in their order, filtered. The result does not depend on threads.
void merge(Film& film, const std::vector<std::vector<Splat>>& chunks);
/// Forgets all finished passes: those to come go on with their numbers.
void drop_passes(Film& film);
/// Closes the pass at work, which counts for so much, above 0; an even pass and the one after it for as much as each
/// other.
void finish_pass(Film& film, double weight = 1);
/// Passes that a sum of the film is of, and what they count for.
struct Summed {
  double passes = 0, weight = 0;
};
inline Summed all_passes(const Film& film) { return {double(film.passes), film.weight}; }
inline Summed even_passes(const Film& film) { return {double((film.passes + 1) / 2), film.half_weight}; }
/// Of a sum and what it was before, of some passes: what those since then have brought, as many of them that count
/// alike. (A2)
glm::dvec3 sum_since(const Summed& of_now, const Summed& of_then, const glm::dvec3& now, const glm::dvec3& then);
/// Linear RGB estimate, its fireflies limited where the film is to; includes the chunks of the pass at work that are
/// done.
Picture develop(const Film& film);
/// The image (R, G, B) of sums over passes, that at work among them, one for each pixel: of what camera samples brought
/// their pixels, or of what fell on pixels from all of the film (splats).
Picture average(const Film& film, const std::vector<glm::dvec3>& sums, bool splats);
/// Variance of the estimate per pixel and channel, from the spread of the passes; zero before the second pass. Exact in
/// expectation for independent numbers where passes count alike. Passes of a low-discrepancy sequence err less together
/// than apart, so there it is too large (1.1 to 2 times measured in easy scenes, docs/results/error.md), and tests that
/// read it milder. The halves below would be exact for both, but with a single degree of freedom per pixel no test
/// could stand on them.
Picture variance(const Film& film);

/// What is expected of `ajar compare` against the true image; infinite before the second pass, and as long as nothing
/// but black was seen.
struct ErrorEstimate {
  double relmse = infinity, relmse_trimmed = infinity;  ///< of all pixels; without the worst 0.1 % of them
};
/// Whether nothing but black was seen.
bool is_black(const Film& film);
/// From the difference of the two halves, which are independent whatever the sampler; docs/notation.md, E1 to E3. A
/// pass at work counts by the share of it that is done.
ErrorEstimate estimate_error(const Film& film);
/// Of one sample: relMSE without the worst 0.1 % of pixels, times passes, of the image exposed to a mean luminance of a
/// fifth, so that it does not depend on the light's unit.
double estimate_sample_error(const Film& film);
/// Of something else that varies from sample to sample, given per pixel [luminance^2]: relative to the image, exposed
/// likewise; zeros where that is black.
std::vector<double> relative_to(const Film& film, std::vector<double> variances);
/// Variance of a sample per pixel as the difference of the halves tells it [luminance^2]: with a single degree of
/// freedom, but less than that of what samples bring where points of a sequence lie evenly, and more where pixels share
/// noise.
std::vector<double> half_differences(const Film& film);
/// Leaves out the worst 0.1 % of pixels, given one error each; the others change places.
void trim(std::vector<double>& errors);
/// Mean without them.
double trimmed_mean(std::vector<double> errors);
inline double estimated_error(const Film& film) { return estimate_error(film).relmse; }

}  // namespace ajar
