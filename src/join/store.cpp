#include "ajar/join/store.h"

#include <array>

namespace ajar {
namespace {

constexpr size_t most_candidates = 32;

uint32_t region_of(const Guide& guide) { return guide.cell == none ? no_region : guide.fields->cells[guide.cell].region; }

// 1 / own density, in units of the density with which a cosine lobe at the other end would find the vertex.
float near_of(const Vertex& v, double inner) { return float(inv_pi / std::max(inner * v.own, 1e-30)); }

// What a join brings, up to a factor that all candidates of a camera vertex share: unoccluded, both ends taken for
// diffuse, with the weight against a camera subpath that finds the light vertex, or a light subpath the camera's. (J1)
float expected(const LightStore::Place& at, const Vertex& c, float near, bool opaque, int most) {
  const Vec3 between = c.p - at.p;
  const float d2 = length2(between), cos_a = glm::dot(at.n, between), cos_c = -glm::dot(c.guide.frame.n, between);
  if (at.s > most || !(d2 > 0) || (at.opaque && !(cos_a > 0)) || (opaque && !(cos_c > 0))) return 0;
  const float g = std::max(std::abs(cos_a * cos_c) / sqr(d2), 1e-12f / d2);
  return at.flux * g / (1 + g * (at.near + near));
}

}  // namespace

void clear(LightStore& store) { store.vertices.clear(), store.places.clear(), store.paths = 0; }

void add(LightStore& store, const Subpath& light, double share, double inner) {
  ++store.paths;
  const uint32_t first = uint32_t(store.vertices.size());
  int last = 0;
  for (int s = 2; s <= light.n; ++s) {
    const Vertex& v = light[s - 1];
    if (!connectable(v.guide)) continue;
    const float flux = luminance(v.beta) * inv_pi * std::max(luminance(albedo(v.guide.bsdf, v.guide.wo_local)), 0.02f);
    if (!(flux > 0)) continue;
    store.places.push_back({v.p, flux, v.guide.frame.n, near_of(v, inner), region_of(v.guide), first, s, float(share),
                            v.guide.bsdf.opaque});
    last = s;
  }
  store.vertices.insert(store.vertices.end(), light.vertices.begin(), light.vertices.begin() + last);
}

bool choose(const LightStore& store, const Vertex& camera, double inner, int most, Sampler& sampler, StoreChoice& out) {
  const Vec2 u = sampler.next2();
  const size_t all = store.places.size(), n = std::min(all, most_candidates);
  if (n == 0) return false;
  const float near = near_of(camera, inner);
  const uint32_t region = region_of(camera.guide);
  std::array<float, most_candidates> sums;
  const auto candidate = [&](size_t i) -> const LightStore::Place& {
    return store.places[std::min(size_t((float(i) + u.x) * (float(all) / float(n))), all - 1)];
  };
  float sum = 0;
  for (size_t i = 0; i < n; ++i) {
    const LightStore::Place& at = candidate(i);
    const float value = expected(at, camera, near, camera.guide.bsdf.opaque, most);
    if (value > 0)
      sum += value * (camera.guide.fields ? chance(camera.guide.fields->views, region, at.region) : 1);
    sums[i] = sum;
  }
  if (!(sum > 0) || !(sum < infinity)) return false;
  size_t i = 0;
  while (i + 1 < n && !(u.y * sum < sums[i])) ++i;
  const float mine = sums[i] - (i > 0 ? sums[i - 1] : 0);
  if (!(mine > 0)) return false;
  out.place = &candidate(i);
  out.weight = float(double(all) / (double(n) * store.paths)) * sum / mine;
  return true;
}

}  // namespace ajar
