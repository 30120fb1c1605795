// Enters: a scene.
// Leaves: fields learned from a few subpaths of either side.
#pragma once

#include "ajar/field/learn.h"
#include "ajar/join/connect.h"
#include "ajar/path/record.h"

namespace ajar {

/// One subpath of the camera, through the middle of a random pixel, or of a light.
inline void trace_subpath(const Scene& scene, const Accel& accel, const WalkOptions& options, Side side, uint64_t path,
                          uint32_t pass, int most, Subpath& out, Training* training = nullptr) {
  Sampler sampler = make_sampler(SamplerKind::independent, 3, side, path, pass);
  Walk walk;
  Surface surface;
  if (side == Side::camera) {
    const Vec2 raster = sampler.next2() * Vec2(float(scene.camera.width), float(scene.camera.height));
    start_camera(scene, raster, Vec2(0.5f), out, walk);
  } else if (!start_light(scene, options, sampler, out, walk)) {
    return;
  }
  while (out.n < most && step(scene, accel, options, out, walk, surface)) {
    Candidate c;
    if (out.n == 2 && side == Side::light && training) {
      const Vertex& first = out[1];
      record_start(scene, *options.fields, *training, walk.start, promise(first.guide, first.beta).all,
                   promise(first.guide, Rgb(1)).all,
                   {&first.guide, pdf_next_event(scene, first.guide, walk.start.point, -walk.start.direction)});
    }
    const Vertex& v = out[out.n - 1];
    if (side == Side::camera && training && connectable(v.guide)) {
      Sampler other = make_sampler(SamplerKind::independent, 5, side, path, pass * 64 + uint32_t(out.n));
      LightChances chances;
      LightNumbers u;
      const bool lit = draw_light(scene, v.guide, other, u) &&
                       join_light(scene, options.fields, out, out.n, chances, u, c) && visible(accel, c.segment);
      record_next_event(scene, v.guide, chances, *training, c.point, lit ? max_component(c.arrives) : 0);
      if (lit && c.point.infinite)
        record_start(scene, *options.fields, *training, c.point, c.light_found.w, {&v.guide, c.light.own * c.nee.ratio},
                     1, 1);
      c = {};
    }
    if (side == Side::camera && scene.shapes[surface.shape].light != none &&
        join_hit(scene, options.fields, out, surface, c))
      out[out.n - 1].emitted = luminance(c.arrives);
    if (!scatter(options, sampler, out, walk)) return;
  }
}

/// Lessons of so many pairs of subpaths. The strata are trusted soon, so that few paths guide as many will.
inline Fields train(const Scene& scene, const Accel& accel, int lessons = 5, int pairs = 2000, float mix = 0.8f) {
  Fields fields = start_fields(scene, 576);
  LearnOptions learning;
  learning.trust = 4, learning.divide_cell = 300, learning.mix = mix, learning.least_contrast = 1;
  for (int lesson = 0; lesson < lessons; ++lesson) {
    Training training = start_training(fields);
    Sightings sightings;
    WalkOptions options;
    options.fields = &fields;
    Subpath path;
    for (int i = 0; i < pairs; ++i)
      for (const Side side : {Side::camera, Side::light}) {
        trace_subpath(scene, accel, options, side, uint64_t(i), uint32_t(lesson), 6, path, &training);
        if (side == Side::camera && path.n > 1 && path[1].guide.cell != none)
          record_direct(fields.w, training.w, path[1].guide.cell, float(path[1].own));
        record_subpath(fields, training, sightings, path, side);
      }
    fields = learn(fields, training, sightings, pairs, learning, &scene.light_tree);
  }
  return fields;
}

}  // namespace ajar
