// What subpaths teach, and how fields without a share in the mixtures guide: not at all, to the bit.
#include <gtest/gtest.h>

#include "ajar/core/warp.h"
#include "kit/stage.h"
#include "train.h"

namespace ajar {
namespace {

// Subpaths that differ in any vertex, of n of either side. No roulette: the fields' own asks other questions.
int different(const Scene& scene, const Fields& fields, int n) {
  const Accel accel(scene);
  WalkOptions bare, guided;
  bare.roulette_from = guided.roulette_from = 100;
  guided.fields = &fields, guided.window = infinity;
  Subpath a, b;
  int count = 0;
  for (int i = 0; i < n; ++i)
    for (const Side side : {Side::camera, Side::light}) {
      trace_subpath(scene, accel, bare, side, uint64_t(i), 99, 8, a);
      trace_subpath(scene, accel, guided, side, uint64_t(i), 99, 8, b);
      bool same = a.n == b.n;
      for (int k = 0; same && k < a.n; ++k)
        same = a[k].p == b[k].p && a[k].beta == b[k].beta && a[k].own == b[k].own && a[k].sum == b[k].sum;
      count += !same;
    }
  return count;
}

TEST(Guided, NoMixIsUnguided) {
  Scene scene = kit::stage();
  Material glossy, glass;
  glossy.kind = MaterialKind::roughplastic, glass.kind = MaterialKind::dielectric;
  add_sphere(scene, {0.4f, -0.6f, 0.2f}, 0.4f, add_material(scene, glossy));
  add_sphere(scene, {-0.4f, -0.6f, 0.3f}, 0.35f, add_material(scene, glass));
  finish(scene);
  EXPECT_EQ(different(scene, train(scene, Accel(scene), 5, 2000, 0), 2000), 0);
  EXPECT_GT(different(scene, train(scene, Accel(scene)), 2000), 2000) << "with a mix they differ";
}

// A floor under a lamp as wide as the sky, with black slats before half of it or without.
Scene under_slats(bool slats) {
  Scene scene;
  const uint32_t grey = add_diffuse(scene, Rgb(0.5f)), black = add_diffuse(scene, Rgb(0));
  add_quad(scene, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, grey);
  add_area_light(scene, add_quad(scene, {-4, 1, -4}, {8, 0, 0}, {0, 0, 8}, black), Rgb(1));
  for (float x = -4; slats && x < 4; x += 0.04f) add_box(scene, {x, 0.2f, -4}, {x + 0.02f, 0.2001f, 4}, black);
  set_camera(scene, {0, 0.1f, 0.9f}, Vec3(0), 60, 24, 24);
  finish(scene);
  return scene;
}

// What scatters nothing is known to: a field that only learned of rays that find something would be as bright as
// without the slats.
TEST(Guided, BlackSurfacesTeachZeros) {
  const auto brings = [](bool slats) {
    const Scene scene = under_slats(slats);
    const Fields fields = train(scene, Accel(scene), 4, 4000, 0);
    const uint32_t cell = find(fields.table, Vec3(0), Vec3(0, 1, 0)).cell;
    return cell == none ? 0 : fields.q.cells[cell].total;
  };
  const float open = brings(false);
  EXPECT_GT(open, 0);
  EXPECT_NEAR(brings(true) / open, 0.5, 0.15);
}

// Irradiance at a point by paths that scatter evenly, without the fields.
double irradiance(const Scene& scene, const Accel& accel, const Vec3& p, const Vec3& n, int paths) {
  double sum = 0;
  for (int i = 0; i < paths; ++i) {
    Sampler sampler = make_sampler(SamplerKind::independent, 9, Side::camera, uint64_t(i), 0);
    Vec3 o = p + 1e-4f * n, d = make_frame(n).to_world(to_cosine_hemisphere(sampler.next2()));
    double beta = pi;
    for (int k = 0; k < 40; ++k) {
      Hit hit;
      if (!accel.intersect(o, d, 0, infinity, hit)) break;
      const Surface surface = make_surface(scene, hit, o, d);
      if (scene.shapes[surface.shape].light != none && glm::dot(surface.ng, d) < 0) sum += beta;
      Guide guide;
      make_guide(scene, nullptr, Side::camera, surface, -d, guide);
      GuideSample s;
      const float u_lobe = sampler.next1();
      if (!sample(guide, u_lobe, sampler.next2(), Mode::radiance, s)) break;
      beta *= luminance(s.weight);
      o = offset(surface.p, surface.ng, surface.error, s.wi), d = s.wi;
    }
  }
  return sum / paths;
}

// What is lit from behind is as bright as that makes it: else all that a field knows of the dark half is nothing.
TEST(Guided, PaperIsAsBrightAsWhatIsBehindIt) {
  const Scene scene = kit::lit_through_paper();
  const Accel accel(scene);
  const Fields fields = train(scene, accel, 40, 4000, 0);
  double known[2] = {}, true_[2] = {};
  for (int i = 0; i < 24; ++i) {
    const Vec3 floor((i % 2 ? 0.15f : -0.15f) * float(1 + i % 6), -1, 0.35f * float(i / 6) - 0.5f), up(0, 1, 0);
    const uint32_t cell = find(fields.table, floor, up).cell;
    ASSERT_NE(cell, none);
    known[i % 2] += fields.q.cells[cell].total, true_[i % 2] += irradiance(scene, accel, floor, up, 2000);
  }
  EXPECT_NEAR((known[1] / known[0]) / (true_[1] / true_[0]), 1, 0.3);
}

}  // namespace
}  // namespace ajar
