#include "ajar/scene/bsdf.h"

#include <span>

#include "visit.h"

namespace ajar {
namespace {

// One lobe of weight 1, which is what most materials are.
bool alone(const Bsdf& bsdf) { return bsdf.count == 1 && bsdf.weights[0] == 1 && bsdf.pass == 0 && !bsdf.bent; }

// A lobe with a normal of its own: directions in its frame, which have to be on the same sides as in the common one,
// else light would pass the surface.
struct Own {
  Frame frame;
  float side;

  explicit Own(const Vec3& n) : frame(make_frame(n, Vec3(1, 0, 0))), side(n.z > 0 ? 1.0f : -1.0f) {}
  bool agrees(const Vec3& w, const Vec3& own) const { return side * w.z * own.z > 0; }
};
// Cosine at the lobe's normal over that at the common one; those below 1e-10 are rounding, and would leave the range.
float cosines(const Vec3& own, const Vec3& w) { return std::abs(own.z) / std::max(std::abs(w.z), 1e-10f); }

BsdfEval eval_lobe(const Bsdf& bsdf, int i, const Vec3& wo, const Vec3& wi, Mode mode) {
  const auto value = [&](const Vec3& o, const Vec3& in) {
    return visit(bsdf.lobes[i], [&](const auto& lobe) { return eval(lobe, o, in, mode); });
  };
  if (!bsdf.bent) return value(wo, wi);
  const Own own(bsdf.normals[i]);
  const Vec3 o = own.frame.to_local(wo), in = own.frame.to_local(wi);
  if (!own.agrees(wo, o) || !own.agrees(wi, in)) return {};
  BsdfEval e = value(o, in);
  e.f *= mode == Mode::radiance ? cosines(in, wi) : cosines(o, wo);  // (P5)
  return e;
}

// Roughness of the narrower of what a lobe consists of.
float roughness(const Lobe& lobe) {
  switch (lobe.kind) {
    case LobeKind::roughconductor:
      return narrower(lobe.roughconductor.facets);
    case LobeKind::roughdielectric:
      return narrower(lobe.roughdielectric.facets);
    case LobeKind::roughplastic:
      return narrower(lobe.roughplastic.facets);
    case LobeKind::phong:
      return lobe.phong.share > 0 ? std::sqrt(2 / (lobe.phong.exponent + 2)) : 1;
    case LobeKind::ward:
      return lobe.ward.share > 0 ? narrower(lobe.ward.facets) : 1;
    case LobeKind::principled:
      return std::min(narrower(facets(lobe.principled)),
                      lobe.principled.clearcoat > 0 ? lobe.principled.clearcoat_alpha : 1);
    default:
      return 1;
  }
}

// The weight of a smooth sample is left to the sum.
bool sample_lobe(const Bsdf& bsdf, int i, const Vec3& wo, float u_lobe, const Vec2& u, Mode mode, BsdfSample& out) {
  const auto draw = [&](const Vec3& o) {
    return visit(bsdf.lobes[i], [&](const auto& lobe) { return sample(lobe, o, u_lobe, u, mode, out); });
  };
  if (!bsdf.bent) return draw(wo);
  const Own own(bsdf.normals[i]);
  const Vec3 o = own.frame.to_local(wo);
  if (!own.agrees(wo, o) || !draw(o)) return false;
  const Vec3 in = out.wi;
  out.wi = in == -o ? -wo : own.frame.to_world(in);
  if (!own.agrees(out.wi, in)) return false;
  if (out.delta && mode == Mode::importance) out.weight *= cosines(o, wo) / cosines(in, out.wi);
  return true;
}

BsdfEval eval_sum(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi, Mode mode) {
  BsdfEval sum;
  for (int i = 0; i < bsdf.count; ++i) {
    const BsdfEval e = eval_lobe(bsdf, i, wo, wi, mode);
    sum.f += e.f * bsdf.weights[i];
    sum.pdf += e.pdf * bsdf.choice[i];
    sum.pdf_reverse += e.pdf_reverse * bsdf.choice[i];
  }
  return sum;
}

// Several lobes, or one beside a passage: the direction comes from one, value and densities from all.
bool sample_sum(const Bsdf& bsdf, const Vec3& wo, float u_lobe, const Vec2& u, Mode mode, BsdfSample& out) {
  if (take_part(u_lobe, bsdf.pass)) return set_delta(out, -wo, Rgb((1 - bsdf.opacity) / bsdf.pass), bsdf.pass);
  float left = 1 - bsdf.pass;
  for (int i = 0; i < bsdf.count; ++i) {
    const float p = bsdf.choice[i];
    if (i + 1 < bsdf.count && !take_part(u_lobe, std::min(p / left, 1.0f))) {
      left = std::max(left - p, 1e-30f);
      continue;
    }
    if (!(p > 0)) return false;
    if (!sample_lobe(bsdf, i, wo, u_lobe, u, mode, out)) return false;
    if (out.delta) {
      out.weight *= bsdf.weights[i] / p;
      out.pdf *= p;
      out.pdf_reverse *= p;
      return out.pdf > 0;
    }
    const BsdfEval e = eval_sum(bsdf, wo, out.wi, mode);
    if (!(e.pdf > 0)) return false;
    out.weight = e.f * (std::abs(out.wi.z) / e.pdf);
    out.pdf = e.pdf;
    out.pdf_reverse = e.pdf_reverse;
    return true;
  }
  return false;
}

}  // namespace

BsdfEval eval(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi, Mode mode) {
  if (!alone(bsdf)) return eval_sum(bsdf, wo, wi, mode);
  return visit(bsdf.lobes[0], [&](const auto& lobe) { return eval(lobe, wo, wi, mode); });
}

bool sample(const Bsdf& bsdf, const Vec3& wo, float u_lobe, const Vec2& u, Mode mode, BsdfSample& out) {
  if (!alone(bsdf)) return sample_sum(bsdf, wo, u_lobe, u, mode, out);
  return visit(bsdf.lobes[0], [&](const auto& lobe) { return sample(lobe, wo, u_lobe, u, mode, out); });
}

Rgb albedo(const Bsdf& bsdf, const Vec3& wo) {
  Rgb sum(1 - bsdf.opacity);
  for (int i = 0; i < bsdf.count; ++i) {
    const Vec3 o = bsdf.bent ? Own(bsdf.normals[i]).frame.to_local(wo) : wo;
    sum += bsdf.weights[i] * visit(bsdf.lobes[i], [&](const auto& lobe) { return albedo(lobe, o); });
  }
  return sum;
}

float least_roughness(const Bsdf& bsdf) {
  float least = 1;
  for (const Lobe& lobe : std::span(bsdf.lobes, size_t(bsdf.count))) least = std::min(least, roughness(lobe));
  return least;
}

}  // namespace ajar
