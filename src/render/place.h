// Enters: a job, and the film's pass at hand.
// Leaves: the virtual point lights of that pass, and how densely they lie.
#pragma once

#include "job.h"

namespace ajar {

/// The light vertices of a pass as virtual point lights, the same for all pixels.
struct Vpls {
  LightStore store;
  std::optional<uint32_t> pass;  ///< that they are of
  uint32_t paths = 256;          ///< light subpaths of a pass
  double even = 0;               ///< vertices per area and light subpath; read where no field tells
  int joins = 8;                 ///< at the first surface of a camera subpath
  WalkOptions camera;            ///< of camera subpaths: fields are read for the lights alone
  uint32_t most = 0;             ///< lights that are kept, about
  double least = 0;              ///< a light that brings this to the image, or more, is sure to be kept; 0: all are
  double per_flux = 0;           ///< what a light is taken to bring, beside what the field says
  uint32_t rejected_at = none;   ///< light subpath of the pass's first rejected value
  std::vector<std::vector<Splat>> splats;  ///< of the pass's light subpaths, per chunk of the film
};

/// How many lights and joins there are to be.
Vpls make_vpls(const Scene&, const Film&, bool guided);
/// Whether a vertex may be a light: what it scatters is not so narrow that hardly any pixel ever sees it. The same from
/// both sides of what light goes through: joins and walks, which may come from different ones, must agree.
bool can_light(const Scene& scene, const Surface& surface, const Guide& y);
/// Lights per area at a point of a surface, on the side of direction w: of all that are kept, as far as fields know. A
/// function of the place, whatever the pass's lights are.
double density_of_lights(const Job& job, const Vec3& p, const Vec3& ng, const Vec3& w);
/// Has the job's lights be those of the film's pass at hand: traces its light subpaths, and before the first ones
/// others, which tell how much a light must bring to be kept.
void place_vpls(const Job&, const Film&, std::vector<Scratch>&);

}  // namespace ajar
