// The virtual point lights of a pass: light subpaths are traced, and of their vertices those are kept that the field W
// expects to bring something to the image, in proportion to how much (docs/method.md, "Virtual point lights").

#include "place.h"
#include "ajar/core/parallel.h"
#include "ajar/field/probes.h"
#include "ajar/join/pool.h"
#include "contribution.h"
#include "light.h"

namespace ajar {
namespace {

// What a group of light subpaths left.
struct Group {
  LightStore store;
  std::vector<bool> may_light;  // of the subpath at work: its last vertex, by how many there are
  std::vector<Splat> splats;
  uint64_t rejected_at = Scratch::no_path;  // its first
};

// What a light subpath whose last event but one was a delta brings to the lens: camera subpaths could not aim at it.
// Weights are against s = 0 and s = 1.
void join_lens(const Job& job, Sampler& sampler, uint32_t path, Scratch& scratch, std::vector<Splat>& splats) {
  const Subpath& light = scratch.light;
  if (light.n < 3 || !light[light.n - 2].delta || !connectable(light[light.n - 1].guide)) return;
  const Camera& camera = job.scene->camera;
  const Vec2 lens = camera.kind == CameraKind::thinlens ? sampler.next2() : Vec2(0);
  Candidate c;
  if (!join_camera(*job.scene, lens, light, light.n, c)) return;
  ++scratch.counters.shadow_rays;
  if (!is_unblocked(job, c.segment, 1)) return;
  const SampleCounts unjoined{.light_paths = job.walk.counts.light_paths, .inner = 0, .seen = 0};
  // The film takes as many light subpaths as it has pixels.
  c.value *= float(weight(job.walk.heuristic, c, unjoined) * pixels_of(camera) / unjoined.light_paths);
  if (accept(c.value, path, scratch)) splats.push_back({c.raster, c.value});
}

// Points of one sequence for either half of the image, numbered by passes and paths, so that the lights of a pass are
// evenly spread.
Sampler numbers_of(const Job& job, uint64_t stream, uint32_t pass, uint32_t path) {
  const uint32_t point = 2 * ((pass / 2) * job.vpls->paths + path) + pass % 2;
  return make_sampler(job.sampler, job.seed, Side::light, stream, point);
}

void trace_lights(const Job& job, Sampler sampler, uint32_t path, Scratch& scratch, Group& out) {
  Subpath& light = scratch.light;
  Walk walk;
  out.may_light.assign(2, false);
  if (start_light(*job.scene, job.walk, sampler, light, walk)) {
    ++scratch.counters.light_paths;
    Surface surface;
    while (follow_light(job, sampler, scratch, walk, surface)) {
      join_lens(job, sampler, path, scratch, out.splats);
      out.may_light.push_back(can_light(*job.scene, surface, light[light.n - 1].guide));
    }
  }
  const size_t before = scratch.traced.entries.size();
  add(scratch.traced, light);
  std::vector<LightStore::Entry>& entries = scratch.traced.entries;
  const auto is_none = [&](const LightStore::Entry& at) { return !out.may_light[size_t(at.s)] && !at.only_joined; };
  entries.erase(std::remove_if(entries.begin() + ptrdiff_t(before), entries.end(), is_none), entries.end());
}

// Lights that a guided pass keeps, about.
constexpr uint32_t kept_lights = 1024;

constexpr uint32_t grain = 16;  // light subpaths of a group

// What arrives there, whatever is made of it.
double flux_at(const LightStore& store, const LightStore::Entry& at) {
  return double(std::max(luminance(store.vertex(at).beta), 0.0f));
}

// What a light is taken to bring to the image.
double value_of(const Vpls& vpls, const LightStore& store, const LightStore::Entry& at) {
  return double(at.worth) + vpls.per_flux * flux_at(store, at);
}

// Keeps some lights of a group. Which depends on each light alone, and on a number of its own: as fields change from
// frame to frame, most stay.
void select_lights(const Job& job, uint32_t pass, uint32_t number, LightStore& store) {
  const Vpls& v = *job.vpls;
  const uint64_t key = hash(hash(job.seed, 0x6b657074), hash(pass, number));
  std::vector<LightStore::Entry> kept;
  for (LightStore::Entry& at : store.entries) {
    const double chance = std::min(value_of(v, store, at) / v.least, 1.0);  // (I2)
    if (!(double(hash(key, uint64_t(at.path) << 32 | uint32_t(at.s)) >> 11) * 0x1p-53 < chance)) continue;
    at.counts = float(1 / chance);
    kept.push_back(at);
  }
  store.entries = std::move(kept);
}

// Traces the light subpaths, and copies of their vertices those alone that are kept.
std::vector<Group> trace_groups(const Job& job, uint64_t stream, uint32_t pass, std::vector<Scratch>& scratches) {
  const uint32_t paths = job.vpls->paths;
  std::vector<Group> groups((paths + grain - 1) / grain);
  parallel_for(groups.size(), [&](size_t g) {
    Scratch& scratch = scratches[thread_slot()];
    Group& group = groups[g];
    clear(scratch.traced);
    scratch.rejected_at = Scratch::no_path, scratch.clock = 0;
    const uint32_t from = uint32_t(g) * grain, to = std::min(paths, from + grain);
    for (uint32_t i = from; i < to; ++i) trace_lights(job, numbers_of(job, stream, pass, i), i, scratch, group);
    if (job.vpls->least > 0) select_lights(job, pass, uint32_t(g), scratch.traced);
    append(group.store, scratch.traced);
    group.rejected_at = scratch.rejected_at;
  });
  return groups;
}

void put_in_order(const Scene& scene, LightStore& store) {
  std::vector<std::pair<uint64_t, LightStore::Entry>> keyed;
  for (const LightStore::Entry& at : store.entries)
    keyed.emplace_back(morton_key(store.vertex(at), scene.center, scene.radius), at);
  std::stable_sort(keyed.begin(), keyed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (size_t i = 0; i < keyed.size(); ++i) store.entries[i] = keyed[i].second;
}

// Lights per area here, of the side that has more where light goes through: joins come from either, and none that has a
// share of them (I1) may seem to bring nothing.
double most_density(const Job& job, const Vertex& v) {
  const double lit = density_of_lights(job, v.p, v.ng, v.guide.wo);
  return v.guide.bsdf.opaque ? lit : std::max(lit, density_of_lights(job, v.p, v.ng, -v.guide.wo));
}

// Finds out from light subpaths that are in no image how much a light must bring to be kept.
void measure_lights(const Job& job, std::vector<Scratch>& scratches) {
  Vpls& vpls = *job.vpls;
  constexpr uint64_t stream = 0x70696c6f74;
  const std::vector<Group> groups = trace_groups(job, stream, 0, scratches);
  double worth = 0, flux = 0;
  for (const Group& g : groups)
    for (const LightStore::Entry& at : g.store.entries) worth += double(at.worth), flux += flux_at(g.store, at);
  vpls.per_flux = flux > 0 ? by_flux * worth / flux : 0;
  std::vector<double> values;
  for (const Group& g : groups)
    for (const LightStore::Entry& at : g.store.entries) values.push_back(value_of(vpls, g.store, at));
  vpls.least = find_threshold(std::move(values), vpls.most);
}

// The tile with which a splat goes to the film: that of a pixel by lot. So of a pass that is not finished as large a
// share of the splats is in the image as of the pixels.
uint32_t chunk_of_splat(const Film& film, uint64_t key, size_t number) {
  const uint64_t pixel = hash(key, number) % film.pixels(), width = uint64_t(film.width);
  return uint32_t(pixel / width / tile) * uint32_t(tiles_x(film)) + uint32_t(pixel % width / tile);
}

// Traces the light subpaths of a pass and keeps its lights.
void trace_vpls(const Job& job, const Film& film, uint32_t pass, std::vector<Scratch>& scratches) {
  Vpls& vpls = *job.vpls;
  constexpr uint64_t stream = 0x76706c;
  const std::vector<Group> groups = trace_groups(job, stream, pass, scratches);
  clear(vpls.store);
  vpls.rejected_at = none;
  for (std::vector<Splat>& list : vpls.splats) list.clear();
  size_t splats = 0;
  const uint64_t key = hash(hash(job.seed, 0x5b1a7), pass);
  for (const Group& g : groups) {
    append(vpls.store, g.store);
    for (const Splat& s : g.splats) vpls.splats[chunk_of_splat(film, key, splats++)].push_back(s);
    if (vpls.rejected_at == none && g.rejected_at != Scratch::no_path) vpls.rejected_at = uint32_t(g.rejected_at);
  }
  put_in_order(*job.scene, vpls.store);
  for (LightStore::Entry& at : vpls.store.entries) {
    // No walk shares what is only joined.
    const auto per_light = [&] { return inv_pi / std::max(most_density(job, vpls.store.vertex(at)), 1e-30); };
    at.near = at.only_joined ? 0 : float(per_light());
  }
  lay_blocks(vpls.store);
}

// What was traced does not count: it is in no image, or was counted before.
void forget_counts(std::vector<Scratch>& scratches) {
  for (Scratch& s : scratches) s.counters = {}, s.rejected = 0;
}

}  // namespace

Vpls make_vpls(const Scene& scene, const Film& film, bool guided) {
  Vpls v;
  v.splats.resize(chunk_count(film));
  // Where nothing is learned: as if two vertices of each subpath were spread over all surfaces.
  v.even = 2 / std::max(area(scene), 1e-30);
  if (!guided) return v;
  // Where fields tell which of many light subpaths the image needs, there are many; else as few as all pixels can use.
  v.paths = uint32_t(std::clamp<size_t>(film.pixels() / 4, 256, 8192));
  v.most = kept_lights;
  v.joins = 12;
  return v;
}

bool can_light(const Scene& scene, const Surface& surface, const Guide& y) {
  constexpr float least_alpha = 0.11f;
  if (least_roughness(y.bsdf) < least_alpha) return false;
  if (y.bsdf.opaque) return true;
  Frame frame = surface.frame;
  Bsdf behind;
  resolve(scene, surface, -y.wo, frame, behind);
  return least_roughness(behind) >= least_alpha;
}

double density_of_lights(const Job& job, const Vec3& p, const Vec3& ng, const Vec3& w) {
  const Fields* fields = job.walk.fields;
  const Vpls& v = *job.vpls;
  if (!job.guided) return v.paths * v.even;
  const uint32_t cell = find(fields->table, p, facing(ng, w)).cell;
  if (cell == none) return 0;
  const FieldCell& importance = fields->w.cells[cell];
  const double traced = double(v.paths) * double(importance.visits);
  if (!(v.least > 0)) return traced;
  constexpr double grey = 0.5;  // not the vertex's own albedo: a share must not depend on where it is seen from
  const double brings = grey * inv_pi * double(importance.total - importance.direct);
  const double arrives = double(v.paths) * double(fields->q.cells[cell].total);
  return std::min(traced, arrives * std::max(brings, 0.0) / v.least);
}

void place_vpls(const Job& job, const Film& film, std::vector<Scratch>& scratches) {
  Vpls& vpls = *job.vpls;
  vpls.camera = job.walk;
  vpls.camera.fields = nullptr;
  const uint32_t pass = film.dropped + film.passes;
  if (!vpls.pass && job.guided) {
    measure_lights(job, scratches);
    forget_counts(scratches);
  }
  if (vpls.pass != pass) {
    trace_vpls(job, film, pass, scratches);
    if (film.chunks > 0) forget_counts(scratches), vpls.rejected_at = none;  // a pass that is gone on with
  }
  vpls.pass = pass;
}

}  // namespace ajar
