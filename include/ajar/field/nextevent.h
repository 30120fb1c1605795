// Enters: a vertex with its guide, the light tree, what its cell learned.
// Leaves: next-event estimation's choice of a light, with its density for MIS; what a shadow ray teaches.
#pragma once

#include "ajar/field/guide.h"
#include "ajar/field/training.h"

namespace ajar {

/// What every entry of a vertex's cut of the lights promises it, times what was learned of it (V3). Made where it is
/// first asked for, once for all that the vertex asks of the lights.
struct LightChances {
  bool known = false;
  const LightCut* cut = nullptr;  ///< null: the tree alone
  Receiver at;
  float asks = 1;  ///< probability with which a light is asked at all
  float total = 0;
  float of[LightRules{}.most];  ///< entries of the cut; set where there are several
};

/// Draws a piece of the lights for the vertex, where it does not take a sky whole; u in [0,1). False where none is
/// to be asked for. place is set where one was chosen, though it turned out to be of no use, else none.
bool choose_light(const Scene& scene, const Guide& guide, LightChances& chances, float u, uint32_t& place, float& pdf);
/// Probability of a piece.
float light_pdf(const Scene& scene, const Guide& guide, LightChances& chances, uint32_t place);
/// Whether sample_next_event needs LightNumbers::choice.
bool chooses_light(const Scene& scene, const Guide& guide);
/// Numbers in [0,1).
struct LightNumbers {
  float choice = 0;
  Vec2 point{0};
};
/// Those of the i-th of n rays of one vertex: the first's, shifted. Each is as uniform as these, and together they lie
/// evenly in the cube. (J4)
LightNumbers spread(const LightNumbers& first, int i, int n);
/// A point of a light that the vertex may see; out.pdf includes the choice. False where it gives nothing.
bool sample_next_event(const Scene& scene, const Guide& guide, LightChances& chances, const LightNumbers& u,
                       DirectSample& out);
/// Density of the same for a point of a light along unit wi, per solid angle; of deltas the probability.
double pdf_next_event(const Scene& scene, const Guide& guide, const LightPoint& point, const Vec3& wi);
/// What the vertex got from the point that sample_next_event gave it: irradiance divided by its density, 0 where
/// something was in the way. Nothing is recorded where no light was asked.
void record_next_event(const Scene& scene, const Guide& guide, LightChances& chances, Training& training,
                       const LightPoint& point, float arrives);

}  // namespace ajar
