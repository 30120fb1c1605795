#include "ajar/field/emission.h"

#include "ajar/core/warp.h"
#include "ajar/field/guide.h"
#include "ajar/field/nextevent.h"
#include "ajar/scene/geometry.h"

namespace ajar {
namespace {

// Cell of W at a point of an area light, and its share of the mixture; none where the lamp's own cosine is left alone.
uint32_t emission_cell(const Fields* fields, const LightPoint& point, float& mix) {
  mix = 0;
  if (!fields || point.infinite || point.delta_position) return none;
  const uint32_t cell = find(fields->table, point.p, point.n).cell;
  if (cell != none) mix = mix_of(fields->w.cells[cell]);
  return mix > 0 ? cell : none;
}

const LightCut* cut_of(const Fields* fields) {
  return fields && !fields->starts.cuts.empty() ? &fields->starts.cuts[0] : nullptr;
}

// Probability with which light subpaths start at a piece.   (V5) Never nothing, which no other density could be held
// against: beside a lamp 10^16 times as bright the share of a faint one is lost in the sum.
double start_pdf(const LightTree& tree, const Fields* fields, uint32_t place) {
  const double power = std::max(power_of(tree, place, place + 1), 1e-30 * tree.power_before.back());
  const LightCut* cut = cut_of(fields);
  if (!cut) return power / tree.power_before.back();
  const uint32_t entry = entry_of(fields->starts, *cut, place);
  const double of_entry = power_of(tree, fields->starts.entries[entry].first, end_of(tree, fields->starts, entry));
  return power / std::max(of_entry, power) * std::max(double(share_of(fields->starts, *cut, entry)), 1e-30);
}

// Of a light of the sky.
double power_share(const LightTree& tree, uint32_t light) {
  for (const SkyLight& s : tree.sky)
    if (s.light == light) return power_of(tree, s.first, s.last) / tree.power_before.back();
  return 0;
}

uint32_t choose_start(const LightTree& tree, const Fields* fields, float u) {
  if (tree.pieces.size() == 1) return 0;
  const LightCut* cut = cut_of(fields);
  if (!cut) return choose_by_power(tree, 0, uint32_t(tree.pieces.size()), u);
  const uint32_t entry = choose_entry(fields->starts, *cut, u);
  return choose_by_power(tree, fields->starts.entries[entry].first, end_of(tree, fields->starts, entry), u);
}

// How a start is found: its density (infinite: of its direction), the choice included, and the part of the sky that an
// infinite light's direction belongs to.
struct Start {
  double density = 0;
  uint32_t region = none;
};
Start start_at(const Scene& scene, const Fields* fields, const LightPoint& point, const Vec3& direction) {
  Start out;
  if (!fields && !scene.light_tree.sky.empty()) {  // whole
    out.density = power_share(scene.light_tree, point.light) * double(pdf_emission(scene, point, direction).direction);
    return out;
  }
  PieceDensity found[most_shares];
  const int n = densities_emission(scene, point, direction, found);
  int best = 0;
  for (int i = 0; i < n; ++i) {
    out.density += double(found[i].pdf) * start_pdf(scene.light_tree, fields, found[i].place);
    if (found[i].pdf > found[best].pdf) best = i;
  }
  if (n > 0 && point.infinite) out.region = scene.light_tree.region[found[best].place];
  return out;
}

// Of the disk across the scene, as a square (G1), and its area over that of the square.
Vec2 square_of(const Scene& scene, const Vec3& p, const Vec3& direction) {
  const Frame f = make_frame(direction);
  const Vec3 v = (p - scene.center) / scene.radius;
  Vec2 at(glm::dot(f.s, v), glm::dot(f.t, v));
  if (const float l2 = glm::dot(at, at); l2 > 1) at /= std::sqrt(l2);
  return to_square({at.x, at.y, 0});
}

float disk_mix(const Fields* fields, uint32_t region) {
  return fields && region < fields->disk.cells.size() ? fields->disk.cells[region].mix : 0;
}

// Density on the unit disk, which was stretched to the square.
float disk_density(const Field& disk, uint32_t region, const Vec2& square) {
  const Vec3 at = from_square(square);
  return density(disk.nodes, disk.cells[region].root, square) * square_density({at.x, at.y, 1});
}

// Density of the start's place on the disk, per area.   (V6)
float disk_pdf(const Scene& scene, const Fields* fields, uint32_t region, const Vec2& square) {
  const float mix = disk_mix(fields, region), even = (1 - mix) * inv_pi;
  const float guided = mix > 0 ? mix * disk_density(fields->disk, region, square) : 0;
  return (even + guided) / (scene.radius * scene.radius);
}

void guide_place(const Scene& scene, const Fields* fields, uint32_t region, Vec2 u, EmissionSample& out) {
  const float mix = disk_mix(fields, region);
  if (!(mix > 0)) return;
  if (take_part(u.x, mix)) {
    float over_square;
    const Vec3 at = from_square(sample(fields->disk.nodes, fields->disk.cells[region].root, u, over_square));
    const Frame f = make_frame(out.direction);
    out.point.p = scene.center + scene.radius * (f.s * at.x + f.t * at.y - out.direction);
  } else {
    place_on_disk(scene, u, out);
  }
  out.pdf_position = disk_pdf(scene, fields, region, square_of(scene, out.point.p, out.direction));
}

// W at the lamp mixed with its own cosine.
bool guide_direction(const Fields* fields, Vec2 u, EmissionSample& out) {
  float mix;
  const uint32_t cell = emission_cell(fields, out.point, mix);
  if (cell == none) return true;
  float pdf_field;
  if (take_part(u.x, mix)) {
    out.direction = sample(*fields, fields->w, cell, out.point.p, u, pdf_field);
    // Through a portal a direction may fall below the cell's horizon, where the field has no density, and still leave
    // the lamp, whose normal is another.
    if (!(pdf_field > 0) || !(glm::dot(out.direction, out.point.n) > 0)) return false;
  } else {
    out.direction = make_frame(out.point.n).to_world(to_cosine_hemisphere(u));
    pdf_field = pdf(*fields, fields->w, cell, out.point.p, out.direction);
  }
  out.pdf_direction = (1 - mix) * std::max(glm::dot(out.point.n, out.direction), 0.0f) * inv_pi + mix * pdf_field;
  return out.pdf_direction > 0;
}

// Rays of camera subpaths to the light, per area of the disk across the scene and solid angle. 0: none, or unknown.
double camera_rays(const Fields& fields, const WayBack& way, const Vec3& wi) {
  if (!way.guide || !is_known(*way.guide)) return 0;
  const float cosine = std::abs(glm::dot(way.guide->ng, wi));
  return cosine > 1e-4f ? double(fields.q.cells[way.guide->cell].visits) * way.pdf / double(cosine) : 0;
}

// What a ray from the disk brings per watt. Rays of both sides teach, weighed by what both make of them, relative to
// even starts.   (V8)
void record_on_disk(const Scene& scene, const Fields& fields, Training& training, uint32_t region, const Vec2& square,
                    float per_watt, double of_light, double of_camera, float share) {
  const double even = double(inv_pi) / sqr(double(scene.radius));
  record_square(fields.disk, training.disk, region, square, per_watt, share * float(even / (of_light + of_camera)));
}

}  // namespace

bool sample_emission(const Scene& scene, const Fields* fields, float u_choice, const Vec2& u_position,
                     const Vec2& u_direction, EmissionSample& out) {
  const LightTree& tree = scene.light_tree;
  if (tree.nodes.empty()) return false;
  const uint32_t place = choose_start(tree, fields, u_choice);
  const bool emits = sample_emission(scene, tree.pieces[place], u_position, u_direction, out);
  out.point.place = place;
  if (!emits) return false;
  if (out.point.infinite) {
    const Start start = start_at(scene, fields, out.point, out.direction);
    out.pdf_direction = float(start.density);
    guide_place(scene, fields, start.region, u_position, out);
  } else {
    out.pdf_position *= float(start_pdf(tree, fields, place));
    if (!guide_direction(fields, u_direction, out)) return false;
  }
  return out.pdf_position > 0 && out.pdf_direction > 0;
}

EmissionPdf pdf_emission(const Scene& scene, const Fields* fields, const LightPoint& point, const Vec3& direction) {
  const Start start = start_at(scene, fields, point, direction);
  if (point.infinite) {
    const bool guided = disk_mix(fields, start.region) > 0;
    return {disk_pdf(scene, fields, start.region, guided ? square_of(scene, point.p, direction) : Vec2(0)),
            float(start.density)};
  }
  EmissionPdf e = pdf_emission(scene, point, direction);
  e.position = float(start.density);
  float mix;
  const uint32_t cell = emission_cell(fields, point, mix);
  if (cell != none && e.direction > 0)
    e.direction = (1 - mix) * e.direction + mix * pdf(*fields, fields->w, cell, point.p, direction);
  return e;
}

void record_start(const Scene& scene, const Fields& fields, Training& training, const EmissionSample& start,
                  float brings, float per_watt, const WayBack& way) {
  const LightCut* cut = cut_of(&fields);
  if (cut && start.point.place != none) {
    const LightTree& tree = scene.light_tree;
    const uint32_t entry = entry_of(fields.starts, *cut, start.point.place);
    const double power = power_of(tree, fields.starts.entries[entry].first, end_of(tree, fields.starts, entry));
    const float share = share_of(fields.starts, *cut, entry);
    record(fields.starts, training.starts, entry, power > 0 ? float(double(brings * share) / power) : 0);
  }
  if (!start.point.infinite) return;
  const uint32_t region = start_at(scene, &fields, start.point, start.direction).region;
  if (region >= fields.disk.cells.size()) return;
  record_on_disk(scene, fields, training, region, square_of(scene, start.point.p, start.direction), per_watt,
                 start.pdf_position, camera_rays(fields, way, start.direction) / double(start.pdf_direction), 1);
}

void record_start(const Scene& scene, const Fields& fields, Training& training, const LightPoint& point, const Vec3& wi,
                  const WayBack& way, float through, int count) {
  const Start start = start_at(scene, &fields, point, -wi);
  const double of_camera = start.density > 0 ? camera_rays(fields, way, wi) / start.density : 0;
  if (!(of_camera > 0) || start.region >= fields.disk.cells.size()) return;
  const Vec2 square = square_of(scene, way.guide->p, -wi);
  const float per_watt = through * scatters(*way.guide) * arrival(fields.w, *way.guide).all;
  record_on_disk(scene, fields, training, start.region, square, per_watt,
                 double(disk_pdf(scene, &fields, start.region, square)), of_camera, 1 / float(count));
}

}  // namespace ajar
