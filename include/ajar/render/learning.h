// Enters: passes of a guided integrator.
// Leaves: the fields that the next pass reads. The one place where what was recorded flows back.
#pragma once

#include "ajar/field/learn.h"
#include "ajar/field/store.h"
#include "ajar/film/film.h"

namespace ajar {

/// Fields with what was recorded through them since they were learned.
struct Learning {
  Fields fields;
  Training training;
  Sightings sightings;
  uint32_t passes = 0;   ///< recorded since
  uint32_t train = 0;    ///< generation from which the fields are frozen, 0: they learn all along; LearnOptions::train
  uint32_t lesson = 1;   ///< passes of a lesson before that, and of the first lessons where they learn all along
  bool of_film = false;  ///< in a lesson of a film, which needs so many pixels as the scene asks for, not the image
  uint32_t first = 0;    ///< number of the render's first pass; even; not 0 where it goes on from stored fields
};

/// After each of the first passes, young_generations of them, the fields are learned; the next lesson is after
/// rare_records passes, of which one path in so many is recorded, and from lesson to lesson both double: a lesson is
/// always of as many paths. What the first blind_generations saw, through fields that knew next to nothing, is dropped
/// from the image.
inline constexpr uint32_t young_generations = 8, blind_generations = 4, rare_records = 8;

Learning start_learning(const Scene& scene, const Film& film, const LearnOptions& options);
/// Puts stored fields in place of those that know nothing. They may be of the scene as it was before it changed: what
/// they know of other lights, or with other options, is forgotten. Passes are numbered on from those that the fields
/// were learned from: a pass guided by what its own numbers taught would be biased. Call before the first pass.
/// options: learn_options of the render's.
void go_on_from(const Scene& scene, StoredFields stored, const LearnOptions& options, Learning& learning, Film& film);
/// The fields as they are now, with the numbers that they have seen: those of so many passes (passes_drawn).
StoredFields stored_fields(const Scene& scene, const Learning& learning, uint32_t passes);
/// Passes that were traced and dropped.
inline uint32_t dropped_passes(const Learning& learning, const Film& film) { return film.dropped - learning.first; }
/// Whether passes only train the fields so far (LearnOptions::train): they do not count.
bool in_training(const Learning& learning);
/// Whether fields know enough for the image: what passes saw before is dropped.
inline bool knows_enough(const Learning& learning) { return learning.fields.generation >= blind_generations; }
/// Has training end with the pair of passes at work, but not before blind_generations of them.
void end_training(Learning& learning);
/// One pixel in so many is traced in the pass at hand. What blind passes find is not for the image, and the first
/// lessons need less than all pixels of a large one.
uint32_t traced_one_in(const Learning& learning, const Film& film);
/// One path in so many is recorded in the pass at hand: how much young fields need is the scene's affair, not that of
/// the number of pixels.
uint32_t recorded_one_in(const Learning& learning, const Film& film);
/// The same of light subpaths, of which there are `rate` for each pixel: about as many of them are recorded as of the
/// others, where there are as many.
uint32_t light_recorded_one_in(const Learning& learning, const Film& film, float rate);
/// Whether the subpaths of this pixel are recorded in this pass, one in so many.
bool is_recorded(const Learning& learning, uint64_t pixel, uint32_t pass, uint32_t one_in);
/// Of the passes since the fields were last learned.
Recorded paths_recorded(const Learning& learning, const LearnOptions& options, const Film& film, float rate);
/// Call after every finished pass, of which there were `rate` light subpaths for each pixel. Drops the blind passes
/// from the film when the time has come.
void end_pass(const Scene& scene, Learning& learning, const LearnOptions& options, float rate, Film& film);

}  // namespace ajar
