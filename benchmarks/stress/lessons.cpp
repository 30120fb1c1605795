#include "lessons.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ajar/render/render.h"
#include "ajar/scene/build.h"

namespace ajar::stress {
namespace {

Lesson look(const RenderState& state) {
  Lesson out{state.learning.fields.generation, state.film.dropped + state.film.passes};
  double visits = 0;
  for (const FieldCell& c : state.learning.fields.q.cells) {
    const double radiance = double(c.total) / std::numbers::pi;
    out.mean += double(c.visits) * radiance, visits += double(c.visits);
    out.most = std::max(out.most, radiance);
  }
  if (visits > 0) out.mean /= visits;
  out.cells = state.learning.fields.q.cells.size();
  return out;
}

}  // namespace

std::vector<Lesson> lessons(float albedo, const LearnOptions& learn, uint32_t passes, int size, int max_depth) {
  Material wall;
  wall.reflectance = Rgb(albedo);
  const Scene scene = furnace(Oven::box, wall, Rgb(1), size);
  const Accel accel(scene);
  RenderOptions o;
  o.integrator = "guided-path";
  o.sampler = SamplerKind::independent;
  o.learn = learn;
  o.spp = passes;
  o.max_depth = max_depth;
  RenderState state = start_render(scene, o);
  std::vector<Lesson> out;
  render(scene, accel, o, state, [&](const RenderState& now) {
    if (now.learning.fields.generation != (out.empty() ? 0 : out.back().number)) out.push_back(look(now));
    return true;
  });
  return out;
}

uint32_t lesson_of_convergence(const std::vector<Lesson>& all, float albedo, double share) {
  for (const Lesson& l : all)
    if (l.mean >= share / (1 - double(albedo))) return l.number;
  return 0;
}

}  // namespace ajar::stress
