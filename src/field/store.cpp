#include "ajar/field/store.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "ajar/core/error.h"
#include "ajar/field/portals.h"
#include "ajar/scene/light.h"
#include "keys.h"

namespace ajar {
namespace {

constexpr FileKind fields_kind = {"AJARfd13", "file of fields", "make one with --save-fields",
                                  "learn the fields again with --save-fields"};

bool is_amount(float x) { return x >= 0 && x < infinity; }
bool is_cell_key(CellKey key) {
  return level_of(key) >= 0 && level_of(key) <= most_cell_levels && kind_of(key).normal < normal_bins;
}

// One list of members for both ways, one value each: structs may have gaps, whose bytes mean nothing.
template <class Io, class Part>
void frame_members(Io& io, Part& f) {
  io.value(f.s), io.value(f.t), io.value(f.n);
}
template <class Io, class Part>
void cell_members(Io& io, Part& c) {
  io.value(c.root), io.value(c.direct), io.value(c.total), io.value(c.mix), io.value(c.visits), io.value(c.near);
  io.value(c.portal), io.value(c.through), io.value(c.even);
}
template <class Io, class Part>
void tallies_members(Io& io, Part& t) {
  io.array(t.value), io.array(t.weight), io.array(t.direct), io.array(t.directs), io.array(t.visits);
  io.array(t.held), io.array(t.nearness), io.array(t.through), io.array(t.lines);
}
template <class Io, class Part>
void portal_members(Io& io, Part& p) {
  io.value(p.axis), io.value(p.wall), io.value(p.center), io.value(p.radius);
}
template <class Io, class Node>
void node_members(Io& io, Node& n) {
  io.bytes(n.before, 16 * sizeof(n.before[0]));  // the last is always 0
  io.value(n.divided), io.value(n.children);
}
static_assert(sizeof(FieldCell) == 32 && sizeof(StrataNode) == 40 && sizeof(Cell) == 64 && sizeof(Sighting) == 32 &&
                  sizeof(Probe) == 28 && sizeof(Portal) == 24,
              "a member was added or taken away: list it here and raise the versions of the files");

void write(Writer& w, const Field& f) {
  w.value(f.unit);
  for (const std::vector<FieldCell>* cells : {&f.cells, &f.portals})
    for (const FieldCell& c : *cells) cell_members(w, c);
  w.value(uint64_t(f.nodes.size()));
  for (const StrataNode& n : f.nodes) node_members(w, n);
  w.bytes(f.mean.data(), f.mean.size() * sizeof(UFloat16));
  w.bytes(f.weight.data(), f.weight.size() * sizeof(UFloat16));
}

// first: the first stratum in use.
bool is_sound(const StrataNode& n, int first) {
  for (int i = 0; i <= first; ++i)
    if (n.before[i] != 0) return false;
  for (int i = first; i < 15; ++i)
    if (n.before[i] >= n.before[i + 1]) return false;
  return true;
}

// Whether the nodes under root are zones and their segments, as patches are.
bool is_patches(const std::vector<StrataNode>& nodes, uint32_t root) {
  if (!is_sound(nodes[root], no_zones) || nodes[root].divided != uint16_t(0xffff << no_zones)) return false;
  for (int i = no_zones; i < 16; ++i) {
    const StrataNode& zone = nodes[nodes[root].child(i)];
    if (zone.divided != 0 || !is_sound(zone, no_segments)) return false;
  }
  return true;
}

// Whether the tree under root lies in the nodes as trees do, breadth first from its root, and shares nothing with those
// that were claimed before.
bool claim(const std::vector<StrataNode>& nodes, uint32_t root, std::vector<bool>& claimed) {
  size_t known = 1;  // nodes of the tree that were seen, at root and after it
  size_t level_end = 1;
  int level = 0;
  for (size_t k = 0; k < known; ++k) {
    if (k == level_end) level_end = known, ++level;
    const size_t at = root + k;
    if (level >= most_levels || at >= nodes.size() || claimed[at]) return false;
    claimed[at] = true;
    if (nodes[at].divided != 0 && nodes[at].children != root + known) return false;
    known += size_t(std::popcount(unsigned(nodes[at].divided)));
  }
  return true;
}

bool is_sound(const FieldCell& c, size_t portals) {
  return is_amount(c.direct) && is_amount(c.total) && c.mix >= 0 && c.mix < 1 && is_amount(c.visits) &&
         is_amount(c.near) && (c.portal == FieldCell::no_portal || c.portal < portals) && c.through >= 0 &&
         c.through <= 1 && c.even <= 1;
}

// portals: of the table.
void read(Reader& r, Structure structure, size_t cells, size_t portals, Field& f) {
  r.value(f.unit);
  r.require(f.unit > 0 && f.unit < double(infinity));
  f.cells.resize(cells), f.portals.resize(2 * portals);
  for (std::vector<FieldCell>* list : {&f.cells, &f.portals})
    for (FieldCell& c : *list) {
      cell_members(r, c);
      r.require(is_sound(c, portals));
    }
  f.nodes.resize(r.count(sizeof(StrataNode) - 2 + 32 * sizeof(UFloat16)));
  for (StrataNode& n : f.nodes) {
    node_members(r, n);
    r.require(structure != Structure::adaptive || is_sound(n, 0));
  }
  f.mean.resize(16 * f.nodes.size());
  f.weight.resize(16 * f.nodes.size());
  r.bytes(f.mean.data(), f.mean.size() * sizeof(UFloat16));
  r.bytes(f.weight.data(), f.weight.size() * sizeof(UFloat16));
  r.require(std::all_of(f.mean.begin(), f.mean.end(), is_amount) &&
            std::all_of(f.weight.begin(), f.weight.end(), is_amount));
  std::vector<bool> claimed(f.nodes.size());
  for (const FieldCell& c : f.cells)
    r.require(claim(f.nodes, c.root, claimed) && (structure == Structure::adaptive || is_patches(f.nodes, c.root)));
  for (const FieldCell& c : f.portals) r.require(claim(f.nodes, c.root, claimed));
}

// regions: of the fields. Joins that are free are among those that were tried.
void read(Reader& r, uint32_t regions, Views& v) {
  r.value(v.regions);
  r.array(v.tried), r.array(v.seen);
  const size_t size = pair_count(v.regions);
  r.require(v.regions <= std::min(regions, most_regions) && v.tried.size() == size && v.seen.size() == size);
  for (size_t i = 0; i < size; ++i) r.require(is_amount(v.tried[i]) && v.seen[i] >= 0 && v.seen[i] <= v.tried[i]);
  v = learn_views(v, start_tallies(v), v.regions, 1);
}

template <class Io, class Part>
void cut_members(Io& io, Part& c) {
  io.value(c.first), io.value(c.count), io.value(c.asks), io.value(c.plain);
}

void write(Writer& w, const LearnedLights& v) {
  w.value(v.unit);
  w.value(uint64_t(v.cuts.size()));
  for (const LightCut& c : v.cuts) cut_members(w, c);
  w.value(uint64_t(v.entries.size()));
  for (const LightEntry& e : v.entries) w.value(e.node), w.value(e.first), w.value(e.weight), w.value(e.before);
  for (const LightEvidence& e : v.evidence) w.value(e.square), w.value(e.hits), w.value(e.tried);
}

// Whether the cuts are those of the scene's tree is for fits to say. cells: cuts, if there are any; most: of entries.
void read(Reader& r, size_t cells, uint32_t most, LearnedLights& v) {
  r.value(v.unit);
  r.require(v.unit > 0 && v.unit < double(infinity));
  v.cuts.resize(r.count(16));
  r.require(v.cuts.empty() || v.cuts.size() == cells);
  uint32_t next = 0;
  for (LightCut& c : v.cuts) {
    cut_members(r, c);
    r.require(c.first == next && c.count > 0 && c.count <= most && c.asks > 0 && c.asks <= 1 && c.plain <= 1);
    next += c.count;
  }
  v.entries.resize(r.count(28));
  v.evidence.resize(v.entries.size());
  r.require(v.entries.size() == next);
  for (LightEntry& e : v.entries) {
    r.value(e.node), r.value(e.first), r.value(e.weight), r.value(e.before);
    r.require(e.weight > 0 && e.weight < infinity);
  }
  for (LightEvidence& e : v.evidence) {
    r.value(e.square), r.value(e.hits), r.value(e.tried);
    r.require(is_amount(e.square) && is_amount(e.hits) && is_amount(e.tried));
  }
  for (const LightCut& c : v.cuts) {
    r.require(v.entries[c.first].before == 0);
    for (uint32_t i = c.first + 1; i < c.first + c.count; ++i)
      r.require(v.entries[i].before >= v.entries[i - 1].before && v.entries[i].before <= 1);
  }
}

void read(Reader& r, const LearnedLights& v, LightTallies& t) {
  r.array(t.square), r.array(t.hits), r.array(t.tried);
  r.require(fits(t, v));
}

bool is_sound(const Frame& f) {
  const auto unit = [](const Vec3& v) { return std::abs(glm::dot(v, v) - 1) < 1e-3f; };
  const auto apart = [](const Vec3& a, const Vec3& b) { return std::abs(glm::dot(a, b)) < 1e-3f; };
  return unit(f.s) && unit(f.t) && unit(f.n) && apart(f.s, f.t) && apart(f.t, f.n) && apart(f.n, f.s);
}

void read(Reader& r, const Field& f, Tallies& t) {
  tallies_members(r, t);
  r.require(fits(t, f));
}

template <class T>
uint64_t sum_of(const std::vector<T>& v, uint64_t sum) {
  return checksum(v.data(), v.size() * sizeof(T), sum);
}

void read_probes(Reader& r, CellTable& table) {
  table.probes.resize(r.count(sizeof(Probe)));
  for (Probe& p : table.probes) {
    r.value(p.p), r.value(p.n), r.value(p.axis);
    r.require(is_finite(p.p) && is_finite(p.n) && p.axis < 3);
  }
}

void read_portals(Reader& r, CellTable& table, std::vector<double>& lines) {
  table.portals.resize(r.count(sizeof(Portal)));
  r.require(table.portals.size() <= most_portals);
  for (Portal& p : table.portals) {
    portal_members(r, p);
    r.require(p.axis >= 0 && p.axis < 3 && std::isfinite(p.wall) && is_finite(p.center) && p.radius > 0 &&
              p.radius < infinity);
  }
  r.array(lines);
  r.require(lines.size() == line_sums * table.portals.size() &&
            std::all_of(lines.begin(), lines.end(), [](double x) { return std::isfinite(x); }));
}

// Cuts lead to later cuts or to compartments that a key has room for, so that every way through them ends.
void read_compartments(Reader& r, CellTable& table) {
  r.array(table.cuts), r.array(table.compartments);
  const auto leads_on = [&](int32_t to, int32_t from) {
    return to >= 0 ? to > from && size_t(to) < table.cuts.size() : ~to < most_compartments;
  };
  r.require(table.compartments.empty() ? table.cuts.empty() : table.compartments.size() == all_top_cubes);
  for (const int32_t c : table.compartments) r.require(leads_on(c, -1));
  for (size_t i = 0; i < table.cuts.size(); ++i) {
    const CellCut& c = table.cuts[i];
    r.require(std::isfinite(c.at) && c.axis >= 0 && c.axis < 3 && leads_on(c.below, int32_t(i)) &&
              leads_on(c.above, int32_t(i)));
  }
}

// The table is filled with them, and their marks set that they are divided.
void read_cells(Reader& r, Fields& fields) {
  fields.cells.resize(r.count(sizeof(CellKey)));
  for (uint32_t i = 0; i < fields.cells.size(); ++i) {
    Cell& c = fields.cells[i];
    char divided = 0;
    r.value(c.key), r.value(divided), frame_members(r, c.frame), r.value(c.seen), r.value(c.region);
    r.require(is_cell_key(c.key) && cell_of(fields.table, c.key) == none && is_sound(c.frame) && is_amount(c.seen) &&
              c.region < most_regions);
    c.center = middle_of(fields.table, c.key);
    r.require(is_finite(c.center));
    insert(fields.table, c.key, i);
    if (divided) set_divided(fields.table, c.key);
  }
  if (fields.structure == Structure::adaptive) shorten(fields.table);
}

}  // namespace

void write(Writer& w, const Fields& fields) {
  w.value(fields.structure), w.value(fields.rule);
  w.value(fields.generation), w.value(fields.table.origin), w.value(fields.table.width), w.value(fields.table.first);
  w.value(uint64_t(fields.table.probes.size()));
  for (const Probe& p : fields.table.probes) w.value(p.p), w.value(p.n), w.value(p.axis);
  w.array(fields.table.cuts), w.array(fields.table.compartments);
  w.value(uint64_t(fields.table.portals.size()));
  for (const Portal& p : fields.table.portals) portal_members(w, p);
  w.array(fields.lines);
  // The table's divided marks go with the cells; the table itself is made anew.
  std::vector<char> divided(fields.cells.size());
  for (const CellTable::Slot& s : fields.table.slots)
    if (s.key != 0) divided[s.at.cell] = s.at.parts != 0;
  w.value(uint64_t(fields.cells.size()));
  for (size_t i = 0; i < fields.cells.size(); ++i) {
    const Cell& c = fields.cells[i];
    w.value(c.key), w.value(divided[i]), frame_members(w, c.frame), w.value(c.seen), w.value(c.region);
  }
  write(w, fields.q);
  write(w, fields.w);
  w.value(fields.regions), w.value(fields.views.regions);
  w.array(fields.views.tried), w.array(fields.views.seen);
  write(w, fields.lights), write(w, fields.starts);
  w.value(uint64_t(fields.disk.cells.size()));
  write(w, fields.disk);
}

void read(Reader& r, Fields& fields) {
  fields.table = make_cell_table(Vec3(0), 1);
  r.value(fields.structure), r.value(fields.rule);
  r.require(fields.structure <= Structure::probes && fields.rule <= Rule::returned);
  r.value(fields.generation), r.value(fields.table.origin), r.value(fields.table.width), r.value(fields.table.first);
  r.require(is_finite(fields.table.origin) && is_amount(fields.table.width) &&
            is_amount(float(1 << most_cell_levels) / fields.table.width));
  read_probes(r, fields.table);
  read_compartments(r, fields.table);
  read_portals(r, fields.table, fields.lines);
  r.require(fields.structure == Structure::adaptive || fields.table.portals.empty());
  read_cells(r, fields);
  const size_t portals = fields.table.portals.size();
  read(r, fields.structure, fields.cells.size(), portals, fields.q);
  read(r, fields.structure, fields.cells.size(), portals, fields.w);
  r.value(fields.regions);
  read(r, fields.regions, fields.views);
  read(r, fields.cells.size(), LightRules{}.most, fields.lights);
  read(r, 1, most_starts, fields.starts);
  const size_t disks = r.count(sizeof(FieldCell));
  r.require(disks <= most_regions_of_sky);
  read(r, Structure::adaptive, disks, 0, fields.disk);
}

void write(Writer& w, const Training& training) {
  tallies_members(w, training.q), tallies_members(w, training.w);
  w.array(training.views.counts);
  for (const LightTallies* t : {&training.lights, &training.starts})
    w.array(t->square), w.array(t->hits), w.array(t->tried);
  tallies_members(w, training.disk);
}

void read(Reader& r, const Fields& fields, Training& training) {
  read(r, fields.q, training.q);
  read(r, fields.w, training.w);
  r.array(training.views.counts);
  r.require(training.views.counts.size() == start_tallies(fields.views).counts.size());
  read(r, fields.lights, training.lights);
  read(r, fields.starts, training.starts);
  read(r, fields.disk, training.disk);
}

void write(Writer& w, const Sightings& sightings) {
  std::vector<std::pair<CellKey, Sighting>> sorted(sightings.begin(), sightings.end());
  std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  w.value(uint64_t(sorted.size()));
  for (const auto& [key, seen] : sorted) w.value(key), w.value(seen.count), w.value(seen.normal);
}

void read(Reader& r, Sightings& sightings) {
  sightings.clear();
  for (size_t n = r.count(sizeof(CellKey) + sizeof(Sighting)); n > 0; --n) {
    CellKey key = 0;
    Sighting seen;
    r.value(key), r.value(seen.count), r.value(seen.normal);
    r.require(is_cell_key(key) && sightings.emplace(key, seen).second);
  }
}

std::string scene_key(const Scene& scene) {
  uint64_t triangles = 0, sum = 0;
  for (const Mesh& m : scene.meshes)
    triangles += m.triangles.size(), sum = sum_of(m.triangles, sum_of(m.positions, sum));
  for (const Shape& s : scene.shapes) {
    const uint32_t words[] = {uint32_t(s.kind), s.mesh, s.light, s.group, uint32_t(s.flip)};
    sum = checksum(words, sizeof words, checksum(&s.to_world, sizeof s.to_world, sum));
  }
  for (const Instance& i : scene.instances)
    sum = checksum(&i.group, sizeof i.group, checksum(&i.to_world, sizeof i.to_world, sum));
  double watts = 0;
  for (uint32_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const double one = power(scene, i);
    sum = checksum(&one, sizeof one, checksum(&light.kind, sizeof light.kind, sum));
    sum = checksum(&light.to_world, sizeof light.to_world, sum);
    sum = checksum(&light.position, sizeof light.position, sum);
    sum = checksum(&light.direction, sizeof light.direction, sum);
    const float shape[] = {light.sampling_weight, light.cone, light.cutoff, light.beam, light.plane.x, light.plane.y};
    sum = checksum(shape, sizeof shape, sum);
    watts += one;
  }
  return fmt::format(
      "{} triangles, {} shapes, {} lights of {:.6g} W, radius {:.6g} about ({:.6g}, {:.6g}, {:.6g}), {:016x}",
      triangles, scene.shapes.size(), scene.lights.size(), watts, scene.radius, scene.center.x, scene.center.y,
      scene.center.z, sum);
}

void save_fields(const std::string& path, const StoredFields& stored) {
  write_file(path, fields_kind, [&](Writer& w) {
    w.key(stored.scene);
    w.value(stored.passes);
    write(w, stored.fields);
  });
}

StoredFields load_fields(const std::string& path, const std::string& key) {
  Reader r(path, fields_kind);
  StoredFields stored;
  r.key(stored.scene);
  r.value(stored.passes);
  if (!key.empty() && stored.scene != key)
    throw Error(fmt::format("{}: fields of another scene ({}); this one has {}; learn its own with --save-fields", path,
                            stored.scene, key));
  read(r, stored.fields);
  r.finish();
  return stored;
}

}  // namespace ajar
