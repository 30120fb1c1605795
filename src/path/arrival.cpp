#include "ajar/path/arrival.h"

namespace ajar {
namespace {

// Measured (docs/results/joins.md).
constexpr float window = 100, least = 0.2f;

// Of what is expected to come by way of the last vertex, the share that strategies with this vertex bring, by their
// weights. The others join one before it, where a light subpath that comes here is joined as well.
float share_brought(const WalkOptions& walk, const Subpath& camera) {
  const Vertex& v = camera[camera.n - 1];
  if (v.seen || v.guide.cell == none) return 1;
  const double others = count_before(walk, camera) * double(walk.fields->w.cells[v.guide.cell].visits);
  return weight_against(walk.heuristic, walk.counts.inner * v.own, others);
}

}  // namespace

double count_before(const WalkOptions& walk, const Subpath& camera) {
  const Vertex &v = camera[camera.n - 1], &last = camera[camera.n - 2];
  const SampleCounts& n = walk.counts;
  const double share = last.delta ? 0 : raise(walk.heuristic, camera.n == 2 ? n.light_paths : join_count(n, last.seen));
  const double back = double(std::abs(v.guide.wo_local.z) * inv_pi) * v.back;
  const double all = camera.n == 2 ? share : extend(share, raise(walk.heuristic, ratio(back, last.own)), v.sum);
  return walk.heuristic == Heuristic::power ? std::sqrt(all) : all;
}

bool is_worth_it(const WalkOptions& options, Sampler& sampler, Subpath& camera, Walk& walk) {
  const uint32_t number = sampler.skip();
  Vertex& v = camera[camera.n - 1];
  const float all = promise(v.guide, v.beta).all;
  if (!(walk.promise > 0) || !(all > 0)) return true;
  const float probability = std::clamp(window * options.goes_on * share_brought(options, camera) * all / walk.promise,
                                       lowest_chance(options, walk.survival, least, 1), 1.0f);  // (G15)
  if (!(sampler.at(number).x < probability)) return false;
  walk.sure = walk.sure && probability == 1;
  v.beta /= probability, walk.survival /= probability;
  return true;
}

}  // namespace ajar
