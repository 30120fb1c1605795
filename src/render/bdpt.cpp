// Bidirectional path tracing (Veach 1997, chapter 10): all strategies (s, t) with t >= 1, joined by multiple importance
// sampling. Without light paths (WalkOptions) it is path tracing that keeps its vertices, and can teach: s = 0 and s
// = 1.

#include "bdpt.h"
#include "ajar/path/arrival.h"
#include "integrators.h"
#include "merge.h"

namespace ajar {
namespace {

// Joins for a pixel's whole light, where the lens sees the vertex and beyond, and blocks of lights that they choose
// from there: at the full effort (J3). Rays to lights (J4).
constexpr float seen_joins = 12, inner_joins = 3, most_blocks = 32, seen_next_events = 5, inner_next_events = 1.5f;

// Radiance that the camera subpath, at the first vertex that can be joined, expects its pixel to have.
float expected_pixel(const Fields* fields, const Vertex& v) {
  const bool known = fields && is_known(v.guide) && arrival(fields->q, v.guide).all > 0;
  return known ? luminance(v.beta) * expected_radiance(*fields, v.guide, 0.002f) : 0;
}

// Which light the vertex asked for, with one ray of count, and what it got from it: nothing where something is in the
// way.
void teach_light(const Work& work, const Vertex& v, LightChances& chances, const Candidate& c, bool lit, int count) {
  const Job& job = work.job;
  record_next_event(*job.scene, v.guide, chances, *job.training, c.point, lit ? max_component(c.arrives) : 0);
  if (lit && job.guided && c.point.infinite)
    record_start(*job.scene, *job.walk.fields, *job.training, c.point, c.light_found.w,
                 {&v.guide, c.light.own * c.nee.ratio}, 1, count);
  charge(work.scratch, &Ledger::learn_ticks);
}

// s = 0: the camera subpath ran into a light.
void join_surface(Work& work, const Surface& surface) {
  const Job& job = work.job;
  Subpath& camera = work.scratch.camera;
  Candidate c;
  if (job.scene->shapes[surface.shape].light == none) return;
  if (join_hit(*job.scene, job.walk.fields, camera, surface, c)) {
    add(work, c, 0, camera.n);
    if (work.sample.teaches) camera[camera.n - 1].emitted = luminance(c.arrives) * weigh(work, c);
  }
  charge_join(work.scratch, 0, camera.n);
}

// Share of the light of a next-event estimation that hitting the lamp would not have brought better: the other share is
// learned from rays that do hit it. Without it Q would hold large lamps twice, and, near them, the infinite variance of
// points on a lamp.
float share_of_next_event(const Work& work, const Candidate& c) {
  if (c.light.sum_before == 0) return 1;  // cannot be hit
  const double nee = c.light.own * c.nee.ratio * c.nee.rays;
  return weight_against(work.job.walk.heuristic, nee, c.light.other);
}

// What the camera subpath's last vertex makes of irradiance, relative to what its pixel is expected to be; 0: fields do
// not know.
float worth_of(Work& work, const Vertex& v) {
  if (!work.pixel) work.pixel = expected_pixel(work.job.walk.fields, v);
  return *work.pixel > 0 ? luminance(v.beta) * scatters(v.guide) / *work.pixel : 0;
}

// Of such a light all rays would be one.
bool is_one_point(const Scene& scene) { return scene.lights.size() == 1 && has_no_extent(scene.lights[0].kind); }

// Rays to lights: the more, the more of the pixel's light is expected of them. Behind the first vertex that the lens
// sees they all hang on the one walk that came there.
uint8_t next_events(const Work& work, const Vertex& v, float worth) {
  if (!(worth > 0) || !is_known(v.guide) || is_one_point(*work.job.scene)) return 1;
  const float brings = worth * arrival(work.job.walk.fields->q, v.guide).direct;
  const float most = v.seen ? seen_next_events : inner_next_events;
  return brings > 0 ? uint8_t(std::clamp(most * std::sqrt(brings), 1.0f, 16.0f)) : uint8_t(1);  // (J4)
}

// s = 1: next-event estimation.
void join_next_event(Work& work, float worth) {
  const Job& job = work.job;
  Subpath& camera = work.scratch.camera;
  const int t = camera.n;
  Vertex& v = camera[t - 1];
  if (!job.next_event || job.scene->lights.empty()) return;
  v.next_events = next_events(work, v, worth);
  LightNumbers first;
  const int count = draw_light(*job.scene, v.guide, work.scratch.numbers, first) ? v.next_events : 0;
  LightChances chances;
  Received received;
  for (int i = 0; i < count; ++i) {
    Candidate c;
    const LightNumbers u = spread(first, i, count);
    const bool found = join_light(*job.scene, job.walk.fields, camera, t, chances, u, c);
    c.value /= float(count);
    const bool lit = found && add_if_visible(work, c, 1, t);
    charge_join(work.scratch, 1, t);
    if (!work.sample.teaches) continue;
    if (lit) add(received, v.guide, c, share_of_next_event(work, c));
    teach_light(work, v, chances, c, lit, count);
  }
  if (!work.sample.teaches) return;
  const float rays = float(std::max(count, 1));
  teach_direct(work, v, {received.near / rays, received.far / rays});
  if (!job.guided) record_place(v.guide, v.ng, *job.training, work.scratch.sightings);
}

// Share of the pixel's light that joins could bring the vertex: all that is not next-event estimation's.
float left_to_joins(const Fields& fields, const Guide& guide, float worth) {
  const Arrival arrives = arrival(fields.q, guide);
  return worth * std::max(arrives.all - arrives.direct, 0.0f);
}

Joiner joiner_of(const Job& job, const Subpath& camera, float worth) {
  const Vertex& v = camera[camera.n - 1];
  Joiner j{&v, job.walk.max_edges + 1 - camera.n, worth};
  j.counts = join_count(job.walk.counts, v.seen);
  j.onwards = job.walk.counts.inner;
  j.before = count_before(job.walk, camera);
  j.joins = (v.seen ? seen_joins : inner_joins) * job.effort;
  if (!v.seen || !(worth > 0) || !is_known(v.guide)) return j;
  const float share = std::min(left_to_joins(*job.walk.fields, v.guide, worth), 1.0f);
  j.blocks = uint32_t(job.effort * most_blocks * std::sqrt(share) + 0.5f);  // (J9)
  return j;
}

// Vertices that were chosen lie all over the pool: memory is asked for them at once, up to the first lobe.
void ask_for(const LightStore& store, const std::vector<StoreChoice>& choices) {
  for (const StoreChoice& choice : choices) {
    const char* const at = reinterpret_cast<const char*>(&store.vertex(store.entries[choice.entry]));
    for (size_t i = 0; i < offsetof(Vertex, guide.bsdf.lobes[1]); i += 64) __builtin_prefetch(at + i);
  }
}

// The camera subpath's last vertex and a light vertex that it sees.
void add_join(Work& work, const LightEnd& light, const Between& between, float counts) {
  const Subpath& camera = work.scratch.camera;
  Candidate c;
  if (!join_vertices(light, camera.first(camera.n), between, c)) return;
  c.value *= counts;
  add(work, c, light.s, camera.n);
}

// s >= 2: some of the light vertices of many chunks.
void join_stored(Work& work, float worth) {
  const Job& job = work.job;
  const LightStore& store = *work.scratch.pool;
  const Subpath& camera = work.scratch.camera;
  const Vertex& v = camera[camera.n - 1];
  std::vector<StoreChoice>& choices = work.scratch.choices;
  choose(store, joiner_of(job, camera, worth), work.scratch.numbers, work.scratch.expected, choices);
  ask_for(store, choices);
  for (const StoreChoice& choice : choices) {
    const LightStore::Entry& at = store.entries[choice.entry];
    Between between;
    if (look_between(store.vertex(at), v, between)) {
      const bool seen = is_unblocked(job, between.segment, at.s, camera.n, work.scratch);
      if (seen) add_join(work, store.end(at), between, choice.weight);
      if (work.sample.teaches)
        record_join(job.walk.fields->views, job.training->views, region_of(v.guide), at.region, seen);
    }
    charge_join(work.scratch, at.s, camera.n);
  }
}

// What the sample has brought its pixel so far.
float brought(const Work& work) { return luminance(work.sample.value) * work.sample.weight; }

// Rays of camera subpaths and joins, so far.
uint64_t work_of(const Counters& n) { return n.camera_rays + n.joins; }

// What a sample had brought and cost when its first vertex was joined.
struct First {
  bool known = false;
  float brought = 0;
  uint64_t work = 0;
};

void note_first(const Work& work, First& first) {
  if (!work.job.beyond || first.known || !work.pixel) return;
  first = {true, brought(work), work_of(work.scratch.counters)};
}

void note_beyond(const Work& work, const First& first, const Walk& walk) {
  if (!first.known || walk.sure) return;
  work.scratch.counters.beyond += work_of(work.scratch.counters) - first.work;
  if (work.sample.number > 0) return;
  const float more = (brought(work) - first.brought) * std::sqrt(float(work.sample.count));
  Beyond& found = work.job.beyond[work.sample.path];
  found.sum += more, found.square += sqr(more);
}

// What teaches goes on, and takes its numbers.
bool survives_roulette(Work& work, Walk& walk) {
  Sampler& numbers = work.scratch.numbers;
  if (!work.sample.teaches) return is_worth_it(work.job.walk, numbers, work.scratch.camera, walk);
  numbers.skip();
  return true;
}

// All joins at the camera subpath's last vertex.
void join_all(Work& work) {
  const Job& job = work.job;
  const Subpath& camera = work.scratch.camera;
  const Subpath& light = work.scratch.light;
  const int t = camera.n;
  if (t > job.walk.max_edges || !connectable(camera[t - 1].guide)) return;
  const float worth = worth_of(work, camera[t - 1]);
  join_next_event(work, worth);
  if (job.photons) join_merged(job, work.sample, work.scratch);
  if (work.scratch.pool) return join_stored(work, worth);
  const int most = std::min(light.n, job.walk.max_edges + 1 - t);
  for (int s = 2; s <= most; ++s)
    if (connectable(light[s - 1].guide)) {
      if (Between between;
          look_between(light[s - 1], camera[t - 1], between) && is_unblocked(job, between.segment, s, t, work.scratch))
        add_join(work, light_end(light, s), between, 1);
      charge_join(work.scratch, s, t);
    }
}

// A light subpath would have come the same way, straight through panes, to the last vertex that scatters: next-event
// estimation does not go through them.
void teach_escape(const Work& work, const Walk& walk, uint32_t light) {
  const Job& job = work.job;
  const Subpath& camera = work.scratch.camera;
  int i = camera.n - 1;
  while (i > 1 && camera[i].delta && !connectable(camera[i].guide)) --i;
  if (i < 1 || i + 1 >= camera.n || !connectable(camera[i].guide)) return;
  const Vertex &from = camera[i], &pane = camera[i + 1];
  const Vec3 d = -pane.guide.wo;
  if (from.delta || !(glm::dot(d, walk.d) > straight_on)) return;
  const double pdf = pane.own * pane.distance2 / std::abs(glm::dot(pane.ng, d));
  LightPoint point = light_point(*job.scene, light, walk.d);
  point.p = from.p;
  record_start(*job.scene, *job.walk.fields, *job.training, point, walk.d, {&from.guide, pdf},
               luminance(walk.beta) / luminance(pane.beta), 1);
}

// s = 0: the camera subpath left the scene.
void join_escapes(Work& work, const Walk& walk) {
  Subpath& camera = work.scratch.camera;
  Candidate c;
  float found = 0;
  for (const uint32_t light : work.job.scene->infinite_lights)
    if (join_escape(*work.job.scene, work.job.walk.fields, light, camera, walk, c)) {
      add(work, c, 0, camera.n + 1);
      if (!work.sample.teaches) continue;
      found += luminance(c.arrives) * weigh(work, c);
      if (work.job.guided) teach_escape(work, walk, light);
    }
  if (work.sample.teaches) camera.escape = escape_of(camera, walk, found);
  charge_join(work.scratch, 0, camera.n + 1);
}

// Density of the pixel's samples per area at vertex i, which the lens sees: itself, or by way of delta events, which
// are taken to leave light as straight as panes and flat mirrors do.
float seen_density(const Camera& lens, const Subpath& camera, int i) {
  if (i == 1) return float(camera[1].own);
  const auto cosine = [](const Vertex& v) { return std::abs(glm::dot(v.ng, v.guide.wo)); };
  float distance = glm::length(camera[1].p - camera[0].p);
  double share = luminance(camera[i].beta) / luminance(camera[1].beta);
  for (int k = 2; k <= i; ++k) {
    distance += std::sqrt(camera[k].distance2);
    share *= camera[k].own * camera[k].distance2 / cosine(camera[k]);  // the event's probability
  }
  const Vec3 at = camera[0].p - distance * camera[1].guide.wo;
  return float(share) * raster_factor(lens, camera[0].p, at) * cosine(camera[i]);
}

// What the camera subpath teaches, and that the lens sees its first vertex that scatters light.
void teach_camera(Work& work) {
  const Job& job = work.job;
  const Fields& fields = *job.walk.fields;
  const Subpath& camera = work.scratch.camera;
  int i = 1;
  while (i < camera.n && camera[i].seen && !connectable(camera[i].guide)) ++i;
  if (i < camera.n && camera[i].seen && camera[i].guide.cell != none)
    record_direct(fields.w, job.training->w, camera[i].guide.cell,
                  seen_density(job.scene->camera, camera, i) * relative_importance(fields, camera[i].guide));
  record_subpath(fields, *job.training, work.scratch.sightings, camera, Side::camera);
}

}  // namespace

void trace_bdpt(const Job& job, Sample& sample, Scratch& scratch) {
  Work work{job, sample, scratch};
  scratch.light.n = 0;
  if (job.walk.counts.light_paths > 0 && !job.light_half) trace_light_subpath(work);
  charge(scratch, &Ledger::light_ticks);
  Subpath& camera = scratch.camera;
  Walk walk;
  start_camera(*job.scene, sample.raster, sample.lens, camera, walk);
  Surface surface;
  First first;
  do {
    ++scratch.counters.camera_rays;
    const bool hit = step(*job.scene, *job.accel, job.walk, camera, walk, surface);
    charge(scratch, &Ledger::camera_ticks);
    if (!hit) {
      join_escapes(work, walk);
      break;
    }
    join_surface(work, surface);
    if (scratch.pool && !survives_roulette(work, walk)) break;
    join_all(work);
    note_first(work, first);
  } while (camera.n <= job.walk.max_edges && scatter(job.walk, scratch.numbers, camera, walk));
  charge(scratch, &Ledger::camera_ticks);
  note_beyond(work, first, walk);
  if (!sample.teaches || !job.guided) return;
  teach_camera(work);
  charge(scratch, &Ledger::learn_ticks);
}

}  // namespace ajar
