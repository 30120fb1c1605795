#include "feature_parts.h"

namespace ajar {
namespace {

using namespace kit;

// The floor under a sphere that the camera does not see.
Scene caustic(const Material& material, bool point) {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  set_camera(scene, {0, -0.2f, 2}, {0, -1, 0.1f}, 24, 24, 24);
  add_open_room(scene);
  add_sphere(scene, {0, 0.1f, 0}, 0.35f, add_material(scene, material));
  if (point)
    scene.lights[add_light(scene, LightKind::point, Rgb(3))].position = {0.1f, 0.9f, 0};
  else
    add_lamp(scene, 0.3f, Rgb(15));
  return finished(std::move(scene));
}

Slot checker(Scene& scene, float a, float b) {
  Texture t;
  t.kind = TextureKind::checkerboard;
  t.color0 = Rgb(a, 0.5f * a, a), t.color1 = Rgb(b);
  t.to_uv = Mat3(4);
  scene.textures.push_back(t);
  Slot slot;
  slot.texture = uint32_t(scene.textures.size() - 1);
  return slot;
}

Slot bumps(Scene& scene, float height) {
  std::vector<float> rgb;
  for (int i = 0; i < 64; ++i)
    for (int c = 0; c < 3; ++c) rgb.push_back(height * float((i * 37) % 11) / 11.0f);
  return add_image(scene, 8, 8, rgb);
}

Scene with_textures() {
  Scene scene = stage();
  scene.lights[0].radiance = checker(scene, 20, 2);
  scene.materials[scene.shapes[0].material].reflectance = checker(scene, 0.9f, 0.1f);
  return finished(std::move(scene));
}

Scene with_globe(float bend, const Material& material) {
  Scene scene = stage();
  add_mesh(scene, globe({0.1f, -0.4f, 0}, 0.5f, 8, bend), add_material(scene, material));
  return finished(std::move(scene));
}

Scene with_bump_map(MaterialKind kind, uint32_t base_kind) {
  Scene scene = stage();
  Material base = base_kind == 0 ? Material{} : rough(MaterialKind::roughconductor, Microfacet::ggx, 0.3f, 0.3f);
  Material m = of_kind(kind);
  m.nested[0] = add_material(scene, base);
  m.map = bumps(scene, kind == MaterialKind::bumpmap ? 0.6f : 1);
  const uint32_t twosided = nest(scene, MaterialKind::twosided, add_material(scene, m));
  add_mesh(scene, globe({-0.45f, -0.5f, 0}, 0.4f, 12), twosided);
  add_quad(scene, {0.1f, -0.9f, -0.3f}, {0.7f, 0.1f, 0.4f}, {0, 1, -0.2f}, twosided);
  return finished(std::move(scene));
}

Scene with_masks() {
  Scene scene = stage();
  Material mask = of_kind(MaterialKind::mask);
  mask.nested[0] = nest(scene, MaterialKind::twosided, add_diffuse(scene, {0.3f, 0.3f, 0.8f}),
                        add_diffuse(scene, {0.8f, 0.8f, 0.1f}));
  mask.weight = checker(scene, 0.8f, 0.1f);
  add_quad(scene, {-0.7f, -0.9f, 0.3f}, {1.2f, 0, 0.1f}, {0, 1.1f, 0}, add_material(scene, mask));
  mask.weight = 0.4f;
  add_mesh(scene, globe({0.4f, 0, -0.3f}, 0.4f, 6, 0.3f), add_material(scene, mask));
  add_quad(scene, {-0.9f, 0.6f, -0.9f}, {1.8f, 0, 0}, {0, 0, 1}, add_material(scene, of_kind(MaterialKind::null)));
  return finished(std::move(scene));
}

// Holes in a part of what is summed up: a mask of glass beside metal, nothing beside matter.
Scene with_holes_in_sums() {
  Scene scene = stage();
  Material mask = of_kind(MaterialKind::mask), blend = of_kind(MaterialKind::blend),
           mixture = of_kind(MaterialKind::mixture);
  mask.nested[0] = add_material(scene, rough(MaterialKind::roughdielectric, Microfacet::ggx, 0.3f, 0.3f));
  mask.weight = checker(scene, 0.8f, 0.1f);
  const uint32_t metal = add_material(scene, rough(MaterialKind::roughconductor, Microfacet::ggx, 0.3f, 0.3f));
  blend.nested = {add_material(scene, mask), metal, none, none}, blend.weight = checker(scene, 0.2f, 0.7f);
  add_quad(scene, {-0.7f, -0.9f, 0.3f}, {1.2f, 0, 0.1f}, {0, 1.1f, 0}, add_material(scene, blend));
  const uint32_t null = add_material(scene, of_kind(MaterialKind::null));
  mixture.nested = {null, add_diffuse(scene, {0.3f, 0.3f, 0.8f}), none, none}, mixture.weights = {0.4f, 0.5f, 0, 0};
  add_mesh(scene, globe({0.4f, 0, -0.3f}, 0.4f, 6, 0.3f), add_material(scene, mixture));
  return finished(std::move(scene));
}

Scene with_blend(MaterialKind kind) {
  Scene scene = stage();
  const uint32_t diffuse = add_diffuse(scene, {0.7f, 0.4f, 0.1f});
  const uint32_t glossy = add_material(scene, rough(MaterialKind::roughconductor, Microfacet::beckmann, 0.2f, 0.2f));
  Material m = of_kind(kind);
  m.nested[0] = diffuse, m.nested[1] = glossy;
  m.weight = checker(scene, 0.9f, 0.2f);
  m.weights = {0.5f, 0.3f, 0, 0};
  add_sphere(scene, {0.1f, -0.4f, 0}, 0.5f, nest(scene, MaterialKind::twosided, add_material(scene, m)));
  return finished(std::move(scene));
}

// Each part of the blend has a normal map or bump map of its own.
Scene with_bent_blend() {
  Scene scene = stage();
  Material bump = of_kind(MaterialKind::bumpmap), map = of_kind(MaterialKind::normalmap),
           m = of_kind(MaterialKind::blend);
  bump.nested[0] = add_diffuse(scene, {0.7f, 0.4f, 0.1f});
  bump.map = bumps(scene, 0.6f);
  map.nested[0] = add_material(scene, rough(MaterialKind::roughconductor, Microfacet::ggx, 0.3f, 0.3f));
  map.map = bumps(scene, 1);
  m.nested = {add_material(scene, bump), add_material(scene, map), none, none};
  m.weight = checker(scene, 0.9f, 0.2f);
  const uint32_t twosided = nest(scene, MaterialKind::twosided, add_material(scene, m));
  add_mesh(scene, globe({-0.45f, -0.5f, 0}, 0.4f, 12), twosided);
  add_quad(scene, {0.1f, -0.9f, -0.3f}, {0.7f, 0.1f, 0.4f}, {0, 1, -0.2f}, twosided);
  return finished(std::move(scene));
}

const Feature of_materials[] = {
    {"ggx", [] { return with_rough_sphere(MaterialKind::roughconductor, Microfacet::ggx, 0.2f, 0.2f); }},
    {"ggx_sharp", [] { return with_rough_sphere(MaterialKind::roughconductor, Microfacet::ggx, 0.02f, 0.02f); }, "pb"},
    {"beckmann", [] { return with_rough_sphere(MaterialKind::roughconductor, Microfacet::beckmann, 0.1f, 0.4f); }},
    {"conductor", [] { return with_sphere(of_kind(MaterialKind::conductor)); }, "pb"},
    {"glass", [] { return with_sphere(glass()); }, "pb"},
    {"pane", [] { return with_sphere(of_kind(MaterialKind::thindielectric)); }, "pb", -1, Heuristic::power, 2},
    {"rough_glass", [] { return with_rough_sphere(MaterialKind::roughdielectric, Microfacet::ggx, 0.3f, 0.3f); }},
    {"rough_glass_beckmann",
     [] { return with_rough_sphere(MaterialKind::roughdielectric, Microfacet::beckmann, 0.2f, 0.4f); }},
    {"plastic", [] { return with_sphere(of_kind(MaterialKind::plastic)); }, "pb"},
    {"rough_plastic", [] { return with_rough_sphere(MaterialKind::roughplastic, Microfacet::ggx, 0.3f, 0.3f); }},
    {"phong", [] { return with_sphere(of_kind(MaterialKind::phong)); }},
    {"rough_diffuse", [] { return with_sphere(of_kind(MaterialKind::roughdiffuse)); }},
    {"diffuse_transmitter", [] { return with_sphere(of_kind(MaterialKind::difftrans)); }},
    {"ward",
     [] {
       Material m = of_kind(MaterialKind::ward);
       m.specular = 0.4f, m.alpha_u = 0.2f, m.alpha_v = 0.4f;
       return with_sphere(m);
     }},
    {"bent_blend", with_bent_blend},
    {"principled",
     [] {
       Material m = of_kind(MaterialKind::principled);
       m.reflectance = Rgb(0.8f, 0.4f, 0.2f);
       m.roughness = 0.4f, m.metallic = 0.2f, m.spec_trans = 0.4f, m.clearcoat = 0.7f, m.sheen = 0.3f;
       return with_sphere(m);
     }},
    {"blend", [] { return with_blend(MaterialKind::blend); }},
    {"mixture", [] { return with_blend(MaterialKind::mixture); }},
    {"mask", with_masks},
    {"mask_in_sum", with_holes_in_sums},
    {"caustic", [] { return caustic(glass(), false); }},
    {"caustic_of_point", [] { return caustic(glass(), true); }, "blv"},
    {"caustic_of_rough_glass",
     [] { return caustic(rough(MaterialKind::roughdielectric, Microfacet::ggx, 0.15f, 0.15f), true); }},
    {"bent_normals", [] { return with_globe(0.5f, Material{}); }, "pbl", -1, Heuristic::power, 4},
    {"bent_rough_glass",
     [] { return with_globe(0.3f, rough(MaterialKind::roughdielectric, Microfacet::ggx, 0.3f, 0.3f)); }},
    {"bent_glass_caustic",
     [] {
       Scene scene;
       scene.filter = make_filter(FilterKind::box);
       set_camera(scene, {0, -0.2f, 2}, {0, -1, 0.1f}, 24, 24, 24);
       add_open_room(scene);
       add_mesh(scene, globe({0, 0.1f, 0}, 0.4f, 8, 0.2f), add_material(scene, glass()));
       add_lamp(scene, 0.5f, Rgb(8));
       return finished(std::move(scene));
     }},
    {"bumpmap", [] { return with_bump_map(MaterialKind::bumpmap, 0); }},
    {"bumpmap_glossy", [] { return with_bump_map(MaterialKind::bumpmap, 1); }},
    {"normalmap", [] { return with_bump_map(MaterialKind::normalmap, 0); }},
    {"textures", with_textures},
};

}  // namespace

std::span<const Feature> features_of_materials() { return of_materials; }

}  // namespace ajar
