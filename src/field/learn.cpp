#include "ajar/field/learn.h"

#include "ajar/core/frame.h"
#include "ajar/core/parallel.h"
#include "ajar/field/probes.h"
#include "fixed.h"

namespace ajar {
namespace {

// Area of the projected hemisphere under a stratum: [corner, corner + width] of the unit square.
float stratum_area(const Vec2& corner, float width) {
  float sum = 0;
  for (int i = 0; i < 4; ++i) {
    const Vec2 a = 2.0f * (corner + width * Vec2(0.25f + 0.5f * float(i & 1), 0.25f + 0.5f * float(i >> 1))) - 1.0f;
    const float m = std::max(std::abs(a.x), std::abs(a.y));
    sum += m * m / glm::dot(a, a);
  }
  return sum * width * width;  // x 4 for the square's area, / 4 samples
}

// A tree at work: children by index into the same vector, values at leaves.
struct Node {
  float mean[16], weight[16], mass[16];
  int32_t child[16];
};

struct Work {
  Structure structure = Structure::adaptive;
  Rule rule = Rule::expected;
  const Fields* fields = nullptr;
  const Field* field = nullptr;
  const Tallies* tallies = nullptr;
  const LearnOptions* options = nullptr;
  std::vector<Node> nodes;
};

// Old node with the evidence of its records.
int32_t take(Work& w, uint32_t old) {
  const int32_t at = int32_t(w.nodes.size());
  w.nodes.emplace_back();
  for (int i = 0; i < 16; ++i) {
    const size_t k = 16 * size_t(old) + size_t(i);
    if (w.field->nodes[old].is_divided(i)) {
      const int32_t child = take(w, w.field->nodes[old].child(i));
      w.nodes[size_t(at)].child[i] = child;
      continue;
    }
    const float fresh = float(double(w.tallies->weight[k]) * weight_step),
                kept = w.options->forget * w.field->weight[k];
    const float sum = kept + fresh;
    float mean = w.field->mean[k];
    if (fresh > 0) {
      const double value = double(w.tallies->value[k]) * value_step * w.field->unit / fresh;
      mean += float((value - mean) * (fresh / sum));  // (G3)
    }
    Node& mine = w.nodes[size_t(at)];
    mine.child[i] = -1;
    mine.mean[i] = mean;
    mine.weight[i] = fresh > 0 ? sum : w.field->weight[k];
  }
  return at;
}

// Fills the masses of a node and all below it; returns their sum.
float weigh(std::vector<Node>& nodes, int32_t at, const Vec2& corner, float width, float floor) {
  float sum = 0;
  for (int i = 0; i < 16; ++i) {
    const float w = width / 4;
    const Vec2 c = corner + w * Vec2(i & 3, i >> 2);
    const int32_t child = nodes[size_t(at)].child[i];
    const float mass =
        child >= 0 ? weigh(nodes, child, c, w, floor) : (nodes[size_t(at)].mean[i] + floor) * stratum_area(c, w);
    nodes[size_t(at)].mass[i] = mass;
    sum += mass;
  }
  return sum;
}

// The same for patches; returns irradiance over all of them. The grid's masses are without the cosine, as Comi's.
float weigh_patches(std::vector<Node>& nodes, float floor, Structure structure) {
  float sum = 0;
  for (int zone = no_zones; zone < 16; ++zone) {
    const float cosine = patch_cosine(zone);
    Node& child = nodes[size_t(nodes[0].child[zone])];
    float radiance = 0;
    for (int i = no_segments; i < 16; ++i) radiance += child.mass[i] = child.mean[i] + floor;
    nodes[0].mass[zone] = radiance * (structure == Structure::grid ? patch_angle : cosine);
    sum += radiance * cosine;
  }
  return sum;
}

float weigh(Work& w, float floor) {
  if (w.structure == Structure::adaptive) return weigh(w.nodes, 0, Vec2(0), 1, floor);
  return weigh_patches(w.nodes, floor, w.structure);
}

// Largest mean of all strata.
float best(const std::vector<Node>& nodes) {
  float most = 0;
  for (const Node& n : nodes)
    for (int i = 0; i < 16; ++i)
      if (n.child[i] < 0) most = std::max(most, n.mean[i]);
  return most;
}

// How many records a stratum of a level got, by their weights: those of narrow strata weigh little, since many
// directions are drawn there.
constexpr float least_records = 8;
float records_in(float weight, float share, int level, float mix) {
  const float even = std::ldexp(1.0f, -4 * (level + 1));
  return weight * (1 - mix + mix * share / even);
}

// Divides heavy strata, joins light ones.
void reshape(Work& w, int32_t at, int level, float total) {
  for (int i = 0; i < 16; ++i) {
    const float share = w.nodes[size_t(at)].mass[i] / total;
    const int32_t child = w.nodes[size_t(at)].child[i];
    if (child >= 0) {
      if (share > 0.4f * w.options->divide_stratum) {
        reshape(w, child, level + 1, total);
        continue;
      }
      float mean = 0, weight = 0;
      bool leaf = true;
      for (int j = 0; j < 16; ++j) {
        leaf = leaf && w.nodes[size_t(child)].child[j] < 0;
        mean += w.nodes[size_t(child)].mean[j] / 16, weight += w.nodes[size_t(child)].weight[j];
      }
      if (!leaf) continue;
      Node& mine = w.nodes[size_t(at)];
      mine.child[i] = -1, mine.mean[i] = mean, mine.weight[i] = weight;
    } else if (share > w.options->divide_stratum && level + 1 < most_levels &&
               records_in(w.nodes[size_t(at)].weight[i], share, level, w.options->mix) >= least_records) {
      const int32_t fresh = int32_t(w.nodes.size());
      w.nodes.emplace_back();
      Node& mine = w.nodes[size_t(at)];
      Node& part = w.nodes.back();
      for (int j = 0; j < 16; ++j)
        part.mean[j] = mine.mean[i], part.weight[j] = mine.weight[i] / 16, part.child[j] = -1;
      mine.child[i] = fresh;
    }
  }
}

// Writes shares in steps of 2^-16; every stratum gets one at least, but those before the first one in use.
void quantise(const Node& from, int first, StrataNode& to) {
  float sum = 0;
  for (const float m : from.mass) sum += m;
  double before = 0;
  uint32_t last = 0;
  for (int i = 0; i < 16; ++i) {
    to.before[i] = uint16_t(last);
    if (i < first) continue;
    before += from.mass[i];
    const uint32_t next =
        uint32_t(sum > 0 ? std::lround(before / sum * 65536) : 65536 * (i + 1 - first) / (16 - first));
    last = std::clamp(next, last + 1, 65536u - uint32_t(15 - i));
  }
}

// A finished tree, appended: breadth first, so that the children of a node follow each other.
struct Trees {
  std::vector<StrataNode> nodes;
  std::vector<float> mean, weight;
};

// First place in use of a node of patches.
int first_of(Structure structure, bool is_root) {
  return structure == Structure::adaptive ? 0 : is_root ? no_zones : no_segments;
}

uint32_t append(Trees& out, const std::vector<Node>& nodes, Structure structure) {
  const uint32_t root = uint32_t(out.nodes.size());
  std::vector<int32_t> order = {0};
  for (size_t k = 0; k < order.size(); ++k) {
    const Node& from = nodes[size_t(order[k])];
    StrataNode to;
    quantise(from, first_of(structure, k == 0), to);
    to.children = root + uint32_t(order.size());
    for (int i = 0; i < 16; ++i) {
      if (from.child[i] >= 0) to.divided |= uint16_t(1u << i), order.push_back(from.child[i]);
      out.mean.push_back(from.child[i] >= 0 ? 0 : from.mean[i]);
      out.weight.push_back(from.child[i] >= 0 ? 0 : from.weight[i]);
    }
    out.nodes.push_back(to);
  }
  return root;
}

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
  w.nodes.clear();
  take(w, old.root);
  const float bare = weigh(w, 0);
  const float floor = 0.03f * bare / pi;
  const float total = weigh(w, floor);
  if (total > 0 && w.structure == Structure::adaptive) {
    reshape(w, 0, 0, total);
    weigh(w, floor);
  }
  next.root = append(out, w.nodes, w.structure);
  if (t.directs[cell] > 0) {
    const double mean = double(t.direct[cell]) * value_step * w.field->unit / double(t.directs[cell]);
    next.direct = old.visits > 0 ? float(0.5 * (old.direct + mean)) : float(mean);
  }
  next.total = next.direct + (w.rule == Rule::max ? pi * best(w.nodes) : bare);
  float weight = 0;
  for (const Node& n : w.nodes)
    for (int i = 0; i < 16; ++i) weight += n.child[i] < 0 ? n.weight[i] : 0;
  next.mix = bare > 0 ? mix_for(*w.options, weight) : 0;
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
  std::vector<Trees> trees(blocks);
  Field next;
  next.unit = field.unit;
  next.cells.resize(n);
  parallel_for(blocks, [&](uint32_t b) {
    Work work{structure, fields.rule, &fields, &field, &tallies, &options, {}};
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

// Blank strata.
void add_strata(Field& field, Structure structure) {
  const bool patches = structure != Structure::adaptive;
  const size_t root = field.nodes.size();
  field.nodes.resize(root + (patches ? 1 + zones : 1));
  for (size_t i = root; i < field.nodes.size(); ++i) quantise({}, first_of(structure, i == root), field.nodes[i]);
  if (patches)
    field.nodes[root].divided = uint16_t(0xffff << no_zones), field.nodes[root].children = uint32_t(root + 1);
  field.mean.resize(16 * field.nodes.size());
  field.weight.resize(16 * field.nodes.size());
}

// Copies a cell's strata from another, or makes blank ones.
void add_cell(Field& field, uint32_t from, Structure structure) {
  FieldCell cell;
  cell.root = uint32_t(field.nodes.size());
  if (from == none) {
    add_strata(field, structure);
  } else {
    const FieldCell& parent = field.cells[from];
    const uint32_t shift = cell.root - parent.root;
    std::vector<uint32_t> order = {parent.root};
    for (size_t k = 0; k < order.size(); ++k) {
      StrataNode node = field.nodes[order[k]];
      for (int i = 0; i < 16; ++i) {
        if (node.is_divided(i)) order.push_back(node.child(i));
        field.mean.push_back(field.mean[16 * size_t(order[k]) + size_t(i)]);
        field.weight.push_back(0.25f * field.weight[16 * size_t(order[k]) + size_t(i)]);
      }
      node.children += shift;
      field.nodes.push_back(node);
    }
    const uint32_t root = cell.root;
    cell = parent;
    cell.root = root;
  }
  field.cells.push_back(cell);
}

void add_cells(Fields& fields, const Sightings& sightings, const LearnOptions& options) {
  std::vector<std::pair<CellKey, Sighting>> sorted(sightings.begin(), sightings.end());
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [key, seen] : sorted) {
    if (bytes(fields) > options.memory) return;
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
  constexpr double strata = (1 + zones) * (sizeof(StrataNode) + 32 * sizeof(float));
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
      weight += field.weight[16 * size_t(order[k]) + size_t(i)] *= kept;
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
  if (options.lights) next.lights = learn_lights(tree, fields.lights, training.lights, rules);
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
