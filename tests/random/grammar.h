// Enters: dice, a folder that holds what write_props wrote.
// Leaves: small scenes of all kinds of materials, shapes, lights and cameras, as Mitsuba XML.
#pragma once

#include <string>

#include "dice.h"

namespace ajar::random {

/// What a scene must not hold for an integrator to find all of its light.
struct Kinds {
  bool point_lights = false;  ///< lights that no path hits
  bool deltas = false;        ///< mirrors, clear glass, holes
  bool sky = false;
};

struct RandomScene {
  std::string xml;
  std::string noted;  ///< what is in it, by name
  Kinds kinds;
};

/// Images and meshes that scenes name, into a folder that is there.
void write_props(const std::string& folder);

/// A bsdf element; deltas: whether it may scatter into single directions.
std::string material(Dice& dice, bool deltas);
/// One that lets nothing through, and one that lets something through.
std::string opaque(Dice& dice, bool deltas, int depth = 0);
std::string through(Dice& dice, bool deltas, int depth = 0);

RandomScene random_scene(uint64_t seed);

}  // namespace ajar::random
