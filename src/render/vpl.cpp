// Instant radiosity (Keller 1997) with guided light vertices: those of a pass are virtual point lights for all pixels.
// A camera subpath joins some of them where it can, and goes on only as often as joins are too bright to be trusted:
// what other renderers clamp away is so found by a short walk, and the image is unbiased given the fields
// (docs/method.md, "Virtual point lights").

#include "ajar/core/parallel.h"
#include "job.h"

namespace ajar {
namespace {

struct Work {
  const Job& job;
  Sample& sample;
  Scratch& scratch;
};

void add(Work& work, const Candidate& c, float weight, int s, int t) {
  const Rgb value = c.value * weight;
  if (!accept(value, work.sample, work.scratch)) return;
  work.sample.value += value;
  gain(work.scratch, s, t, value * work.sample.filter);
  if (!work.scratch.strategies) return;
  const Rgb filtered = value * work.sample.filter;
  work.scratch.strategies->push_back(
      {s, t, Vec2(work.sample.x, work.sample.y), c.value * work.sample.filter, filtered});
}

// Of hits and next-event estimation among each other: nothing else finds what they find.
float weigh(const Work& work, Candidate& c) {
  c.shares.inner = 0;
  return float(weight(work.job.walk.heuristic, c));
}

bool is_free(Work& work, const Candidate& c, int s, int t) {
  ++work.scratch.counters.shadow_rays;
  ++work.scratch.ledger->at(s, t).rays;
  return visible(*work.job.accel, c.segment);
}

// Light vertices per area and light subpath at a point of a surface, on the side of direction w: learned.
double density_of_lights(const Job& job, const Vec3& p, const Vec3& ng, const Vec3& w) {
  const Fields* fields = job.walk.fields;
  if (!fields) return job.vpls->even;
  const uint32_t cell = find(fields->table, p, glm::dot(ng, w) < 0 ? -ng : ng).cell;
  return cell == none ? 0 : double(fields->w.cells[cell].visits);
}

// The share of a path that joins have whose edge is x - y, of all that could find it: the rest is for the walk from x
// to y. Of the edge alone, so that both ways say the same. walked: area density of y as the walk from x finds it. (I1)
double share_of_joins(const Job& job, const Vec3& y, const Vec3& ng, const Vec3& to_x, double walked) {
  const double lights = job.vpls->worth * density_of_lights(job, y, ng, to_x);
  return lights > 0 ? lights / (lights + walked) : 0;
}

// Whether the walk is to find what its last vertex y scatters, which joins at the one before could have found as well.
// What passes y by a delta event they could not.
bool is_walked(Work& work) {
  const Subpath& camera = work.scratch.camera;
  const Vertex &x = camera[camera.n - 2], &y = camera[camera.n - 1];
  if (camera.n < 3 || x.delta || !connectable(x.guide) || !connectable(y.guide)) return true;
  const double share = share_of_joins(work.job, y.p, y.ng, y.guide.wo, y.own);
  return work.sample.sampler.next1() >= share;
}

void join_lights(Work& work, const Surface& surface) {
  const Job& job = work.job;
  const Subpath& camera = work.scratch.camera;
  Candidate c;
  if (job.scene->shapes[surface.shape].light == none) return;
  if (join_hit(*job.scene, job.walk.fields, camera, surface, c)) add(work, c, weigh(work, c), 0, camera.n);
  charge_join(work.scratch, 0, camera.n);
}

void join_next_event(Work& work) {
  const Job& job = work.job;
  const Subpath& camera = work.scratch.camera;
  Candidate c;
  if (job.scene->lights.empty()) return;
  if (join_light(*job.scene, job.walk.fields, work.sample.sampler, camera, camera.n, 0, c) &&
      is_free(work, c, 1, camera.n))
    add(work, c, weigh(work, c), 1, camera.n);
  charge_join(work.scratch, 1, camera.n);
}

void join_vpls(Work& work) {
  const Job& job = work.job;
  Scratch& scratch = work.scratch;
  const Subpath& camera = scratch.camera;
  const LightStore& store = job.vpls->store;
  const Vertex& x = camera[camera.n - 1];
  choose_some(store, x, job.walk.max_edges + 1 - camera.n, job.vpls->joins, work.sample.sampler.next1(), scratch.sums,
              scratch.choices);
  for (const StoreChoice& choice : scratch.choices) {
    const LightStore::Place& at = *choice.place;
    Candidate c;
    if (join_vertices(store.subpath(at), at.share, camera.first(camera.n), 0, c) && is_free(work, c, at.s, camera.n)) {
      const Vertex& y = store.subpath(at).back();
      const double share = share_of_joins(job, y.p, y.ng, camera[camera.n - 1].p - y.p, c.light.other);
      c.value *= choice.weight;
      add(work, c, float(share), at.s, camera.n);
    }
    charge_join(scratch, at.s, camera.n);
  }
}

// One light subpath of the pass. Passes and paths number the points of one sequence for either half of the image, so
// that the lights of a pass are evenly spread.
void trace_lights(const Job& job, uint32_t pass, uint32_t path, Scratch& scratch, LightStore& out) {
  constexpr uint64_t stream = 0x76706c;
  const uint32_t point = 2 * ((pass / 2) * job.vpls->paths + path) + pass % 2;
  Sampler sampler = make_sampler(job.sampler, job.seed, Side::light, stream, point);
  Subpath& light = scratch.light;
  Walk walk;
  light.n = 0;
  if (start_light(*job.scene, job.walk, sampler, light, walk)) {
    ++scratch.counters.light_paths;
    Surface surface;
    while (light.n < job.walk.max_edges) {
      if (light.n > 1 && !scatter(job.walk, sampler, light, walk)) break;
      ++scratch.counters.light_rays;
      if (!step(*job.scene, *job.accel, job.walk, light, walk, surface)) break;
    }
  }
  add(out, light, walk.first_share);
}

}  // namespace

void place_vpls(const Job& job, uint32_t pass, std::vector<Scratch>& scratches, Vpls& vpls) {
  constexpr uint32_t grain = 16;
  std::vector<LightStore> parts((vpls.paths + grain - 1) / grain);
  parallel_for(parts.size(), [&](size_t part) {
    for (uint32_t i = uint32_t(part) * grain; i < std::min(vpls.paths, uint32_t(part + 1) * grain); ++i)
      trace_lights(job, pass, i, scratches[thread_slot()], parts[part]);
  });
  clear(vpls.store);
  for (const LightStore& part : parts) append(vpls.store, part);
  std::vector<float> near;
  for (const LightStore::Place& at : vpls.store.places) {
    const Vertex& v = vpls.store.subpath(at).back();
    const double lights = vpls.worth * density_of_lights(job, v.p, v.ng, v.guide.wo);
    near.push_back(float(inv_pi / std::max(lights, 1e-30)));
  }
  finish(vpls.store, near);
}

void trace_vpl(const Job& job, Sample& sample, Scratch& scratch) {
  Work work{job, sample, scratch};
  Subpath& camera = scratch.camera;
  Walk walk;
  start_camera(*job.scene, job.walk, sample.raster, sample.lens, camera, walk);
  Surface surface;
  bool walked = true;
  do {
    ++scratch.counters.camera_rays;
    const bool hit = step(*job.scene, *job.accel, job.walk, camera, walk, surface);
    charge(scratch, scratch.ledger->camera_ticks);
    if (!hit) {
      Candidate c;
      for (const uint32_t light : job.scene->infinite_lights)
        if (join_escape(*job.scene, job.walk.fields, light, camera, walk, c))
          add(work, c, weigh(work, c), 0, camera.n + 1);
      charge_join(scratch, 0, camera.n + 1);
      return;
    }
    join_lights(work, surface);
    walked = is_walked(work);
    if (!walked || camera.n > job.walk.max_edges || !connectable(camera[camera.n - 1].guide)) continue;
    join_next_event(work);
    join_vpls(work);
  } while (camera.n <= job.walk.max_edges && scatter(job.walk, sample.sampler, camera, walk) &&
           (walked || camera[camera.n - 1].delta));
  charge(scratch, scratch.ledger->camera_ticks);
}

}  // namespace ajar
