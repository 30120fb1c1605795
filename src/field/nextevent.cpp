#include "ajar/field/nextevent.h"

namespace ajar {
namespace {

// What light passes through is lit from both sides, whoever looks: the choice must not depend on the viewer's side.
bool one_sided(const Guide& g) { return g.bsdf.opaque; }

Receiver receiver_at(const Guide& g, const Vec3& p) { return {p, one_sided(g) ? g.frame.n : Vec3(0)}; }

// The cell's cut; null where none was learned.
const LightCut* cut_of(const Guide& g) {
  if (g.cell == none || g.fields->lights.cuts.empty() || !one_sided(g)) return nullptr;
  return &g.fields->lights.cuts[g.cell];
}

// What every entry of a cut promises the receiver, times what was learned of it.   (V3)
struct Chances {
  float of[LightRules{}.most];
};
float chances(const LightTree& tree, const LearnedLights& v, const LightCut& cut, const Receiver& at, Chances& out) {
  float sum = 0;
  for (uint32_t i = 0; i < cut.count; ++i) {
    const LightEntry& e = v.entries[cut.first + i];
    out.of[i] = e.weight * importance(tree, e.node, at);
    sum += out.of[i];
  }
  return sum < infinity ? sum : 0;
}

uint32_t draw(const Chances& c, uint32_t count, float total, float& u) {
  float at = u * total;
  uint32_t i = 0, last = 0;
  for (; i < count; ++i) {
    if (!(c.of[i] > 0)) continue;
    last = i;
    if (at < c.of[i]) break;
    at -= c.of[i];
  }
  u = std::clamp(at / c.of[last], 0.0f, one_minus_epsilon);
  return last;
}

}  // namespace

bool chooses_light(const Scene& scene, const Guide& guide) {
  const LightCut* cut = cut_of(guide);
  return scene.light_tree.pieces.size() > 1 || (cut && cut->asks < 1);
}

bool choose_light(const Scene& scene, const Guide& guide, const Vec3& p, float u, uint32_t& place, float& pdf) {
  const LightTree& tree = scene.light_tree;
  const LightCut* cut = cut_of(guide);
  const float asks = cut ? cut->asks : 1;
  place = none, pdf = asks;
  if (tree.nodes.empty() || (asks < 1 && u >= asks)) return false;
  if (tree.pieces.size() == 1) {
    place = 0;
    return true;
  }
  if (asks < 1) u = std::min(u / asks, one_minus_epsilon);
  const Receiver at = receiver_at(guide, p);
  uint32_t node = 0;
  float below;
  if (cut && cut->count > 1) {
    Chances c;
    const float total = chances(tree, guide.fields->lights, *cut, at, c);
    if (!(total > 0)) return false;
    const uint32_t entry = draw(c, cut->count, total, u);
    pdf *= c.of[entry] / total;
    node = guide.fields->lights.entries[cut->first + entry].node;
    place = tree.nodes[node].first;
  }
  if (!choose(tree, node, at, u, place, below)) return false;
  pdf *= below;
  return pdf > 0;
}

float light_pdf(const Scene& scene, const Guide& guide, const Vec3& p, uint32_t place) {
  const LightTree& tree = scene.light_tree;
  const LightCut* cut = cut_of(guide);
  const float asks = cut ? cut->asks : 1;
  if (tree.pieces.size() == 1) return asks;
  const Receiver at = receiver_at(guide, p);
  if (!cut || cut->count == 1) return asks * choice_pdf(tree, 0, at, place);
  const LearnedLights& v = guide.fields->lights;
  Chances c;
  const float total = chances(tree, v, *cut, at, c);
  const uint32_t entry = entry_of(v, *cut, place);
  const float chance = c.of[entry - cut->first];
  return chance > 0 ? asks * (chance / total) * choice_pdf(tree, v.entries[entry].node, at, place) : 0;
}

bool sample_next_event(const Scene& scene, const Guide& guide, const Vec3& p, float u_choice, const Vec2& u_point,
                       DirectSample& out) {
  uint32_t place;
  float pick;
  out.point.place = none;
  const bool chosen = choose_light(scene, guide, p, u_choice, place, pick);
  const bool found = chosen && sample_direct(scene, scene.light_tree.pieces[place], p, u_point, out);
  out.point.place = place;
  if (!found) return false;
  if (!is_tile(scene, scene.light_tree.pieces[place])) {
    out.pdf *= pick;
    return out.pdf > 0;
  }
  PieceDensity tiles[most_shares];  // others may reach here
  const int n = densities_direct(scene, out.point, p, out.wi, tiles);
  double sum = 0;
  for (int i = 0; i < n; ++i)
    sum += double(tiles[i].pdf) * double(tiles[i].place == place ? pick : light_pdf(scene, guide, p, tiles[i].place));
  out.pdf = float(sum);
  return out.pdf > 0;
}

double pdf_next_event(const Scene& scene, const Guide& guide, const Vec3& p, const LightPoint& point, const Vec3& wi) {
  PieceDensity found[most_shares];
  const int n = densities_direct(scene, point, p, wi, found);
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += double(found[i].pdf) * double(light_pdf(scene, guide, p, found[i].place));
  return sum;
}

void record_next_event(const Scene& scene, const Guide& guide, const Vec3& p, Training& training, uint32_t place,
                       float arrives) {
  const LightCut* cut = cut_of(guide);
  if (!cut || place == none) return;
  const LearnedLights& v = guide.fields->lights;
  const uint32_t entry = entry_of(v, *cut, place);
  float brought = 0;
  if (arrives > 0) {
    const Receiver at = receiver_at(guide, p);
    Chances c;  // what the entry promises cancels against its chance
    const float promised = cut->count > 1 ? chances(scene.light_tree, v, *cut, at, c)
                                          : importance(scene.light_tree, v.entries[entry].node, at);
    const float weight = cut->count > 1 ? v.entries[entry].weight : 1;
    brought = promised > 0 ? pi * arrives * cut->asks * weight / promised : 0;  // (V1)
  }
  record(v, training.lights, entry, brought);
}

void record_place(const Guide& guide, const Vec3& ng, Training& training, Sightings& sightings) {
  if (guide.missing) record_missing(sightings, guide.missing, glm::dot(ng, guide.wo) < 0 ? -ng : ng);
  if (guide.cell != none) record_visit(training.of(guide.side), guide.cell);
}

}  // namespace ajar
