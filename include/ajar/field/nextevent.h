// Enters: a vertex with its guide, the light tree, what its cell learned.
// Leaves: next-event estimation's choice of a light, with its density for MIS; what a shadow ray teaches.
#pragma once

#include "ajar/field/guide.h"
#include "ajar/field/training.h"

namespace ajar {

/// Draws a piece of the lights for the vertex at p, where it does not take a sky whole; u in [0,1). False where none is
/// to be asked for. place is set where one was chosen, though it turned out to be of no use, else none.
bool choose_light(const Scene& scene, const Guide& guide, const Vec3& p, float u, uint32_t& place, float& pdf);
/// Whether sample_next_event needs u_choice.
bool chooses_light(const Scene& scene, const Guide& guide);
/// Probability of a piece.
float light_pdf(const Scene& scene, const Guide& guide, const Vec3& p, uint32_t place);
/// A point of a light that the vertex may see; out.pdf includes the choice. Numbers in [0,1); false where it gives
/// nothing.
bool sample_next_event(const Scene& scene, const Guide& guide, const Vec3& p, float u_choice, const Vec2& u_point,
                       DirectSample& out);
/// Density of the same for a point of a light along unit wi, per solid angle; of deltas the probability.
double pdf_next_event(const Scene& scene, const Guide& guide, const Vec3& p, const LightPoint& point, const Vec3& wi);
/// What the vertex got from the point that sample_next_event gave it: irradiance divided by its density, 0 where
/// something was in the way. Nothing is recorded where no light was asked.
void record_next_event(const Scene& scene, const Guide& guide, const Vec3& p, Training& training,
                       const LightPoint& point, float arrives);
/// The vertex was here: cells come to be, and divide, where there are many. ng: its geometric normal.
void record_place(const Guide& guide, const Vec3& ng, Training& training, Sightings& sightings);

}  // namespace ajar
