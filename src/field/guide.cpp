#include "ajar/field/guide.h"

#include "breadth.h"

namespace ajar {
namespace {

// Light must pass the geometric and the shading surface on the same side, for both modes, else bent normals leak.
bool sides_agree(const Guide& g, const Vec3& w, const Vec3& local) {
  return !g.bent || glm::dot(g.ng, w) * local.z > 0;
}

bool is_open(const Guide& g, const Vec3& w, const Vec3& local) {
  return local.z != 0 && !g.blocked && sides_agree(g, w, local);
}

// |cos(ng, wi)| / |cos(ns, wi)| times the stored half: Veach's correction of the adjoint bsdf for bent normals.
float adjoint(const Guide& g, const Vec3& wi, const Vec3& local, Mode mode) {
  if (!g.bent || mode == Mode::radiance) return 1;
  return g.adjoint * std::abs(glm::dot(g.ng, wi) / local.z);  // (P4)
}

const Field& field_of(const Guide& g) { return g.fields->of(g.side); }
const Field& field_of_other(const Guide& g) {
  return g.fields->of(g.side == Side::camera ? Side::light : Side::camera);
}

// Most of the time that a field takes is spent waiting for memory: what look-ups in a cell begin with is asked for
// early.
void fetch(const Fields& fields, uint32_t cell) {
  const Cell& c = fields.cells[cell];
  __builtin_prefetch(&c), __builtin_prefetch(&c.region);
  for (const Field* field : {&fields.q, &fields.w}) {
    const StrataNode& root = field->nodes[field->cells[cell].root];
    __builtin_prefetch(&root), __builtin_prefetch(&root.children);
  }
}

void place(const Surface& surface, Guide& out) {
  const Fields& fields = *out.fields;
  const Place at = find(fields.table, surface.p, facing(surface.ng, out.wo));
  out.cell = at.cell, out.missing = at.missing;
  if (at.cell != none) fetch(fields, at.cell);
}

// Chances of a field's draws on either side of the surface, for a walk that arrives on the side of here: sides are
// chosen by what is expected to come from there and be scattered.
struct SideChances {
  float here = 0, there = 0;
};
SideChances choose_side(const Field& field, uint32_t here, uint32_t there, const Breadth& b) {
  const FieldCell &near = field.cells[here], &far = field.cells[there];
  const float stays = (1 - b.through) * near.total, passes = b.through * far.total;
  const float through = stays + passes > 0 ? passes / (stays + passes) : b.through;  // (G17)
  return {(1 - through) * b.near * mix_of(near), through * mix_of(far)};
}

// Both sides are guided, or none, since a walk from there must know the same of the way back: not where another
// material is behind.
void mix_both_sides(Guide& out, const Breadth& b, const Vec3& ng) {
  out.through = b.through;
  out.far_cell = find(out.fields->table, out.p, facing(ng, -out.wo)).cell;
  if (out.far_cell == none || out.bsdf.two_faced) return;
  const SideChances own = choose_side(field_of(out), out.cell, out.far_cell, b);
  const float bsdf = 1 - own.here - own.there;
  out.near = {own.here, bsdf}, out.far = {own.there, bsdf};
  const Field& other = field_of_other(out);
  const SideChances from_near = choose_side(other, out.cell, out.far_cell, b);
  const SideChances from_far = choose_side(other, out.far_cell, out.cell, b);
  out.back.near = {from_near.here, 1 - from_near.here - from_near.there};
  out.back.far = {from_far.there, 1 - from_far.here - from_far.there};
}

void mix_one_side(Guide& out, const Breadth& b) {
  const float mix = b.near * mix_of(field_of(out).cells[out.cell]);
  const float other = b.near * mix_of(field_of_other(out).cells[out.cell]);
  out.near = {mix, 1 - mix}, out.back.near = {other, 1 - other};
}

void mix_fields(Guide& out, const Vec3& ng) {
  if (out.cell == none || !out.bsdf.has_smooth) return;
  const Breadth b = breadth_of(out.bsdf);
  if (b.through > 0)
    mix_both_sides(out, b, ng);
  else
    mix_one_side(out, b);
  if (out.back.near.field > 0 || out.back.far.field > 0)
    out.back.pdf = pdf(*out.fields, field_of_other(out), out.cell, out.p, out.wo);
}

// Where one side alone is guided, it is whatever the direction.
bool is_through(const Guide& g, const Vec3& local) { return g.far_cell != none && local.z * g.wo_local.z < 0; }

// (G4) for both sides: the bsdf's densities become those of the mixtures. What passes a mask straight does so with the
// mask's probability, whatever the fields on either side say: the mixtures are of the rest.
float mix_in(const Bsdf& bsdf, const Mix& mix, float bsdf_pdf, float pdf_field) {
  return mix.bsdf * bsdf_pdf + mix.field * bsdf.opacity * pdf_field;
}
float mixed_back(const Guide& g, bool through, float bsdf_pdf) {
  const Mix& mix = through ? g.back.far : g.back.near;
  return mix.bsdf < 1 ? mix_in(g.bsdf, mix, bsdf_pdf, g.back.pdf) : bsdf_pdf;
}
float mixed(const Guide& g, const Vec3& wi, bool through, float bsdf_pdf) {
  const Mix& mix = through ? g.far : g.near;
  if (!(mix.field > 0)) return mix.bsdf * bsdf_pdf;
  return mix_in(g.bsdf, mix, bsdf_pdf, pdf(*g.fields, field_of(g), through ? g.far_cell : g.cell, g.p, wi));
}

// The cell whose field is to be sampled; none: the bsdf is, and u_lobe becomes that of the bsdf, which keeps its first
// part for passage.
uint32_t choose_cell(const Guide& g, float& u_lobe) {
  const float pass = g.bsdf.pass, near = g.bsdf.opacity * g.near.field, far = g.bsdf.opacity * g.far.field;
  if (!(g.near.bsdf < 1) || u_lobe < pass) return none;
  if (u_lobe < pass + near) return g.cell;
  if (u_lobe < pass + near + far) return g.far_cell;
  u_lobe = std::min(pass + (u_lobe - pass - near - far) / g.near.bsdf, one_minus_epsilon);
  return none;
}

bool sample_field(const Guide& g, uint32_t cell, const Vec2& u, Mode mode, GuideSample& out) {
  float pdf_field;
  out.wi = sample(*g.fields, field_of(g), cell, g.p, u, pdf_field);
  const Vec3 local = g.frame.to_local(out.wi);
  if (!(pdf_field > 0) || !is_open(g, out.wi, local)) return false;
  const bool through = is_through(g, local);
  if (g.far_cell != none && through != (cell == g.far_cell)) return false;  // a cell's plane is not the surface's
  const BsdfEval e = eval(g.bsdf, g.wo_local, local, mode);
  out.pdf = mix_in(g.bsdf, through ? g.far : g.near, e.pdf, pdf_field);
  out.pdf_reverse = mixed_back(g, through, e.pdf_reverse);
  out.weight = e.f * (std::abs(local.z) * adjoint(g, out.wi, local, mode) / out.pdf);
  out.eta = 1;
  out.delta = false;
  return true;
}

}  // namespace

void make_guide(const Scene& scene, const Fields* fields, Side side, const Surface& surface, const Vec3& wo,
                Guide& out) {
  out.side = side;
  out.p = surface.p;
  out.wo = wo;
  out.fields = fields;
  out.cell = out.far_cell = none;
  out.missing = 0;
  if (fields) place(surface, out);
  out.frame = surface.frame;
  resolve(scene, surface, wo, out.frame, out.bsdf);
  const float agreement = glm::dot(out.frame.n, surface.ng);
  out.ng = agreement < 0 ? -surface.ng : surface.ng;
  out.bent = std::abs(agreement) < 1 - 1e-6f;
  out.wo_local = out.frame.to_local(wo);
  out.near = out.far = {}, out.back = {}, out.through = 0;
  mix_fields(out, surface.ng);
  out.blocked = false;
  if (!out.bent) return;
  out.blocked = !sides_agree(out, wo, out.wo_local);
  out.adjoint = std::abs(out.wo_local.z / glm::dot(out.ng, wo));
}

Promise promise(const Guide& guide, const Rgb& beta) {
  if (!is_known(guide) || !connectable(guide)) return {};
  const Arrival arrives = arrival(guide.fields->of(guide.side), guide);
  const float scattered = luminance(beta * albedo(guide.bsdf, guide.wo_local)) * inv_pi;
  return {scattered * arrives.all, scattered * (arrives.all - arrives.direct)};
}

GuideEval evaluate(const Guide& guide, const Vec3& wi, Mode mode) {
  GuideEval e = evaluate_bsdf(guide, wi, mode);
  if (guide.near.bsdf < 1) {
    const Vec3 local = guide.frame.to_local(wi);
    if (is_open(guide, wi, local)) e.pdf = mixed(guide, wi, is_through(guide, local), e.pdf);
  }
  return e;
}

GuideEval evaluate_bsdf(const Guide& guide, const Vec3& wi, Mode mode) {
  const Vec3 local = guide.frame.to_local(wi);
  if (!is_open(guide, wi, local)) return {};
  const BsdfEval e = eval(guide.bsdf, guide.wo_local, local, mode);
  return {e.f * (std::abs(local.z) * adjoint(guide, wi, local, mode)), e.pdf,
          mixed_back(guide, is_through(guide, local), e.pdf_reverse)};
}

float with_field(const Guide& g, const Vec3& wi, float bsdf_pdf) {
  if (!(g.near.bsdf < 1)) return bsdf_pdf;
  return mixed(g, wi, g.far_cell != none && is_through(g, g.frame.to_local(wi)), bsdf_pdf);
}

bool sample(const Guide& guide, float u_lobe, const Vec2& u, Mode mode, GuideSample& out) {
  if (const uint32_t cell = choose_cell(guide, u_lobe); cell != none) return sample_field(guide, cell, u, mode, out);
  BsdfSample s;
  if (!sample(guide.bsdf, guide.wo_local, u_lobe, u, mode, s)) return false;
  out.wi = guide.frame.to_world(s.wi);
  const bool straight = s.delta && s.wi == -guide.wo_local;  // passes through, whatever the normals say
  if (s.wi.z == 0 || (!straight && (guide.blocked || !sides_agree(guide, out.wi, s.wi)))) return false;
  out.weight = straight ? s.weight : s.weight * adjoint(guide, out.wi, s.wi, mode);
  out.eta = s.eta;
  out.delta = s.delta;
  if (straight) {
    out.pdf = s.pdf;
    out.pdf_reverse = s.pdf_reverse;
  } else if (s.delta) {
    out.pdf = guide.near.bsdf * s.pdf;
    out.pdf_reverse = (is_through(guide, s.wi) ? guide.back.far : guide.back.near).bsdf * s.pdf_reverse;
    out.weight /= guide.near.bsdf;
  } else {
    const bool through = is_through(guide, s.wi);
    out.pdf = mixed(guide, out.wi, through, s.pdf);
    out.pdf_reverse = mixed_back(guide, through, s.pdf_reverse);
    if (guide.near.bsdf < 1) out.weight *= s.pdf / out.pdf;
  }
  return true;
}

}  // namespace ajar
