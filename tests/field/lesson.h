// Enters: hand-made records.
// Leaves: fields that learned from them, and what they hold.
#pragma once

#include <cstring>

#include "ajar/core/sampler.h"
#include "ajar/field/learn.h"

namespace ajar {

inline const Vec3 up(0, 0, 1), somewhere(0.1f, 0.1f, 0.1f);

/// A direction in the middle of a stratum of the root, seen from a cell whose frame is the world's.
inline Vec3 towards(int stratum, const Vec2& within = Vec2(0.5f)) {
  return from_square((Vec2(stratum & 3, stratum >> 2) + within) / 4.0f);
}

inline Sightings seen(CellKey key, const Vec3& n, int times) {
  Sightings s;
  for (int i = 0; i < times; ++i) record_missing(s, key, n);
  return s;
}

/// Fields with a cell around somewhere that knows nothing yet.
inline Fields one_cell() {
  Fields f;
  f.table = make_cell_table(Vec3(0), 1);
  const Sightings s = seen(find(f.table, somewhere, up).missing, up, 4);
  f = learn(f, start_training(f), s, 1, {});
  if (f.cells.size() == 1) f.cells[0].frame = {Vec3(1, 0, 0), Vec3(0, 1, 0), up};
  return f;
}

/// Records of one field, Q or W, in the first cell.
struct Lesson {
  Fields fields;
  Training training = start_training(fields);
  Side side = Side::camera;

  explicit Lesson(const Fields& f, Side s = Side::camera) : fields(f), side(s) {}
  void add(const Vec3& w, float value, float weight) {
    record(fields, fields.of(side), training.of(side), 0, {somewhere, w, 1e30f, value, weight});
  }
  Fields learned(const LearnOptions& options = {}) const { return learn(fields, training, {}, 1, options); }
};

/// Strata stay whole, however much of the field they hold.
inline LearnOptions whole_strata() {
  LearnOptions o;
  o.divide_stratum = 1;
  return o;
}

inline float mean_of(const Field& f, int stratum) { return f.mean[16 * size_t(f.cells[0].root) + size_t(stratum)]; }
inline float weight_of(const Field& f, int stratum) { return f.weight[16 * size_t(f.cells[0].root) + size_t(stratum)]; }

/// What 16 bits keep of it.
inline float kept(float x) { return UFloat16(x); }

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}
inline bool same_field(const Field& a, const Field& b) {
  return same_bytes(a.cells, b.cells) && a.nodes == b.nodes && same_bytes(a.mean, b.mean) &&
         same_bytes(a.weight, b.weight);
}
inline bool same_training(const Tallies& a, const Tallies& b) {
  return a.value == b.value && a.weight == b.weight && a.direct == b.direct && a.directs == b.directs &&
         a.visits == b.visits;
}

}  // namespace ajar
