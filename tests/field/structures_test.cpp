// Patches of the hemisphere, probes and their look-up, and lessons of fields that are built of them.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <set>

#include "ajar/core/sampler.h"
#include "ajar/field/learn.h"
#include "ajar/field/probes.h"
#include "ajar/scene/build.h"
#include "kit/stage.h"
#include "lesson.h"

namespace ajar {
namespace {

Scene room() {
  Scene scene = kit::stage(8);
  finish(scene);
  return scene;
}

LearnOptions options_of(Structure structure, size_t memory = size_t(2) << 20) {
  LearnOptions o;
  o.structure = structure, o.memory = memory;
  return o;
}

// Middle of a patch.
Vec3 towards(int zone, int segment) {
  const float z = (float(zone) + 0.5f) / zones, r = std::sqrt(1 - z * z);
  const float phi = 2 * pi * (float(segment) + 0.5f) / segments;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

// Fields with one cell whose frame is the world's.
Fields one_cell(Structure structure, Rule rule = Rule::expected) {
  Fields f = start_fields(room(), 64, options_of(structure));
  f.rule = rule;
  Sightings s;
  const Vec3 p(0.1f, -1, 0.2f), n(0, 1, 0);
  for (int i = 0; i < 4; ++i) record_missing(s, find(f.table, p, n).missing, n);
  f = learn(f, start_training(f), s, 1, {});
  EXPECT_EQ(f.cells.size(), 1u);
  f.cells[0].frame = {Vec3(1, 0, 0), Vec3(0, 1, 0), up};
  return f;
}

TEST(Patches, AreOfEqualAngle) {
  int hits[zones][segments] = {};
  double cosines[zones] = {};
  const int n = 288;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {  // equal areas of the hemisphere
      const float z = (float(i) + 0.5f) / n, phi = 2 * pi * (float(j) + 0.5f) / n, r = std::sqrt(1 - z * z);
      const Patch at = patch_of({r * std::cos(phi), r * std::sin(phi), z});
      ASSERT_TRUE(at.zone >= no_zones && at.zone < 16 && at.segment >= no_segments && at.segment < 16);
      ++hits[at.zone - no_zones][at.segment - no_segments];
      cosines[at.zone - no_zones] += z;
    }
  double sum = 0;
  for (int zone = 0; zone < zones; ++zone) {
    for (const int h : hits[zone]) EXPECT_EQ(h, n * n / (zones * segments));
    EXPECT_NEAR(patch_cosine(no_zones + zone), cosines[zone] * 2 * pi / (n * n) / segments, 1e-5);
    sum += segments * patch_cosine(no_zones + zone);
  }
  EXPECT_NEAR(sum, pi, 1e-5);
}

TEST(Patches, LessonsStayInTheirPatch) {
  for (const Structure structure : {Structure::grid, Structure::probes}) {
    const Fields blank = one_cell(structure);
    EXPECT_NEAR(pdf(blank, blank.q, 0, somewhere, towards(2, 7)), 1 / (2 * pi), 1e-4) << "knows nothing yet";
    Training t = start_training(blank);
    for (int zone = 0; zone < zones; ++zone)
      for (int s = 0; s < segments; ++s)
        record(blank, blank.q, t.q, 0, {somewhere, towards(zone, s), 1, zone == 4 && s == 3 ? 9.0f : 1.0f, 2});
    const Fields f = learn(blank, t, {}, 1, {});
    for (int zone = 0; zone < zones; ++zone)
      for (int s = 0; s < segments; ++s)
        EXPECT_FLOAT_EQ(f.q.mean[find_stratum(f, f.q, 0, towards(zone, s))], zone == 4 && s == 3 ? 9 : 1);
    const float cosine = patch_cosine(no_zones + 4), irradiance = pi + 8 * cosine;
    EXPECT_NEAR(f.q.cells[0].total, irradiance, 1e-4);
    EXPECT_EQ(f.q.nodes.size(), size_t(1 + zones)) << "patches do not divide";
    // 3 % of the mean are everywhere. Probes are sampled with the cosine, the grid without it.
    const float floor = 0.03f * irradiance / pi;
    const double share = structure == Structure::grid ? (9 + floor) / (8 + 72 * (1 + floor))
                                                      : (9 + floor) * cosine / (8 * cosine + pi * (1 + floor));
    EXPECT_NEAR(pdf(f, f.q, 0, somewhere, towards(4, 3)) * patch_angle, share, 2e-4);
    Sampler sampler = make_sampler(SamplerKind::independent, 3, Side::camera, 0, 0);
    double drawn = 0;
    for (int i = 0; i < 20000; ++i) {
      float p;
      const Vec3 w = sample(f, f.q, 0, somewhere, sampler.next2(), p);
      ASSERT_NEAR(glm::length(w), 1, 1e-5);
      EXPECT_NEAR(p, pdf(f, f.q, 0, somewhere, w), 1e-5f * p);
      drawn += glm::dot(w, towards(4, 3)) > 0.999f ? 1 / 20000.0 / p : 0;
    }
    EXPECT_NEAR(drawn, 2 * pi * 0.001, 6e-4) << "a small cap within the patch has its solid angle";
  }
}

TEST(Rules, MaxTakesTheBestForAll) {
  for (const Rule rule : {Rule::expected, Rule::max, Rule::returned}) {
    const Fields blank = one_cell(Structure::probes, rule);
    Training t = start_training(blank);
    record(blank, blank.q, t.q, 0, {somewhere, towards(4, 3), 1, 9, 2});
    record(blank, blank.q, t.q, 0, {somewhere, towards(1, 3), 1, 2, 2});
    record_direct(blank.q, t.q, 0, 5);
    const Fields f = learn(blank, t, {}, 1, {});
    EXPECT_EQ(f.rule, rule) << "goes from lesson to lesson";
    const float strata = rule == Rule::max ? 9 * pi : 9 * patch_cosine(no_zones + 4) + 2 * patch_cosine(no_zones + 1);
    EXPECT_NEAR(f.q.cells[0].total, 5 + strata, 1e-3);
  }
}

TEST(Rates, VisitsKeepAllEvidence) {
  LearnOptions visits;
  visits.forget = 1;
  Fields f = one_cell(Structure::grid);
  for (const float value : {1.0f, 2.0f, 6.0f}) {
    Training t = start_training(f);
    record(f, f.q, t.q, 0, {somewhere, towards(4, 3), 1, value, 1});
    f = learn(f, t, {}, 1, visits);
  }
  EXPECT_FLOAT_EQ(f.q.mean[find_stratum(f, f.q, 0, towards(4, 3))], 3) << "1 / (1 + visits) makes the mean of all";
}

TEST(Grid, HasOneSizeThatFitsTheMemory) {
  const Scene scene = room();
  for (const size_t memory : {size_t(256) << 10, size_t(1) << 20}) {
    Fields f = start_fields(scene, 64, options_of(Structure::grid, memory));
    Sampler sampler = make_sampler(SamplerKind::independent, 3, Side::camera, 0, 0);
    for (int pass = 0; pass < 3; ++pass) {
      Training t = start_training(f);
      Sightings s;
      for (int i = 0; i < 60000; ++i) {  // all six walls of the room
        const Vec2 u = 2.0f * sampler.next2() - 1.0f;
        const int axis = i % 3;
        const float side = i / 3 % 2 ? 1.0f : -1.0f;
        Vec3 p(side), n(0);
        p[(axis + 1) % 3] = u.x, p[(axis + 2) % 3] = u.y, n[axis] = -side;
        const Place at = find(f.table, p, n);
        if (at.missing) record_missing(s, at.missing, n);
        if (at.cell != none) record_visit(t.q, at.cell);
      }
      LearnOptions o = options_of(Structure::grid, memory);
      f = learn(f, t, s, 1, o);
    }
    EXPECT_GT(bytes(f) - bytes(f.views), memory / 2);
    EXPECT_LT(bytes(f), memory + 4096);
    EXPECT_LE(bytes(f.views), memory * 15 / 100);
    for (const Cell& c : f.cells) EXPECT_EQ(level_of(c.key), 0) << "visited often, never divided";
  }
}

// Two squares, of which one is four times as large; and the small one once more, twice as wide, as an instance.
TEST(Probes, AreSpreadByArea) {
  Scene scene;
  const uint32_t grey = add_diffuse(scene, Rgb(0.5f));
  add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 2, 0}, grey);
  add_quad(scene, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, grey);
  const uint32_t in_group = add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, grey);
  scene.groups = 1, scene.shapes[in_group].group = 0;
  add_instance(scene, 0, glm::scale(glm::translate(Mat4(1), Vec3(0, 0, 5)), Vec3(2)));
  add_sphere(scene, {9, 9, 9}, std::sqrt(3 / (4 * pi)), grey);
  finish(scene);
  double total = 0;
  const auto probes = place_probes(scene, 1200, total);
  EXPECT_NEAR(total, 4 + 1 + 4 + 3, 1e-4);
  ASSERT_EQ(probes.size(), 1200u);
  int in[4] = {}, quarters[4] = {};
  for (const Probe& p : probes) {
    EXPECT_NEAR(glm::length(p.n), 1, 1e-5);
    const int which = p.p.z > 8 ? 3 : p.p.z > 4 ? 2 : p.p.z > 0.5f ? 1 : 0;
    ++in[which];
    if (which == 2) {
      EXPECT_NEAR(p.p.z, 5, 1e-5);
    }
    if (which == 0) ++quarters[(p.p.x > 1) + 2 * (p.p.y > 1)];
    if (which == 3) {
      EXPECT_NEAR(glm::dot(p.n, glm::normalize(p.p - Vec3(9))), 1, 1e-4);
    }
  }
  EXPECT_NEAR(in[0], 400, 2);
  EXPECT_NEAR(in[1], 100, 2);
  EXPECT_NEAR(in[2], 400, 2);
  EXPECT_NEAR(in[3], 300, 2);
  for (const int q : quarters) EXPECT_NEAR(q, 100, 8) << "of low discrepancy";
}

TEST(Probes, TheNearestWithASimilarNormalAnswers) {
  const Fields f = start_fields(room(), 64, options_of(Structure::probes, size_t(1) << 20));
  const CellTable& t = f.table;
  ASSERT_GT(t.probes.size(), 300u);
  Sampler sampler = make_sampler(SamplerKind::independent, 9, Side::camera, 0, 0);
  int none_near = 0;
  std::set<CellKey> keys;
  for (int i = 0; i < 3000; ++i) {
    const Vec2 a = sampler.next2(), b = sampler.next2(), c = sampler.next2();
    const Vec3 p = 2.2f * Vec3(a, b.x) - 1.1f, n = glm::normalize(Vec3(b.y, c) - 0.5f);
    float best = sqr(4 * t.width);
    uint32_t nearest = none;
    for (uint32_t k = 0; k < t.probes.size(); ++k) {
      const float d2 = length2(t.probes[k].p - p);
      if (d2 < best && std::abs(glm::dot(t.probes[k].n, n)) > 0.8f) best = d2, nearest = k;
    }
    const Place at = find(t, p, n);
    EXPECT_EQ(at.cell, none);
    EXPECT_EQ(at.missing == 0, nearest == none);
    none_near += nearest == none;
    if (nearest == none) continue;
    keys.insert(at.missing);
    // The same as right at the probe, on that side of it.
    const Probe& probe = t.probes[nearest];
    const Vec3 side = glm::dot(probe.n, n) < 0 ? -probe.n : probe.n;
    EXPECT_EQ(find(t, probe.p, side).missing, at.missing);
    EXPECT_NE(find(t, probe.p, -side).missing, at.missing) << "its back is another";
  }
  EXPECT_GT(none_near, 300);
  EXPECT_GT(keys.size(), 200u);
}

TEST(Probes, ASceneWithoutSurfacesHasNone) {
  Scene empty;
  finish(empty);
  const Fields f = start_fields(empty, 64, options_of(Structure::probes));
  EXPECT_TRUE(f.table.probes.empty());
  EXPECT_EQ(find(f.table, somewhere, up).cell, none);
  EXPECT_TRUE(learn(f, start_training(f), {}, 1, {}).cells.empty());
}

}  // namespace
}  // namespace ajar
