#include "ajar/scene/cutout.h"

#include "ajar/scene/geometry.h"

namespace ajar {
namespace {

// What looks the same on both sides, or bends normals alone: where light passes is up to what it holds.
bool is_wrapper(const Material& m) {
  return m.kind == MaterialKind::bumpmap || m.kind == MaterialKind::normalmap ||
         (m.kind == MaterialKind::twosided && m.nested[1] == none);
}

bool has_masks(const Scene& scene, uint32_t id) {
  while (is_wrapper(scene.materials[id])) id = scene.materials[id].nested[0];
  const MaterialKind kind = scene.materials[id].kind;
  return kind == MaterialKind::mask || kind == MaterialKind::null;
}

// What is left of a material without its masks: a part of it, or a copy of what is around them, made anew each time
// since the material may have changed.
uint32_t unmasked(Scene& scene, uint32_t id) {
  const uint32_t nested = scene.materials[id].nested[0];
  if (scene.materials[id].kind == MaterialKind::mask) return unmasked(scene, nested);
  if (!is_wrapper(scene.materials[id])) return id;
  const uint32_t inner = unmasked(scene, nested);
  if (inner == nested) return id;
  if (scene.materials[id].bare == none) {
    scene.materials[id].bare = uint32_t(scene.materials.size());
    scene.materials.emplace_back();
  }
  const uint32_t bare = scene.materials[id].bare;
  scene.materials[bare] = scene.materials[id];
  scene.materials[bare].nested[0] = inner, scene.materials[bare].bare = none;
  return bare;
}

}  // namespace

void cut_out(Scene& scene, Shape& shape) {
  if (shape.mask != none && unmasked(scene, shape.mask) != shape.material) shape.mask = none;
  if (shape.light != none || !has_masks(scene, shape.material)) return;
  if (shape.mask == none) shape.mask = shape.material;
  shape.material = unmasked(scene, shape.material);
}

float opacity(const Scene& scene, uint32_t shape, uint32_t prim, const Vec2& bary) {
  Surface at;
  at.shape = shape, at.prim = prim, at.bary = bary;
  at.uv = texture_point(scene, shape, prim, bary);
  float out = 1;
  const Material* m = &scene.materials[scene.shapes[shape].mask];
  for (; m->kind == MaterialKind::mask || is_wrapper(*m); m = &scene.materials[m->nested[0]])
    if (m->kind == MaterialKind::mask) out *= std::clamp(eval_scalar(scene, m->weight, at), 0.0f, 1.0f);
  return m->kind == MaterialKind::null ? 0 : out;
}

bool is_open(const Scene& scene, const Shape& shape) {
  if (shape.mask == none) return false;
  const Material* m = &scene.materials[shape.mask];
  for (; m->kind == MaterialKind::mask || is_wrapper(*m); m = &scene.materials[m->nested[0]])
    if (m->kind == MaterialKind::mask && m->weight.texture == none && !(max_component(m->weight.value) > 0))
      return true;
  return m->kind == MaterialKind::null;
}

}  // namespace ajar
