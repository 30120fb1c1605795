#include "ajar/field/guide.h"

#include "ajar/scene/bsdf/through.h"

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

// What a boundary over a base takes of the field's part: three times what it reflects at right angles, so that its own
// lobe, which reflects more at others, is never starved. The same for both directions of a path.
float boundary(float share, float ior) {
  const float reflected = sqr((ior - 1) / (ior + 1)), s = share * reflected;
  return std::min(3 * s / std::max(s + (1 - share) * (1 - reflected), 1e-6f), 1.0f);
}

// 1 up to a roughness of 0.1, which fields of a few dozen strata cannot resolve, 0 from 0.5 on.
float narrow(float alpha) { return 1 - std::clamp((alpha - 0.1f) * 2.5f, 0.0f, 1.0f); }

// What lobe widths allow, over all that is on the base: what metal reflects, it reflects at all angles.
float breadth(const Principled& p) {
  const float base = max_component(p.base), dielectric = 1 - p.metallic;
  const float reflected = dielectric * sqr((p.eta - 1) / (p.eta + 1)), coat = 0.04f * p.clearcoat;
  const float all = dielectric * base + p.metallic * base + reflected + coat;
  const float narrow_part =
      (3 * reflected + p.metallic * base) * narrow(sqr(p.roughness) * p.aspect) + 3 * coat * narrow(p.clearcoat_alpha);
  return std::max(1 - narrow_part / std::max(all, 1e-6f), 0.0f);
}

// How good a guide the field alone is, without the bsdf: 0 for narrow lobes, 1 for diffuse ones.
float breadth(const Lobe& lobe) {
  switch (lobe.kind) {
    case LobeKind::diffuse:
    case LobeKind::roughdiffuse:
      return 1;
    case LobeKind::plastic:
      return 1 - boundary(lobe.plastic.share, lobe.plastic.ior);
    case LobeKind::roughplastic:
      return 1 - boundary(lobe.roughplastic.share, lobe.roughplastic.ior) * narrow(narrower(lobe.roughplastic.facets));
    case LobeKind::roughconductor:
      return 1 - narrow(narrower(lobe.roughconductor.facets));
    case LobeKind::phong:
      return 1 - lobe.phong.share * narrow(std::sqrt(2 / (lobe.phong.exponent + 2)));
    case LobeKind::ward:
      return 1 - lobe.ward.share * narrow(narrower(lobe.ward.facets));
    case LobeKind::principled:
      return breadth(lobe.principled);
    default:
      return 0;  // deltas
  }
}

// Of what does not pass straight through. What turns light to the other side is left alone: other cells guide there,
// and the densities of the way back.
float breadth(const Bsdf& bsdf) {
  float sum = 0;
  for (int i = 0; i < bsdf.count; ++i) {
    if (turns_through(bsdf.lobes[i])) return 0;
    sum += bsdf.choice[i] * breadth(bsdf.lobes[i]);
  }
  return sum / bsdf.opacity;
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

void mix_fields(Guide& out) {
  if (out.cell == none || !out.bsdf.has_smooth) return;
  const float share = breadth(out.bsdf);
  if (!(share > 0)) return;
  const Field& other = field_of_other(out);
  out.mix = share * mix_of(field_of(out).cells[out.cell]);
  out.mix_other = share * mix_of(other.cells[out.cell]);
  if (out.mix_other > 0) out.back = pdf(*out.fields, other, out.cell, out.p, out.wo);
}

float pdf_field(const Guide& g, const Vec3& wi) { return pdf(*g.fields, field_of(g), g.cell, g.p, wi); }

// (G4) for both sides: the bsdf's densities become those of the mixtures. What passes a mask straight does so with the
// mask's probability, whatever the fields on either side say: the mixtures are of the rest.
float mix_in(const Bsdf& bsdf, float mix, float bsdf_pdf, float pdf_field) {
  return (1 - mix) * bsdf_pdf + mix * bsdf.opacity * pdf_field;
}
float mixed_back(const Guide& g, float bsdf_pdf) {
  return g.mix_other > 0 ? mix_in(g.bsdf, g.mix_other, bsdf_pdf, g.back) : bsdf_pdf;
}

// Whether the field is to be sampled; otherwise u_lobe becomes that of the bsdf, which keeps its first part for
// passage.
bool takes_field(const Guide& g, float& u_lobe) {
  const float pass = g.bsdf.pass, field = g.bsdf.opacity * g.mix;
  if (!(g.mix > 0) || u_lobe < pass) return false;
  if (u_lobe < pass + field) return true;
  u_lobe = std::min(pass + (u_lobe - pass - field) / (1 - g.mix), one_minus_epsilon);
  return false;
}

bool sample_field(const Guide& g, const Vec2& u, Mode mode, GuideSample& out) {
  float pdf_field;
  out.wi = sample(*g.fields, field_of(g), g.cell, g.p, u, pdf_field);
  const Vec3 local = g.frame.to_local(out.wi);
  if (!(pdf_field > 0) || !is_open(g, out.wi, local)) return false;
  const BsdfEval e = eval(g.bsdf, g.wo_local, local, mode);
  out.pdf = mix_in(g.bsdf, g.mix, e.pdf, pdf_field);
  out.pdf_reverse = mixed_back(g, e.pdf_reverse);
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
  out.cell = none;
  out.missing = 0;
  if (fields) place(surface, out);
  out.frame = surface.frame;
  resolve(scene, surface, wo, out.frame, out.bsdf);
  const float agreement = glm::dot(out.frame.n, surface.ng);
  out.ng = agreement < 0 ? -surface.ng : surface.ng;
  out.bent = std::abs(agreement) < 1 - 1e-6f;
  out.wo_local = out.frame.to_local(wo);
  out.mix = out.mix_other = 0;
  mix_fields(out);
  out.blocked = false;
  if (!out.bent) return;
  out.blocked = !sides_agree(out, wo, out.wo_local);
  out.adjoint = std::abs(out.wo_local.z / glm::dot(out.ng, wo));
}

Promise promise(const Guide& guide, const Rgb& beta) {
  if (guide.cell == none || !connectable(guide)) return {};
  const FieldCell& cell = guide.fields->of(guide.side).cells[guide.cell];
  const float scattered = luminance(beta * albedo(guide.bsdf, guide.wo_local)) * inv_pi;
  return {scattered * cell.total, scattered * (cell.total - cell.direct)};
}

GuideEval evaluate(const Guide& guide, const Vec3& wi, Mode mode) {
  GuideEval e = evaluate_bsdf(guide, wi, mode);
  if (guide.mix > 0 && is_open(guide, wi, guide.frame.to_local(wi))) e.pdf = with_field(guide, wi, e.pdf);
  return e;
}

GuideEval evaluate_bsdf(const Guide& guide, const Vec3& wi, Mode mode) {
  const Vec3 local = guide.frame.to_local(wi);
  if (!is_open(guide, wi, local)) return {};
  const BsdfEval e = eval(guide.bsdf, guide.wo_local, local, mode);
  return {e.f * (std::abs(local.z) * adjoint(guide, wi, local, mode)), e.pdf, mixed_back(guide, e.pdf_reverse)};
}

float with_field(const Guide& g, const Vec3& wi, float bsdf_pdf) {
  return g.mix > 0 ? mix_in(g.bsdf, g.mix, bsdf_pdf, pdf_field(g, wi)) : bsdf_pdf;
}

bool sample(const Guide& guide, float u_lobe, const Vec2& u, Mode mode, GuideSample& out) {
  if (takes_field(guide, u_lobe)) return sample_field(guide, u, mode, out);
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
    out.pdf = (1 - guide.mix) * s.pdf;
    out.pdf_reverse = (1 - guide.mix_other) * s.pdf_reverse;
    out.weight /= 1 - guide.mix;
  } else {
    out.pdf = with_field(guide, out.wi, s.pdf);
    out.pdf_reverse = mixed_back(guide, s.pdf_reverse);
    if (guide.mix > 0) out.weight *= s.pdf / out.pdf;
  }
  return true;
}

}  // namespace ajar
