#include "ajar/scene/bsdf.h"

#include "visit.h"

namespace ajar {
namespace {

// One lobe of weight 1, which is what most materials are.
bool alone(const Bsdf& bsdf) { return bsdf.count == 1 && bsdf.weights[0] == 1 && bsdf.pass == 0; }

BsdfEval eval_sum(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi, Mode mode) {
  BsdfEval sum;
  for (int i = 0; i < bsdf.count; ++i) {
    const BsdfEval e = visit(bsdf.lobes[i], [&](const auto& lobe) { return eval(lobe, wo, wi, mode); });
    sum.f += e.f * bsdf.weights[i];
    sum.pdf += e.pdf * bsdf.choice[i];
    sum.pdf_reverse += e.pdf_reverse * bsdf.choice[i];
  }
  return sum;
}

// Several lobes, or one beside a passage: the direction comes from one, value and densities from all.
bool sample_sum(const Bsdf& bsdf, const Vec3& wo, float u_lobe, const Vec2& u, Mode mode, BsdfSample& out) {
  if (take(u_lobe, bsdf.pass)) return set_delta(out, -wo, Rgb((1 - bsdf.opacity) / bsdf.pass), bsdf.pass);
  float left = 1 - bsdf.pass;
  for (int i = 0; i < bsdf.count; ++i) {
    const float p = bsdf.choice[i];
    if (i + 1 < bsdf.count && !take(u_lobe, std::min(p / left, 1.0f))) {
      left = std::max(left - p, 1e-30f);
      continue;
    }
    if (!(p > 0)) return false;
    if (!visit(bsdf.lobes[i], [&](const auto& lobe) { return sample(lobe, wo, u_lobe, u, mode, out); })) return false;
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
  for (int i = 0; i < bsdf.count; ++i)
    sum += bsdf.weights[i] * visit(bsdf.lobes[i], [&](const auto& lobe) { return albedo(lobe, wo); });
  return sum;
}

}  // namespace ajar
