#include "ajar/field/nextevent.h"

#include "ajar/core/warp.h"

namespace ajar {
namespace {

// What light passes through is lit from both sides, whoever looks: the choice must not depend on the viewer's side.
bool one_sided(const Guide& g) { return g.bsdf.opaque; }

Receiver receiver_at(const Guide& g) { return {g.p, one_sided(g) ? g.frame.n : Vec3(0)}; }

// The cell's cut; null where none was learned.
const LightCut* cut_of(const Guide& g) {
  if (g.cell == none || g.fields->lights.cuts.empty() || !one_sided(g)) return nullptr;
  return &g.fields->lights.cuts[g.cell];
}

// Whether the vertex takes the sky's lights whole.
bool is_plain(const Scene& scene, const LightCut* cut) {
  return !scene.light_tree.sky.empty() && (!cut || cut->plain != 0);
}

// Probability of a next-event ray: none is sent where no light may be asked.
float asks_of(const LightTree& tree, const LightCut* cut) {
  if (tree.nodes.empty() || !(tree.nodes[0].weight > 0)) return 0;
  return cut ? cut->asks : 1;
}

bool is_cut(const LightChances& c) { return c.cut && c.cut->count > 1; }

const LightChances& know(const LightTree& tree, const Guide& guide, LightChances& c) {
  if (c.known) return c;
  c.known = true;
  c.cut = cut_of(guide);
  c.at = receiver_at(guide);
  c.asks = asks_of(tree, c.cut);
  c.total = 0;
  if (!is_cut(c)) return c;
  for (uint32_t i = 0; i < c.cut->count; ++i) {
    const LightEntry& e = guide.fields->lights.entries[c.cut->first + i];
    c.of[i] = std::min(most_importance, e.weight * importance(tree, e.node, c.at));
    c.total += c.of[i];
  }
  const float least = least_share * c.total / float(c.cut->count);
  c.total = 0;
  for (uint32_t i = 0; i < c.cut->count; ++i) c.total += c.of[i] = c.of[i] > 0 ? std::max(c.of[i], least) : 0;
  return c;
}

// Whether a light is asked at all; u becomes uniform again.
bool is_asked(float asks, float& u) { return !(asks < 1) || take_part(u, asks); }

uint32_t draw(const LightChances& c, float& u) {
  float at = u * c.total;
  uint32_t i = 0, last = 0;
  for (; i < c.cut->count; ++i) {
    if (!(c.of[i] > 0)) continue;
    last = i;
    if (at < c.of[i]) break;
    at -= c.of[i];
  }
  u = std::clamp(at / c.of[last], 0.0f, one_minus_epsilon);
  return last;
}

// A light of the sky as a whole, by power. Which piece that would have been is left open.
bool sample_plain(const Scene& scene, const Guide& guide, const LightCut* cut, float u, const Vec2& u_point,
                  DirectSample& out) {
  const float asks = asks_of(scene.light_tree, cut);
  if (!is_asked(asks, u)) return false;
  float pick;
  const SkyLight& light = choose_of_sky(scene.light_tree, receiver_at(guide), u, pick);
  if (!sample_direct(scene, light.light, guide.p, u_point, out)) return false;
  out.pdf *= pick * asks;
  return out.pdf > 0;
}

double pdf_plain(const Scene& scene, const Guide& guide, const LightCut* cut, const LightPoint& point, const Vec3& wi) {
  const float pick = sky_pdf(scene.light_tree, receiver_at(guide), point.light);
  const double pdf = point.delta_direction ? 1 : double(pdf_direct(scene, point, guide.p, wi));
  return pdf * double(pick) * double(asks_of(scene.light_tree, cut));
}

float wrapped(float u) { return std::min(u - std::floor(u), one_minus_epsilon); }

}  // namespace

LightNumbers spread(const LightNumbers& first, int i, int n) {
  constexpr float plastic = 0.7548776662f;  // 1 / 1.3247..., the root of x^3 = x + 1 (Roberts 2018)
  const float k = float(i);
  return {wrapped(first.choice + k / float(n)),
          {wrapped(first.point.x + k * plastic), wrapped(first.point.y + k * plastic * plastic)}};
}

bool chooses_light(const Scene& scene, const Guide& guide) {
  const LightCut* cut = cut_of(guide);
  const bool one = is_plain(scene, cut) ? scene.light_tree.sky.size() == 1 : scene.light_tree.pieces.size() == 1;
  return !one || (cut && cut->asks < 1);
}

bool choose_light(const Scene& scene, const Guide& guide, LightChances& chances, float u, uint32_t& place, float& pdf) {
  const LightTree& tree = scene.light_tree;
  const LightChances& c = know(tree, guide, chances);
  place = none, pdf = c.asks;
  if (!is_asked(c.asks, u)) return false;
  if (tree.pieces.size() == 1) {
    place = 0;
    return true;
  }
  uint32_t node = 0;
  float below;
  if (is_cut(c)) {
    if (!(c.total > 0)) return false;
    const uint32_t entry = draw(c, u);
    pdf *= c.of[entry] / c.total;
    node = guide.fields->lights.entries[c.cut->first + entry].node;
    place = tree.nodes[node].first;
  }
  if (!choose(tree, node, c.at, u, place, below)) return false;
  pdf *= below;
  return pdf > 0;
}

float light_pdf(const Scene& scene, const Guide& guide, LightChances& chances, uint32_t place) {
  const LightTree& tree = scene.light_tree;
  const LightChances& c = know(tree, guide, chances);
  if (tree.pieces.size() == 1) return c.asks;
  if (!is_cut(c)) return c.asks * choice_pdf(tree, 0, c.at, place);
  const LearnedLights& v = guide.fields->lights;
  const uint32_t entry = entry_of(v, *c.cut, place);
  const float chance = c.of[entry - c.cut->first];
  return chance > 0 ? c.asks * (chance / c.total) * choice_pdf(tree, v.entries[entry].node, c.at, place) : 0;
}

bool sample_next_event(const Scene& scene, const Guide& guide, LightChances& chances, const LightNumbers& u,
                       DirectSample& out) {
  out.point.place = none;
  if (const LightCut* cut = cut_of(guide); is_plain(scene, cut))
    return sample_plain(scene, guide, cut, u.choice, u.point, out);
  uint32_t place;
  float pick;
  const bool chosen = choose_light(scene, guide, chances, u.choice, place, pick);
  const bool found = chosen && sample_direct(scene, scene.light_tree.pieces[place], guide.p, u.point, out);
  out.point.place = place;
  if (!found) return false;
  if (!is_tile(scene, scene.light_tree.pieces[place])) {
    out.pdf *= pick;
    return out.pdf > 0;
  }
  PieceDensity tiles[most_shares];  // others may reach here
  const int n = densities_direct(scene, out.point, guide.p, out.wi, tiles);
  double sum = 0;
  for (int i = 0; i < n; ++i)
    sum += double(tiles[i].pdf) *
           double(tiles[i].place == place ? pick : light_pdf(scene, guide, chances, tiles[i].place));
  out.pdf = float(sum);
  return out.pdf > 0;
}

double pdf_next_event(const Scene& scene, const Guide& guide, const LightPoint& point, const Vec3& wi) {
  if (const LightCut* cut = cut_of(guide); is_plain(scene, cut)) return pdf_plain(scene, guide, cut, point, wi);
  PieceDensity found[most_shares];
  const int n = densities_direct(scene, point, guide.p, wi, found);
  LightChances chances;
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += double(found[i].pdf) * double(light_pdf(scene, guide, chances, found[i].place));
  return sum;
}

void record_next_event(const Scene& scene, const Guide& guide, LightChances& chances, Training& training,
                       const LightPoint& point, float arrives) {
  const LightCut* cut = cut_of(guide);
  if (!cut) return;
  const bool plain = is_plain(scene, cut);
  const uint32_t place = plain && point.light != none ? place_at(scene, point) : point.place;
  if (place == none) return;
  const LightTree& tree = scene.light_tree;
  const LearnedLights& v = guide.fields->lights;
  const uint32_t entry = entry_of(v, *cut, place);
  float brought = 0;
  if (arrives > 0) {
    const LightChances& c = know(tree, guide, chances);
    const uint32_t node = v.entries[entry].node;
    const float promise = importance(tree, node, c.at);
    float over = (is_cut(c) ? c.of[entry - cut->first] / c.total : 1) / promise;  // its chance over what it promises
    if (plain) over = sky_share(tree, c.at, node) / promise;
    brought = promise > 0 ? pi * arrives * c.asks * over : 0;  // (V1)
  }
  record(v, training.lights, entry, brought);
}

}  // namespace ajar
