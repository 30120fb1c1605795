// Enters: a job, a film and the number of one of its tiles.
// Leaves: what the samples of the tile found in the pass at hand: on the film, and in a thread's scratch.
#pragma once

#include "job.h"

namespace ajar {

/// A number of the chunk's own in the pass at hand, in [0, 1).
float number_of(const Job& job, const Film& film, uint32_t chunk);
/// One pixel in so many is traced.
uint32_t traced_one_in(const Job& job, const Film& film);
/// Of every step-th sample of a chunk so many light halves are traced.
struct LightHalves {
  size_t step = 1, each = 1;
};
/// rate: Job::light_rate.
LightHalves light_halves_at(float rate);
/// All of so many samples.
size_t light_halves(size_t samples, float rate);
/// Makes the samples of a chunk, whose pixels begin the pass black.
void begin_samples(const Job& job, Film& film, uint32_t chunk, Scratch& scratch);
/// The light halves of the samples that were begun, and what is stored of them.
/// kept: light vertices of the chunk that go into its pool, about.
void trace_light_halves(const Job& job, const Film& film, uint32_t chunk, double kept, Scratch& scratch);
/// Those samples of a chunk that join the light vertices of one pool.
struct OfPool {
  uint32_t pool = 0, pools = 1;  ///< which, of how many
};
/// What the samples of the scratch's halves see, all or those of a pool.
void trace_camera_halves(const Job& job, Film& film, OfPool of, Scratch& scratch);
/// What a camera sample of a pixel brings in the film's pass at hand, filtered, of a job without light subpaths; the
/// film stays as it is.
Rgb trace_alone(const Job& job, const Film& film, uint32_t pixel, Scratch& scratch);

}  // namespace ajar
