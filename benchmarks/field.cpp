// What the learned fields cost at a vertex. Renders a scene with guided-bdpt until the fields are learned, walks light
// and camera subpaths through them as the next pass would, and notes every vertex; then sends the vertices, in their
// order, through what a guide does with the fields at each: find the cell, density of the way back by the other side's
// field, draw a direction from its own field with its density, density of the direction that the path took. Prints
// nanoseconds a vertex for each, and for all four one after another: in a loop of their own, and between rays like
// those of the render, which leave the caches as a render does (the same loop with rays alone is taken off).
//
//   bench_field SCENE.xml [WIDTH HEIGHT [PASSES [ROUNDS [NAME=VALUE ...]]]]
//
// Without SCENE: scenes/ajar and veach-ajar of the folder of shared scenes (AJAR_SHARED_SCENES), where that is present.

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "ajar/core/error.h"
#include "ajar/render/render.h"
#include "ajar/scene/load.h"

namespace {

using namespace ajar;

// What a guide knows of a vertex when it asks the fields.
struct Visit {
  Vec3 p, n;  // n: geometric, on the side of wo
  Vec3 wo, wi;
  Vec2 u;
  float error;
  Side side;
  uint32_t cell = none;
};

struct Settings {
  int width = 320, height = 180, rounds = 20;
  uint32_t passes = 24;
  LoadOptions load;
};

void note(const Subpath& path, Side side, Sampler& numbers, std::vector<Visit>& out) {
  for (int i = 1; i + 1 < path.n; ++i) {
    const Vertex& v = path[i];
    if (!connectable(v.guide) || v.delta || v.guide.cell == none) continue;
    const Vec3 n = glm::dot(v.ng, v.guide.wo) < 0 ? -v.ng : v.ng;
    out.push_back({v.p, n, v.guide.wo, -path[i + 1].guide.wo, numbers.next2(), v.error, side, v.guide.cell});
  }
}

// The subpaths of a pass that the fields have not seen, pixel by pixel.
std::vector<Visit> walk_paths(const Scene& scene, const Accel& accel, const Fields& fields, int max_depth) {
  WalkOptions options;
  options.fields = &fields;
  options.max_edges = max_depth < 0 ? 64 : max_depth;
  std::vector<Visit> visits;
  Subpath path;
  Surface surface;
  Sampler numbers = make_sampler(SamplerKind::independent, 7, Side::camera, 0, 0);
  const Camera& c = scene.camera;
  for (int y = 0; y < c.crop_height; ++y)
    for (int x = 0; x < c.crop_width; ++x)
      for (const Side side : {Side::light, Side::camera}) {
        Sampler sampler =
            make_sampler(SamplerKind::sobol, 11, side, uint64_t(y) * uint64_t(c.crop_width) + uint64_t(x), 0);
        Walk walk;
        if (side == Side::camera)
          start_camera(scene, Vec2(c.crop_x + x, c.crop_y + y) + sampler.next2(), sampler.next2(), path, walk);
        else if (!start_light(scene, options, sampler, path, walk))
          continue;
        while (step(scene, accel, options, path, walk, surface) && path.n <= options.max_edges &&
               scatter(options, sampler, path, walk)) {
        }
        note(path, side, numbers, visits);
      }
  return visits;
}

const Field& other(const Fields& f, Side side) { return side == Side::camera ? f.w : f.q; }

// The least of some rounds, in nanoseconds a vertex; what is computed goes to a sum that is printed, lest it be left
// out.
template <class Work>
double measure(const std::vector<Visit>& visits, int rounds, float& sum, Work work) {
  double least = infinity;
  for (int round = 0; round < rounds; ++round) {
    const double start = process_cpu_seconds();
    for (const Visit& v : visits) sum += work(v);
    least = std::min(least, process_cpu_seconds() - start);
  }
  return least / double(visits.size()) * 1e9;
}

float all(const Fields& f, const Visit& v) {
  const Place at = find(f.table, v.p, v.n);
  float p;
  const float back = pdf(f, other(f, v.side), at.cell, v.p, v.wo);
  const Vec3 w = sample(f, f.of(v.side), at.cell, v.p, v.u, p);
  return back + w.x + p + pdf(f, f.of(v.side), at.cell, v.p, v.wi);
}

float trace(const Accel& accel, const Visit& v) {
  Hit hit;
  return accel.intersect(offset(v.p, v.n, v.error, v.wi), v.wi, 0, infinity, hit) ? hit.t : 0;
}

void run(const std::string& path, const Settings& set) {
  Scene scene = load_scene(path, set.load);
  Camera& c = scene.camera;
  c.plane.y = c.plane.x * float(set.height) / float(set.width);
  c.width = c.crop_width = set.width, c.height = c.crop_height = set.height, c.crop_x = c.crop_y = 0;
  const Accel accel(scene);
  RenderOptions options;
  options.integrator = "guided-bdpt";
  options.spp = set.passes;
  options.max_depth = scene.hints.max_depth < 0 ? 10 : scene.hints.max_depth;
  RenderState state = start_render(scene, options);
  render(scene, accel, options, state, {});
  const Fields& f = state.learning.fields;
  const std::vector<Visit> visits = walk_paths(scene, accel, f, options.max_depth);
  if (visits.empty()) throw Error(path + ": no path met a vertex that the fields know; nothing to measure");
  double levels = 0;  // that a look-up passes
  for (const Visit& v : visits) levels += level_of(f.cells[v.cell].key) + 1;
  fmt::print("{} {}x{}, {} passes: {} cells, {} + {} nodes, {:.1f} MB; {} vertices, {:.1f} levels of cells\n", path,
             set.width, set.height, set.passes, f.cells.size(), f.q.nodes.size(), f.w.nodes.size(),
             double(bytes(f)) * 1e-6, visits.size(), levels / double(visits.size()));
  float sum = 0, p;
  const int n = set.rounds;
  const auto ns = [&](auto work) { return measure(visits, n, sum, work); };
  const double look_up = ns([&](const Visit& v) { return float(find(f.table, v.p, v.n).cell); });
  const double reverse = ns([&](const Visit& v) { return pdf(f, other(f, v.side), v.cell, v.p, v.wo); });
  const double draw = ns([&](const Visit& v) { return sample(f, f.of(v.side), v.cell, v.p, v.u, p).x + p; });
  const double density = ns([&](const Visit& v) { return pdf(f, f.of(v.side), v.cell, v.p, v.wi); });
  const double together = ns([&](const Visit& v) { return all(f, v); });
  const double rays = ns([&](const Visit& v) { return trace(accel, v); });
  const double among = ns([&](const Visit& v) { return all(f, v) + trace(accel, v); });
  fmt::print(
      "  ns a vertex: look-up {:.1f}  reverse density {:.1f}  sample {:.1f}  density {:.1f}; "
      "look-up and both densities {:.1f}; all {:.1f}; a ray {:.0f}; all between rays {:.1f}  (sum {:.3g})\n",
      look_up, reverse, draw, density, look_up + reverse + density, together, rays, among - rays, sum);
}

int argument(int argc, char** argv, int i, int otherwise) { return argc > i ? std::atoi(argv[i]) : otherwise; }

}  // namespace

int main(int argc, char** argv) try {
  Settings set;
  set.width = argument(argc, argv, 2, set.width), set.height = argument(argc, argv, 3, set.height);
  set.passes = uint32_t(argument(argc, argv, 4, int(set.passes))), set.rounds = argument(argc, argv, 5, set.rounds);
  if (set.width < 1 || set.height < 1 || set.passes < 1 || set.rounds < 1)
    throw Error("bench_field [SCENE.xml [WIDTH HEIGHT [PASSES [ROUNDS [NAME=VALUE ...]]]]], numbers from 1");
  for (int i = 6; i < argc; ++i) {
    const std::string text = argv[i];
    const size_t equals = text.find('=');
    if (equals == std::string::npos) throw Error(text + ": write NAME=VALUE");
    set.load.defines[text.substr(0, equals)] = text.substr(equals + 1);
  }
  if (argc > 1) return run(argv[1], set), 0;
  run(AJAR_SOURCE_DIR "/scenes/ajar/ajar.xml", set);
  const char* shared = std::getenv("AJAR_SHARED_SCENES");
  const std::string veach =
      std::string(shared ? shared : AJAR_SOURCE_DIR "/../shared/scenes") + "/veach-ajar/scene.xml";
  if (std::filesystem::exists(veach))
    run(veach, set);
  else
    fmt::print("{}: not there, skipped; set AJAR_SHARED_SCENES to the folder that has veach-ajar\n", veach);
  return 0;
} catch (const ajar::Error& e) {
  return fmt::print(stderr, "{}\n", e.what()), 2;
}
