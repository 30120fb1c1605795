#include "ajar/field/cells.h"

#include <algorithm>

#include "ajar/core/sampler.h"
#include "shortcuts.h"

namespace ajar {
namespace {

// Where a key is among the slots, or the free slot where it would be.
size_t slot_of(const CellTable& table, CellKey key) {
  const size_t mask = table.slots.size() - 1;
  size_t i = mix64(key) & mask;
  while (table.slots[i].key != key && table.slots[i].key != 0) i = (i + 1) & mask;
  return i;
}

const CellTable::Slot* find_slot(const CellTable& table, CellKey key) {
  const CellTable::Slot& slot = table.slots[slot_of(table, key)];
  return slot.key == key ? &slot : nullptr;
}

// What a cell's parent has of it; null where no parent is divided.
CellTable::Part* entry_in_parent(CellTable& table, CellKey key) {
  const CellKey above = parent_of(key);
  const CellTable::Slot* parent = above ? find_slot(table, above) : nullptr;
  return parent && parent->at.parts ? &table.parts[parent->at.parts][octant_of(coordinates_of(key))] : nullptr;
}

// A point on the finest level.
Vec3 scaled(const CellTable& table, const Vec3& p) {
  return (p - table.origin) * (float(1 << most_cell_levels) / table.width);
}

// Whether keys reach as far.
bool in_range(const Vec3& scaled) {
  const auto is_in = [](float x) { return x >= 0 && x < float(most_coordinate); };
  return is_in(scaled.x) && is_in(scaled.y) && is_in(scaled.z);
}

glm::uvec3 coordinates(const Vec3& scaled) {
  const auto cut = [](float x) { return uint32_t(std::min(std::max(0.0f, x), float(most_coordinate))); };
  return {cut(scaled.x), cut(scaled.y), cut(scaled.z)};
}

// Which part of its cube of level 0 a point is in.
uint32_t compartment_of(const CellTable& table, size_t cube, const Vec3& p) {
  int32_t at = cube < table.compartments.size() ? table.compartments[cube] : ~0;
  while (at >= 0) {
    const CellCut& cut = table.cuts[size_t(at)];
    at = component(p, cut.axis) < cut.at ? cut.below : cut.above;
  }
  return uint32_t(~at);
}

// Nearest probe to a point with a similar normal, or its opposite; none where there is none within reach.
struct Search {
  const std::vector<Probe>& probes;
  Vec3 p, n;
  float nearest2;
  uint32_t found = none;
};

void search(Search& s, size_t from, size_t to) {
  constexpr float similar = 0.8f;
  while (from < to) {
    const size_t middle = (from + to) / 2;
    const Probe& probe = s.probes[middle];
    const float d2 = length2(probe.p - s.p);
    if (d2 < s.nearest2 && std::abs(glm::dot(probe.n, s.n)) > similar) s.nearest2 = d2, s.found = uint32_t(middle);
    const float across = s.p[int(probe.axis)] - probe.p[int(probe.axis)];
    if (across < 0) {
      search(s, from, middle);
      from = middle + 1;
    } else {
      search(s, middle + 1, to);
      to = middle;
    }
    if (sqr(across) >= s.nearest2) return;
  }
}

Place find_probe(const CellTable& table, const Vec3& p, const Vec3& n) {
  Search s{table.probes, p, n, sqr(4 * table.width)};
  search(s, 0, table.probes.size());
  if (s.found == none) return {};
  const bool back = glm::dot(table.probes[s.found].n, n) < 0;
  const CellKey key = make_key(0, {back, 0}, {s.found & most_coordinate, s.found >> coordinate_bits, 0});
  const CellTable::Slot* slot = find_slot(table, key);
  return slot ? Place{slot->at.cell, 0} : Place{none, key};
}

// Orders a range of probes as a kd-tree.
void order(std::vector<Probe>& probes, size_t from, size_t to) {
  if (from >= to) return;
  Vec3 low(infinity), high(-infinity);
  for (size_t i = from; i < to; ++i) low = glm::min(low, probes[i].p), high = glm::max(high, probes[i].p);
  const Vec3 extent = high - low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const size_t middle = (from + to) / 2;
  const auto at = [&](size_t i) { return probes.begin() + ptrdiff_t(i); };
  std::nth_element(at(from), at(middle), at(to), [&](const Probe& a, const Probe& b) { return a.p[axis] < b.p[axis]; });
  probes[middle].axis = uint32_t(axis);
  order(probes, from, middle);
  order(probes, middle + 1, to);
}

void place(CellTable& table, const CellTable::Slot& slot) { table.slots[slot_of(table, slot.key)] = slot; }

}  // namespace

uint32_t normal_bin(const Vec3& n) {
  const auto third = [](float x) { return uint32_t(!(x < -1 / 3.0f)) + uint32_t(x > 1 / 3.0f); };
  return third(n.x) + 3 * third(n.y) + 9 * third(n.z);
}

CellTable make_cell_table(const Vec3& center, float radius, float width) {
  // Walls like to stand at round coordinates; the cubes' faces should not coincide with them.
  const Vec3 before = Vec3(1.0371f, 1.0193f, 1.0457f) * radius;
  CellTable t;
  t.width = width > 0 ? width : radius / 6;
  const auto across = uint32_t(std::ceil(2 * before.z / t.width));
  t.first = ((most_coordinate >> most_cell_levels) + 1 - across) / 2;
  t.origin = center - before - float(t.first) * t.width;
  t.slots.resize(256);
  return t;
}

CellTable make_probe_table(std::vector<Probe> probes, double area) {
  CellTable t;
  t.width = std::max(float(std::sqrt(area / double(std::max(probes.size(), size_t(1))))), 1e-18f);
  t.slots.resize(256);
  order(probes, 0, probes.size());
  t.probes = std::move(probes);
  return t;
}

size_t top_cube(const CellTable& table, const Vec3& p) {
  return top_cube(table, coordinates(scaled(table, p)) >> uint32_t(most_cell_levels));
}

Place find(const CellTable& table, const Vec3& p, const Vec3& n) {
  if (!table.probes.empty()) return find_probe(table, p, n);
  const Vec3 at_finest = scaled(table, p);
  if (table.slots.empty() || !in_range(at_finest)) return {};
  const glm::uvec3 c(at_finest);
  const glm::uvec3 at_top = c >> uint32_t(most_cell_levels);
  const size_t cube = top_cube(table, at_top);
  const CellKind kind{normal_bin(n), compartment_of(table, cube, p)};
  if (Place at; follow(table.shortcuts, cube, kind, c, at)) return at;
  const CellKey top = make_key(0, kind, at_top);
  const CellTable::Slot* slot = find_slot(table, top);
  if (!slot) return {none, top};
  CellTable::Part at = slot->at;
  for (uint32_t level = 1; at.parts != 0 && level <= uint32_t(most_cell_levels); ++level) {
    const glm::uvec3 part = c >> (uint32_t(most_cell_levels) - level);
    const CellTable::Part next = table.parts[at.parts][octant_of(part)];
    if (next.cell == none) return {at.cell, make_key(int(level), kind, part)};
    at = next;
  }
  return {at.cell, 0};
}

void insert(CellTable& table, CellKey key, uint32_t cell) {
  table.shortcuts = {};
  if (2 * (table.used + 1) > table.slots.size()) {
    std::vector<CellTable::Slot> old(2 * table.slots.size());
    old.swap(table.slots);
    for (const CellTable::Slot& s : old)
      if (s.key != 0) place(table, s);
  }
  place(table, {key, {cell, 0}});
  ++table.used;
  if (CellTable::Part* entry = entry_in_parent(table, key)) *entry = {cell, 0};
}

uint32_t cell_of(const CellTable& table, CellKey key) {
  const CellTable::Slot* slot = find_slot(table, key);
  return slot ? slot->at.cell : none;
}

void set_divided(CellTable& table, CellKey key) {
  CellTable::Part& at = table.slots[slot_of(table, key)].at;
  if (at.parts != 0) return;
  table.shortcuts = {};
  if (table.parts.empty()) table.parts.resize(1);
  at.parts = uint32_t(table.parts.size());
  std::array<CellTable::Part, 8>& parts = table.parts.emplace_back();
  for (uint32_t i = 0; i < 8; ++i) {
    const glm::uvec3 c = part_of(coordinates_of(key), i);
    const CellTable::Slot* slot = find_slot(table, make_key(level_of(key) + 1, kind_of(key), c));
    if (slot) parts[i] = slot->at;
  }
  if (CellTable::Part* entry = entry_in_parent(table, key)) entry->parts = at.parts;
}

int level_of(CellKey key) { return int(key >> at_level) - 1; }

Box cube_of(const CellTable& table, CellKey key) {
  const glm::uvec3 c = coordinates_of(key);
  if (!table.probes.empty()) {
    const Vec3 p = table.probes[std::min(size_t(c.x) | size_t(c.y) << coordinate_bits, table.probes.size() - 1)].p;
    return {p, p};
  }
  const float edge = table.edge(level_of(key));
  const Vec3 low = table.origin + Vec3(c) * edge;
  return {low, low + edge};
}

Vec3 middle_of(const CellTable& table, CellKey key) {
  const Box cube = cube_of(table, key);
  return 0.5f * (cube.lo + cube.hi);
}

CellKey parent_of(CellKey key) {
  const int level = level_of(key);
  if (level <= 0) return 0;
  const glm::uvec3 c = coordinates_of(key);
  return make_key(level - 1, kind_of(key), c >> 1u);
}

}  // namespace ajar
