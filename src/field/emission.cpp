#include "ajar/field/emission.h"

#include "ajar/core/warp.h"

namespace ajar {
namespace {

// Cell of W at a point of an area light, and its share of the mixture; none where the lamp's own cosine is left alone.
uint32_t emission_cell(const Fields* fields, const LightPoint& point, float& mix) {
  mix = 0;
  if (!fields || point.infinite || point.delta_position) return none;
  const uint32_t cell = find(fields->table, point.p, point.n).cell;
  if (cell != none) mix = fields->w.cells[cell].mix;
  return mix > 0 ? cell : none;
}

}  // namespace

bool sample_emission(const Scene& scene, const Fields* fields, uint32_t light, const Vec2& u_position,
                     const Vec2& u_direction, EmissionSample& out) {
  Vec2 u = u_direction;
  if (!sample_emission(scene, light, u_position, u, out)) return false;
  float mix;
  const uint32_t cell = emission_cell(fields, out.point, mix);
  if (cell == none) return true;
  float pdf_field;
  if (u.x < mix) {
    u.x = std::min(u.x / mix, one_minus_epsilon);
    out.direction = sample(*fields, fields->w, cell, u, pdf_field);
    if (!(glm::dot(out.direction, out.point.n) > 0)) return false;
  } else {
    u.x = std::min((u.x - mix) / (1 - mix), one_minus_epsilon);
    out.direction = make_frame(out.point.n).to_world(to_cosine_hemisphere(u));
    pdf_field = pdf(*fields, fields->w, cell, out.direction);
  }
  out.pdf_direction = (1 - mix) * std::max(glm::dot(out.point.n, out.direction), 0.0f) * inv_pi + mix * pdf_field;
  return out.pdf_direction > 0;
}

EmissionPdf pdf_emission(const Scene& scene, const Fields* fields, const LightPoint& point, const Vec3& direction) {
  EmissionPdf e = pdf_emission(scene, point, direction);
  float mix;
  const uint32_t cell = emission_cell(fields, point, mix);
  if (cell != none && e.direction > 0)
    e.direction = (1 - mix) * e.direction + mix * pdf(*fields, fields->w, cell, direction);
  return e;
}

}  // namespace ajar
