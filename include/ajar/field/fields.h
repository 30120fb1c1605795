// Enters: what learn (learn.h) made of the passes so far.
// Leaves: the learned fields Q (incident radiance, guides camera subpaths) and W (incident importance, guides light
// subpaths) over cells of the scene's surfaces. Constant while a pass reads them.
#pragma once

#include "ajar/core/side.h"
#include "ajar/field/cells.h"
#include "ajar/field/lights.h"
#include "ajar/field/strata.h"
#include "ajar/field/views.h"

namespace ajar {

/// One field in one cell. Values are means over the cell: luminance of radiance for Q; for W importance, in pixels per
/// area where radiance is power per area (notation.md).
struct alignas(32) FieldCell {
  uint32_t root = none;  ///< of its strata
  float direct = 0;  ///< irradiance by light that next-event estimation brings (Q), or importance of the lens itself
                     ///< (W); not in the strata
  float total = 0;   ///< irradiance: direct and over all strata; of lamps that are hit, what is not left to light
                     ///< subpaths
  float mix = 0;     ///< g of (G4) for a diffuse surface: how much the strata are trusted
  float visits = 0;  ///< vertices of subpaths of the side that it guides, per area of the cell and path
  float near = 0;    ///< 1 / R of (G7): reciprocal of how far away the things are that its strata hold [1/m]
  static constexpr uint16_t no_portal = 0xffff;
  uint16_t portal = no_portal;  ///< through which the most arrives of what comes through one (CellTable::portals)
  uint16_t even = 0;            ///< 1: surfaces are not guided by the strata, which are as good as even (G14)
  float through = 0;            ///< share of the directions to be drawn through it, as far as it is trusted
};

/// g of (G4) for a diffuse surface, or a lamp; 0 where the strata are left out.
inline float mix_of(const FieldCell& cell) { return cell.even ? 0 : cell.mix; }

/// One learned field: strata of all cells. Hot: what sampling reads. mean and weight stand beside the nodes.
struct Field {
  std::vector<FieldCell> cells;
  std::vector<StrataNode> nodes;
  std::vector<UFloat16> mean;      ///< 16 per node: what the stratum's field is, without what is direct
  std::vector<UFloat16> weight;    ///< 16 per node: how much evidence stands behind it, in records of typical weight
  std::vector<FieldCell> portals;  ///< two for each portal, of what goes down and up its axis: strata of its disk
  double unit = 1;  ///< a typical value: of Q radiance, of W pixels' importance per area and solid angle [1/(m^2 sr)]
};

/// In a cache line of its own.
struct alignas(64) Cell {
  CellKey key = 0;
  Frame frame;                  ///< its strata are about frame.n
  Vec3 center{0};               ///< its strata are as seen from here
  float seen = 0;               ///< vertices since it was made
  uint32_t region = no_region;  ///< of the top-level cell that it is part of (views.h)
};

/// How the scene is divided into cells and a cell's hemisphere into strata (docs/method.md, "Structures").
enum class Structure : uint8_t {
  adaptive,  ///< cubes and strata that divide where the field asks for it
  grid,      ///< cubes of one size, 72 patches, sampled by their field alone (Comi 2019)
  probes     ///< hemispheres at points on surfaces, 72 patches, sampled by field times cosine (Dahm and Keller 2017)
};
/// What a segment's end is taken to scatter, for the record at its other end (docs/method.md, "Rules").
enum class Rule : uint8_t {
  expected,  ///< what its own strata bring (Dahm and Keller 2017, equation 5)
  max,       ///< as if all directions brought what the best of them brings (equation 1)
  returned   ///< what the path itself brought back from there
};

/// As the user writes them.
inline constexpr const char* structure_names[] = {"adaptive", "grid", "probes"};
inline constexpr const char* rule_names[] = {"expected", "max", "return"};

struct Fields {
  Structure structure = Structure::adaptive;
  Rule rule = Rule::expected;
  CellTable table;
  std::vector<Cell> cells;
  Field q, w;
  Views views;
  std::vector<double> lines;  ///< per portal: line_sums (portals.h) of all lessons, where portals are
  LearnedLights lights;       ///< V: a cut for every cell; none: lights are not learned
  LearnedLights starts;       ///< where light subpaths start: one cut
  Field disk;                 ///< importance over the disk across the scene, for each region of the sky (LightTree)
  uint32_t regions = 0;       ///< top-level cells
  uint32_t generation = 0;    ///< how often it was learned

  const Field& of(Side side) const;
};

// Below, `cell` indexes Fields::cells, and is never none.

/// Index into Field::mean and Field::weight of the stratum that holds a direction (z > 0) as the cell's centre sees it
/// (centered).
size_t find_stratum(const Fields& fields, const Field& field, uint32_t cell, const Vec3& local);
/// The same of a point of the unit square.
size_t find_stratum(const Field& field, const FieldCell& cell, Vec2 square);
/// A direction at a point of a cell as the cell's centre has it, in its frame: towards where the ray leaves the sphere
/// of radius R about the centre; z > 0 stays so. density: solid angle at the centre per solid angle at the point. (G7)
Vec3 centered(const Fields& fields, const Field& field, uint32_t cell, const Vec3& p, const Vec3& local,
              float& density);
/// Density per solid angle of a field in a cell at point p of it towards unit world direction w, by its strata and
/// through its portal (G11); 0 below the cell's horizon.
float pdf(const Fields& fields, const Field& field, uint32_t cell, const Vec3& p, const Vec3& w);
/// Draws a unit world direction at p: by the strata in proportion to the field times the cosine at the cell (grid: to
/// the field), or through the portal. Leaves its density per solid angle: 0 where it fell below the cell's horizon.
Vec3 sample(const Fields& fields, const Field& field, uint32_t cell, const Vec3& p, Vec2 u, float& density);
/// Bytes of all that is learned; shortcuts that are made of it (CellTable) are some per cent more.
size_t bytes(const Fields& fields);

}  // namespace ajar
