#include "feature_parts.h"

namespace ajar {

using namespace kit;

Scene finished(Scene scene) {
  finish(scene);
  return scene;
}

Material of_kind(MaterialKind kind) {
  Material m;
  m.kind = kind;
  return m;
}

Material rough(MaterialKind kind, Microfacet distribution, float alpha_u, float alpha_v) {
  Material m = of_kind(kind);
  m.distribution = distribution;
  m.alpha_u = alpha_u, m.alpha_v = alpha_v;
  m.eta = Rgb(0.2f, 0.9f, 1.2f), m.k = Rgb(3.9f, 2.4f, 2.2f);
  return m;
}

Material glass() {
  Material m = of_kind(MaterialKind::dielectric);
  m.ior = 1.5f;
  return m;
}

uint32_t nest(Scene& scene, MaterialKind kind, uint32_t first, uint32_t second) {
  Material m = of_kind(kind);
  m.nested[0] = first, m.nested[1] = second;
  return add_material(scene, m);
}

Scene with_sphere(const Material& material, float radius) {
  Scene scene = stage();
  add_sphere(scene, {0.15f, -0.35f, 0.1f}, radius, add_material(scene, material));
  return finished(std::move(scene));
}

Scene with_rough_sphere(MaterialKind kind, Microfacet distribution, float alpha_u, float alpha_v) {
  return with_sphere(rough(kind, distribution, alpha_u, alpha_v));
}

Scene open_stage() {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  set_camera(scene, {0, 0.8f, 3.5f}, {0, -0.5f, 0}, 22, 24, 24);
  add_open_room(scene);
  const uint32_t glossy = add_material(scene, rough(MaterialKind::roughconductor, Microfacet::ggx, 0.3f, 0.3f));
  add_sphere(scene, {0, -0.7f, 0}, 0.3f, glossy);
  return scene;
}

}  // namespace ajar
