// Real subpaths of small scenes: for every way to join them, all densities of the whole path are computed afresh from
// its points, materials, light and camera, and the weight that bdpt takes is compared with the oracle's.
#include <gtest/gtest.h>

#include <map>

#include "afresh.h"
#include "ajar/field/emission.h"
#include "ajar/join/connect.h"
#include "ajar/join/photons.h"
#include "kit/stage.h"
#include "train.h"

namespace ajar {
namespace {

using namespace kit;

// A subpath together with the surfaces that its vertices lie on.
struct Traced {
  Subpath path;
  std::vector<Surface> surfaces;  // of vertex 1 ..
  Walk walk;
  bool escaped = false;
};

Point point_of(const Traced& traced, int i) {
  const Vertex& v = traced.path[i];
  return {v.p, v.ng, i > 0 ? traced.surfaces[size_t(i - 1)] : Surface{}, v.delta};
}

struct Tracer {
  const Scene& scene;
  const Accel accel;
  WalkOptions options;
  int most = 6;  // vertices of a subpath

  explicit Tracer(const Scene& s) : scene(s), accel(s) {}

  void go_on(Traced& t, Sampler& sampler, bool first_given) {
    Surface surface;
    for (bool start = first_given; t.path.n < most; start = false) {
      if (!start && !scatter(options, sampler, t.path, t.walk)) return;
      if (!step(scene, accel, options, t.path, t.walk, surface)) {
        t.escaped = true;
        return;
      }
      t.surfaces.push_back(surface);
    }
  }
};

// Strategies that bdpt treats alike, each of which must agree.
enum class Way { seen, hit, next_event, splat, join, merge };
constexpr size_t ways = 6;
constexpr const char* way_names[] = {"light seen", "light hit (s = 0)", "next event (s = 1)", "splat (t = 1)", "join",
                                     "merge"};

Way way_of(int s, int t) {
  if (s == 0) return t == 2 ? Way::seen : Way::hit;
  return s == 1 ? Way::next_event : t == 1 ? Way::splat : Way::join;
}

struct Tally {
  Heuristic heuristic = Heuristic::power;
  const Fields* fields = nullptr;
  SampleCounts counts{.light_paths = 333};
  Merging merging;
  int compared[ways] = {}, off[ways] = {};
  double worst[ways] = {};

  void compare(const Scene& scene, Candidate& c, const WholePath& path, int s) {
    compare(scene, weight(heuristic, c, counts), path, size_t(s), way_of(s, int(path.points.size()) - s));
  }

  // which: of the oracle's strategies.
  void compare(const Scene& scene, double fast, WholePath path, size_t which, Way kind) {
    path.fields = fields;
    OraclePath slow = densities_afresh(scene, path, counts, merging);
    slow.next_events = path.next_events;
    const double right = double(weights(slow, heuristic == Heuristic::power ? 2 : 1)[which]);
    // Relative, or absolute where the weight hardly counts: float rounding in long chains of densities.
    const double error = std::abs(fast - right) / std::max(right, 1e-4);
    const auto way = size_t(kind);
    ++compared[way];
    off[way] += !(error < 1e-3);
    worst[way] = std::max(worst[way], error);
  }
};

void append(WholePath& path, const Traced& t, int n, bool backwards) {
  for (int i = 0; i < n; ++i) path.points.push_back(point_of(t, backwards ? n - 1 - i : i));
}

// x_0 = light's own vertices 0 .. s-1, then the camera's t-1 .. 0.
WholePath joined(const Traced& light, int s, const Traced& camera, int t) {
  WholePath path;
  path.light = light.path[0].point;
  path.travel = light.path.n > 1 ? -light.path[1].guide.wo : Vec3(0, 0, 1);
  append(path, light, s, false);
  append(path, camera, t, true);
  // The ends of a connection scatter smoothly there, whatever the walks did next.
  path.points[size_t(s - 1)].delta = false;
  path.points[size_t(s)].delta = false;
  if (s == 1) path.travel = glm::normalize(path.points[1].p - path.points[0].p);
  return path;
}

// The camera's t vertices behind a light point that was found from the last of them.
WholePath lit(const LightPoint& light, const Vec3& wi, const Traced& camera, int t, bool delta_at_end) {
  WholePath path;
  path.light = light;
  path.travel = -wi;
  path.points.push_back({light.p, light.infinite ? Vec3(0) : light.n, {}, false});
  append(path, camera, t, true);
  path.next_events = camera.path[t - 1].next_events;
  path.points[1].delta = delta_at_end;
  return path;
}

// The light's s - 1 vertices, and as their next one the camera's last of t: false where they do not see each other.
bool reach(const Tracer& tracer, const Traced& light, int s, const Traced& camera, int t, Traced& out) {
  const Vertex& a = light.path[s - 2];
  const Vertex& c = camera.path[t - 1];
  out = light;
  out.path.n = s - 1;
  out.surfaces.resize(size_t(s - 2));
  Walk& walk = out.walk;
  walk = Walk{};
  walk.side = Side::light;
  walk.d = glm::normalize(c.p - a.p);
  const GuideEval e = evaluate(a.guide, walk.d, Mode::importance);
  if (!(e.pdf > 0) || is_black(e.f_cos)) return false;
  out.path[s - 2].delta = false;
  walk.o = offset(a.p, a.ng, a.error, walk.d);
  walk.pdf = e.pdf, walk.other_before = double(e.pdf_reverse) * a.back, walk.beta = a.beta * e.f_cos / e.pdf;
  Surface surface;
  if (!step(tracer.scene, tracer.accel, tracer.options, out.path, walk, surface)) return false;
  out.surfaces.push_back(surface);
  return length2(out.path[s - 1].p - c.p) < 1e-10f;
}

// Merges of the camera's vertices with light vertices that are put just there.
void compare_merges(const Tracer& tracer, const Traced& light, const Traced& camera, Tally& tally) {
  const Heuristic h = tally.heuristic;
  for (int t = 2; t <= camera.path.n; ++t)
    for (int s = 3; s <= light.path.n + 1; ++s) {
      const Vertex& c = camera.path[t - 1];
      const Vertex& before = camera.path[t - 2];
      Traced there;
      if (!connectable(c.guide) || !connectable(light.path[s - 2].guide)) continue;
      if (!reach(tracer, light, s, camera, t, there)) continue;
      Photons photons;
      add_photons(photons, there.path, h, tally.counts);
      if (photons.empty() || photons.back().s != s) continue;
      const Photon& p = photons.back();
      const GuideEval e = evaluate(c.guide, p.wi, Mode::radiance);
      if (is_black(e.f_cos)) continue;
      const End end{t, c.own, 0, before.own, 0, before.delta, c.sum, c.merge, c.seen, before.seen};
      const MergeSide side = merge_side(h, end, c.back, tally.counts.light_paths, tally.counts);
      const MergeSide lit{c.seen ? p.fixed * seen_factor(h, tally.counts, s) : p.fixed, p.slope};
      const double fast = merge_weight(h, c.merge, lit, e.pdf, side, e.pdf_reverse);
      const WholePath path = joined(there, s - 1, camera, t);
      WholePath smooth = path;
      smooth.points[size_t(s - 1)].delta = false;
      tally.compare(tracer.scene, fast, smooth, smooth.points.size() + size_t(s - 1), Way::merge);
    }
}

void compare_all(const Tracer& tracer, Traced& light, Traced& camera, const Vec2& lens, Sampler sampler, Tally& tally) {
  const Scene& scene = tracer.scene;
  Candidate c;
  for (int t = 2; t <= camera.path.n; ++t) {
    Subpath part = camera.path;
    part.n = t;
    const Vertex& last = camera.path[t - 1];
    const Surface& surface = camera.surfaces[size_t(t - 2)];
    if (join_hit(scene, tally.fields, part, surface, c)) {
      WholePath path = lit(light_point(scene, surface), -last.guide.wo, camera, t - 1, camera.path[t - 2].delta);
      tally.compare(scene, c, path, 0);
    }
    if (!connectable(last.guide)) continue;
    LightChances chances;
    LightNumbers u;
    if (draw_light(scene, last.guide, sampler, u) && join_light(scene, tally.fields, camera.path, t, chances, u, c)) {
      DirectSample d;
      ASSERT_TRUE(sample_next_event(scene, last.guide, chances, u, d));
      tally.compare(scene, c, lit(d.point, d.wi, camera, t, false), 1);
    }
    for (int s = 2; s <= light.path.n; ++s)
      if (connectable(light.path[s - 1].guide) && join_vertices(light_end(light.path, s), camera.path.first(t), c))
        tally.compare(scene, c, joined(light, s, camera, t), s);
  }
  for (int s = 2; s <= light.path.n; ++s)
    if (connectable(light.path[s - 1].guide) && join_camera(scene, lens, light.path, s, c)) {
      CameraConnection k;
      ASSERT_TRUE(connect(scene.camera, light.path[s - 1].p, lens, scene.filter.radius, k));
      Traced end;
      end.path.add().p = k.p;
      tally.compare(scene, c, joined(light, s, end, 1), s);
    }
  if (tally.merging.paths > 0) compare_merges(tracer, light, camera, tally);
  if (!camera.escaped) return;
  for (const uint32_t l : scene.infinite_lights)
    if (join_escape(scene, tally.fields, l, camera.path, camera.walk, c)) {
      const int t = camera.path.n;
      tally.compare(scene, c,
                    lit(light_point(scene, l, camera.walk.d), camera.walk.d, camera, t, camera.path[t - 1].delta), 0);
    }
}

struct Case {
  Heuristic heuristic = Heuristic::power;
  const Fields* fields = nullptr;
  Merging merging = {};
  SampleCounts counts = {};  // but for light paths
};

void expect_oracle(const Scene& scene, int paths, const Case& which) {
  Tally tally;
  tally.heuristic = which.heuristic;
  tally.fields = which.fields;
  Tracer tracer(scene);
  tracer.options.heuristic = which.heuristic;
  tracer.options.fields = which.fields;
  tracer.options.merging = tally.merging = which.merging;
  tally.counts = which.counts, tally.counts.light_paths = 333;
  tracer.options.counts = tally.counts;
  int compared = 0, vertices = 0, guided = 0;
  for (int i = 0; i < paths; ++i) {
    Sampler c = make_sampler(SamplerKind::independent, 1, Side::camera, uint64_t(i), 0);
    Sampler l = make_sampler(SamplerKind::independent, 1, Side::light, uint64_t(i), 0);
    const Vec2 raster = c.next2() * Vec2(float(scene.camera.width), float(scene.camera.height)), lens = c.next2();
    Traced camera, light;
    start_camera(scene, raster, lens, camera.path, camera.walk);
    tracer.go_on(camera, c, true);
    if (which.fields)  // several rays to lights, as many as one likes
      for (int k = 1; k < camera.path.n; ++k) camera.path[k].next_events = uint8_t(1 + (k + i) % 5);
    if (start_light(scene, tracer.options, l, light.path, light.walk)) tracer.go_on(light, l, true);
    compare_all(tracer, light, camera, lens, c, tally);
    for (const Traced* t : {&camera, &light})
      for (int k = 1; k < t->path.n; ++k) ++vertices, guided += t->path[k].guide.near.bsdf < 0.8f;
  }
  for (size_t way = 0; way < ways; ++way) {
    // Rounding of positions makes a few weights uncertain, where vertices nearly touch or directions graze.
    EXPECT_LE(tally.off[way], tally.compared[way] / 150)
        << way_names[way] << ": of " << tally.compared[way] << ", worst " << tally.worst[way];
    compared += tally.compared[way];
  }
  EXPECT_GT(compared, paths / 2);
  EXPECT_TRUE(which.merging.paths == 0 || tally.compared[size_t(Way::merge)] > paths / 50);
  EXPECT_TRUE(!which.fields || guided > vertices / 20) << guided << " of " << vertices << " are too few";
}

// Bare, and with guides that carry trained fields on both sides.
void expect_oracle(const Scene& scene, int paths = 3000) {
  const Fields fields = train(scene, Accel(scene));
  for (const Heuristic heuristic : {Heuristic::balance, Heuristic::power}) {
    SCOPED_TRACE(heuristic == Heuristic::balance ? "balance" : "power");
    expect_oracle(scene, paths, {heuristic, nullptr});
    SCOPED_TRACE("guided");
    expect_oracle(scene, paths / 2, {heuristic, &fields, {}, {.seen = 8, .first_seen = 3}});
    SCOPED_TRACE("merging");
    expect_oracle(
        scene, paths / 3,
        {heuristic, &fields, {500, {0, 0, 4}, 0.01f, 0, 1}, {.seen = 8, .first_seen = 3, .merge_inner = 0.3}});
  }
}

Scene finished(Scene scene) {
  finish(scene);
  return scene;
}

Material of_kind(MaterialKind kind, float alpha = 0.2f) {
  Material m;
  m.kind = kind;
  m.distribution = Microfacet::ggx;
  m.alpha_u = m.alpha_v = alpha;
  return m;
}

Scene with_sphere(const Material& m) {
  Scene scene = stage();
  add_sphere(scene, {0.1f, -0.3f, 0.2f}, 0.5f, add_material(scene, m));
  return finished(std::move(scene));
}

// Open room under lights of all kinds.
Scene open(LightKind kind) {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  set_camera(scene, {0, 0, 4.2f}, {0, 0, 0}, 36, 24, 24);
  add_open_room(scene);
  add_sphere(scene, {0, -0.5f, 0}, 0.5f, add_material(scene, of_kind(MaterialKind::dielectric)));
  const uint32_t id = add_light(scene, kind, Rgb(3, 2, 1));
  Light& light = scene.lights[id];
  light.position = {0.3f, 0.8f, 0.4f};
  light.direction = glm::normalize(Vec3(-0.3f, -1, -0.4f));
  light.to_world = look_at(light.position, light.position + light.direction);
  light.cutoff = std::acos(0.8f), light.beam = std::acos(0.9f);
  if (kind == LightKind::envmap) {
    std::vector<float> sky;
    for (int i = 0; i < 32 * 16; ++i)
      for (int c = 0; c < 3; ++c) sky.push_back(i == 70 ? 100 : 0.1f + float(i % 7));
    const Slot image = add_image(scene, 32, 16, sky);
    scene.environments.push_back(make_environment(scene, scene.textures[image.texture].image, 1));
    light.environment = 0;
    light.to_world = Mat4(1);
  }
  return finished(std::move(scene));
}

TEST(Weights, Diffuse) { expect_oracle(finished(stage())); }
// Emission is guided where the lamp itself scatters.
TEST(Weights, GreyLamp) {
  Scene scene = stage();
  scene.shapes[scene.lights[0].shape].material = add_diffuse(scene, Rgb(0.4f));
  expect_oracle(finished(std::move(scene)));
}
TEST(Weights, Glossy) { expect_oracle(with_sphere(of_kind(MaterialKind::roughconductor, 0.3f))); }
TEST(Weights, RoughGlass) { expect_oracle(with_sphere(of_kind(MaterialKind::roughdielectric, 0.3f))); }
TEST(Weights, Glass) { expect_oracle(with_sphere(of_kind(MaterialKind::dielectric))); }
TEST(Weights, Mirror) { expect_oracle(with_sphere(of_kind(MaterialKind::conductor))); }
TEST(Weights, Plastic) { expect_oracle(with_sphere(of_kind(MaterialKind::plastic))); }
TEST(Weights, RoughPlastic) { expect_oracle(with_sphere(of_kind(MaterialKind::roughplastic, 0.3f))); }
TEST(Weights, Principled) { expect_oracle(with_sphere(of_kind(MaterialKind::principled))); }
TEST(Weights, Null) { expect_oracle(with_sphere(of_kind(MaterialKind::null))); }
TEST(Weights, Constant) { expect_oracle(open(LightKind::constant)); }
TEST(Weights, EnvironmentMap) { expect_oracle(open(LightKind::envmap)); }
TEST(Weights, PointLight) { expect_oracle(open(LightKind::point)); }
TEST(Weights, Spot) { expect_oracle(open(LightKind::spot)); }
TEST(Weights, Directional) { expect_oracle(open(LightKind::directional)); }

TEST(Weights, Textured) {
  Scene scene = stage();
  std::vector<float> rgb;
  for (int i = 0; i < 16; ++i) rgb.insert(rgb.end(), {float(i), float(i % 4), 1});
  scene.lights[0].radiance = add_image(scene, 4, 4, rgb);
  scene.materials[scene.shapes[0].material] = of_kind(MaterialKind::roughconductor);
  scene.materials[scene.shapes[0].material].alpha_u = add_image(scene, 2, 1, {0.1f, 0.1f, 0.1f, 0.5f, 0.5f, 0.5f});
  expect_oracle(finished(std::move(scene)));
}

// What masks let pass is a delta on lamps alone.
uint32_t half_open(Scene& scene, uint32_t inner) {
  Material blend = of_kind(MaterialKind::blend);
  blend.weight = 0.6f;
  blend.nested[0] = add_material(scene, of_kind(MaterialKind::null)), blend.nested[1] = inner;
  return add_material(scene, blend);
}

TEST(Weights, BentNormalsAndMasks) {
  Scene scene = stage();
  add_area_light(scene, add_mesh(scene, globe({0, -0.3f, 0.2f}, 0.5f, 6, 0.4f), half_open(scene, 0)), Rgb(0.3f));
  expect_oracle(finished(std::move(scene)));
}

// What passes a mask does so with one probability, whatever the material on either side.
TEST(Weights, TwoFacedMask) {
  Scene scene = stage();
  Material faces = of_kind(MaterialKind::twosided);
  faces.nested[0] = add_diffuse(scene, Rgb(0.1f)), faces.nested[1] = add_diffuse(scene, Rgb(0.9f));
  const uint32_t material = half_open(scene, add_material(scene, faces));
  add_area_light(scene, add_mesh(scene, globe({0, -0.3f, 0.2f}, 0.5f, 6), material), Rgb(0.3f));
  expect_oracle(finished(std::move(scene)));
}

// Lobes that reflect beside lobes that transmit: the fields of two sides meet.
TEST(Weights, GlassAndDiffuse) {
  for (const MaterialKind kind : {MaterialKind::dielectric, MaterialKind::thindielectric, MaterialKind::roughdielectric,
                                  MaterialKind::principled}) {
    SCOPED_TRACE(int(kind));
    Scene scene = stage();
    Material blend = of_kind(MaterialKind::blend), clear = of_kind(kind, 0.3f);
    clear.spec_trans = 0.5f;
    blend.weight = 0.4f;
    blend.nested[0] = add_diffuse(scene, Rgb(0.7f)), blend.nested[1] = add_material(scene, clear);
    add_sphere(scene, {0.1f, -0.3f, 0.2f}, 0.5f, add_material(scene, blend));
    expect_oracle(finished(std::move(scene)), 1000);
  }
}

// Both sides are guided; not where what is behind reflects otherwise, since a way back would be guided otherwise.
TEST(Weights, Paper) {
  Scene scene = stage();
  add_sphere(scene, {0.1f, -0.3f, 0.2f}, 0.5f, add_paper(scene, Rgb(0.7f)));
  expect_oracle(finished(std::move(scene)));
}

TEST(Weights, TwoFacedPaper) {
  Scene scene = stage();
  const uint32_t metal = add_material(scene, of_kind(MaterialKind::roughconductor, 0.2f));
  const uint32_t paper = add_paper(scene, Rgb(0.7f));
  scene.materials[scene.materials[paper].nested[0]].nested[1] = metal;
  add_sphere(scene, {0.1f, -0.3f, 0.2f}, 0.5f, paper);
  expect_oracle(finished(std::move(scene)));
}

TEST(Weights, ManyLights) {
  Scene scene = open(LightKind::constant);
  scene.lights[add_light(scene, LightKind::point, Rgb(1))].position = {0.5f, 0.5f, 0.5f};
  add_lamp(scene, 0.3f, Rgb(4));
  add_area_light(scene, add_sphere(scene, {0.6f, -0.2f, 0}, 0.1f, 0), Rgb(9));
  add_light(scene, LightKind::directional, Rgb(1));
  expect_oracle(finished(std::move(scene)));
}

TEST(Weights, ThinLensAndOrthographic) {
  Scene scene = stage();
  scene.camera.kind = CameraKind::thinlens;
  scene.camera.aperture = 0.2f, scene.camera.focus = 4;
  expect_oracle(finished(scene));
  set_orthographic(scene.camera, look_at({0, 0, 3}, {0, 0, 0}));
  expect_oracle(finished(scene));
}

}  // namespace
}  // namespace ajar
