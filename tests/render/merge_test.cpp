// Integrators that merge: energy, leaks, bias that goes with the radius, and what is left when nothing is merged.
#include <gtest/gtest.h>

#include <cstring>

#include "ajar/scene/load.h"
#include "kit/files.h"
#include "kit/stage.h"
#include "measure.h"

namespace ajar {
namespace {

using namespace kit;

constexpr const char* merging[] = {"vcm", "guided-vcm", "photon"};

RenderOptions with_radius(const std::string& integrator, float pixels, uint32_t spp = 4) {
  RenderOptions o;
  o.integrator = integrator;
  o.merge_radius = pixels;
  o.spp = spp;
  return o;
}

double mean(const Picture& p) {
  double sum = 0;
  for (const float x : p.pixels) sum += double(x);
  return sum / double(p.pixels.size());
}

Picture render_once(const Scene& scene, const RenderOptions& o) {
  const Accel accel(scene);
  return develop(rendered(scene, accel, o).film);
}

double mean_of_seeds(const Scene& scene, RenderOptions o) {
  double sum = 0;
  for (o.seed = 1; o.seed <= 3; ++o.seed) sum += mean(render_once(scene, o)) / 3;
  return sum;
}

TEST(Merging, OffIsGuidedBdpt) {
  const Scene scene = cornell(40);
  const Picture off = render_once(scene, with_radius("guided-vcm", 0, 10));
  const Picture bdpt = render_once(scene, with_radius("guided-bdpt", 5, 10));
  EXPECT_EQ(off.pixels, bdpt.pixels);
}

// A room 2^24 times as large is the same image: where a step of 1 from the eye is lost, too.
TEST(Merging, RadiusIsOfPixelsInRoomsOfAnySize) {
  const Scene room = cornell(24);
  Scene huge = room;
  constexpr float factor = 0x1p24f;
  for (Mesh& mesh : huge.meshes)
    for (Vec3& p : mesh.positions) p *= factor;
  Camera& c = huge.camera;
  c.to_world[3] = Vec4(Vec3(c.to_world[3]) * factor, 1);
  c.to_camera = Mat4(glm::inverse(glm::dmat4(c.to_world)));
  finish(huge);
  const RenderOptions o = with_radius("photon", 0.2f, 4);  // less than its bound by the size of the scene
  const Picture a = render_once(room, o), b = render_once(huge, o);
  double apart = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i) apart += std::abs(double(a.pixels[i]) - double(b.pixels[i]));
  EXPECT_LT(apart / double(a.pixels.size()), 0.01 * mean(a));
}

// Radiance 1 / (1 - a) everywhere. Every wall meets others, so that discs hang over edges in many pixels.
TEST(Merging, KeepsTheEnergyOfAFurnace) {
  Material wall;
  wall.reflectance = Rgb(0.5f);
  for (const Oven oven : {Oven::box, Oven::sphere})
    for (const char* integrator : merging) {
      const Picture p = render_once(furnace(oven, wall, Rgb(1), 24), with_radius(integrator, 2, 24));
      EXPECT_NEAR(mean(p), 2, 0.013) << integrator << " oven " << int(oven);
    }
}

// Slabs that run into one another, and blocks that stand on the floor: floors go on inside of solids, where no light
// vertex can be. Radiance 1 / (1 - a) everywhere, as above.
Scene masonry(int size) {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  set_camera(scene, {0.1f, 0.9f, 0.1f}, {0, -1, 0}, 70, size, size);
  const uint32_t wall = add_diffuse(scene, Rgb(0.5f));
  const auto add = [&](const Vec3& low, const Vec3& high) {
    add_area_light(scene, add_box(scene, low, high, wall), Rgb(1));
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-1.0f, 1.0f}) {
      Vec3 low(-1.1f), high(1.1f);
      (side < 0 ? high : low)[axis] = side;
      add(low, high);
    }
  for (int block = 0; block < 49; ++block) {
    const Vec3 at(0.25f * float(block % 7 - 3), -1, 0.25f * float(block / 7 - 3));
    add(at - Vec3(0.06f), at + Vec3(0.06f));
  }
  finish(scene);
  return scene;
}

TEST(Merging, KeepsTheEnergyBetweenSolids) {
  EXPECT_NEAR(mean_of_seeds(masonry(64), with_radius("photon", 3, 24)), 2, 0.02);
}

// A wide floor under an even sky of 1; the camera sees the middle half of it.
Scene floor(Scene scene, uint32_t material) {
  scene.filter = make_filter(FilterKind::box);
  add_quad(scene, {-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, material);
  add_light(scene, LightKind::constant, Rgb(1));
  set_camera(scene, {0, 3, 0}, {0, 0, 0}, 67.4f, 32, 32);
  finish(scene);
  return scene;
}

// What keeps no light vertices is no part of the disc: nothing beside black tiles, mirrors and panes is dark for it.
TEST(Merging, KeepsTheEnergyBesideWhatIsBare) {
  for (const MaterialKind kind : {MaterialKind::diffuse, MaterialKind::conductor, MaterialKind::thindielectric}) {
    Scene scene;
    Material bare;
    bare.kind = kind, bare.reflectance = bare.specular = bare.transmittance = Slot(0.0f);
    Material tiles;
    tiles.kind = MaterialKind::blend;
    tiles.weight = add_checkerboard(scene, Rgb(0), Rgb(1));
    tiles.nested = {add_diffuse(scene, Rgb(0.6f)), add_material(scene, bare), none, none};
    const uint32_t material = add_material(scene, tiles);
    EXPECT_NEAR(mean_of_seeds(floor(std::move(scene), material), with_radius("photon", 3, 256)), 0.3, 0.006)
        << int(kind);
  }
}

// Nor what lies under a pane that does nothing, so near that darts begin above it. Discs are small there, and few light
// vertices in them.
TEST(Merging, KeepsTheEnergyUnderPanes) {
  Scene scene;
  Material pane;
  pane.kind = MaterialKind::thindielectric, pane.ior = 1.00001f;
  add_quad(scene, {-4, 0.002f, 4}, {8, 0, 0}, {0, 0, -8}, add_material(scene, pane));
  const uint32_t matt = add_diffuse(scene, Rgb(0.6f));
  EXPECT_NEAR(mean_of_seeds(floor(std::move(scene), matt), with_radius("photon", 3, 256)), 0.6, 0.1);
}

// The mean over blocks, where what merging blurs stays in its block, is that of bdpt once the radius is small.
TEST(Merging, ConvergesAsTheRadiusShrinks) {
  const Scene scene = cornell(24);
  const Estimate right = measure(scene, statistical("bdpt"), {8, 16, 1});
  for (const char* integrator : merging) {
    RenderOptions o = statistical(integrator);
    o.merge_radius = 0.2f;
    expect_same(measure(scene, o, {8, 16, 100}), right, integrator);
  }
}

// What gathers bring is what they leave out at the first vertex: caustics of glass, a floor whose boundary reflects
// sharply, and all else.
TEST(Merging, FinalGatherFindsTheSameLight) {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  set_camera(scene, {0, 0, 4.2f}, {0, -0.1f, 0}, 36, 24, 24);
  Material coated, glass;
  coated.kind = MaterialKind::plastic, glass.kind = MaterialKind::dielectric;
  add_open_room(scene, add_material(scene, coated));
  add_ceiling(scene);
  add_lamp(scene, 0.4f, Rgb(12, 10, 8));
  add_sphere(scene, {0.1f, -0.4f, 0.2f}, 0.5f, add_material(scene, glass));
  finish(scene);
  const Estimate right = measure(scene, statistical("bdpt"), {8, 32, 1});
  RenderOptions o = statistical("photon");
  o.merge_radius = 0.5f;
  for (const int rays : {1, 4}) {
    o.final_gather = rays;
    expect_same(measure(scene, o, {8, 16, 100}), right, std::to_string(rays) + " rays");
  }
}

// Whether one gather's merges are looked at says nothing of the next one's: one that finds what is bright is held
// against what those before it found. (With the same numbers for all of a sample's gathers a sixth too much was found.)
TEST(Merging, ManyGathersFindTheLightOfOne) {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  set_camera(scene, {0, 0, 0}, {0, -1, 0.01f}, 60, 24, 24);
  add_box(scene, Vec3(-1), Vec3(1), add_diffuse(scene, Rgb(0.6f)), true);
  add_lamp(scene, 0.2f, Rgb(1.5f));
  Light& spot = scene.lights[add_light(scene, LightKind::spot, Rgb(5))];
  spot.position = {0.5f, 0.2f, 0};
  spot.direction = glm::normalize(Vec3(-1.5f, 0.3f, 0.3f));
  spot.cutoff = 0.2f, spot.beam = 0.15f;
  add_quad(scene, {0, 0, 60}, {1, 0, 0}, {0, 1, 0}, 0);  // radii are bounded by the scene's
  finish(scene);
  RenderOptions o = statistical("photon");
  o.merge_radius = 9;
  const auto found = [&](int rays, int batches) {
    o.final_gather = rays;
    return ajar::mean(measure(scene, o, {batches, 4, 1}));
  };
  const double right = found(1, 48);
  EXPECT_NEAR(found(32, 12), right, 0.05 * right);
}

// Mean of squared relative differences to the right image.
double error_of(const Picture& p, const Estimate& right) {
  double sum = 0;
  for (size_t i = 0; i < p.pixels.size(); ++i)
    sum += sqr(double(p.pixels[i]) - right.mean[i]) / (sqr(right.mean[i]) + 1e-4);
  return sum / double(p.pixels.size());
}

// Areas shrink with the cube root of the passes, so that variance and squared bias fall as passes^(-2/3) while bias is
// most of the error, as with these radii of a sixth of the room; a radius that stays leaves the bias where it was.
TEST(Merging, ErrorFallsWithTheRadius) {
  Scene scene = cornell(24);
  const Estimate right = measure(scene, statistical("bdpt"), {8, 32, 1});
  add_quad(scene, {0, 0, 60}, {1, 0, 0}, {0, 1, 0}, 0);  // radii are bounded by the scene's
  finish(scene);
  for (const char* integrator : {"photon", "guided-vcm"}) {
    const double few = error_of(render_once(scene, with_radius(integrator, 4, 16)), right);
    const double many = error_of(render_once(scene, with_radius(integrator, 4, 256)), right);
    const double slope = std::log(many / few) / std::log(16.0);
    EXPECT_LT(slope, -0.35) << integrator;
  }
}

// Luminance of all that a strategy found, unweighted.
double raw(const RenderState& state, int s, int t) {
  double sum = 0;
  for (const glm::dvec3& pixel : state.pyramid.layers.at({s, t}).raw) sum += double(luminance(Rgb(pixel)));
  return sum;
}

// The light of paths comes by merges at any of their vertices as it comes by next-event estimation, though merges
// beyond the first vertex are with one light subpath in many, and left out where they would add little.
TEST(Merging, FindsWhatNextEventEstimationFinds) {
  Scene scene = cornell(24);
  add_quad(scene, {0, 0, 60}, {1, 0, 0}, {0, 1, 0}, 0);  // radii are bounded by the scene's
  finish(scene);
  const Accel accel(scene);
  RenderOptions o = with_radius("vcm", 4, 384);
  o.techniques = true;
  o.max_depth = 4;
  const RenderState state = rendered(scene, accel, o);
  double first = 0, beyond = 0, right_first = 0, right_beyond = 0;
  for (int edges = 2; edges <= 4; ++edges) {
    const double right = raw(state, 1, edges);
    first += raw(state, -edges, 2), right_first += right;
    for (int t = 3; t <= edges; ++t) beyond += raw(state, t - edges - 2, t), right_beyond += right;
  }
  EXPECT_NEAR(first, right_first, 0.03 * right_first);
  EXPECT_NEAR(beyond, right_beyond, 0.06 * right_beyond);
}

// One light subpath in twenty stops at the floor, and one dart in twenty.
TEST(Merging, SurfacesThatAreHardlyThereLoseNoLight) {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  set_camera(scene, {0, 3, 3}, {0, 0, 0}, 30, 32, 32);
  Material floor;
  floor.kind = MaterialKind::mask;
  floor.weight = Slot(0.05f), floor.nested[0] = add_diffuse(scene, Rgb(0.8f));
  add_quad(scene, {-4, 0, -4}, {0, 0, 8}, {8, 0, 0}, add_material(scene, floor));
  add_area_light(scene, add_quad(scene, {-0.5f, 2, -0.5f}, {1, 0, 0}, {0, 0, 1}, add_diffuse(scene, Rgb(0))), Rgb(5));
  finish(scene);
  const double right = mean(render_once(scene, with_radius("path", 0, 1024)));
  EXPECT_GT(right, 0.005);
  for (const char* integrator : {"vcm", "photon"})
    EXPECT_NEAR(mean(render_once(scene, with_radius(integrator, 5, 1024))), right, 0.1 * right) << integrator;
}

// Where a pixel is alone, in most passes no light subpath is kept for joins; those that are kept stand for all.
TEST(Merging, OnePixel) {
  const Scene scene = cornell(1);
  const double right = mean(render_once(scene, with_radius("bdpt", 0, 20000)));
  const double found = mean(render_once(scene, with_radius("vcm", 0.2f, 20000)));
  EXPECT_NEAR(found, right, 0.025 * right);
}

// What a rough mirror reflects is not blurred by more than its own lobe, however large the radius.
TEST(Merging, NarrowLobesStaySharp) {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  set_camera(scene, {0, 1, 2.5f}, {0, 0, 0}, 30, 24, 24);
  Material metal;
  metal.kind = MaterialKind::roughconductor;
  metal.alpha_u = metal.alpha_v = 0.05f;
  add_quad(scene, {-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, add_material(scene, metal));
  const uint32_t lamp = add_quad(scene, {-0.15f, 0.6f, -1.5f}, {0.3f, 0, 0}, {0, 0.3f, 0}, add_diffuse(scene, Rgb(0)));
  add_area_light(scene, lamp, Rgb(1));
  add_quad(scene, {0, 0, 60}, {1, 0, 0}, {0, 1, 0}, 0);  // radii are bounded by the scene's
  finish(scene);
  const Estimate right = measure(scene, statistical("bdpt", 3), {8, 16, 1});
  RenderOptions o = with_radius("photon", 12, 256);
  o.max_depth = 3;
  EXPECT_LT(error_of(render_once(scene, o), right), 0.1);
}

// A closed box, divided by a wall of no thickness or next to none, with a gap below it or none; the lamp shines in one
// half, the camera is in the other.
Scene divided(float thickness, float gap = 0) {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  const uint32_t grey = add_diffuse(scene, Rgb(0.7f));
  set_camera(scene, {-0.9f, 0, 0}, {0, 0, 0}, 90, 24, 24);
  add_box(scene, Vec3(-1), Vec3(1), grey, true);
  const float low = gap > 0 ? gap - 1 : -1.01f;
  if (thickness > 0) {
    add_box(scene, {-thickness, low, -1.01f}, {thickness, 1.01f, 1.01f}, grey);
  } else {
    Material both;
    both.kind = MaterialKind::twosided;
    both.nested[0] = both.nested[1] = grey;
    add_quad(scene, {0, low, -1.01f}, {0, 1.01f - low, 0}, {0, 0, 2.02f}, add_material(scene, both));
  }
  const uint32_t lamp = add_quad(scene, {0.3f, 0.9f, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}, grey);
  add_area_light(scene, lamp, Rgb(20));
  finish(scene);
  return scene;
}

TEST(Merging, ThinWallsLetNoLightThrough) {
  for (const float thickness : {0.0f, 1e-3f})
    for (const char* integrator : merging)
      EXPECT_EQ(mean(render_once(divided(thickness), with_radius(integrator, 3, 6))), 0) << integrator;
}

// A door does not touch the floor: what is lit before it must not be seen under it.
TEST(Merging, DoorsLetLittleLightUnderThem) {
  Scene scene = divided(0.01f, 0.005f);
  set_camera(scene, {-0.5f, -0.5f, 0}, {0, -1, 0}, 40, 24, 24);
  finish(scene);
  const double right = mean(render_once(scene, with_radius("bdpt", 0, 64)));
  // All that photon finds is merged.
  EXPECT_LT(mean(render_once(scene, with_radius("photon", 3, 32))), 1.5 * right);
}

// A camera that all but touches three walls. There the radius all but vanishes, and with it what photon finds.
TEST(Merging, CameraInACorner) {
  Scene scene = cornell(24);
  set_camera(scene, Vec3(-0.9999f, -0.9999f, -0.9999f), {0.5f, 0.2f, 0.4f}, 100, 24, 24);
  finish(scene);
  const double right = mean(render_once(scene, with_radius("bdpt", 0, 64)));
  for (const char* integrator : {"vcm", "guided-vcm"})
    EXPECT_NEAR(mean(render_once(scene, with_radius(integrator, 2, 64))), right, 0.04 * right) << integrator;
}

// Low light on cobbles: where they turn away from it nothing scatters, but what arrives there is as much as arrives
// beside it, and is merged there. (Without it a tenth of the light was missing.)
TEST(Merging, BentNormalsLoseNoLight) {
  LoadOptions options;
  options.defines = {{"resx", "64"}, {"resy", "36"}};
  const Scene scene = load_scene(source_path("scenes/bump/bump.xml"), options);
  const auto ground = [&](const char* integrator, uint32_t spp) {
    const Picture p = render_once(scene, with_radius(integrator, 3, spp));
    double sum = 0;
    for (int y = p.height / 2; y < p.height; ++y)
      for (int i = 0; i < 3 * p.width / 2; ++i) sum += double(p.pixels[size_t(y * p.width * 3 + i)]);
    return sum;
  };
  const double path = ground("path", 128);
  for (const char* integrator : {"vcm", "photon"}) EXPECT_NEAR(ground(integrator, 96) / path, 1, 0.025) << integrator;
}

TEST(Merging, NoLightIsBlack) {
  Scene scene = cornell(16);
  for (Shape& s : scene.shapes) s.light = none;
  scene.lights.clear();
  finish(scene);
  for (const char* integrator : merging)
    EXPECT_EQ(mean(render_once(scene, with_radius(integrator, 5))), 0) << integrator;
}

// Raw images of merges tell the same light as joins of as long paths.
TEST(Merging, IsCountedInTheLedger) {
  const Scene scene = cornell(24);
  const Accel accel(scene);
  const RenderState state = rendered(scene, accel, with_radius("photon", 3, 8));
  double energy = 0;
  for (const auto& row : state.stats.ledger.merges)
    for (const StrategyCost& c : row) energy += c.energy;
  const double seen = state.stats.ledger.strategies[0][2].energy;
  EXPECT_NEAR(energy + seen, total_energy(state.stats.ledger), 1e-6 * energy);
  EXPECT_GT(energy, 0);
}

}  // namespace
}  // namespace ajar
