// A large part of what joins cost, so it is compiled to run in vectors: no NaN is asked for (CMakeLists.txt).
#include "expect.h"

namespace ajar {
namespace {

// Of `count` entries from one on.
template <bool glossy, bool glossy_light, uint32_t from = 0, uint32_t count = LightStore::width>
void expect_part(const LightStore::Block& b, const Seer& seer, int most, Values& out) {
  const Guide& guide = seer.vertex->guide;
  const Vec3 p = seer.vertex->p, n = guide.frame.n, wo = guide.wo;
  const float behind = guide.bsdf.opaque ? 0.0f : -1.0f, n_o = guide.wo_local.z, near = seer.near,
              lights = seer.near_lights;
  const Gloss g = seer.gloss;
  for (uint32_t i = from; i < from + count; ++i) {
    const float x = p.x - b.x[i], y = p.y - b.y[i], z = p.z - b.z[i];
    const float d2 = std::max(x * x + y * y + z * z, 1e-30f);
    const float cos_a = b.nx[i] * x + b.ny[i] * y + b.nz[i] * z, cos_c = -(n.x * x + n.y * y + n.z * z);
    const float faces = std::max(cos_a, b.behind[i] * cos_a) * std::max(cos_c, behind * cos_c);
    const float per_d = glossy || glossy_light ? 1 / std::sqrt(d2) : 0;
    const float cosines = glossy || glossy_light ? faces * per_d * per_d : faces / d2;
    float here = 1, there = 1;
    if constexpr (glossy) {
      const float between = -(wo.x * x + wo.y * y + wo.z * z) * per_d;
      here = shine(g, n_o, cos_c * per_d, between);
    }
    if constexpr (glossy_light) {
      const float between = (b.wx[i] * x + b.wy[i] * y + b.wz[i] * z) * per_d;
      const float n_w = b.nx[i] * b.wx[i] + b.ny[i] * b.wy[i] + b.nz[i] * b.wz[i];
      there = shine({b.matt[i], b.peak[i], b.f0[i], b.alpha[i]}, n_w, cos_a * per_d, between);
    }
    const float brings = b.flux[i] * cosines * here * there;
    out[i] = b.s[i] <= most ? brings / (d2 + cosines * (lights * b.near[i] * here + near * there)) : 0;  // (J1)
  }
}

template <bool glossy>
void expect_block(const LightStore::Block& b, const Seer& seer, int most, Values& out) {
  constexpr uint32_t half = LightStore::width / 2;
  if (b.glossy > half) return expect_part<glossy, true>(b, seer, most, out);
  if (b.glossy == 0) return expect_part<glossy, false>(b, seer, most, out);
  expect_part<glossy, true, 0, half>(b, seer, most, out);
  expect_part<glossy, false, half, half>(b, seer, most, out);
}

}  // namespace

void expect(const LightStore::Block& b, const Seer& seer, int most, Values& out) {
  if (seer.gloss.peak > 0)
    expect_block<true>(b, seer, most, out);
  else
    expect_block<false>(b, seer, most, out);
}

void apply_chances(const LightStore::Block& b, const Views& views, uint32_t region, Values& values) {
  const uint32_t regions = views.regions;
  if (region >= regions) return;
  const uint8_t* const chances = views.chance.data();
  std::array<uint32_t, LightStore::width> at, found;
  for (uint32_t i = 0; i < LightStore::width; ++i) at[i] = pair_index(region, std::min(b.region[i], regions - 1));
  for (uint32_t i = 0; i < LightStore::width; ++i) found[i] = chances[at[i]];  // does not run in vectors
  for (uint32_t i = 0; i < LightStore::width; ++i) {
    const float seen = float(int(found[i])) * chance_step;
    values[i] *= b.region[i] < regions ? seen : 1;
  }
}

}  // namespace ajar
