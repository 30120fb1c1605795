#include "ajar/field/lights.h"

#include <algorithm>
#include <cmath>

#include "ajar/core/distribution.h"
#include "ajar/scene/surface.h"
#include "fixed.h"

namespace ajar {
namespace {

// More than this times what was promised counts as this: what teaches may be clamped.
constexpr double largest_brought = 64;

struct CutNode {
  uint32_t node = 0;
  LightEvidence e;
  float weight = 1;
  double share = 0;    // of the cut, by its weight
  double promise = 0;  // share of what the tree promises
};

// Share of `all` that is taken for what is not known, at least: joins choose among light vertices by their flux, and of
// a lamp 10^16 times fainter than another choose none, however many subpaths start there.
constexpr double least_unknown = 1e-8;

// Shares that make the least noise go with the root of the second moment. What is not known of an entry is taken from
// all of them: what they brought over their promise, but no more than all of them together bring. (A sun that no ray of
// a closed room has found promises ten thousand times what the room's lamp does.)   (V2)
double strength(const CutNode& w, double all, double brought) {
  const double unknown = all * std::clamp(sqr(brought / std::max(w.promise, 1e-30)) / all, least_unknown, 1.0);
  return std::sqrt((double(w.e.square) + unknown) / (double(w.e.tried) + 1));
}

struct Sum {
  double square = 0, hits = 0, tried = 0;
};
Sum sum_of(const std::vector<CutNode>& cut) {
  Sum s;
  for (const CutNode& w : cut) s.square += double(w.e.square), s.hits += double(w.e.hits), s.tried += double(w.e.tried);
  return s;
}

// Makes shares add up to one; even ones where none is known, as of a cell that no lamp shines at.
void normalise(std::vector<CutNode>& cut) {
  double total = 0;
  for (const CutNode& w : cut) total += w.share;
  const bool known = total > 0 && total < double(infinity);
  for (CutNode& w : cut) w.share = known ? w.share / total : 1 / double(cut.size());
}

// The entries' new weights, and what becomes of their shares.
void weigh(const LightRules& rules, std::vector<CutNode>& cut) {
  const Sum sum = sum_of(cut);
  if (!(sum.hits > 0)) return;
  const double all = sum.square / sum.tried;
  double brought = 0, mean = 0;
  for (const CutNode& w : cut) brought += w.promise * std::sqrt(double(w.e.square) / std::max(double(w.e.tried), 1.0));
  for (const CutNode& w : cut) mean += w.promise * strength(w, all, brought);
  const double mix = double(rules.mix) * sum.hits / (sum.hits + 8);
  for (CutNode& w : cut) {
    const float weight = float(mix * strength(w, all, brought) / std::max(mean, 1e-30) + (1 - mix));  // (V3)
    w.share *= double(weight / w.weight);
    w.weight = weight;
  }
  normalise(cut);
}

constexpr float least_tries = 32;  // of an entry that is divided

// Divides strong entries as long as what is known of them carries it.
void divide(const LightTree& tree, const LightRules& rules, const CutNode& from, std::vector<CutNode>& to,
            size_t& room) {
  const LightNode& n = tree.nodes[from.node];
  if (n.left == 0 || room == 0 || !(from.share > double(rules.divide)) || from.e.tried < least_tries) {
    to.push_back(from);
    return;
  }
  --room;
  for (const uint32_t child : {n.left, n.left + 1}) {
    CutNode half = from;
    half.node = child;
    half.e.square *= 0.5f, half.e.hits *= 0.5f, half.e.tried *= 0.5f, half.share *= 0.5;
    divide(tree, rules, half, to, room);
  }
}

// Joins children that are both in the cut and weak together.
void unite(const LightTree& tree, const std::vector<uint32_t>& parents, double least, std::vector<CutNode>& cut) {
  std::vector<CutNode> out;
  for (const CutNode& w : cut) {
    out.push_back(w);
    while (out.size() > 1) {
      const CutNode &b = out.back(), &a = out[out.size() - 2];
      const uint32_t parent = parents[b.node];
      if (b.node == 0 || parents[a.node] != parent || tree.nodes[parent].left != a.node) break;
      if (a.share + b.share > least) break;
      CutNode both = a;
      both.node = parent, both.share += b.share;
      both.weight = both.share > 0 ? float((a.share * double(a.weight) + b.share * double(b.weight)) / both.share)
                                   : std::max(a.weight, b.weight);
      both.e.square += b.e.square, both.e.hits += b.e.hits, both.e.tried += b.e.tried;
      out.pop_back();
      out.back() = both;
    }
  }
  cut = std::move(out);
}

constexpr double least_gain = 16;  // of relative variance, for which entries are asked

// Whether the cut's entries would gain so little over the plain choice that they are not worth the time: both second
// moments of what comes, over the square of its mean. What an entry brings is taken to be one value or nothing.   (V7)
bool is_plain(const LightTree& tree, const Receiver& cell, const std::vector<CutNode>& cut) {
  double mean = 0, plain = 0, learned = 0;
  for (const CutNode& w : cut) {
    const double tried = std::max(double(w.e.tried), 1.0), square = double(w.e.square) / tried, part = w.promise;
    mean += part * std::sqrt(square * double(w.e.hits) / tried);
    plain += sqr(part) * square / std::max(double(sky_share(tree, cell, w.node)), 1e-30);
    learned += sqr(part) * square / std::max(w.share, 1e-30);
  }
  return !(plain - learned > least_gain * sqr(mean));
}

void append(std::vector<CutNode>& cut, const LightTree& tree, const LightRules& rules, bool plain, LearnedLights& to) {
  LightCut c;
  c.first = uint32_t(to.entries.size()), c.count = uint32_t(cut.size());
  const Sum sum = sum_of(cut);
  if (sum.tried > 0)
    c.asks = float(std::clamp(64 * (sum.hits + 1) / sum.tried, double(rules.least_asks), 1.0));  // (V4)
  c.plain = plain;
  if (rules.by_power)
    for (CutNode& w : cut)
      w.share = power_of(tree, tree.nodes[w.node].first, tree.nodes[w.node].last) * double(w.weight);
  normalise(cut);
  std::vector<float> shares;
  for (const CutNode& w : cut) shares.push_back(w.share > 0 ? float(std::max(w.share, 1e-30)) : 0);
  const Distribution choice(shares);  // however faint a lamp, it has its share of the starts
  for (size_t i = 0; i < cut.size(); ++i) {
    to.entries.push_back({cut[i].node, tree.nodes[cut[i].node].first, cut[i].weight, choice.cdf[i]});
    to.evidence.push_back(cut[i].e);
  }
  to.cuts.push_back(c);
}

// What the tree promises a cell of each entry; null: by power. False where it promises nothing.
bool set_promises(const LightTree& tree, const Receiver* cell, std::vector<CutNode>& cut) {
  double all = 0;
  for (CutNode& w : cut) {
    const LightNode& n = tree.nodes[w.node];
    all += w.promise = cell ? double(importance(tree, w.node, *cell)) : power_of(tree, n.first, n.last);
  }
  for (CutNode& w : cut) w.promise = all > 0 ? w.promise / all : 1 / double(cut.size());
  return all > 0;
}

// A cut's entries with the evidence of the records. Shares are how often entries were chosen, where that was seen;
// where they were not chosen by their weights (cell), what they would have been.
void take(const LightTree& tree, const LearnedLights& v, const LightTallies& t, const LightCut& cut,
          const LightRules& rules, const Receiver* cell, std::vector<CutNode>& out) {
  double tried = 0;
  for (uint32_t i = cut.first; i < cut.first + cut.count; ++i) tried += double(t.tried[i]);
  out.clear();
  for (uint32_t i = cut.first; i < cut.first + cut.count; ++i) {
    CutNode w{v.entries[i].node, v.evidence[i], v.entries[i].weight, double(share_of(v, cut, i))};
    if (cell) w.share = double(w.weight * importance(tree, w.node, *cell));
    if (tried > 0) {  // (V1)
      w.e.square = rules.forget * w.e.square + float(double(t.square[i]) * value_step);
      w.e.hits = rules.forget * w.e.hits + float(t.hits[i]);
      w.e.tried = rules.forget * w.e.tried + float(t.tried[i]);
      if (!cell) w.share = (32 * w.share + double(t.tried[i])) / (32 + tried);
    }
    out.push_back(w);
  }
  normalise(out);
}

}  // namespace

uint32_t entry_of(const LearnedLights& v, const LightCut& cut, uint32_t place) {
  uint32_t at = cut.first;
  for (uint32_t n = cut.count; n > 1;) {
    const uint32_t half = n / 2;
    at += v.entries[at + half].first <= place ? half : 0;
    n -= half;
  }
  return at;
}

uint32_t choose_entry(const LearnedLights& v, const LightCut& cut, float& u) {
  uint32_t at = cut.first;
  for (uint32_t n = cut.count; n > 1;) {
    const uint32_t half = n / 2;
    at += v.entries[at + half].before <= u ? half : 0;
    n -= half;
  }
  const float share = share_of(v, cut, at);
  u = share > 0 ? std::clamp((u - v.entries[at].before) / share, 0.0f, one_minus_epsilon) : u;
  return at;
}

LightTallies start_tallies(const LearnedLights& v) {
  const size_t n = v.entries.size();
  return {std::vector<int64_t>(n), std::vector<int64_t>(n), std::vector<int64_t>(n)};
}

void record(const LearnedLights& v, LightTallies& tallies, uint32_t entry, float brought) {
  add(tallies.tried[entry], 1);
  if (!(brought > 0)) return;
  add(tallies.hits[entry], 1);
  const double b = std::min(double(brought) / v.unit, largest_brought);
  add(tallies.square[entry], to_fixed(b * b, value_step));
}

void add_cut(LearnedLights& v, uint32_t from) {
  LightCut cut;
  if (from == none) {
    cut.first = uint32_t(v.entries.size()), cut.count = 1;
    v.entries.push_back({});
    v.evidence.push_back({});
  } else {
    cut = v.cuts[from];
    for (uint32_t i = 0; i < cut.count; ++i) {
      v.entries.push_back(LightEntry(v.entries[cut.first + i]));
      LightEvidence e = v.evidence[cut.first + i];
      e.square *= 0.25f, e.hits *= 0.25f, e.tried *= 0.25f;
      v.evidence.push_back(e);
    }
    cut.first = uint32_t(v.entries.size()) - cut.count;
  }
  v.cuts.push_back(cut);
}

LearnedLights learn_lights(const LightTree& tree, const LearnedLights& v, const LightTallies& tallies,
                           const LightRules& rules, std::span<const Receiver> cells) {
  LearnedLights next;
  next.unit = v.unit;
  next.cuts.reserve(v.cuts.size()), next.entries.reserve(v.entries.size());
  std::vector<uint32_t> parents(tree.nodes.size(), none);
  for (uint32_t i = 0; i < tree.nodes.size(); ++i)
    if (const uint32_t left = tree.nodes[i].left; left != 0) parents[left] = parents[left + 1] = i;
  std::vector<CutNode> cut, divided;
  for (size_t i = 0; i < v.cuts.size(); ++i) {
    const Receiver* cell = cells.empty() ? nullptr : &cells[i];
    const bool under_sky = cell && !tree.sky.empty();
    take(tree, v, tallies, v.cuts[i], rules, under_sky && v.cuts[i].plain ? cell : nullptr, cut);
    const bool promises = set_promises(tree, cell, cut);
    weigh(rules, cut);
    const bool plain = under_sky && (!promises || is_plain(tree, *cell, cut));
    unite(tree, parents, 0.2 * double(rules.divide), cut);
    size_t room = cut.size() < rules.most ? rules.most - cut.size() : 0;
    divided.clear();
    for (const CutNode& w : cut) divide(tree, rules, w, divided, room);
    append(divided, tree, rules, plain, next);
  }
  return next;
}

bool fits(const LearnedLights& v, const LightTree& tree) {
  for (const LightCut& c : v.cuts) {
    uint32_t next = 0;
    if (tree.nodes.empty()) {  // nothing shines
      if (c.count != 1 || v.entries[c.first].node != 0) return false;
      continue;
    }
    for (uint32_t i = c.first; i < c.first + c.count; ++i) {
      if (v.entries[i].node >= tree.nodes.size()) return false;
      const LightNode& n = tree.nodes[v.entries[i].node];
      if (n.first != next || v.entries[i].first != next) return false;
      next = n.last;
    }
    if (next != tree.pieces.size()) return false;
  }
  return true;
}

size_t bytes(const LearnedLights& v) {
  return v.cuts.size() * sizeof(LightCut) + v.entries.size() * (sizeof(LightEntry) + sizeof(LightEvidence));
}

}  // namespace ajar
