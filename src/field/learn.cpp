#include "ajar/field/learn.h"

#include <span>

#include "ajar/core/frame.h"
#include "ajar/core/parallel.h"
#include "ajar/field/portals.h"
#include "ajar/field/probes.h"
#include "fixed.h"
#include "tree.h"

namespace ajar {
namespace {

// Share of the memory up to which cells are added, and strata divided: cells are few, their strata go on growing, and a
// lesson does not know how much it is about to add. Coarse cells are always let in: without one, what has moved to
// where nothing was (a door's leaf) would not be guided at all. Pairs of regions have a share of their own.
constexpr double for_cells = 0.4, for_strata = 0.75, for_views = 0.15;
constexpr int coarse_levels = 3;
bool is_left(const Fields& fields, double share, const LearnOptions& options) {
  return double(bytes(fields)) < share * double(options.memory);
}
uint32_t affordable_regions(const LearnOptions& options) {
  return ajar::affordable_regions(for_views * double(options.memory));
}

struct Rebuild {
  Structure structure = Structure::adaptive;
  Rule rule = Rule::expected;
  const Fields* fields = nullptr;
  const Field* field = nullptr;
  const Tallies* tallies = nullptr;
  const LearnOptions* options = nullptr;
  bool divides = true;  // strata that are heavy enough
  Tree tree;
};

// (G4): how much strata with so much evidence behind them are trusted.
float mix_for(const LearnOptions& options, float weight) { return options.mix * weight / (weight + options.trust); }

// (G8); at most what the cell's size allows.
float nearness(const Fields& fields, const Rebuild& w, uint32_t cell) {
  const int64_t held = w.tallies->held[cell];
  const float old = w.field->cells[cell].near;
  if (held == 0) return old;
  const float now = float(double(w.tallies->nearness[cell]) / double(held)) / fields.table.width;
  return std::min(old > 0 ? 0.5f * (old + now) : now, 1 / fields.table.edge(level_of(fields.cells[cell].key)));
}

// Through which portal a cell's directions are drawn, and how many: as many the more radiance comes through it than
// from elsewhere. More than come through it by themselves: from there on the other side's subpaths know the way, and
// hardly any path finds through. (G11)
void learn_opening(const Rebuild& w, uint32_t cell, FieldCell& next) {
  constexpr double most_drawn = 0.6, least_carried = 1e-4, usual_contrast = 2;
  const size_t n = w.field->portals.size() / 2;
  if (n == 0) return;
  const int64_t* const sums = &w.tallies->through[cell * sums_through(*w.field)];
  if (sums[1] == 0) return;
  uint32_t best = none;
  double most = 0;
  for (uint32_t k = 0; k < n; ++k) {
    const int64_t* const s = sums + 2 + 2 * k;
    if (double(s[1]) < least_carried * double(sums[1])) continue;
    const double contrast = double(s[1]) / double(s[0]) * (double(sums[0]) / double(sums[1]));
    const double share = most_drawn * (1 - usual_contrast / std::max(contrast, usual_contrast));
    if (share > most) most = share, best = k;
  }
  next.through = next.portal == best ? 0.5f * (next.through + float(most)) : float(most);
  next.portal = next.through > 0.01f ? uint16_t(best) : FieldCell::no_portal;
}

// Portals stay where they are from this lesson on.
constexpr uint32_t settled = 8;

// What strata weigh at least [per solid angle], of a sum of weights: a share of what they would if all were alike.
float floor_for(float sum) { return 0.03f * sum / pi; }

// Strata of a portal: there are few, so they may be fine. What a portal held before it moved is a first guess.
FieldCell learn_portal(Rebuild& w, const FieldCell& old, bool moved, Trees& out) {
  LearnOptions fine = *w.options;
  fine.divide_stratum = 1 / 256.0f;
  FieldCell next = old;
  w.tree.clear();
  take(*w.field, *w.tallies, fine.forget, old.root, w.tree);
  if (moved)
    for (TreeNode& n : w.tree)
      for (float& weight : n.weight) weight *= 0.1f;
  const float bare = weigh(w.tree, Structure::adaptive, 0);
  next.mix = bare > 0 ? mix_for(fine, evidence(w.tree)) : 0;
  const float floor = floor_for(bare);
  if (const float total = weigh(w.tree, Structure::adaptive, floor); total > 0) {
    reshape(w.tree, total, fine, true);
    weigh(w.tree, Structure::adaptive, floor);
  }
  next.root = append(out, w.tree, Structure::adaptive);
  return next;
}

// Irradiance that next-event estimation brings, or importance that the lens itself gives, by all lessons.
float direct_of(const Rebuild& w, uint32_t cell) {
  const FieldCell& old = w.field->cells[cell];
  if (w.tallies->directs[cell] == 0) return old.direct;
  const double mean = double(w.tallies->direct[cell]) * value_step * w.field->unit / double(w.tallies->directs[cell]);
  return old.visits > 0 ? float(0.5 * (old.direct + mean)) : float(mean);
}

// Whether the cell's field goes on as it was: what was learned, now in the tree's masses, differs from it by no more
// than noise may, and no stratum asks to be divided.   (T2)
bool is_steady(const Rebuild& w, const FieldCell& old, float mix, float strata, float total) {
  constexpr float shares = 0.05f, of_strata = 0.15f, trust = 0.05f;
  if (!w.options->steady || w.structure != Structure::adaptive || !(old.visits > 0) || !(total > 0)) return false;
  const float was = old.total - old.direct;
  if (std::abs(strata - was) > of_strata * was || std::abs(mix - old.mix) > trust) return false;
  if (difference(*w.field, old.root, w.tree) > shares) return false;
  Tree tree = w.tree;
  reshape(tree, total, *w.options, w.divides);
  return tree.size() == w.tree.size();
}

// The cell with new evidence alone, and with what it receives directly where that is another by far.
FieldCell as_it_was(const Rebuild& w, const FieldCell& old, float direct, Trees& out) {
  constexpr float of_direct = 0.25f, of_all = 0.05f;
  FieldCell next = old;
  next.root = append_evidence(out, w.tree, *w.field, old.root);
  if (std::abs(direct - old.direct) > of_direct * old.direct + of_all * old.total)
    next.total += direct - old.direct, next.direct = direct;
  return next;
}

FieldCell learn_cell(Rebuild& w, uint32_t cell, double area, double paths, Trees& out) {
  const FieldCell& old = w.field->cells[cell];
  FieldCell next = old;
  w.tree.clear();
  take(*w.field, *w.tallies, w.options->forget, old.root, w.tree);
  const float bare = weigh(w.tree, w.structure, 0);
  const bool even = w.structure == Structure::adaptive && contrast(w.tree) < w.options->least_contrast;
  const float floor = floor_for(bare);
  const float total = weigh(w.tree, w.structure, floor);
  next.mix = bare > 0 ? mix_for(*w.options, evidence(w.tree)) : 0;
  next.direct = direct_of(w, cell);
  if (is_steady(w, old, next.mix, bare, total)) return as_it_was(w, old, next.direct, out);
  if (total > 0 && w.structure == Structure::adaptive) {
    reshape(w.tree, total, *w.options, w.divides);
    weigh(w.tree, w.structure, floor);
  }
  next.root = append(out, w.tree, w.structure);
  next.total = next.direct + (w.rule == Rule::max ? pi * most_radiance(w.tree) : bare);
  const float seen = float(double(w.tallies->visits[cell]) / (area * paths));
  if (w.structure == Structure::adaptive) next.near = nearness(*w.fields, w, cell);
  learn_opening(w, cell, next);
  next.even = even && next.portal == FieldCell::no_portal;
  next.visits = old.visits > 0 ? 0.5f * (old.visits + seen) : seen;
  return next;
}

// Adds trees, and shifts the roots of the cells that they are of.
void join(Field& to, Trees trees, std::span<FieldCell> cells) {
  const uint32_t shift = uint32_t(to.nodes.size());
  for (StrataNode& node : trees.nodes) node.children += shift;
  for (FieldCell& c : cells) c.root += shift;
  to.nodes.insert(to.nodes.end(), trees.nodes.begin(), trees.nodes.end());
  to.mean.insert(to.mean.end(), trees.mean.begin(), trees.mean.end());
  to.weight.insert(to.weight.end(), trees.weight.begin(), trees.weight.end());
}

// structure: of its strata. places: its cells'; none: they have no size.
Field learn_field(const Fields& fields, const Field& field, std::span<const Cell> places, Structure structure,
                  const Tallies& tallies, double paths, const LearnOptions& options,
                  const std::vector<bool>& moved = {}) {
  constexpr uint32_t block = 64;
  const uint32_t n = uint32_t(field.cells.size()), blocks = (n + block - 1) / block;
  const bool divides = is_left(fields, for_strata, options);
  std::vector<Trees> trees(blocks);
  Field next;
  next.unit = field.unit;
  next.cells.resize(n);
  parallel_for(blocks, [&](uint32_t b) {
    Rebuild work{structure, fields.rule, &fields, &field, &tallies, &options, divides, {}};
    for (uint32_t c = b * block; c < std::min(n, (b + 1) * block); ++c) {
      const double edge = places.empty() ? 1 : double(fields.table.edge(level_of(places[c].key)));
      next.cells[c] = learn_cell(work, c, edge * edge, paths, trees[b]);
    }
  });
  for (uint32_t b = 0; b < blocks; ++b)
    join(next, std::move(trees[b]), std::span(next.cells).subspan(b * block, std::min(block, n - b * block)));
  Rebuild work{Structure::adaptive, fields.rule, &fields, &field, &tallies, &options, divides, {}};
  Trees of_portals;
  for (size_t i = 0; i < field.portals.size(); ++i)
    next.portals.push_back(learn_portal(work, field.portals[i], moved[i / 2], of_portals));
  join(next, std::move(of_portals), next.portals);
  return next;
}

void add_cells(Fields& fields, const Sightings& sightings, const LearnOptions& options) {
  std::vector<std::pair<CellKey, Sighting>> sorted(sightings.begin(), sightings.end());
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  const bool adaptive = fields.structure == Structure::adaptive;
  const uint32_t most = affordable_regions(options);
  for (const auto& [key, seen] : sorted) {
    const double share = !adaptive ? 1 - for_views : level_of(key) < coarse_levels ? for_strata : for_cells;
    if (!is_left(fields, share, options)) return;
    if (seen.count < 4) continue;
    const CellKey above = parent_of(key);
    const uint32_t parent = above ? cell_of(fields.table, above) : none;
    const Vec3 n = Vec3(glm::normalize(glm::dvec3(seen.normal)));
    if (!is_finite(n)) continue;
    const uint32_t id = uint32_t(fields.cells.size());
    if (parent == none)
      fields.cells.push_back({key, make_frame(n), middle_of(fields.table, key), 0, fields.regions++ % most});
    else
      fields.cells.push_back(
          {key, fields.cells[parent].frame, middle_of(fields.table, key), 0, fields.cells[parent].region});
    insert(fields.table, key, id);
    add_cell(fields.q, parent, fields.structure);
    add_cell(fields.w, parent, fields.structure);
    if (options.lights) add_cut(fields.lights, parent);
  }
}

// Cells of patches that the memory has room for, with their places in the hash table.
double affordable_cells(size_t memory) {
  constexpr double strata = (1 + zones) * (sizeof(StrataNode) + 32 * sizeof(UFloat16));
  return (1 - for_views) * double(memory) /
         (2 * (strata + sizeof(FieldCell)) + sizeof(Cell) + 3 * sizeof(CellTable::Slot) + sizeof(Probe));
}

CellTable start_table(const Scene& scene, const LearnOptions& options) {
  const double cells = affordable_cells(options.memory);
  if (options.structure == Structure::probes) {
    double area = 0;
    std::vector<Probe> probes = place_probes(scene, uint32_t(std::clamp(cells, 1.0, 1e7)), area);
    return make_probe_table(std::move(probes), area);
  }
  if (options.structure != Structure::grid) return make_cell_table(scene.center, scene.radius);
  // A plane that leans cuts through half as many cubes again as its area has squares.
  const float width = std::clamp(float(std::sqrt(1.5 * area(scene) / cells)), scene.radius / 100, scene.radius);
  return make_cell_table(scene.center, scene.radius, width);
}

// Less weight to all strata of a cell.
void doubt_cell(Field& field, FieldCell& cell, float kept, const LearnOptions& options) {
  float weight = 0;
  std::vector<uint32_t> order = {cell.root};
  for (size_t k = 0; k < order.size(); ++k)
    for (int i = 0; i < 16; ++i) {
      if (field.nodes[order[k]].is_divided(i)) order.push_back(field.nodes[order[k]].child(i));
      UFloat16& of_stratum = field.weight[16 * size_t(order[k]) + size_t(i)];
      of_stratum = kept * of_stratum;
      weight += of_stratum;
    }
  if (cell.mix > 0) cell.mix = mix_for(options, weight);
}

// Which lights cells see, and which ones light subpaths start at.
void learn_choices(const Fields& fields, const Training& training, const LearnOptions& options, const LightTree& tree,
                   Fields& next) {
  LightRules rules;
  if (!(options.mix > 0)) rules.mix = 0;
  rules.forget = options.forget;
  rules.most = most_starts, rules.divide = 1 / 128.0f, rules.by_power = true;
  next.starts = learn_lights(tree, fields.starts, training.starts, rules);
  rules.most = LightRules{}.most, rules.divide = LightRules{}.divide, rules.by_power = false;
  if (options.mix > 0) rules.least_asks = 1 / 8.0f;
  if (!options.lights) return;
  std::vector<Receiver> cells;
  for (const Cell& c : fields.cells) cells.push_back({c.center, c.frame.n});
  next.lights = learn_lights(tree, fields.lights, training.lights, rules, cells);
}

// To where paths through them are closest together, as long as little is known; which moved. (G13)
std::vector<bool> move_portals(const Training& training, Fields& next) {
  std::vector<bool> moved(next.table.portals.size());
  for (size_t i = 0; i < next.lines.size(); ++i)
    next.lines[i] += (double(training.q.lines[i]) + double(training.w.lines[i])) * value_step;
  for (size_t k = 0; k < moved.size() && next.generation <= settled; ++k) {
    Portal& p = next.table.portals[k];
    const float to = narrowest(p, &next.lines[k * line_sums], portal_margin * next.table.width);
    moved[k] = std::abs(to - p.center[p.axis]) > p.radius / 256;
    if (moved[k]) p.center[p.axis] = to;
  }
  return moved;
}

// Light subpaths start as the plain choice has it.
void forget_starts(Fields& fields) {
  const double unit = fields.starts.unit;
  fields.starts = {};
  fields.starts.unit = unit;
  add_cut(fields.starts, none);
}

size_t cuts_of_cells(const Fields& fields, const LearnOptions& options) {
  return options.lights ? fields.cells.size() : 0;
}
bool lights_fit(const Fields& fields, const LightTree& tree, const LearnOptions& options) {
  return fields.lights.cuts.size() == cuts_of_cells(fields, options) && fits(fields.lights, tree);
}
bool starts_fit(const Fields& fields, const LightTree& tree) {
  return fields.starts.cuts.size() == 1 && fits(fields.starts, tree);
}
bool disk_fits(const Fields& fields, const LightTree& tree) { return fields.disk.cells.size() == tree.regions.size(); }

}  // namespace

Fields start_fields(const Scene& scene, double pixels, const LearnOptions& options) {
  Fields f;
  f.structure = options.structure, f.rule = options.rule;
  f.table = start_table(scene, options);
  double watts = 0;
  for (uint32_t i = 0; i < scene.lights.size(); ++i) watts += power(scene, i);
  const double area = 4 * std::numbers::pi * double(scene.radius) * double(scene.radius);
  f.q.unit = std::max(watts, 1e-30) / (area * std::numbers::pi);
  f.w.unit = pixels / (area * std::numbers::pi);
  f.starts.unit = 16 * f.w.unit, f.disk.unit = f.w.unit;
  add_cut(f.starts, none);
  for (size_t i = 0; i < scene.light_tree.regions.size(); ++i) add_cell(f.disk, none, Structure::adaptive);
  return f;
}

Fields learn(const Fields& fields, const Training& training, const Sightings& sightings, const Recorded& paths,
             const LearnOptions& options, const LightTree* lights) {
  Fields next;
  next.structure = fields.structure, next.rule = fields.rule;
  next.generation = fields.generation + 1;
  next.table = fields.table;
  next.cells = fields.cells;
  next.lines = fields.lines;
  const std::vector<bool> moved = move_portals(training, next);
  next.q = learn_field(fields, fields.q, fields.cells, fields.structure, training.q, paths.camera, options, moved);
  next.w = learn_field(fields, fields.w, fields.cells, fields.structure, training.w, paths.light, options, moved);
  next.disk = learn_field(fields, fields.disk, {}, Structure::adaptive, training.disk, paths.light, options);
  next.lights = fields.lights, next.starts = fields.starts;
  if (lights && !lights->nodes.empty()) learn_choices(fields, training, options, *lights, next);
  for (uint32_t c = 0; c < next.cells.size(); ++c) {
    Cell& cell = next.cells[c];
    cell.seen += float(training.q.visits[c] + training.w.visits[c]);
    if (next.structure != Structure::adaptive) continue;
    if (cell.seen > options.divide_cell && level_of(cell.key) < most_cell_levels) set_divided(next.table, cell.key);
  }
  next.regions = fields.regions;
  add_cells(next, sightings, options);
  if (next.structure == Structure::adaptive) shorten(next.table);
  next.views = learn_views(fields.views, training.views,
                           std::max(fields.views.regions, std::min(next.regions, affordable_regions(options))), 0.9f);
  restrict_to(next, options.guided);
  return next;
}

Fields doubt(const Fields& fields, const std::vector<Box>& moved, float kept, const LearnOptions& options) {
  Fields next = fields;
  for (uint32_t c = 0; c < next.cells.size(); ++c) {
    Box cube = cube_of(next.table, next.cells[c].key);
    const float edge = next.table.edge(level_of(next.cells[c].key));
    cube.lo -= edge, cube.hi += edge;
    if (std::none_of(moved.begin(), moved.end(), [&](const Box& box) { return overlap(box, cube); })) continue;
    for (Field* field : {&next.q, &next.w}) doubt_cell(*field, field->cells[c], kept, options);
  }
  for (size_t i = 0; i < next.q.portals.size() && !moved.empty(); ++i)
    for (Field* field : {&next.q, &next.w}) doubt_cell(*field, field->portals[i], kept, options);
  return next;
}

void restrict_to(Fields& fields, Guided guided) {
  const bool camera = guided == Guided::both || guided == Guided::camera;
  const bool light = guided == Guided::both || guided == Guided::light;
  if (!camera)
    for (FieldCell& c : fields.q.cells) c.mix = 0;
  if (light) return;
  for (Field* f : {&fields.w, &fields.disk})
    for (FieldCell& c : f->cells) c.mix = 0;
  forget_starts(fields);
}

bool fits(const Fields& fields, const LightTree& tree, const LearnOptions& options) {
  return lights_fit(fields, tree, options) && starts_fit(fields, tree) && disk_fits(fields, tree);
}

bool fit_lights(const LightTree& tree, const LearnOptions& options, Fields& fields) {
  if (fits(fields, tree, options)) return false;
  if (!lights_fit(fields, tree, options)) {
    fields.lights = {};
    for (size_t i = 0; i < cuts_of_cells(fields, options); ++i) add_cut(fields.lights, none);
  }
  if (!starts_fit(fields, tree)) forget_starts(fields);
  if (!disk_fits(fields, tree)) {
    const double unit = fields.disk.unit;
    fields.disk = {};
    fields.disk.unit = unit;
    for (size_t i = 0; i < tree.regions.size(); ++i) add_cell(fields.disk, none, Structure::adaptive);
  }
  return true;
}

}  // namespace ajar
