#include "ajar/field/training.h"

#include <array>

#include "ajar/core/sampler.h"
#include "ajar/field/portals.h"
#include "fixed.h"

namespace ajar {
namespace {

void add_record(const Field& field, Tallies& tallies, size_t stratum, float value, float weight) {
  const double clamped = std::min(double(weight), largest_weight);
  add(tallies.weight[stratum], to_fixed(clamped, weight_step));
  if (value > 0) add(tallies.value[stratum], to_fixed(clamped * value / field.unit, value_step));
}

void resize(Tallies& t, const Field& f) {
  t.value.assign(16 * f.nodes.size(), 0);
  t.weight.assign(16 * f.nodes.size(), 0);
  t.direct.assign(f.cells.size(), 0);
  t.held.assign(f.cells.size(), 0);
  t.nearness.assign(f.cells.size(), 0);
  t.directs.assign(f.cells.size(), 0);
  t.visits.assign(f.cells.size(), 0);
  t.lines.assign(f.portals.size() / 2 * line_sums, 0);
  t.through.assign(f.cells.size() * sums_through(f), 0);
}

// What is brightest decides how far away things are; nothing is nearer than a cell is wide. (G8)
void add_distance(const Fields& fields, const Field& field, Tallies& tallies, uint32_t cell, const Record& r) {
  const float total = field.cells[cell].total, above = total > 0 ? std::min(pi * r.value / total, 64.0f) : 1;
  const double held = std::min(double(r.weight), largest_weight) * r.value * above / field.unit;
  add(tallies.held[cell], to_fixed(held, value_step));
  const float nearest = std::ldexp(1.0f, level_of(fields.cells[cell].key));
  add(tallies.nearness[cell], to_fixed(held * std::min(fields.table.width / r.distance, nearest), value_step));
}

// What would have come through a portal, had nothing been in the way before it, counts as nothing.
void add_crossings(const Fields& fields, const Field& field, Tallies& tallies, uint32_t cell, const Record& r) {
  const uint32_t n = uint32_t(field.portals.size() / 2);
  const double weight = std::min(double(r.weight), largest_weight), carried = weight * r.value / field.unit;
  int64_t* const sums = tallies.through.data() + cell * sums_through(field);
  const auto count = [&](uint32_t at) {
    add(sums[at], to_fixed(weight, weight_step)), add(sums[at + 1], to_fixed(carried, value_step));
  };
  count(0);
  for (uint32_t k = 0; k < n; ++k) {
    const Portal& portal = fields.table.portals[k];
    Crossing at;
    if (!cross(portal, k, r.p, r.w, at)) continue;
    const float margin = portal_margin * fields.table.width / std::abs(r.w[portal.axis]);
    const bool through = at.distance > margin && at.distance + margin < r.distance;
    add_record(field, tallies, find_stratum(field, field.portals[at.cell], at.square), through ? r.value : 0, r.weight);
    if (!through) continue;
    count(2 + 2 * k);
    if (carried > 0) record_line(portal, r.p, r.w, std::sqrt(carried), tallies.lines.data() + k * line_sums);
  }
}

constexpr size_t no_stratum = ~size_t(0);

// Where a record goes; no_stratum if it says nothing.
size_t stratum_of(const Fields& fields, const Field& field, uint32_t cell, const Record& r) {
  const Vec3 local = fields.cells[cell].frame.to_local(r.w);
  if (!(local.z > 0) || !(r.weight > 0) || !(r.value >= 0)) return no_stratum;
  float density;
  return find_stratum(fields, field, cell, centered(fields, field, cell, r.p, local, density));
}

void add_record(const Fields& fields, const Field& field, Tallies& tallies, uint32_t cell, size_t stratum,
                const Record& r) {
  if (stratum == no_stratum) return;
  add_record(field, tallies, stratum, r.value, r.weight);
  if (r.value > 0) add_distance(fields, field, tallies, cell, r);
  if (!field.portals.empty()) add_crossings(fields, field, tallies, cell, r);
}

void fetch(const Tallies& tallies, uint32_t cell, size_t stratum) {
  if (stratum == no_stratum) return;
  __builtin_prefetch(&tallies.weight[stratum], 1), __builtin_prefetch(&tallies.value[stratum], 1);
  __builtin_prefetch(&tallies.held[cell], 1), __builtin_prefetch(&tallies.nearness[cell], 1);
}

}  // namespace

Tallies& Training::of(Side side) { return side == Side::camera ? q : w; }

Training start_training(const Fields& fields) {
  Training t;
  resize(t.q, fields.q);
  resize(t.w, fields.w);
  t.views = start_tallies(fields.views);
  t.lights = start_tallies(fields.lights), t.starts = start_tallies(fields.starts);
  resize(t.disk, fields.disk);
  return t;
}

bool fits(const Tallies& t, const Field& f) {
  const size_t strata = 16 * f.nodes.size(), cells = f.cells.size();
  return t.value.size() == strata && t.weight.size() == strata && t.direct.size() == cells &&
         t.directs.size() == cells && t.visits.size() == cells && t.held.size() == cells &&
         t.nearness.size() == cells && t.lines.size() == f.portals.size() / 2 * line_sums &&
         t.through.size() == cells * sums_through(f);
}

bool fits(const LightTallies& t, const LearnedLights& v) {
  const size_t n = v.entries.size();
  return t.square.size() == n && t.hits.size() == n && t.tried.size() == n;
}

bool fits(const Training& t, const Fields& f) {
  return fits(t.q, f.q) && fits(t.w, f.w) && fits(t.disk, f.disk) && fits(t.lights, f.lights) &&
         fits(t.starts, f.starts) && t.views.counts.size() == start_tallies(f.views).counts.size();
}

void record(const Fields& fields, const Field& field, Tallies& tallies, uint32_t cell, const Record& r) {
  add_record(fields, field, tallies, cell, stratum_of(fields, field, cell, r), r);
}

void record(const Fields& fields, Training& training, std::span<const FieldRecord> records) {
  std::array<size_t, most_records> strata;
  for (size_t i = 0; i < records.size(); ++i) {
    const FieldRecord& r = records[i];
    strata[i] = stratum_of(fields, fields.of(r.side), r.cell, r.record);
    fetch(training.of(r.side), r.cell, strata[i]);
  }
  for (size_t i = 0; i < records.size(); ++i) {
    const FieldRecord& r = records[i];
    add_record(fields, fields.of(r.side), training.of(r.side), r.cell, strata[i], r.record);
  }
}

void record_square(const Field& field, Tallies& tallies, uint32_t cell, const Vec2& at, float value, float weight) {
  if (weight > 0 && value >= 0) add_record(field, tallies, find_stratum(field, field.cells[cell], at), value, weight);
}

void record_direct(const Field& field, Tallies& tallies, uint32_t cell, float value) {
  add(tallies.directs[cell], 1);
  if (value > 0) add(tallies.direct[cell], to_fixed(value / field.unit, value_step));
}

void record_visit(Tallies& tallies, uint32_t cell) { add(tallies.visits[cell], 1); }

void record_missing(Sightings& sightings, CellKey key, const Vec3& n) {
  Sighting& s = sightings[key];
  ++s.count;
  s.normal += glm::i64vec3(n * 4096.0f);
}

void record_place(const Place& place, const Vec3& n, Tallies& tallies, Sightings& sightings) {
  if (place.missing) record_missing(sightings, place.missing, n);
  if (place.cell != none) record_visit(tallies, place.cell);
}

void gather(Sightings& to, Sightings& from) {
  for (const auto& [key, s] : from) to[key].count += s.count, to[key].normal += s.normal;
  from.clear();
}

}  // namespace ajar
