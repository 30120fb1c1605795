// Subpaths through fields that have no share in the mixtures are unguided subpaths, to the bit.
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace ajar
