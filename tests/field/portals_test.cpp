// Portals: where walls have them, how directions through them are drawn, and how they find their place.
#include "ajar/field/portals.h"

#include <gtest/gtest.h>

#include "ajar/core/sampler.h"
#include "ajar/core/warp.h"
#include "ajar/field/emission.h"
#include "ajar/field/learn.h"
#include "ajar/field/walls.h"
#include "ajar/scene/build.h"
#include "kit/chisquare.h"

namespace ajar {
namespace {

std::vector<CellCut> cuts_at(std::initializer_list<float> places, int axis) {
  std::vector<CellCut> cuts;
  for (const float x : places) cuts.push_back({x, axis, ~0, ~1});
  return cuts;
}

TEST(Portals, AreInThePlaneOfTheMostCuts) {
  std::vector<CellCut> cuts = cuts_at({0.29f, 0.3f, 0.31f, 0.9f, -2}, 2);
  const std::vector<CellCut> fewer = cuts_at({1, 1, 1, 1.01f}, 0);
  EXPECT_TRUE(find_portals(cuts, Vec3(0), 3, 1).empty()) << "three cuts are no wall";
  cuts.push_back({0.3f, 2, ~0, ~1}), cuts.push_back({0.305f, 2, ~0, ~1});
  cuts.insert(cuts.end(), fewer.begin(), fewer.end());
  const std::vector<Portal> found = find_portals(cuts, Vec3(0), 3, 1);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].axis, 2);
  EXPECT_NEAR(found[0].center.z, 0.3f, 0.02f);
  EXPECT_NEAR(found[0].radius, std::sqrt(9 - 0.09f), 0.02f) << "all of the plane that is in the scene's sphere";
  EXPECT_EQ(found[1].axis, 0);
}

TEST(Portals, RoomsBesideEachOtherHaveOneInTheirWall) {
  const Scene scene = two_rooms(5);
  CellTable table = make_cell_table(scene.center, scene.radius);
  cut_along_walls(scene, Accel(scene), table);
  ASSERT_FALSE(table.portals.empty());
  EXPECT_EQ(table.portals[0].axis, 2);
  EXPECT_NEAR(table.portals[0].wall, 0, 0.06f);
}

// A wall at x = 0 with a hole of 0.1 by 1 m whose middle is 0.12 m behind it, between a bright and a dark room. One
// cell on either side, 2 m away.
struct Hole : testing::Test {
  static constexpr float behind = 0.12f;
  const Vec3 middle{behind, 0.3f, -0.2f};
  Fields fields;

  void SetUp() override {
    fields.table = make_cell_table(Vec3(0), 6);
    fields.table.portals = find_portals(cuts_at({0, 0, 0, 0}, 0), Vec3(0), 6, fields.table.width);
    Sightings seen;
    for (const float x : {-2.0f, 2.0f})
      for (int i = 0; i < 4; ++i) {
        const Vec3 n(x < 0 ? 1 : -1, 0, 0);
        record_missing(seen, find(fields.table, {x, 0, 0}, n).missing, n);
      }
    add_portals(fields);
    fields = learn(fields, start_training(fields), seen, 1, {});
    ASSERT_EQ(fields.cells.size(), 2u);
  }
  bool is_open(const Vec3& p, const Vec3& w) const {
    const Vec3 at = p + (behind - p.x) / w.x * w - middle;
    return std::abs(at.y) < 0.5f && std::abs(at.z) < 0.05f;
  }
  // Through the doorway, but not past the leaf that stands 0.2 m behind it.
  bool ends_at_leaf(const Vec3& p, const Vec3& w) const {
    const Vec3 at = p - p.x / w.x * w - middle;
    return std::abs(at.y) < 0.8f && std::abs(at.z) < 0.5f;
  }
  uint32_t cell_at(const Vec3& p) const { return find(fields.table, p, {p.x < 0 ? 1 : -1, 0, 0}).cell; }

  // The room at x < 0 is dark but for what the hole lets in.
  void learn_from_paths(int lessons) {
    for (int l = 0; l < lessons; ++l) {
      Training training = start_training(fields);
      Sampler sampler = make_sampler(SamplerKind::independent, 1, Side::camera, 0, uint32_t(l));
      for (int i = 0; i < 20'000; ++i) {
        const Vec2 u = sampler.next2(), v = sampler.next2();
        const Vec3 p(i % 4 < 2 ? -2 : 2, u.x - 0.5f, u.y - 0.5f);
        const uint32_t cell = cell_at(p);
        if (cell == none) continue;
        const Frame& frame = fields.cells[cell].frame;
        float guided = 0;
        const Vec3 w = i % 2 ? sample(fields, fields.q, cell, p, v, guided) : frame.to_world(to_cosine_hemisphere(v));
        guided = pdf(fields, fields.q, cell, p, w);
        const float cosine = glm::dot(w, frame.n) * inv_pi;
        if (!(cosine > 0)) continue;
        const bool open = is_open(p, w);
        float value = (p.x < 0) == open ? 5.0f : 0.01f, distance = (open ? 4 : 1.95f) / std::abs(w.x);
        if (!open && p.x < 0 && ends_at_leaf(p, w)) value = 1, distance = 2.2f / w.x;
        record(fields, fields.q, training.q, cell, {p, w, distance, value, cosine / (0.5f * (guided + cosine))});
      }
      fields = learn(fields, training, {}, 1, {});
    }
  }
};

TEST_F(Hole, IsFoundByThePathsThroughIt) {
  learn_from_paths(6);
  EXPECT_NEAR(fields.table.portals[0].center.x, behind, 0.08f) << "points that see it lie close together, too";
  const Vec3 p(-2, 0.2f, 0.1f);
  const Opening o = opening(fields, fields.q, cell_at(p), p);
  EXPECT_GT(o.share, 0.3f);
  Sampler sampler = make_sampler(SamplerKind::independent, 2, Side::camera, 0, 0);
  int through = 0;
  for (int i = 0; i < 1000; ++i) through += is_open(p, sample(fields, fields.q, o, p, sampler.next2()));
  EXPECT_GT(through, 700) << "of a hole that takes up a thousandth of the disk";
}

TEST_F(Hole, IsOfNoUseWhereBehindItItIsDarker) {
  learn_from_paths(6);
  const Vec3 p(2, 0.2f, 0.1f);
  EXPECT_EQ(opening(fields, fields.q, cell_at(p), p).share, 0);
}

TEST_F(Hole, IsOfNoUseWithinItsPlane) {
  learn_from_paths(6);
  const Vec3 p(fields.table.portals[0].center.x, 0.2f, 0.1f);
  EXPECT_EQ(opening(fields, fields.q, cell_at({-2, 0, 0}), p).share, 0);
}

// Over the square of the portal's disk, where its strata are flat.
TEST_F(Hole, DirectionsAgreeWithTheirDensity) {
  learn_from_paths(6);
  const Portal& portal = fields.table.portals[0];
  for (const Vec3 p : {Vec3(-2, 0.2f, 0.1f), Vec3(-2, 0.7f, 0.5f)}) {
    const uint32_t cell = cell_at(p);
    const Opening o = opening(fields, fields.q, cell, p);
    ASSERT_GT(o.share, 0);
    const auto r = kit::chi_square_square(
        [&](const Vec2& u) -> std::optional<Vec2> {
          float density;
          const Vec3 w = sample(fields, fields.q, cell, p, u, density);
          EXPECT_NEAR(density, pdf(fields, fields.q, cell, p, w), 1e-3f * density);
          Crossing at;
          if (!(density > 0) || !cross(portal, 0, p, w, at)) return std::nullopt;
          return at.square;
        },
        [&](const Vec2& square) {
          const Vec3 disk = from_square(square);
          const Vec3 to = portal.center + portal.radius * Vec3(0, disk.x, disk.y) - p;
          const float d2 = glm::dot(to, to), cosine = std::abs(to.x) / std::sqrt(d2);
          const Vec3 w = to / std::sqrt(d2);
          const float square_per_disk = square_density({disk.x, disk.y, 1});
          return double(pdf(fields, fields.q, cell, p, w)) * cosine / d2 * sqr(portal.radius) / square_per_disk;
        },
        {.rows = 64, .columns = 64, .samples = 200'000, .quadrature = 4, .level = 1e-6});
    EXPECT_TRUE(r.ok) << r.message;
  }
}

// A lamp whose normal is not its cell's: directions through the portal that fall below the cell's horizon are none,
// also where they leave the lamp. (Kept, they shone with the density of the lamp's own cosine alone: doors let 2 % too
// much of a round lamp's light through.)
TEST_F(Hole, LampsShineAsTheyAreSampled) {
  learn_from_paths(6);
  fields.w = fields.q;
  Scene scene;
  add_area_light(scene, add_quad(scene, {-2, 0.2f, 0.1f}, {0, 0.01f, 0}, {0, 0, 0.01f}, add_diffuse(scene, Rgb(0))),
                 Rgb(1));
  finish(scene);
  Cell& cell = fields.cells[cell_at({-2, 0.2f, 0.1f})];
  for (const Vec3 n : {Vec3(1, 0, 0), Vec3(0.3f, 1, 0.4f), Vec3(0.3f, -1, 0.4f)}) {
    cell.frame = make_frame(glm::normalize(n));
    Sampler sampler = make_sampler(SamplerKind::independent, 4, Side::light, 0, 0);
    constexpr int samples = 100'000;
    double sum = 0;
    for (int i = 0; i < samples; ++i) {
      EmissionSample e;
      const Vec2 u = sampler.next2(), v = sampler.next2();
      if (sample_emission(scene, &fields, 0.5f, u, v, e)) sum += double(e.direction.x * inv_pi / e.pdf_direction);
    }
    EXPECT_NEAR(sum / samples, 1, 0.03) << n.y;
  }
}

}  // namespace
}  // namespace ajar
