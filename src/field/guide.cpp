#include "ajar/field/guide.h"

namespace ajar {
namespace {

// Light must pass the geometric and the shading surface on the same side, for both modes, else bent normals leak.
bool sides_agree(const Guide& g, const Vec3& w, const Vec3& local) {
  return !g.bent || glm::dot(g.ng, w) * local.z > 0;
}

// |cos(ng, wi)| / |cos(ns, wi)| times the stored half: Veach's correction of the adjoint bsdf for bent normals.
float adjoint(const Guide& g, const Vec3& wi, const Vec3& local, Mode mode) {
  if (!g.bent || mode == Mode::radiance) return 1;
  return g.adjoint * std::abs(glm::dot(g.ng, wi) / local.z);  // (A1)
}

}  // namespace

void make_guide(const Scene& scene, const Surface& surface, const Vec3& wo, Guide& out) {
  out.frame = surface.frame;
  resolve(scene, surface, wo, out.frame, out.bsdf);
  const float agreement = glm::dot(out.frame.n, surface.ng);
  out.ng = agreement < 0 ? -surface.ng : surface.ng;
  out.bent = std::abs(agreement) < 1 - 1e-6f;
  out.wo = wo;
  out.wo_local = out.frame.to_local(wo);
  out.mix = 0;
  out.blocked = false;
  if (!out.bent) return;
  out.blocked = !sides_agree(out, wo, out.wo_local);
  out.adjoint = std::abs(out.wo_local.z / glm::dot(out.ng, wo));
}

GuideEval evaluate(const Guide& guide, const Vec3& wi, Mode mode) {
  const Vec3 local = guide.frame.to_local(wi);
  if (local.z == 0 || guide.blocked || !sides_agree(guide, wi, local)) return {};
  const BsdfEval e = eval(guide.bsdf, guide.wo_local, local, mode);
  return {e.f * (std::abs(local.z) * adjoint(guide, wi, local, mode)), e.pdf, e.pdf_reverse};
}

bool sample(const Guide& guide, float u_lobe, const Vec2& u, Mode mode, GuideSample& out) {
  BsdfSample s;
  if (!sample(guide.bsdf, guide.wo_local, u_lobe, u, mode, s)) return false;
  out.wi = guide.frame.to_world(s.wi);
  const bool straight = s.delta && s.wi == -guide.wo_local;  // passes through, whatever the normals say
  if (s.wi.z == 0 || (!straight && (guide.blocked || !sides_agree(guide, out.wi, s.wi)))) return false;
  out.weight = straight ? s.weight : s.weight * adjoint(guide, out.wi, s.wi, mode);
  out.pdf = s.pdf;
  out.pdf_reverse = s.pdf_reverse;
  out.eta = s.eta;
  out.delta = s.delta;
  return true;
}

}  // namespace ajar
