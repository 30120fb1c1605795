// Instant radiosity (Keller 1997) with guided light vertices: those of a pass are virtual point lights for all pixels.
// A camera subpath joins some of them where it can, and goes on only as often as joins are too bright to be trusted:
// what other renderers clamp away is so found by a short walk, and the image is unbiased given the fields
// (docs/method.md, "Virtual point lights").

#include "contribution.h"
#include "integrators.h"
#include "place.h"

namespace ajar {
namespace {

void add(Work& work, const Candidate& c, float weight, int s, int t) {
  add_to_pixel(work.sample, work.scratch, s, t, c.value, c.value * weight);
}

// Whether a path of n camera vertices comes to what the lens sees by way of a delta event, at which only light subpaths
// can aim.
bool is_caustic(const Subpath& camera, int n) {
  return n > 3 && !camera[1].delta && camera[2].delta && connectable(camera[1].guide);
}

// Hits and next-event estimation alone.
constexpr SampleCounts unjoined{.light_paths = 0, .inner = 0, .seen = 0};

// Of hits and next-event estimation among each other, and of what only light subpaths can aim at: nothing else finds
// what they find.
float weigh_unjoined(const Work& work, Candidate& c) {
  if (!is_caustic(work.scratch.camera, c.camera.n)) c.camera.sum_before = 0;
  return float(weight(work.job.walk.heuristic, c, unjoined));
}

// The same of a path that is joined further up: what is left to all that joins and walks share.
float share_of_camera(const Work& work, Candidate& c) {
  if (!is_caustic(work.scratch.camera, c.camera.n)) return 1;
  return float(mis_of_camera(work.job.walk.heuristic, c.light, c.camera, c.nee, unjoined));  // (I3)
}

bool is_free(Work& work, Candidate& c, int s, int t) {
  if (!is_unblocked(work.job, c.segment, s, t, work.scratch)) return false;
  complete(c);
  return true;
}

// The share of a path that joins have whose edge is x - y, of all that could find it: the rest is for the walk from x
// to y. Of the edge alone, so that both ways say the same. walked: area density of y as the walk from x finds it.
double share_of_joins(const Job& job, const Vec3& y, const Vec3& ng, const Vec3& to_x, double walked) {
  const double lights = density_of_lights(job, y, ng, to_x);
  return lights > 0 ? lights / (lights + walked) : 0;  // (I1)
}

double share_at(const Job& job, const LightStore::Entry& at, const Vec3& x, double walked) {
  const Vertex& y = job.vpls->store.vertex(at);
  return at.only_joined ? 1 : share_of_joins(job, y.p, y.ng, x - y.p, walked);
}

// Whether the walk is to find what its last vertex y scatters, which joins at the one before could have found as well.
// What passes y by a delta event they could not.
bool is_walked(Work& work, const Surface& surface) {
  const Subpath& camera = work.scratch.camera;
  const Vertex &x = camera[camera.n - 2], &y = camera[camera.n - 1];
  if (camera.n < 3 || x.delta || !connectable(x.guide) || !connectable(y.guide)) return true;
  const double share =
      can_light(*work.job.scene, surface, y.guide) ? share_of_joins(work.job, y.p, y.ng, y.guide.wo, y.own) : 0;
  return work.scratch.numbers.next1() >= share;
}

// Whether a delta event at the last vertex would make a caustic, where other events take part of the choice.
bool may_be_caustic(const Subpath& camera) {
  return camera.n == 3 && !camera[1].delta && connectable(camera[1].guide) && camera[2].guide.bsdf.has_delta &&
         connectable(camera[2].guide);
}

// What camera subpaths know of W: only how light subpaths, which it guides, would have found a caustic. At the delta
// event itself, that they take it less often than the bsdf would.
void guide_way_back(const Job& job, const Surface& surface, Subpath& camera) {
  if (!job.guided || !(is_caustic(camera, camera.n) || may_be_caustic(camera))) return;
  Guide& guide = camera[camera.n - 1].guide;
  Guide guided;
  make_guide(*job.scene, job.walk.fields, Side::camera, surface, guide.wo, guided);
  guide.back = guided.back, guide.far_cell = guided.far_cell;
}

// Camera subpaths are not guided, but ask the fields which lamps to look for (V3) and which regions see each other:
// both go by the cell alone.
void find_cell(const Job& job, Vertex& v) {
  if (!job.guided || !connectable(v.guide)) return;
  v.guide.fields = job.walk.fields;
  v.guide.cell = find(v.guide.fields->table, v.p, facing(v.ng, v.guide.wo)).cell;
}

void join_lights(Work& work, const Surface& surface) {
  const Job& job = work.job;
  const Subpath& camera = work.scratch.camera;
  Candidate c;
  if (job.scene->shapes[surface.shape].light == none) return;
  if (join_hit(*job.scene, job.walk.fields, camera, surface, c)) add(work, c, weigh_unjoined(work, c), 0, camera.n);
  charge_join(work.scratch, 0, camera.n);
}

void join_next_event(Work& work) {
  const Job& job = work.job;
  const Subpath& camera = work.scratch.camera;
  const Vertex& v = camera[camera.n - 1];
  Candidate c;
  LightChances chances;
  LightNumbers u;
  if (job.scene->lights.empty()) return;
  if (draw_light(*job.scene, v.guide, work.scratch.numbers, u) &&
      join_light(*job.scene, job.walk.fields, camera, camera.n, chances, u, c) && is_free(work, c, 1, camera.n))
    add(work, c, weigh_unjoined(work, c), 1, camera.n);
  charge_join(work.scratch, 1, camera.n);
}

constexpr int further_joins = 8;  // at all but the first surface

void join_vpls(Work& work) {
  const Job& job = work.job;
  Scratch& scratch = work.scratch;
  const Subpath& camera = scratch.camera;
  const LightStore& store = job.vpls->store;
  const Vertex& x = camera[camera.n - 1];
  Visibility* const visibility = !job.guided && x.seen ? &scratch.visibility : nullptr;  // near others of the tile
  Prospect known{visibility};
  if (job.guided) known.views = &job.walk.fields->views, known.region = region_of(x.guide);
  expect_all(store, x, job.walk.max_edges + 1 - camera.n, known, scratch.expected);
  const int joins = camera.n > 2 ? further_joins : job.vpls->joins;
  const uint32_t key = uint32_t(work.scratch.numbers.next1() * 0x1p32f);
  choose_some(store, scratch.expected, joins, key, scratch.choices);
  for (const StoreChoice& choice : scratch.choices) {
    const LightStore::Entry& at = store.entries[choice.entry];
    Between between;
    const bool seen =
        look_between(store.vertex(at), x, between) && is_unblocked(job, between.segment, at.s, camera.n, scratch);
    if (visibility) learn(*visibility, choice.entry, seen);
    if (Candidate c; seen && join_vertices(store.end(at), camera.first(camera.n), between, c)) {
      complete(c);
      const double share = share_at(job, at, camera[camera.n - 1].p, c.light.other);
      c.value *= choice.weight;
      add(work, c, float(share) * share_of_camera(work, c), at.s, camera.n);
    }
    charge_join(scratch, at.s, camera.n);
  }
}

// A surface that scatters by delta events alone.
bool is_clear(const Vertex& v) { return !connectable(v.guide); }

// Follows the camera subpath, and joins what can be joined on the way. Stops at the first surface if that is to be
// followed several times.
void walk_on(Work& work, Walk& walk) {
  const Job& job = work.job;
  Scratch& scratch = work.scratch;
  Subpath& camera = scratch.camera;
  Surface surface;
  bool walked = true;
  do {
    ++scratch.counters.camera_rays;
    const bool hit = step(*job.scene, *job.accel, job.vpls->camera, camera, walk, surface);
    charge(scratch, &Ledger::camera_ticks);
    if (!hit) {
      Candidate c;
      for (const uint32_t light : job.scene->infinite_lights)
        if (join_escape(*job.scene, job.walk.fields, light, camera, walk, c))
          add(work, c, weigh_unjoined(work, c), 0, camera.n + 1);
      charge_join(scratch, 0, camera.n + 1);
      return;
    }
    guide_way_back(job, surface, camera);
    find_cell(job, camera[camera.n - 1]);
    join_lights(work, surface);
    if (camera.n == 2 && is_clear(camera[1])) return;
    walked = is_walked(work, surface);
    if (!walked || camera.n > job.walk.max_edges || !connectable(camera[camera.n - 1].guide)) continue;
    join_next_event(work);
    join_vpls(work);
  } while (camera.n <= job.walk.max_edges && scatter(job.vpls->camera, scratch.numbers, camera, walk) &&
           (walked || camera[camera.n - 1].delta));
  charge(scratch, &Ledger::camera_ticks);
}

// So often camera subpaths are followed from a glass or mirror that the lens sees: what they find by chance is bright.
constexpr int clear_branches = 8;

}  // namespace

void trace_vpl(const Job& job, Sample& sample, Scratch& scratch) {
  Work work{job, sample, scratch};
  Subpath& camera = scratch.camera;
  Walk walk;
  start_camera(*job.scene, sample.raster, sample.lens, camera, walk);
  walk_on(work, walk);
  if (camera.n != 2 || !is_clear(camera[1]) || job.walk.max_edges < 2) return;
  camera[1].beta /= float(clear_branches);
  for (int i = 0; i < clear_branches; ++i) {
    camera.n = 2;
    Walk branch = walk;
    if (scatter(job.vpls->camera, scratch.numbers, camera, branch)) walk_on(work, branch);
  }
}

}  // namespace ajar
