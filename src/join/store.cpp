#include "ajar/join/store.h"

#include <algorithm>
#include <array>

#include "ajar/join/visibility.h"
#include "expect.h"

namespace ajar {
namespace {

// 1 / own density, in units of the density with which a cosine lobe at the other end would find the vertex.
double near_of(const Vertex& v) { return inv_pi / std::max(v.own, 1e-30); }

// Luminance that a vertex scatters, never nothing: narrow lobes are more than their albedo on average.
float flux_of(const Vertex& v) {
  return luminance(v.beta) * inv_pi * std::max(luminance(albedo(v.guide.bsdf, v.guide.wo_local)), 0.02f);
}

bool is_glossy(const Vertex& v) { return gloss_of(v.guide.bsdf, v.guide.wo_local).peak > 0; }

void put(LightStore::Block& b, uint32_t i, const Vertex& v, const LightStore::Entry& at) {
  const Vec3 n = v.guide.frame.n;
  b.x[i] = v.p.x, b.y[i] = v.p.y, b.z[i] = v.p.z;
  b.nx[i] = n.x, b.ny[i] = n.y, b.nz[i] = n.z;
  b.flux[i] = at.flux * at.counts;
  b.near[i] = at.near;
  b.behind[i] = v.guide.bsdf.opaque ? 0.0f : -1.0f;
  b.region[i] = at.region, b.path[i] = at.path, b.s[i] = at.s;
  const Vec3 w = v.guide.wo;
  const Gloss gloss = gloss_of(v.guide.bsdf, v.guide.wo_local);
  if (gloss.peak > 0) b.glossy = i + 1;
  b.wx[i] = w.x, b.wy[i] = w.y, b.wz[i] = w.z;
  b.matt[i] = gloss.matt, b.peak[i] = gloss.peak, b.f0[i] = gloss.f0, b.alpha[i] = gloss.alpha;
}

// Whether no walk finds what a light subpath brings its last vertex: of a light without extent, where delta events
// leave no edge that next-event estimation or a join could be made at.
bool only_joined(std::span<const Vertex> light) {
  const LightPoint& point = light[0].point;
  if (light.size() <= 2 || !(point.delta_position || point.delta_direction)) return false;
  bool joins = true;  // the vertex before can be joined
  for (size_t i = 1; i < light.size(); ++i) {
    const bool joined = i + 1 == light.size() || !light[i].delta;
    if (joins && joined) return false;
    joins = joined;
  }
  return true;
}

Seer seer_of(const Vertex& v, float near = 0, float near_lights = 1) {
  return {&v, gloss_of(v.guide.bsdf, v.guide.wo_local), near, near_lights};
}
Seer seer_of(const Joiner& j) {
  constexpr double most = 1e30;
  const double counts = std::max(j.counts, 1e-30), near = j.before / counts * near_of(*j.vertex);
  return seer_of(*j.vertex, float(std::min(near, most)), float(std::min(j.onwards / counts, most)));
}

}  // namespace

void clear(LightStore& store) { store.vertices.clear(), store.entries.clear(), store.blocks.clear(), store.paths = 0; }

void add(LightStore& store, const Subpath& light) {
  ++store.paths;
  for (int s = 2; s <= light.n; ++s) {
    const Vertex& v = light[s - 1];
    if (!connectable(v.guide)) continue;
    const float flux = flux_of(v);
    if (!(flux > 0)) continue;
    const LightEnd end = light_end(light, s);
    store.entries.push_back({.vertex = uint32_t(store.vertices.size()),
                             .s = s,
                             .delta_before = end.delta_before,
                             .only_joined = only_joined(light.first(s)),
                             .own_before = end.own_before,
                             .nee_ratio = light.nee_ratio,
                             .region = region_of(v.guide),
                             .path = store.paths - 1,
                             .flux = flux,
                             .worth = promise(v.guide, v.beta).beyond,
                             .near = float(near_of(v))});
    store.vertices.push_back(v);
  }
}

namespace {
// Blocks of the entries in turn, so many of them as count says of each.
void fill_blocks(LightStore& store, auto count) {
  uint32_t first = 0;
  for (size_t block = 0; block < store.blocks.size(); first += count(block++)) {
    LightStore::Block& b = store.blocks[block] = {};
    b.first = first;
    for (uint32_t i = 0; i < count(block); ++i) {
      const LightStore::Entry& at = store.entries[first + i];
      put(b, i, store.vertex(at), at);
    }
  }
}

void resize_blocks(LightStore& store) {
  store.blocks.resize((store.entries.size() + LightStore::width - 1) / LightStore::width);
}
}  // namespace

void deal_blocks(LightStore& store) {
  resize_blocks(store);
  const size_t n = store.blocks.size(), all = store.entries.size();
  std::vector<LightStore::Entry> dealt;
  dealt.reserve(all);
  for (size_t block = 0; block < n; ++block) {
    const ptrdiff_t first = ptrdiff_t(dealt.size());
    for (size_t i = block; i < all; i += n) dealt.push_back(store.entries[i]);
    std::stable_partition(dealt.begin() + first, dealt.end(),
                          [&](const auto& e) { return is_glossy(store.vertex(e)); });
  }
  store.entries = std::move(dealt);
  fill_blocks(store, [&](size_t block) { return uint32_t((all - block + n - 1) / n); });
}

void lay_blocks(LightStore& store) {
  resize_blocks(store);
  fill_blocks(store, [&](size_t block) {
    return uint32_t(std::min<size_t>(store.entries.size() - block * LightStore::width, LightStore::width));
  });
}

void append(LightStore& store, const LightStore& more) {
  for (LightStore::Entry at : more.entries) {
    const Vertex& v = more.vertex(at);
    at.vertex = uint32_t(store.vertices.size()), at.path += store.paths;
    store.vertices.push_back(v);
    store.entries.push_back(at);
  }
  store.paths += more.paths;
}

namespace {
using Sums = LightStore::Sums;
constexpr uint32_t runs = LightStore::runs;  // added side by side

Sums sums_of(const Values& values) {
  Sums sums{};
  for (uint32_t k = 0; k < LightStore::width; k += runs)
    for (uint32_t i = 0; i < runs; ++i) sums[i] += values[k + i];
  for (uint32_t i = 1; i < runs; ++i) sums[i] += sums[i - 1];
  return sums;
}

void resize(Expectation& expected, size_t blocks) {
  expected.values.resize(blocks), expected.sums.resize(blocks);
  expected.sum = 0;
}

// The values of a block, once they are there.
void add_up(Expectation& expected, size_t block) {
  expected.sums[block] = sums_of(expected.values[block]);
  expected.sum += expected.sums[block].back();
}

// Which value a place within the sum of all is in.
uint32_t find(const Sums& sums, const Values& values, float at) {
  uint32_t i = 0;  // sums only rise: as many as the place is past
  for (uint32_t j = 0; j + 1 < runs; ++j) i += !(at < sums[j]);
  float before = i > 0 ? sums[i - 1] : 0;
  uint32_t k = i;
  for (; k + runs < LightStore::width; k += runs)
    if (at < (before += values[k])) break;
  return k;
}

// How many joins a camera vertex is worth that would bring so much of its pixel. What comes of a join rises with the
// root of what was expected, since what seems to bring most is mostly hidden: measured.
float joins_for(const Joiner& joiner, float brings) {
  if (!(joiner.worth > 0)) return 1;
  return std::clamp(joiner.joins * std::sqrt(joiner.worth * brings), 0.1f, 32.0f);  // (J3)
}

// Of so many blocks from one on, and around.
void expect_some(const LightStore& store, const Joiner& joiner, uint32_t from, uint32_t count, Expectation& out) {
  if (out.values.size() < count) resize(out, count);
  out.sum = 0;
  const Seer seer = seer_of(joiner);
  const Guide& guide = joiner.vertex->guide;
  const uint32_t region = region_of(guide);
  const uint32_t n = uint32_t(store.blocks.size());
  for (uint32_t j = 0; j < count; ++j) {
    const LightStore::Block& b = store.blocks[from + j < n ? from + j : from + j - n];
    expect(b, seer, joiner.most, out.values[j]);
    if (guide.fields) apply_chances(b, guide.fields->views, region, out.values[j]);
    add_up(out, j);
  }
}
}  // namespace

void choose(const LightStore& store, const Joiner& joiner, Sampler& sampler, Expectation& expected,
            std::vector<StoreChoice>& out) {
  out.clear();
  const Vec2 u = sampler.next2();
  const uint32_t n = uint32_t(store.blocks.size());
  if (n == 0) return;
  const uint32_t from = std::min(uint32_t(u.x * float(n)), n - 1), blocks = std::clamp(joiner.blocks, 1u, n);
  expect_some(store, joiner, from, blocks, expected);
  const float sum = expected.sum;
  if (!(sum > 0) || !(sum < infinity)) return;
  const float share = float(double(n) / blocks / store.paths);
  const float count = joins_for(joiner, share * sum);
  float before = 0, mark = u.y;
  for (uint32_t j = 0; j < blocks && mark < count; ++j) {
    const Values& values = expected.values[j];
    const Sums& sums = expected.sums[j];
    const uint32_t block = (from + j) % n;
    for (; mark < count; ++mark) {
      const float at = mark / count * sum - before;
      if (j + 1 < blocks && !(at < sums.back())) break;
      const uint32_t i = find(sums, values, at);
      if (!(values[i] > 0)) continue;
      const uint32_t entry = store.blocks[block].first + i;
      out.push_back({entry, share * store.entries[entry].counts * sum / (values[i] * count)});
    }
    before += sums.back();
  }
}

void expect_all(const LightStore& store, const Vertex& camera, int most, const Prospect& known, Expectation& out) {
  resize(out, store.blocks.size());
  const Seer seer = seer_of(camera);
  for (size_t block = 0; block < store.blocks.size(); ++block) {
    Values& values = out.values[block];
    expect(store.blocks[block], seer, most, values);
    if (known.views) apply_chances(store.blocks[block], *known.views, known.region, values);
    if (known.tile)
      for (uint32_t i = 0; i < LightStore::width; ++i) values[i] *= known.tile->blocks[block].chance[i];
    add_up(out, block);
  }
}

namespace {
// A number in (0, 1) of each light vertex of a block: never 0, by which a vertex without a chance would be drawn,
// nor 1. (MurmurHash3's finaliser, Appleby 2008.)
void draw_numbers(const LightStore::Block& b, uint32_t key, Values& out) {
  for (uint32_t i = 0; i < LightStore::width; ++i) {
    uint32_t h = (b.path[i] * 64 + uint32_t(b.s[i])) * 0x9e3779b9u ^ key;
    h = (h ^ h >> 16) * 0x85ebca6bu;
    h = (h ^ h >> 13) * 0xc2b2ae35u;
    out[i] = (float((h ^ h >> 16) >> 9) + 0.5f) * 0x1p-23f;
  }
}
}  // namespace

void choose_some(const LightStore& store, const Expectation& expected, int count, uint32_t key,
                 std::vector<StoreChoice>& out) {
  out.clear();
  if (!(expected.sum > 0) || !(expected.sum < infinity)) return;
  for (size_t block = 0; block < expected.values.size(); ++block) {
    Values chances, numbers;
    draw_numbers(store.blocks[block], key, numbers);
    float most = -1;
    for (uint32_t i = 0; i < LightStore::width; ++i) {
      chances[i] = float(count) * (expected.values[block][i] / expected.sum);  // (I4)
      most = std::max(most, chances[i] - numbers[i]);
    }
    if (!(most > 0)) continue;
    for (uint32_t i = 0; i < LightStore::width; ++i) {
      if (!(numbers[i] < chances[i])) continue;
      const uint32_t entry = store.blocks[block].first + i;
      out.push_back({entry, store.entries[entry].counts / (std::min(chances[i], 1.0f) * float(store.paths))});
    }
  }
}

}  // namespace ajar
