// The light tree: probabilities that add up and are those of what is drawn, nothing left out that shines, tiles, bounds
// of memory, and lights of all extremes.
#include <gtest/gtest.h>

#include "ajar/core/error.h"
#include "ajar/core/sampler.h"
#include "ajar/scene/build.h"
#include "kit/chisquare.h"
#include "lights.h"

namespace ajar {
namespace {

// Lamps of every shape, deltas, an environment with a sun, parallel light.
Scene zoo(LightChoice choice = LightChoice::tree) {
  Scene scene = many_lights(60, 4);
  Mesh lamp = kit::icosphere_like();
  for (Vec3& p : lamp.positions) p = 0.1f * p + Vec3(-0.5f, 0.3f, 0.2f);
  add_area_light(scene, add_mesh(scene, lamp, 0), Rgb(5));
  add_area_light(scene, add_sphere(scene, {0.4f, 0.1f, -0.3f}, 0.1f, 0), Rgb(3));
  for (const LightKind kind : {LightKind::point, LightKind::spot, LightKind::directional, LightKind::projector})
    scene.lights[add_light(scene, kind, Rgb(2))].position = {0.2f, 0.6f, float(kind) * 0.1f};
  std::vector<float> sky;
  for (int i = 0; i < 64 * 32 * 3; ++i) sky.push_back(i / 3 == 700 ? 4000 : 0.2f + 0.1f * float(i % 5));
  add_envmap(scene, add_image(scene, 64, 32, sky));
  add_light(scene, LightKind::constant, Rgb(0.1f));
  scene.lights[add_light(scene, LightKind::sun, Rgb(9e3f))].cone = 1e-5f;
  finish(scene);
  set_light_choice(scene, choice);
  return scene;
}

Receiver receiver(uint32_t i) {
  const Vec2 a = kit::random2(i, 1), b = kit::random2(i, 2), c = kit::random2(i, 3);
  const float z = 2 * c.x - 1, r = std::sqrt(1 - z * z), phi = 2 * pi * c.y;
  return {Vec3(a.x, a.y, b.x) * 1.8f - 0.9f, i % 4 == 0 ? Vec3(0) : Vec3(r * std::cos(phi), r * std::sin(phi), z)};
}

TEST(LightTree, ProbabilitiesAddUp) {
  for (const LightChoice choice : {LightChoice::tree, LightChoice::power, LightChoice::uniform}) {
    const Scene scene = zoo(choice);
    const LightTree& t = scene.light_tree;
    for (uint32_t i = 0; i < 50; ++i) {
      double sum = 0;
      for (uint32_t k = 0; k < t.pieces.size(); ++k) sum += double(choice_pdf(t, 0, receiver(i), k));
      ASSERT_LT(sum, 1 + 1e-4);
      ASSERT_GT(sum, 0.5) << "hardly anything may end where nothing shines";
      if (choice != LightChoice::tree) {
        ASSERT_NEAR(sum, 1, 1e-4);
      }
    }
  }
}

TEST(LightTree, DrawsWhatItSays) {
  const Scene scene = zoo();
  const LightTree& t = scene.light_tree;
  constexpr int n = 20'000;
  for (uint32_t i = 1; i < 5; ++i) {
    std::vector<int> drawn(t.pieces.size() + 1);
    for (int k = 0; k < n; ++k) {
      float u = (float(k) + 0.5f) / n, pdf;
      uint32_t place = uint32_t(t.pieces.size());
      if (choose(t, 0, receiver(i), u, place, pdf)) {
        ASSERT_TRUE(u >= 0 && u < 1);
        ASSERT_NEAR(pdf / choice_pdf(t, 0, receiver(i), place), 1, 1e-3);
      } else {
        place = uint32_t(t.pieces.size());
      }
      ++drawn[place];
    }
    for (uint32_t k = 0; k < t.pieces.size(); ++k)  // u goes through in order: off by one at either end
      ASSERT_NEAR(drawn[k], n * choice_pdf(t, 0, receiver(i), k), 2.5 + 1e-3 * n * choice_pdf(t, 0, receiver(i), k));
  }
}

TEST(LightTree, ForgetsNothingThatShines) {
  const Scene scene = zoo();
  const LightTree& t = scene.light_tree;
  int lit = 0;
  for (uint32_t i = 0; i < 100; ++i) {
    const Receiver at = receiver(i);
    for (uint32_t k = 0; k < t.pieces.size(); ++k) {
      DirectSample d;
      if (!sample_direct(scene, t.pieces[k], at.p, kit::random2(i, k + 9), d)) continue;
      if (at.n != Vec3(0) && !(glm::dot(at.n, d.wi) > 1e-3f)) continue;
      ++lit;
      ASSERT_GT(choice_pdf(t, 0, at, k), 0) << "light " << t.pieces[k].light << " part " << t.pieces[k].part;
      PieceDensity found[most_shares];
      const int n = densities_direct(scene, d.point, at.p, d.wi, found);
      float own = 0;
      for (int j = 0; j < n; ++j) own += found[j].place == k ? found[j].pdf : 0;
      if (is_tile(scene, t.pieces[k]))
        ASSERT_GT(own, 0);
      else
        ASSERT_NEAR(own / d.pdf, 1, d.point.infinite ? 0.02f : 2e-3f);
    }
  }
  EXPECT_GT(lit, 2000);
}

// Tiles in turns by power: the map's own density comes out.
TEST(LightTree, TilesFollowTheirDensity) {
  kit::ChiOptions o;
  o.samples = 30'000;
  o.rows = 8, o.columns = 16;
  for (const kit::LitScene& lit : kit::infinite_scenes()) {
    ++o.seed;
    const LightTree& t = lit.scene.light_tree;
    EXPECT_LE(t.pieces.size(), most_tiles);
    const auto r = kit::chi_square_sphere(
        [&](const Vec2& u, float extra) -> std::optional<Vec3> {
          DirectSample d;
          const uint32_t k = choose_by_power(t, 0, uint32_t(t.pieces.size()), extra);
          if (!sample_direct(lit.scene, t.pieces[k], Vec3(0), u, d)) return std::nullopt;
          return d.wi;
        },
        [&](const Vec3& w) {
          PieceDensity found[most_shares];
          const int n = densities_direct(lit.scene, light_point(lit.scene, 0, w), Vec3(0), w, found);
          double sum = 0;
          for (int i = 0; i < n; ++i)
            sum += double(found[i].pdf) * power_of(t, found[i].place, found[i].place + 1) / t.power_before.back();
          return sum;
        },
        o);
    EXPECT_TRUE(r.ok) << lit.name << ": " << r.message;
  }
}

// The sun gets tiles of its own.
TEST(LightTree, TilesDivideAtTheSun) {
  Scene scene = under_sky(LightKind::constant);
  std::vector<float> sky(256 * 128 * 3, 1e-3f);
  for (const int texel : {40 * 256 + 100, 40 * 256 + 101})
    for (int c = 0; c < 3; ++c) sky[size_t(texel) * 3 + size_t(c)] = 1e8f;
  scene.lights.clear();
  add_envmap(scene, add_image(scene, 256, 128, sky));
  finish(scene);
  const Tiling& t = scene.light_tree.tilings[0];
  const Tile& sun = t.tiles[tile_of(t, 100, 40)];
  EXPECT_LE((sun.high.x - sun.low.x) * (sun.high.y - sun.low.y), 2);
  double all = 0;
  for (uint32_t k = 0; k < scene.light_tree.pieces.size(); ++k) {
    const double p = power_of(scene.light_tree, k, k + 1);
    EXPECT_GT(p, 0);  // the sky is not forgotten beside it
    all += p;
  }
  const uint32_t place = place_of(scene.light_tree, 0, tile_of(t, 100, 40));
  EXPECT_GT(power_of(scene.light_tree, place, place + 1) / all, 0.3);
}

TEST(LightTree, StandsExtremes) {
  Scene black = under_sky(LightKind::constant);
  black.lights.clear();
  add_envmap(black, add_image(black, 8, 4, std::vector<float>(96, 0)));
  add_light(black, LightKind::point, Rgb(0));
  finish(black);
  EXPECT_TRUE(black.light_tree.nodes.empty());
  std::vector<float> bad(96, 1);
  bad[50] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(add_envmap(black, add_image(black, 8, 4, bad)), Error);

  Scene mixed = many_lights(40, 2);
  mixed.lights[3].radiance = Slot(0.0f);
  mixed.lights[4].radiance = Slot(1e30f), mixed.lights[5].radiance = Slot(1e-30f);
  mixed.lights[6].sampling_weight = 0;
  finish(mixed);
  const LightTree& t = mixed.light_tree;
  EXPECT_EQ(place_of(t, 3, none), none);
  EXPECT_NE(place_of(t, 6, none), none);  // light subpaths start there
  EXPECT_NE(place_of(t, 5, none), none);
  for (uint32_t i = 0; i < 200; ++i) {
    float u = kit::random2(i, 6).x, pdf;
    uint32_t place;
    EXPECT_EQ(choice_pdf(t, 0, receiver(i), place_of(t, 6, none)), 0);
    if (choose(t, 0, receiver(i), u, place, pdf)) {
      EXPECT_TRUE(pdf > 0 && pdf <= 1 && u < 1);
    }
  }
}

// Small lamps of every kind, ten above the floor, which shine down.
Scene small_lamps() {
  Scene scene;
  const uint32_t grey = add_diffuse(scene, Rgb(0.5f));
  add_area_light(scene, add_quad(scene, {0, 10, 0}, {0.1f, 0, 0}, {0, 0, 0.1f}, grey), Rgb(1));
  Mesh kite;
  kite.positions = {{3, 10, 0}, {3.1f, 10, 0.02f}, {3.1f, 10, 0.1f}, {3, 10, 0.05f}};
  kite.triangles = {{0, 1, 2}, {0, 2, 3}};
  add_area_light(scene, add_mesh(scene, kite, grey), Rgb(1));
  const Mat4 down = glm::rotate(glm::translate(Mat4(1), {-3, 10, 0}), pi / 2, Vec3(1, 0, 0));
  const Mat4 across = glm::translate(Mat4(1), {-6, 10, -0.05f});
  add_area_light(scene, add_quadric(scene, ShapeKind::disk, glm::scale(down, Vec3(0.1f)), grey), Rgb(1));
  add_area_light(scene, add_quadric(scene, ShapeKind::cylinder, glm::scale(across, Vec3(0.01f, 0.01f, 0.1f)), grey),
                 Rgb(1));
  add_area_light(scene, add_sphere(scene, {6, 10, 0}, 0.1f, grey), Rgb(1));
  int at = 3;
  for (const LightKind kind : {LightKind::point, LightKind::spot, LightKind::projector}) {
    Light& light = scene.lights[add_light(scene, kind, Rgb(1))];
    light.position = {0, 10, float(at)}, light.direction = {0, -1, 0};
    light.to_world = look_at(light.position, {0, 0, float(at)});
    light.cutoff = 0.1f, light.beam = 0.08f, light.plane = Vec2(0.05f);
    at += 3;
  }
  finish(scene);
  return scene;
}

// Where nothing stands between and a lamp is small, its promise is what comes: however narrow the cone that it shines
// into, lamps are chosen by what they bring.
TEST(LightTree, PromisesAreKept) {
  const Scene scene = small_lamps();
  const LightTree& t = scene.light_tree;
  ASSERT_EQ(t.pieces.size(), scene.lights.size());
  for (uint32_t n = 0; n < t.nodes.size(); ++n) {
    if (t.nodes[n].left != 0) continue;
    const LightPiece piece = t.pieces[t.nodes[n].first];
    Receiver at{t.nodes[n].center, {0, 1, 0}};
    at.p.y = 0;
    double brings = 0;
    constexpr uint32_t rays = 4096;
    for (uint32_t i = 0; i < rays; ++i) {
      DirectSample d;
      if (sample_direct(scene, piece, at.p, kit::random2(i, 5), d))
        brings += double(pi * luminance(d.radiance) * d.wi.y / d.pdf) / rays;
    }
    EXPECT_NEAR(double(importance(t, n, at)) / brings, 1, 0.02) << "light " << piece.light;
    at.p.x += 2;  // beside the cones
    const LightKind kind = scene.lights[piece.light].kind;
    EXPECT_EQ(importance(t, n, at) == 0, kind == LightKind::spot || kind == LightKind::projector) << piece.light;
  }
}

TEST(LightTree, BallsAreTight) {
  const Scene scene = small_lamps();
  const LightTree& t = scene.light_tree;
  for (const LightNode& n : t.nodes) {
    if (n.left != 0) continue;
    const Light& light = scene.lights[t.pieces[n.first].light];
    if (light.kind != LightKind::area || light.rectangle.area > 0) continue;
    if (scene.shapes[light.shape].kind == ShapeKind::mesh) continue;
    const float half = scene.shapes[light.shape].kind == ShapeKind::cylinder ? 0.06f : 0.1f;
    EXPECT_GE(n.radius, 0.05f);
    EXPECT_LT(n.radius, half * 1.01f);
  }
}

// Promises beyond the range of numbers: none of such lamps is forgotten.
TEST(LightTree, PromisesHaveASum) {
  Scene scene;
  for (int i = 0; i < 8; ++i)
    scene.lights[add_light(scene, LightKind::point, Rgb(1e37f))].position = {0.001f * float(i), 0, 0};
  finish(scene);
  const LightTree& t = scene.light_tree;
  const Receiver at{{0.02f, 0, 0}, Vec3(0)};
  double sum = 0;
  for (uint32_t k = 0; k < t.pieces.size(); ++k) sum += double(choice_pdf(t, 0, at, k));
  EXPECT_NEAR(sum, 1, 1e-4);
  for (uint32_t n = 0; n < t.nodes.size(); ++n) EXPECT_LE(importance(t, n, at), most_importance);
}

// Many at one place, and all alike: no deep recursion, every one has a chance.
TEST(LightTree, StandsLampsAtOnePlace) {
  Scene scene = many_lights(1, 2);
  for (int i = 0; i < 5000; ++i) scene.lights[add_light(scene, LightKind::point, Rgb(1))].position = {0.1f, 0.1f, 0.1f};
  finish(scene);
  const LightTree& t = scene.light_tree;
  ASSERT_EQ(t.pieces.size(), 5001u);
  for (uint32_t k = 0; k < t.pieces.size(); k += 500) EXPECT_GT(choice_pdf(t, 0, {{0, 0, 0.5f}, Vec3(0)}, k), 0);
}

TEST(LightTree, MemoryIsBounded) {
  Scene scene = many_lights(2, 2);
  Mesh mesh;  // more triangles than pieces may be
  for (uint32_t i = 0; i < most_pieces + 10; ++i) {
    const Vec3 at(float(i % 1000) * 1e-3f, 0.5f, float(i / 1000) * 1e-3f);
    for (const Vec3& d : {Vec3(0), Vec3(5e-4f, 0, 0), Vec3(0, 0, 5e-4f)}) mesh.positions.push_back(at + d);
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  add_area_light(scene, add_mesh(scene, std::move(mesh), 0), Rgb(1));
  finish(scene);
  EXPECT_EQ(scene.light_tree.pieces.size(), 3u);
  const Scene many = many_lights(2000, 2);
  EXPECT_GE(many.light_tree.pieces.size(), 2000u);
  EXPECT_LT(bytes(many.light_tree), many.light_tree.pieces.size() * 200);
}

}  // namespace
}  // namespace ajar
