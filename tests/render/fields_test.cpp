// Fields frozen in the middle of learning: what samples them agrees with the densities that are claimed, on both sides,
// and each side knows the density with which the other would have gone its way.
#include <gtest/gtest.h>

#include <numeric>

#include "ajar/field/emission.h"
#include "ajar/scene/build.h"
#include "kit/chisquare.h"
#include "kit/stage.h"
#include "measure.h"

namespace ajar {
namespace {

struct Stage {
  const char* name;
  Scene (*make)();
  Structure structure = Structure::adaptive;
  bool through = false;  ///< of vertices that are guided, those that let light through are looked at
};
void PrintTo(const Stage& s, std::ostream* out) { *out << s.name; }

// All light that it stops goes through; its cells hold more of it than one plane.
Scene with_shade() {
  Scene room = kit::stage();
  Material leaf;
  leaf.kind = MaterialKind::difftrans, leaf.transmittance = Slot(0.8f);
  add_sphere(room, {0.1f, -0.1f, 0.1f}, 0.6f, add_material(room, leaf));
  finish(room);
  return room;
}

// A sheet across the room.
Scene divided_by_paper() {
  Scene room = kit::stage();
  add_quad(room, {-0.95f, -0.9f, 0.35f}, {1.8f, 0, 0.2f}, {0.1f, 1.7f, 0}, kit::add_paper(room, Rgb(0.7f)));
  finish(room);
  return room;
}

const Stage stages[] = {{"two_rooms", [] { return two_rooms(20); }},
                        {"cornell", [] { return cornell(); }},
                        {"glass_ball", [] { return glass_ball(); }},
                        {"bump_plane", [] { return bump_plane(); }},
                        {"rough_plastic", [] { return with_material(MaterialKind::roughplastic, 0.4f); }},
                        {"mask", [] { return with_material(MaterialKind::mask); }},
                        {"paper", divided_by_paper, Structure::adaptive, true},
                        {"shade", with_shade, Structure::adaptive, true},
                        {"grid", [] { return two_rooms(20); }, Structure::grid},
                        {"probes", [] { return two_rooms(20); }, Structure::probes}};

// A vertex that scatters, as it was found.
struct Spot {
  Surface surface;
  Vec3 wo;
  Side side;
};

// Emission is guided where the lamp itself scatters.
Scene with_grey_lamp(Scene scene) {
  scene.shapes[scene.lights[0].shape].material = add_diffuse(scene, Rgb(0.3f));
  finish(scene);
  return scene;
}

struct Trained {
  Scene scene;
  Accel accel;
  bool through;
  RenderState state;

  explicit Trained(const Stage& s) : scene(with_grey_lamp(s.make())), accel(scene), through(s.through) {
    RenderOptions o = statistical("guided-bdpt");
    o.spp = 7;  // all of them young: learning would go on
    o.learn.trust = 8, o.learn.divide_cell = 400, o.learn.least_contrast = 1;
    o.learn.structure = s.structure;
    state = rendered(scene, accel, o);
  }
  const Fields& fields() const { return state.learning.fields; }
};

// Guided subpaths of both sides; every vertex where a field has a share, of those that let light through if that is
// asked.
std::vector<Spot> vertices_of(const Trained& t, int most) {
  std::vector<Spot> out;
  WalkOptions options;
  options.fields = &t.fields();
  Subpath path;
  Walk walk;
  Surface surface;
  for (uint64_t i = 0; i < 4000 && int(out.size()) < most; ++i)
    for (const Side side : {Side::camera, Side::light}) {
      Sampler sampler = make_sampler(SamplerKind::independent, 77, side, i, 0);
      if (side == Side::camera)
        start_camera(t.scene, sampler.next2() * Vec2(float(t.scene.camera.width)), Vec2(0.5f), path, walk);
      else if (!start_light(t.scene, options, sampler, path, walk))
        continue;
      while (path.n < 6 && step(t.scene, t.accel, options, path, walk, surface)) {
        const Guide& g = path[path.n - 1].guide;
        const bool asked = t.through == (g.far_cell != none) && g.near.bsdf < 1;
        if (asked && !g.blocked) out.push_back({surface, g.wo, side});
        if (!scatter(options, sampler, path, walk)) break;
      }
    }
  return out;
}

Guide guide_at(const Trained& t, Side side, const Surface& surface, const Vec3& wo) {
  Guide g;
  make_guide(t.scene, &t.fields(), side, surface, wo, g);
  return g;
}

constexpr kit::ChiOptions chi_options{.rows = 16, .columns = 32, .samples = 60'000, .quadrature = 4, .level = 1e-6};

// A cell's hemisphere as a square, over which its strata are flat and its field's density is measured.
Vec2 flat(const Fields& f, const Vec3& local) {
  if (f.structure == Structure::adaptive) return to_square(local);
  const float turn = std::atan2(local.y, local.x) / (2 * pi);
  return glm::clamp(Vec2(turn < 0 ? turn + 1 : turn, local.z), Vec2(0), Vec2(one_minus_epsilon));
}
Vec3 unflat(const Fields& f, const Vec2& at) {
  if (f.structure == Structure::adaptive) return from_square(at);
  const float r = safe_sqrt(1 - at.y * at.y);
  return {r * std::cos(2 * pi * at.x), r * std::sin(2 * pi * at.x), at.y};
}
float flat_density(const Fields& f, const Vec3& local) {
  return f.structure == Structure::adaptive ? square_density(local) : 1 / (2 * pi);
}

class LearnedFields : public testing::TestWithParam<Stage> {};

TEST_P(LearnedFields, SampleAgreesWithDensity) {
  const Trained t(GetParam());
  const Fields& f = t.fields();
  ASSERT_GT(f.cells.size(), 20u);
  int divided = 0;
  const bool patches = f.structure != Structure::adaptive;
  const int rows = patches ? 3 * zones : 32, columns = patches ? 3 * segments : 32;
  for (const Side side : {Side::camera, Side::light}) {
    const Field& field = f.of(side);
    std::vector<uint32_t> trusted(f.cells.size());
    std::iota(trusted.begin(), trusted.end(), 0u);
    std::sort(trusted.begin(), trusted.end(),
              [&](uint32_t a, uint32_t b) { return field.cells[a].mix > field.cells[b].mix; });
    for (uint32_t k = 0; k < 6; ++k) {
      // Three of the most trusted, three of all.
      const uint32_t cell = k < 3 ? trusted[k] : uint32_t((k - 3) * f.cells.size() / 3);
      divided += field.nodes[field.cells[cell].root].divided != 0;
      // The strata are over the cell's own hemisphere; there the map is measured in the square, where they are flat but
      // for the way from the cell's centre to a point beside it.
      const float edge = f.table.edge(level_of(f.cells[cell].key));
      const Vec3 beside = f.cells[cell].center + edge * (0.4f * f.cells[cell].frame.s - 0.3f * f.cells[cell].frame.t);
      const auto r = kit::chi_square_square(
          [&](const Vec2& u) -> std::optional<Vec2> {
            float p;
            const Vec3 w = sample(f, field, cell, beside, u, p);
            if (!(p > 0)) return std::nullopt;
            EXPECT_NEAR(glm::length(w), 1, 1e-5);
            return flat(f, f.cells[cell].frame.to_local(w));
          },
          [&](const Vec2& at) {
            const Vec3 local = unflat(f, at);
            return double(pdf(f, field, cell, beside, f.cells[cell].frame.to_world(local)) / flat_density(f, local));
          },
          {.rows = rows, .columns = columns, .samples = 60'000, .quadrature = 16, .level = 1e-6});
      EXPECT_TRUE(r.ok) << "cell " << cell << ": " << r.message;
    }
  }
  EXPECT_GT(divided, 3) << "cells without divided strata prove little";
}

TEST_P(LearnedFields, GuideSamplesItsDensity) {
  const Trained t(GetParam());
  const auto places = vertices_of(t, 400);
  ASSERT_GT(places.size(), 100u);
  kit::ChiOptions options = chi_options;
  // Densities that jump: between patches, and where the horizon cuts through a bent hemisphere.
  const bool jumps = GetParam().structure != Structure::adaptive || GetParam().name == std::string("bump_plane");
  options.quadrature = jumps ? 32 : 16;  // strata that hold a caustic are narrower than a bin
  for (size_t k = 0; k < 6; ++k) {
    const Spot& at = places[k * places.size() / 6];
    const Mode mode = at.side == Side::camera ? Mode::radiance : Mode::importance;
    const Guide g = guide_at(t, at.side, at.surface, at.wo);
    int off = 0, smooth = 0, delta = 0;
    const auto r = kit::chi_square_sphere(
        [&](const Vec2& u, float u_lobe) -> std::optional<Vec3> {
          GuideSample s;
          if (!sample(g, u_lobe, u, mode, s)) return std::nullopt;
          if (s.delta) return ++delta, std::nullopt;
          const GuideEval e = evaluate(g, s.wi, mode);
          ++smooth;
          const float weight = luminance(s.weight) * s.pdf, f = luminance(e.f_cos);
          off += std::abs(e.pdf - s.pdf) > 1e-3f * s.pdf || std::abs(weight - f) > 1e-3f * f + 1e-6f ||
                 std::abs(e.pdf_reverse - s.pdf_reverse) > 1e-3f * s.pdf_reverse;
          return s.wi;
        },
        // A lobe that samples below the horizon there gives nothing: draws and densities are compared above alone.
        [&](const Vec3& w) { return double(evaluate(g, w, mode).pdf); }, options);
    EXPECT_TRUE(r.p > chi_options.level) << (at.side == Side::camera ? "camera: " : "light: ") << r.message;
    EXPECT_NEAR(r.mass, r.drawn, 0.02) << r.message;
    EXPECT_LT(off, 60 + smooth / 200) << "of " << smooth << ": evaluate and sample disagree";
  }
}

// The density of the way back that one side claims is the one that the other side samples with.
TEST_P(LearnedFields, EachSideKnowsTheOther) {
  const Trained t(GetParam());
  Sampler sampler = make_sampler(SamplerKind::independent, 5, Side::camera, 0, 0);
  int compared = 0, guided = 0, off = 0;
  for (const Spot& at : vertices_of(t, 3000)) {
    const Side other = at.side == Side::camera ? Side::light : Side::camera;
    const Mode mode = at.side == Side::camera ? Mode::radiance : Mode::importance,
               back_mode = at.side == Side::camera ? Mode::importance : Mode::radiance;
    const Guide g = guide_at(t, at.side, at.surface, at.wo);
    GuideSample s;
    const float u_lobe = sampler.next1();
    if (!sample(g, u_lobe, sampler.next2(), mode, s)) continue;
    const Guide h = guide_at(t, other, at.surface, s.wi);
    float expected = 0;
    if (s.delta) {
      GuideSample r;
      for (int i = 0; i < 64 && expected == 0; ++i)
        if (sample(h, (float(i) + 0.5f) / 64, Vec2(0.5f), back_mode, r) && r.delta && glm::dot(r.wi, at.wo) > 0.9999f)
          expected = r.pdf;
    } else {
      expected = evaluate(h, at.wo, back_mode).pdf;
      const GuideEval e = evaluate(g, s.wi, mode);
      off += std::abs(e.pdf_reverse - s.pdf_reverse) > 1e-3f * s.pdf_reverse;
    }
    ++compared;
    guided += h.near.bsdf < 1 && g.near.bsdf < 1;
    off += std::abs(s.pdf_reverse - expected) > 1e-3f * std::max(expected, 1e-4f);
  }
  EXPECT_GT(guided, 300);
  EXPECT_LE(off, compared / 200) << "of " << compared;
}

TEST_P(LearnedFields, GuidedEmissionSamplesItsDensity) {
  const Trained t(GetParam());
  const Fields* f = &t.fields();
  ASSERT_EQ(t.scene.lights.size(), 1u);
  EmissionSample first;
  ASSERT_TRUE(sample_emission(t.scene, f, 0.5f, {0.4f, 0.7f}, {0.5f, 0.5f}, first));
  ASSERT_NE(find(f->table, first.point.p, first.point.n).cell, none);
  EXPECT_GT(f->w.cells[find(f->table, first.point.p, first.point.n).cell].mix, 0.1f);
  int off = 0, moved = 0;
  const auto r = kit::chi_square_sphere(
      [&](const Vec2& u, float) -> std::optional<Vec3> {
        EmissionSample e;
        if (!sample_emission(t.scene, f, 0.5f, {0.4f, 0.7f}, u, e)) return std::nullopt;
        const EmissionPdf p = pdf_emission(t.scene, f, e.point, e.direction);
        const EmissionPdf bare = pdf_emission(t.scene, e.point, e.direction);
        off += std::abs(p.direction - e.pdf_direction) > 1e-3f * p.direction;
        moved += std::abs(p.direction - bare.direction) > 0.05f * bare.direction;
        EXPECT_EQ(p.position, bare.position);
        return e.direction;
      },
      [&](const Vec3& w) { return double(pdf_emission(t.scene, f, first.point, w).direction); }, chi_options);
  EXPECT_TRUE(r.p > chi_options.level) << r.message;
  EXPECT_NEAR(r.mass, r.drawn, 0.01) << r.message;
  EXPECT_LE(off, chi_options.samples / 200);
  EXPECT_GT(moved, chi_options.samples / 10) << "hardly guided: the test means little";
}

// Next-event rays find the lamp through the paper, too: its light is of the lit side all the same.
TEST(LearnedFieldsOf, WhatLampsBringIsOfTheSideThatTheyAreOn) {
  const Trained t({"halves", kit::lit_through_paper});
  const auto direct = [&](float side) {
    const uint32_t cell = find(t.fields().table, {0, 0.2f, 0.1f}, {side, 0, 0}).cell;
    return cell == none ? -1 : t.fields().q.cells[cell].direct;
  };
  EXPECT_GT(direct(-1), 0);
  EXPECT_EQ(direct(1), 0);
}

TEST(LearnedFieldsOf, EvenLampsAreLeftAlone) {
  const Trained t(stages[0]);
  Fields even = t.fields();
  for (FieldCell& cell : even.w.cells) cell.even = 1;
  Sampler sampler = make_sampler(SamplerKind::independent, 3, Side::light, 0, 0);
  int guided = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec2 u = sampler.next2(), v = sampler.next2();
    EmissionSample e;
    ASSERT_TRUE(sample_emission(t.scene, &t.fields(), 0.5f, u, v, e));
    guided += e.pdf_direction != pdf_emission(t.scene, e.point, e.direction).direction;
    ASSERT_TRUE(sample_emission(t.scene, &even, 0.5f, u, v, e));
    const double bare = pdf_emission(t.scene, e.point, e.direction).direction;
    EXPECT_NEAR(e.pdf_direction, bare, 1e-5 * bare);
    EXPECT_EQ(pdf_emission(t.scene, &even, e.point, e.direction).direction, bare);
  }
  EXPECT_GT(guided, 900) << "the others would be";
}

INSTANTIATE_TEST_SUITE_P(Scenes, LearnedFields, testing::ValuesIn(stages),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace ajar
