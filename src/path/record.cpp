#include "ajar/path/record.h"

namespace ajar {
namespace {

// A vertex as the fields see it.
struct End {
  uint32_t cell = none;
  float cosine = 0;           // of the segment here
  float q = 0, w = 0;         // radiance and importance that it scatters, to any direction
  double own = 0, other = 0;  // vertices per area of the tracing and of the other side
};

// What a vertex passes on from the vertices after it by delta events: the one sample that the path is.
struct Passed {
  float q = 0, w = 0;
  float distance = 0;  // to the place that it comes from, where it goes straight on; 0: it is turned
};

// Only reflects or refracts sharply: the fields know nothing of it.
bool passes(const Guide& guide) { return guide.bsdf.has_delta && !guide.bsdf.has_smooth; }

// Blank where the vertex scatters nothing that the fields could know.
End end_of(const Fields& fields, const Vertex& v, const Vec3& d, Side side, const Passed& passed = {}) {
  End e;
  e.cosine = std::abs(glm::dot(v.ng, d));
  e.q = v.emitted;
  if (passes(v.guide)) e.q += passed.q, e.w = passed.w;
  if (!is_known(v.guide) || !connectable(v.guide)) return e;
  e.cell = cell_towards(v.guide, d);
  const float share = scatters(v.guide);
  e.q += share * arrival(fields.q, v.guide).all, e.w = share * arrival(fields.w, v.guide).all;
  const float q = fields.q.cells[e.cell].visits, w = fields.w.cells[e.cell].visits;
  e.own = side == Side::camera ? q : w;
  e.other = side == Side::camera ? w : q;
  return e;
}

// Weight of the segment's record at an end: the reciprocal of the density of segments of both sides, relative to a
// cosine lobe from every vertex here.
float weight_at(const End& e, double density) { return float(std::max(e.own + e.other, 1e-30) * inv_pi / density); }

void record_segment(const Fields& fields, Training& training, const Vertex& a, const Vertex& b, Side side,
                    const Passed& passed) {
  const Vec3 d = -b.guide.wo;
  End from = end_of(fields, a, d, side), to = end_of(fields, b, d, side, passed);
  if (from.cell == none || !(from.cosine > 1e-4f) || !(to.cosine > 1e-4f)) return;
  if (to.cell == none && connectable(b.guide) && !(to.q > 0)) return;  // what it scatters is not known yet
  const double pdf = b.own * b.distance2 / to.cosine;
  const double back = back_density(b);
  if (from.own + from.other <= 0) from.own = 1;
  const double density = from.own * pdf / from.cosine + to.other * back / to.cosine;
  const float at_a = weight_at(from, density);
  const float distance = std::sqrt(b.distance2), beyond = distance + passed.distance;
  const float at_b = weight_at(to, density);
  const FieldRecord records[] = {{Side::camera, from.cell, {a.p, d, beyond, to.q, at_a}},
                                 {Side::light, from.cell, {a.p, d, beyond, to.w, at_a}},
                                 {Side::camera, to.cell, {b.p, -d, distance, from.q, at_b}},
                                 {Side::light, to.cell, {b.p, -d, distance, from.w, at_b}}};
  record(fields, training, std::span(records, to.cell == none ? 2 : 4));
}

// The field of the side that traced the segment, alone: the path knows nothing of the other's.
void record_return(const Fields& fields, Training& training, const Vertex& a, const Vertex& b, Side side,
                   float brought) {
  const Vec3 d = -b.guide.wo;
  const float cosine = std::abs(glm::dot(a.ng, d)), cosine_b = std::abs(glm::dot(b.ng, d));
  const uint32_t cell = cell_towards(a.guide, d);
  if (cell == none || !(cosine > 1e-4f) || !(cosine_b > 1e-4f)) return;
  const double pdf = b.own * b.distance2 / cosine_b;
  record(fields, fields.of(side), training.of(side), cell,
         {a.p, d, std::sqrt(b.distance2), brought, float(cosine * inv_pi / pdf)});
}

// Where a subpath left the scene there are infinite lights at most: Q, and no W.
void record_escape(const Fields& fields, Training& training, const Subpath& subpath, Side side) {
  const Escape& e = subpath.escape;
  if (!(e.pdf > 0) || subpath.n < 2) return;
  const Vertex& a = subpath[subpath.n - 1];
  End from = end_of(fields, a, e.d, side);
  if (from.cell == none || a.delta || !(from.cosine > 1e-4f)) return;
  if (from.own <= 0) from.own = 1;
  const bool one = fields.rule == Rule::returned;  // as in record_return
  const float weight =
      one ? float(from.cosine * inv_pi / e.pdf) : weight_at(from, from.own * double(e.pdf) / from.cosine);
  const FieldRecord records[] = {{Side::camera, from.cell, {a.p, e.d, infinity, e.radiance, weight}},
                                 {Side::light, from.cell, {a.p, e.d, infinity, 0, weight}}};
  record(fields, training, std::span(records + (one && side == Side::light), one ? 1 : 2));
}

// The lamp's own cell learns where W lies, too: it guides emission.
void record_emission(const Fields& fields, Training& training, Sightings& sightings, const Vertex& lamp,
                     const Vertex& first, const Passed& passed, float brought) {
  if (lamp.infinite || lamp.point.delta_position) return;
  const Place at = find(fields.table, lamp.p, lamp.ng);
  record_place(at, lamp.ng, training.w, sightings);
  if (at.cell == none) return;
  const Vec3 d = -first.guide.wo;
  const End to = end_of(fields, first, d, Side::light, passed);
  const float cosine = glm::dot(lamp.ng, d);
  if (!(to.cosine > 1e-4f) || !(cosine > 0)) return;
  const double pdf = first.own * first.distance2 / to.cosine;
  const float value = fields.rule == Rule::returned ? brought : to.w;
  record(fields, fields.w, training.w, at.cell,
         {lamp.p, d, std::sqrt(first.distance2) + passed.distance, value, float(cosine * inv_pi / pdf)});
}

// What vertex i would pass on to the one before it.
Passed passed_by(const Fields& fields, const Subpath& subpath, int i, Side side, const Passed& next) {
  if (!passes(subpath[i].guide)) return {};
  if (i + 1 >= subpath.n) {
    const Escape& e = subpath.escape;
    return {e.share * e.radiance, 0, glm::dot(subpath[i].guide.wo, -e.d) > straight_on ? infinity : 0};
  }
  const float here = luminance(subpath[i].beta);
  if (!(here > 0)) return {};
  const Vertex& after = subpath[i + 1];
  const End e = end_of(fields, after, after.guide.wo, side, next);
  const float share = luminance(after.beta) / here;
  const bool straight = glm::dot(subpath[i].guide.wo, after.guide.wo) > straight_on;
  return {share * e.q, share * e.w, straight ? std::sqrt(after.distance2) + next.distance : 0};
}

// What a vertex scatters back along the path, by what the path itself went on to find; next is the same of the vertex
// after it.
float brought_by(const Subpath& subpath, int i, Side side, float next) {
  const Vertex& v = subpath[i];
  float sum = v.emitted;
  if (connectable(v.guide)) sum += scatters(v.guide) * v.received;
  const float here = luminance(v.beta);
  if (i + 1 < subpath.n && here > 0) sum += next * luminance(subpath[i + 1].beta) / here;
  if (i + 1 == subpath.n && side == Side::camera) sum += subpath.escape.share * subpath.escape.radiance;
  return sum;
}

// A vertex whose light goes through counts on its other side as well.
void record_beyond(const Fields& fields, const Vertex& v, Tallies& tallies, Sightings& sightings) {
  if (!(v.guide.through > 0)) return;
  const Vec3 n = facing(v.ng, -v.guide.wo);
  record_place(find(fields.table, v.p, n), n, tallies, sightings);
}

}  // namespace

double back_density(const Vertex& v) {
  const Guide& g = v.guide;
  return g.back.near.bsdf * std::abs(glm::dot(v.ng, g.wo)) * inv_pi + g.back.near.field * g.back.pdf;
}

void record_subpath(const Fields& fields, Training& training, Sightings& sightings, const Subpath& subpath, Side side) {
  Tallies& own_tallies = training.of(side);
  record_escape(fields, training, subpath, side);
  float brought = 0;
  Passed passed;
  for (int i = subpath.n - 1; i >= 1; --i) {
    const Vertex& b = subpath[i];
    if (fields.rule == Rule::returned) brought = brought_by(subpath, i, side, brought);
    passed = passed_by(fields, subpath, i, side, passed);
    if (connectable(b.guide)) {
      record_place(b.guide, b.ng, training, sightings);
      record_beyond(fields, b, own_tallies, sightings);
    }
    const Vertex& a = subpath[i - 1];
    if (i == 1 || a.delta || !connectable(a.guide)) continue;
    if (fields.rule == Rule::returned)
      record_return(fields, training, a, b, side, brought);
    else
      record_segment(fields, training, a, b, side, passed);
  }
  if (side == Side::light && subpath.n > 1)
    record_emission(fields, training, sightings, subpath[0], subpath[1], passed, brought);
}

}  // namespace ajar
