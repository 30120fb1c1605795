#include "ajar/scene/cutout.h"

#include "ajar/scene/geometry.h"

namespace ajar {
namespace {

// What is behind all masks.
uint32_t unmasked(const Scene& scene, uint32_t material) {
  while (scene.materials[material].kind == MaterialKind::mask) material = scene.materials[material].nested[0];
  return material;
}

bool has_masks(const Scene& scene, uint32_t material) {
  const MaterialKind kind = scene.materials[material].kind;
  return kind == MaterialKind::mask || kind == MaterialKind::null;
}

}  // namespace

void cut_out(const Scene& scene, Shape& shape) {
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
  uint32_t id = scene.shapes[shape].mask;
  for (; scene.materials[id].kind == MaterialKind::mask; id = scene.materials[id].nested[0])
    out *= std::clamp(eval_scalar(scene, scene.materials[id].weight, at), 0.0f, 1.0f);
  return scene.materials[id].kind == MaterialKind::null ? 0 : out;
}

bool is_open(const Scene& scene, const Shape& shape) {
  if (shape.mask == none) return false;
  uint32_t id = shape.mask;
  for (; scene.materials[id].kind == MaterialKind::mask; id = scene.materials[id].nested[0]) {
    const Slot& weight = scene.materials[id].weight;
    if (weight.texture == none && !(max_component(weight.value) > 0)) return true;
  }
  return scene.materials[id].kind == MaterialKind::null;
}

}  // namespace ajar
