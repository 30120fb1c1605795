// Enters: what the paths of a pass saw.
// Leaves: sums per cell and stratum, in integers, so that threads may add in any order and the sums are the same.
#pragma once

#include <atomic>
#include <span>
#include <unordered_map>

#include "ajar/field/fields.h"

namespace ajar {

/// What a cell that does not exist yet was seen with.
struct Sighting {
  int64_t count = 0;
  glm::i64vec3 normal{0};  ///< sum, in steps of 2^-12
};
using Sightings = std::unordered_map<CellKey, Sighting>;

/// Sums for one field since it was last learned.
struct Tallies {
  std::vector<int64_t> value;            ///< 16 per node: weight times value, in fixed point
  std::vector<int64_t> weight;           ///< 16 per node
  std::vector<int64_t> direct;           ///< per cell
  std::vector<int64_t> held, nearness;   ///< per cell: the sums of (G8), of 1 and of 1 / distance
  std::vector<int64_t> directs, visits;  ///< per cell: how many
  std::vector<int64_t> lines;            ///< per portal: line_sums (portals.h)
  std::vector<int64_t> through;          ///< per cell: weight, weight times value of all records; of those through each
                                         ///< portal
};

/// How many of Tallies::through a cell has.
inline size_t sums_through(const Field& f) { return f.portals.empty() ? 0 : 2 + f.portals.size(); }

struct Training {
  Tallies q, w;
  ViewTallies views;
  LightTallies lights, starts;
  Tallies disk;

  Tallies& of(Side side);
};

/// Sums of zero for these fields, as large as their cells, strata and portals are now: they are to be started anew when
/// any of these change.
Training start_training(const Fields& fields);
/// Whether it has the sums that these fields ask for, and no others.
bool fits(const Training& training, const Fields& fields);
/// The same of one field's.
bool fits(const Tallies& tallies, const Field& field);
bool fits(const LightTallies& tallies, const LearnedLights& lights);

/// A segment as its cell gets to know it.
struct Record {
  Vec3 p{0};           ///< where in the cell it ends
  Vec3 w{0, 0, 1};     ///< unit world direction to the other end
  float distance = 1;  ///< to the other end
  float value = 0;     ///< the field's, from there
  float weight = 1;  ///< reciprocal of the density with which such segments are made, in units of that of a cosine lobe
};
/// Adds it to the stratum of the cell that w is in, to what the cell knows of distances and, where the field has
/// portals, to those that the segment's line crosses. Nothing where w lies below the cell's plane, the weight is not
/// positive, or the value is negative or no number; zero is a value. tallies: of this field.
void record(const Fields& fields, const Field& field, Tallies& tallies, uint32_t cell, const Record& record);
/// A record, and what it is for: whose field, and which cell of it.
struct FieldRecord {
  Side side;
  uint32_t cell = none;
  Record record;
};
inline constexpr size_t most_records = 4;
/// Several at once, most_records at most: memory is asked for all of them before any is added to, since atomic sums
/// wait for it one after the other.
void record(const Fields& fields, Training& training, std::span<const FieldRecord> records);
/// The same at a point of the unit square, of a field whose cells are such squares.
void record_square(const Field& field, Tallies& tallies, uint32_t cell, const Vec2& at, float value, float weight);
/// Irradiance (or the lens's importance) that a vertex in the cell got from next-event estimation; zeros too.
void record_direct(const Field& field, Tallies& tallies, uint32_t cell, float value);
/// A vertex lay in the cell.
void record_visit(Tallies& tallies, uint32_t cell);
/// A vertex with this normal lay where there is no cell yet; key: of the one that ought to be there.
void record_missing(Sightings& sightings, CellKey key, const Vec3& n);
/// A vertex with this normal lay here, where there may or may not be a cell: cells come to be, and divide, where there
/// are many.
void record_place(const Place& place, const Vec3& n, Tallies& tallies, Sightings& sightings);
/// Adds what one thread saw to what all saw, and empties it.
void gather(Sightings& to, Sightings& from);

}  // namespace ajar
