#include "ajar/scene/cutout.h"

#include "ajar/scene/geometry.h"

namespace ajar {
namespace {

// What looks the same on both sides, or bends normals alone: where light passes is up to what it holds.
bool is_wrapper(const Material& m) {
  return m.kind == MaterialKind::bumpmap || m.kind == MaterialKind::normalmap ||
         (m.kind == MaterialKind::twosided && m.nested[1] == none);
}

// Ordered: what contains several of them is the last.
enum class Holes : uint8_t { none, even, by_side };

// Where a material lets light pass: alike from both sides, unless those of a twosided one are two.
Holes holes_in(const Scene& scene, uint32_t id) {
  const Material& m = scene.materials[id];
  Holes out = m.kind == MaterialKind::mask || m.kind == MaterialKind::null ? Holes::even : Holes::none;
  for (const uint32_t nested : m.nested)
    if (nested != none) out = std::max(out, holes_in(scene, nested));
  const bool two_faced = m.kind == MaterialKind::twosided && m.nested[1] != none;
  return two_faced && out != Holes::none ? Holes::by_side : out;
}

// What is left of a material without the masks around it: a part of it, or a copy of what is around them, made anew
// each time since the material may have changed. Masks inside of a sum stay: resolve() sees to them.
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

float opacity_of(const Scene& scene, uint32_t id, const Surface& at) {
  const Material& m = scene.materials[id];
  const auto share = [&] { return std::clamp(eval_scalar(scene, m.weight, at), 0.0f, 1.0f); };
  if (is_wrapper(m)) return opacity_of(scene, m.nested[0], at);
  switch (m.kind) {
    case MaterialKind::null:
      return 0;
    case MaterialKind::mask:
      return share() * opacity_of(scene, m.nested[0], at);
    case MaterialKind::blend: {
      const float first = opacity_of(scene, m.nested[0], at), second = opacity_of(scene, m.nested[1], at);
      return first == second ? first : first + share() * (second - first);
    }
    case MaterialKind::mixture: {  // what its weights leave over is absorbed
      float passing = 0;
      for (int i = 0; i < 4; ++i)
        if (m.nested[i] != none) passing += m.weights[i] * (1 - opacity_of(scene, m.nested[i], at));
      return std::max(1 - passing, 0.0f);
    }
    default:
      return 1;
  }
}

bool is_open(const Scene& scene, uint32_t id) {
  const Material& m = scene.materials[id];
  if (m.kind == MaterialKind::null) return true;
  if (m.kind == MaterialKind::mask && m.weight.texture == none && !(max_component(m.weight.value) > 0)) return true;
  if (m.kind == MaterialKind::blend) return is_open(scene, m.nested[0]) && is_open(scene, m.nested[1]);
  return (m.kind == MaterialKind::mask || is_wrapper(m)) && is_open(scene, m.nested[0]);
}

}  // namespace

void cut_out(Scene& scene, Shape& shape) {
  const auto is_stale = [&] {
    return unmasked(scene, shape.mask) != shape.material || holes_in(scene, shape.mask) != Holes::even;
  };
  if (shape.mask != none && is_stale()) shape.mask = none;
  if (shape.light != none || holes_in(scene, shape.material) != Holes::even) return;
  if (shape.mask == none) shape.mask = shape.material;
  shape.material = unmasked(scene, shape.material);
}

float opacity(const Scene& scene, uint32_t shape, uint32_t prim, const Vec2& bary) {
  Surface at;
  at.shape = shape, at.prim = prim, at.bary = bary;
  at.uv = texture_point(scene, shape, prim, bary);
  return opacity_of(scene, scene.shapes[shape].mask, at);
}

bool is_open(const Scene& scene, const Shape& shape) { return shape.mask != none && is_open(scene, shape.mask); }

}  // namespace ajar
