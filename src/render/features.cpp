#include <fmt/format.h>

#include "ajar/accel/sight.h"
#include "ajar/core/error.h"
#include "ajar/core/parallel.h"
#include "ajar/core/sampler.h"
#include "ajar/field/guide.h"
#include "ajar/render/render.h"

namespace ajar {
namespace {

constexpr int channels = 9;

void add_first_hit(const Scene& scene, const Accel& accel, const Vec2& raster, const Vec2& lens, float share,
                   float* out) {
  const CameraRay ray = generate(scene.camera, raster, lens);
  Hit hit;
  if (!first_seen(scene, accel, ray, hit)) return;
  Guide guide;
  const Surface surface = make_surface(scene, hit, ray.o, ray.d);
  make_guide(scene, nullptr, Side::camera, surface, -ray.d, guide);
  const Vec3 values[] = {albedo(guide.bsdf, guide.wo_local), guide.frame.n, surface.p};
  for (int i = 0; i < channels; ++i) out[i] += share * values[i / 3][i % 3];
}

}  // namespace

Picture render_features(const Scene& scene, const Accel& accel, uint64_t seed, int samples) {
  require_finished(scene);
  if (!accel.fits(scene)) throw Error("render_features: the accelerator is of another scene; make one of this scene");
  if (samples < 1) throw Error(fmt::format("render_features: {} samples are none; ask for 1 or more", samples));
  const Camera& camera = scene.camera;
  Picture out{camera.crop_width,
              camera.crop_height,
              {"Albedo.R", "Albedo.G", "Albedo.B", "N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z"},
              {}};
  out.pixels.resize(size_t(channels) * size_t(out.width) * size_t(out.height));
  parallel_for(out.height, [&](int y) {
    for (int x = 0; x < out.width; ++x) {
      const size_t pixel = size_t(y) * size_t(out.width) + size_t(x);
      for (int i = 0; i < samples; ++i) {
        Sampler sampler = make_sampler(SamplerKind::sobol, hash(seed, 0xfea7), Side::camera, pixel, uint32_t(i));
        const Vec2 raster = Vec2(float(camera.crop_x + x), float(camera.crop_y + y)) + sampler.next2();
        add_first_hit(scene, accel, raster, sampler.next2(), 1.0f / float(samples), &out.pixels[channels * pixel]);
      }
    }
  });
  return out;
}

}  // namespace ajar
