#include "start.h"

#include <fmt/format.h>

#include "ajar/core/error.h"
#include "ajar/film/fireflies.h"
#include "integrators.h"

namespace ajar {
namespace {

// Passes that teach fields before light vertices are placed through them.
constexpr uint32_t vpl_training = 8;

// What joins of a guided vertex count for in the weights: about as many are made of each, where it matters (J3).
constexpr double guided_joins = 2;
// What next-event estimation counts for where the lens sees its vertex: several rays that lie evenly. (J7)
constexpr double guided_first = 2;

}  // namespace

RenderState start_render(const Scene& scene, const RenderOptions& options) {
  check(options);
  require_finished(scene);
  RenderState state;
  const Integrator& integrator = find_integrator(options.integrator);
  state.integrator = integrator.name;
  state.film = make_film(scene.camera, scene.filter, integrator.splats);
  if (options.limit_fireflies) limit_fireflies(state.film);
  state.pyramid.kept = options.techniques;
  if (!learns(options)) return state;
  LearnOptions learn = options.learn;
  if (integrator.vpls && learn.train == 0) learn.train = vpl_training;
  state.learning = start_learning(scene, state.film, learn);
  return state;
}

namespace {

bool are_alike(const Filter& a, const Filter& b) {
  return a.kind == b.kind && a.radius == b.radius && a.a == b.a && a.b == b.b;
}

// What passes that are in the film were made with goes for those to come.
void require_alike(const Scene& scene, const RenderOptions& options, const RenderState& state) {
  if (!are_alike(scene.filter, state.film.filter))
    throw Error("render: the film has another filter than the scene; start_render makes a state for each");
  if (options.techniques != state.pyramid.kept)
    throw Error(
        fmt::format("render: the state was started with techniques {}, and is asked to go on with {}; "
                    "start_render makes a state for each",
                    state.pyramid.kept, options.techniques));
  if (options.limit_fireflies == state.film.brightest.empty())
    throw Error(
        fmt::format("render: the state was started with limit_fireflies {}, and is asked to go on with {}; "
                    "start_render makes a state for each",
                    !options.limit_fireflies, options.limit_fireflies));
}

}  // namespace

void check_state(const Scene& scene, const RenderOptions& options, const RenderState& state) {
  check(options);
  require_finished(scene);
  const Integrator& integrator = find_integrator(options.integrator);
  const Camera& c = scene.camera;
  const Film& f = state.film;
  if (f.width != c.crop_width || f.height != c.crop_height || f.x0 != c.crop_x || f.y0 != c.crop_y)
    throw Error(fmt::format(
        "render: the film is of {}x{} pixels from {},{} on, the camera's are {}x{} from {},{} on; start_render makes a "
        "state for each size",
        f.width, f.height, f.x0, f.y0, c.crop_width, c.crop_height, c.crop_x, c.crop_y));
  if (state.integrator != integrator.name)
    throw Error(fmt::format(
        "render: the state was started for {}, and is asked to go on with {}; start_render makes a state for each",
        state.integrator, integrator.name));
  require_alike(scene, options, state);
  if (learns(options) && state.learning.fields.starts.cuts.empty())
    throw Error(fmt::format("render: {} learns, and the state has no fields; start_render makes one with these options",
                            options.integrator));
  if (learns(options) && !fits(state.learning.fields, scene.light_tree, learn_options(options)))
    throw Error(
        "render: what the state learned of lights is of another scene, another choice of lights, or other options; "
        "start_render makes a new state, go_on_from and start_with bring stored fields into it");
  if (learns(options) && !fits(state.learning.training, state.learning.fields))
    throw Error(
        "render: the state's fields were changed by hand, and its training is of others; go_on_from and start_with "
        "bring fields into a state");
  if (!options.next_event && (integrator.splats || integrator.light_half))
    throw Error(fmt::format("render: next_event false is for path and guided-path; {} finds light in more ways",
                            options.integrator));
}

Job make_job(const Scene& scene, const Accel& accel, const RenderOptions& options, RenderState& state) {
  const Integrator& integrator = find_integrator(options.integrator);
  Job job;
  job.scene = &scene;
  job.accel = &accel;
  job.walk.max_edges = options.max_depth < 0 ? deepest : std::min(options.max_depth, deepest);
  job.walk.roulette_from = options.roulette_depth;
  job.walk.heuristic = options.heuristic;
  job.sampler = options.sampler;
  job.seed = options.seed;
  job.techniques = options.techniques;
  job.next_event = options.next_event;
  job.trace = integrator.trace, job.light_half = integrator.light_half;
  job.merges_alone = integrator.merges && !integrator.weighs;
  if (job.merges_alone) job.final_gather = options.final_gather;
  if (learns(options)) {
    job.learning = &state.learning, job.training = &state.learning.training;
    job.walk.fields = &state.learning.fields;
  }
  if (integrator.guided) {
    job.guided = true;
    SampleCounts& counts = job.walk.counts;
    counts.inner = integrator.splats ? guided_joins : 0;
    counts.seen = counts.inner;  // more where they choose among many, see plan_light
    counts.first_seen = guided_first;
  }
  return job;
}

}  // namespace ajar
