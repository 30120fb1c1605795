// Nanoseconds per call of eval (value and both densities), sample and resolve for single bsdfs, over varied directions.
#include <benchmark/benchmark.h>

#include <vector>

#include "ajar/core/sampler.h"
#include "ajar/core/warp.h"
#include "ajar/scene/bsdf.h"
#include "ajar/scene/scene.h"

namespace {

using namespace ajar;

constexpr size_t count = 1024;

struct Inputs {
  Scene scene;
  Surface surface;
  Bsdf bsdf;
  std::vector<Vec3> wo, wi;
  std::vector<Vec3> u;

  explicit Inputs(MaterialKind kind) {
    Material m;
    m.kind = kind;
    m.distribution = Microfacet::ggx;
    m.alpha_u = m.alpha_v = 0.2f;
    m.eta = {0.2f, 0.9f, 1.5f};
    m.k = {3.9f, 2.4f, 1.9f};
    scene.materials = {m};
    scene.shapes.resize(1);
    prepare_materials(scene);
    surface.shape = 0;
    resolve(scene, surface, {0, 0, 1}, surface.frame, bsdf);
    Sampler sampler = make_sampler(SamplerKind::independent, 1, Side::camera, 0, 0);
    for (size_t i = 0; i < count; ++i) {
      wo.push_back(to_cosine_hemisphere(sampler.next2()));
      wi.push_back(to_cosine_hemisphere(sampler.next2()));
      u.emplace_back(sampler.next2(), sampler.next1());
    }
  }
};

void eval_bsdf(benchmark::State& state, MaterialKind kind) {
  const Inputs in(kind);
  size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(eval(in.bsdf, in.wo[i], in.wi[i], Mode::radiance));
    i = (i + 1) % count;
  }
}

void sample_bsdf(benchmark::State& state, MaterialKind kind) {
  const Inputs in(kind);
  BsdfSample s;
  size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(sample(in.bsdf, in.wo[i], in.u[i].z, Vec2(in.u[i]), Mode::radiance, s));
    benchmark::DoNotOptimize(s);
    i = (i + 1) % count;
  }
}

void resolve_bsdf(benchmark::State& state, MaterialKind kind) {
  Inputs in(kind);
  size_t i = 0;
  for (auto _ : state) {
    resolve(in.scene, in.surface, in.wo[i], in.surface.frame, in.bsdf);
    benchmark::DoNotOptimize(in.bsdf);
    i = (i + 1) % count;
  }
}

#define AJAR_BENCH(kind)                                    \
  BENCHMARK_CAPTURE(eval_bsdf, kind, MaterialKind::kind);   \
  BENCHMARK_CAPTURE(sample_bsdf, kind, MaterialKind::kind); \
  BENCHMARK_CAPTURE(resolve_bsdf, kind, MaterialKind::kind)

AJAR_BENCH(diffuse);
AJAR_BENCH(roughconductor);
AJAR_BENCH(dielectric);
AJAR_BENCH(roughdielectric);
AJAR_BENCH(plastic);
AJAR_BENCH(roughplastic);
AJAR_BENCH(phong);
AJAR_BENCH(principled);

}  // namespace

BENCHMARK_MAIN();
