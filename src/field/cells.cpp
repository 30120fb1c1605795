#include "ajar/field/cells.h"

#include "ajar/core/sampler.h"

namespace ajar {
namespace {

// Bits of a key, from the lowest: x, y, z (18 each), normal (5), level + 1 (4).
constexpr int bits = 18, most_coordinate = (1 << bits) - 1;

uint32_t normal_bin(const Vec3& n) {
  const auto third = [](float x) { return uint32_t(x > 1 / 3.0f ? 2 : x < -1 / 3.0f ? 0 : 1); };
  return third(n.x) + 3 * third(n.y) + 9 * third(n.z);
}

CellKey make_key(int level, uint32_t bin, const glm::uvec3& c) {
  return (uint64_t(level + 1) << 59) | (uint64_t(bin) << 54) | (uint64_t(c.z) << 36) | (uint64_t(c.y) << 18) | c.x;
}

const CellTable::Slot* find_slot(const CellTable& table, CellKey key) {
  const size_t mask = table.slots.size() - 1;
  for (size_t i = mix64(key) & mask;; i = (i + 1) & mask) {
    const CellTable::Slot& s = table.slots[i];
    if (s.key == key) return &s;
    if (s.key == 0) return nullptr;
  }
}

void place(CellTable& table, const CellTable::Slot& slot) {
  const size_t mask = table.slots.size() - 1;
  size_t i = mix64(slot.key) & mask;
  while (table.slots[i].key != 0) i = (i + 1) & mask;
  table.slots[i] = slot;
}

}  // namespace

CellTable make_cell_table(const Vec3& center, float radius) {
  CellTable t;
  t.width = radius / 6;
  // Walls like to stand at round coordinates; the cubes' faces should not coincide with them.
  t.origin = center - Vec3(1.0371f, 1.0193f, 1.0457f) * radius;
  t.slots.resize(256);
  return t;
}

Place find(const CellTable& table, const Vec3& p, const Vec3& n) {
  const Vec3 q = (p - table.origin) * (float(1 << most_cell_levels) / table.width);
  const glm::uvec3 c(glm::clamp(q, Vec3(0), Vec3(float(most_coordinate))));
  const uint32_t bin = normal_bin(n);
  Place out;
  for (int level = 0; level <= most_cell_levels; ++level) {
    const CellKey key = make_key(level, bin, c >> uint32_t(most_cell_levels - level));
    const CellTable::Slot* slot = find_slot(table, key);
    if (!slot) {
      out.missing = key;
      return out;
    }
    out.cell = slot->cell;
    if (!slot->divided) return out;
  }
  return out;
}

void insert(CellTable& table, CellKey key, uint32_t cell) {
  if (2 * (table.used + 1) > table.slots.size()) {
    std::vector<CellTable::Slot> old(2 * table.slots.size());
    old.swap(table.slots);
    for (const CellTable::Slot& s : old)
      if (s.key != 0) place(table, s);
  }
  place(table, {key, cell, false});
  ++table.used;
}

uint32_t cell_of(const CellTable& table, CellKey key) {
  const CellTable::Slot* slot = find_slot(table, key);
  return slot ? slot->cell : none;
}

void set_divided(CellTable& table, CellKey key) { const_cast<CellTable::Slot*>(find_slot(table, key))->divided = true; }

int level_of(CellKey key) { return int(key >> 59) - 1; }

CellKey parent_of(CellKey key) {
  const int level = level_of(key);
  if (level <= 0) return 0;
  const glm::uvec3 c(key & most_coordinate, (key >> 18) & most_coordinate, (key >> 36) & most_coordinate);
  return make_key(level - 1, uint32_t(key >> 54) & 31, c >> 1u);
}

}  // namespace ajar
