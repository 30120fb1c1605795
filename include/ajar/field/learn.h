// Enters: fields and what passes recorded through them.
// Leaves: the next fields. The one place where fields change.
#pragma once

#include "ajar/field/training.h"
#include "ajar/scene/scene.h"

namespace ajar {

/// Whose subpaths the fields guide. Both fields are learned in any case, and both tell roulette what to expect.
enum class Guided : uint8_t { both, camera, light, neither };
inline constexpr const char* guided_names[] = {"both", "camera", "light"};  ///< that a user may choose among

struct LearnOptions {
  Structure structure = Structure::adaptive;  ///< of fields that start from nothing
  Rule rule = Rule::expected;
  size_t memory = size_t(8) << 20;  ///< bytes that all of it may take: four tenths before small cells get no more
  float divide_cell = 600;          ///< vertices after which a cell is divided
  float divide_stratum = 0.03f;     ///< share of its cell's field above which a stratum is divided
  float trust = 32;                 ///< records after which half of the largest mix is given to the strata
  float mix = 0.8f;                 ///< largest g of (G4)
  float least_contrast = 10;        ///< below, a cell's strata do not guide: left side of (G14)
  float forget = 0.5f;              ///< share of older evidence that is kept; 1: a stratum is the mean of its records
  bool steady = false;              ///< a cell's field stays as it is until what was learned contradicts it (T2)
  uint32_t train = 0;  ///< passes of training, even, after which fields are frozen; half of a time limit at most; 0:
                       ///< they learn all along
  Guided guided = Guided::both;
  bool lights = true;  ///< next-event estimation learns which lights a cell sees
};

/// Fields that know nothing: every look-up finds no cell. Grid and probes are as fine as the memory lets them be.
Fields start_fields(const Scene& scene, double pixels, const LearnOptions& options = {});
/// Subpaths that were recorded: of the camera, which teach Q, and of lights, which teach W.
struct Recorded {
  double camera = 0, light = 0;
  Recorded(double of_camera, double of_lights) : camera(of_camera), light(of_lights) {}
  Recorded(double pairs) : camera(pairs), light(pairs) {}
};
/// lights: of the scene; null: they are not learned.
Fields learn(const Fields& fields, const Training& training, const Sightings& sightings, const Recorded& paths,
             const LearnOptions& options, const LightTree* lights = nullptr);
/// Fields of a scene before something in it moved, for the scene after: of the evidence of cells that the boxes touch,
/// grown by the cell's own edge, the share `kept` counts from now on, and less of their mix is the field's. Values stay
/// as a first guess.
Fields doubt(const Fields& fields, const std::vector<Box>& moved, float kept, const LearnOptions& options);
/// Makes stored fields those of this tree and of these options: what was learned of the lights of another tree (that of
/// another LightChoice) is forgotten. False where nothing had to change.
bool fit_lights(const LightTree& tree, const LearnOptions& options, Fields& fields);
/// Whether they are so: fit_lights would change nothing.
bool fits(const Fields& fields, const LightTree& tree, const LearnOptions& options);
/// Takes the field away from the side that is not to be guided: its mix is 0.
void restrict_to(Fields& fields, Guided guided);

}  // namespace ajar
