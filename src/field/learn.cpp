#include "ajar/field/learn.h"

#include "ajar/core/frame.h"
#include "ajar/core/parallel.h"
#include "ajar/field/probes.h"
#include "fixed.h"
#include "tree.h"

namespace ajar {
namespace {

// Share of the memory up to which cells are added, and strata divided: cells are few, their strata go on growing, and a
// lesson does not know how much it is about to add.
constexpr double for_cells = 0.4, for_strata = 0.9;
bool is_left(const Fields& fields, double share, const LearnOptions& options) {
  return double(bytes(fields)) < share * double(options.memory);
}

struct Work {
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
float nearness(const Fields& fields, const Work& w, uint32_t cell) {
  const int64_t held = w.tallies->held[cell];
  const float old = w.field->cells[cell].near;
  if (held == 0) return old;
  const float now = float(double(w.tallies->nearness[cell]) / double(held)) / fields.table.width;
  return std::min(old > 0 ? 0.5f * (old + now) : now, 1 / fields.table.edge(level_of(fields.cells[cell].key)));
}

FieldCell learn_cell(Work& w, uint32_t cell, double area, double paths, Trees& out) {
  const FieldCell& old = w.field->cells[cell];
  const Tallies& t = *w.tallies;
  FieldCell next = old;
  w.tree.clear();
  take(*w.field, t, w.options->forget, old.root, w.tree);
  const float bare = weigh(w.tree, w.structure, 0);
  const float known = evidence(w.tree);
  const float floor = 0.03f * bare / pi;
  const float total = weigh(w.tree, w.structure, floor);
  if (total > 0 && w.structure == Structure::adaptive) {
    reshape(w.tree, total, *w.options, w.divides);
    weigh(w.tree, w.structure, floor);
  }
  next.root = append(out, w.tree, w.structure);
  if (t.directs[cell] > 0) {
    const double mean = double(t.direct[cell]) * value_step * w.field->unit / double(t.directs[cell]);
    next.direct = old.visits > 0 ? float(0.5 * (old.direct + mean)) : float(mean);
  }
  next.total = next.direct + (w.rule == Rule::max ? pi * most_radiance(w.tree) : bare);
  next.mix = bare > 0 ? mix_for(*w.options, known) : 0;
  const float seen = float(double(t.visits[cell]) / (area * paths));
  if (w.structure == Structure::adaptive) next.near = nearness(*w.fields, w, cell);
  next.visits = old.visits > 0 ? 0.5f * (old.visits + seen) : seen;
  return next;
}

// structure: of its strata. Where its cells are not those of the fields, they have no size.
Field learn_field(const Fields& fields, const Field& field, Structure structure, const Tallies& tallies, double paths,
                  const LearnOptions& options) {
  constexpr uint32_t block = 64;
  const uint32_t n = uint32_t(field.cells.size()), blocks = (n + block - 1) / block;
  const bool divides = is_left(fields, for_strata, options);
  std::vector<Trees> trees(blocks);
  Field next;
  next.unit = field.unit;
  next.cells.resize(n);
  parallel_for(blocks, [&](uint32_t b) {
    Work work{structure, fields.rule, &fields, &field, &tallies, &options, divides, {}};
    for (uint32_t c = b * block; c < std::min(n, (b + 1) * block); ++c) {
      const bool sized = &field != &fields.disk;
      const double edge = sized ? double(fields.table.edge(level_of(fields.cells[c].key))) : 1;
      next.cells[c] = learn_cell(work, c, edge * edge, paths, trees[b]);
    }
  });
  for (uint32_t b = 0; b < blocks; ++b) {
    const uint32_t shift = uint32_t(next.nodes.size());
    for (StrataNode& node : trees[b].nodes) node.children += shift;
    for (uint32_t c = b * block; c < std::min(n, (b + 1) * block); ++c) next.cells[c].root += shift;
    next.nodes.insert(next.nodes.end(), trees[b].nodes.begin(), trees[b].nodes.end());
    next.mean.insert(next.mean.end(), trees[b].mean.begin(), trees[b].mean.end());
    next.weight.insert(next.weight.end(), trees[b].weight.begin(), trees[b].weight.end());
  }
  return next;
}

void add_cells(Fields& fields, const Sightings& sightings, const LearnOptions& options) {
  std::vector<std::pair<CellKey, Sighting>> sorted(sightings.begin(), sightings.end());
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  const double share = fields.structure == Structure::adaptive ? for_cells : 1;
  for (const auto& [key, seen] : sorted) {
    if (!is_left(fields, share, options)) return;
    if (seen.count < 4) continue;
    const CellKey above = parent_of(key);
    const uint32_t parent = above ? cell_of(fields.table, above) : none;
    const Vec3 n = Vec3(glm::normalize(glm::dvec3(seen.normal)));
    if (!is_finite(n)) continue;
    const uint32_t id = uint32_t(fields.cells.size());
    if (parent == none)
      fields.cells.push_back({key, make_frame(n), middle_of(fields.table, key), 0, fields.regions++ % most_regions});
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
  constexpr double strata = (1 + zones) * (sizeof(StrataNode) + 32 * sizeof(Short));
  return double(memory) /
         (2 * (strata + sizeof(FieldCell)) + sizeof(Cell) + 3 * sizeof(CellTable::Slot) + sizeof(Probe));
}

CellTable start_table(const Scene& scene, const LearnOptions& options) {
  const double cells = affordable_cells(options.memory);
  if (options.structure == Structure::probes) {
    double area = 0;
    std::vector<Probe> probes = place_probes(scene, uint32_t(std::clamp(cells, 1.0, 1e7)), area);
    return make_probe_table(std::move(probes), area);
  }
  CellTable table = make_cell_table(scene.center, scene.radius);
  // A plane that leans cuts through half as many cubes again as its area has squares.
  if (options.structure == Structure::grid)
    table.width = std::clamp(float(std::sqrt(1.5 * area(scene) / cells)), scene.radius / 100, scene.radius);
  return table;
}

// Less weight to all strata of a cell.
void doubt_cell(Field& field, FieldCell& cell, float kept, const LearnOptions& options) {
  float weight = 0;
  std::vector<uint32_t> order = {cell.root};
  for (size_t k = 0; k < order.size(); ++k)
    for (int i = 0; i < 16; ++i) {
      if (field.nodes[order[k]].is_divided(i)) order.push_back(field.nodes[order[k]].child(i));
      Short& of_stratum = field.weight[16 * size_t(order[k]) + size_t(i)];
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

Fields learn(const Fields& fields, const Training& training, const Sightings& sightings, double paths,
             const LearnOptions& options, const LightTree* lights) {
  Fields next;
  next.structure = fields.structure, next.rule = fields.rule;
  next.generation = fields.generation + 1;
  next.table = fields.table;
  next.cells = fields.cells;
  next.q = learn_field(fields, fields.q, fields.structure, training.q, paths, options);
  next.w = learn_field(fields, fields.w, fields.structure, training.w, paths, options);
  next.disk = learn_field(fields, fields.disk, Structure::adaptive, training.disk, paths, options);
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
  next.views = learn_views(fields.views, training.views, next.regions, 0.9f);
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
  const double unit = fields.starts.unit;
  fields.starts = {};
  fields.starts.unit = unit;
  add_cut(fields.starts, none);
}

bool fit_lights(const LightTree& tree, const LearnOptions& options, Fields& fields) {
  bool changed = false;
  if (const size_t cuts = options.lights ? fields.cells.size() : 0;
      fields.lights.cuts.size() != cuts || !fits(fields.lights, tree)) {
    fields.lights = {};
    for (size_t i = 0; i < cuts; ++i) add_cut(fields.lights, none);
    changed = true;
  }
  if (!fits(fields.starts, tree)) {
    const double unit = fields.starts.unit;
    fields.starts = {};
    fields.starts.unit = unit;
    add_cut(fields.starts, none);
    changed = true;
  }
  if (fields.disk.cells.size() != tree.regions.size()) {
    const double unit = fields.disk.unit;
    fields.disk = {};
    fields.disk.unit = unit;
    for (size_t i = 0; i < tree.regions.size(); ++i) add_cell(fields.disk, none, Structure::adaptive);
    changed = true;
  }
  return changed;
}

}  // namespace ajar
