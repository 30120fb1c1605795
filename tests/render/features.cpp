#include "features.h"

#include <glm/gtc/matrix_transform.hpp>

#include "kit/stage.h"

namespace ajar {
namespace {

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

uint32_t nest(Scene& scene, MaterialKind kind, uint32_t first, uint32_t second = none) {
  Material m = of_kind(kind);
  m.nested[0] = first, m.nested[1] = second;
  return add_material(scene, m);
}

// The usual room with a sphere of this material in it.
Scene with_sphere(const Material& material, float radius = 0.45f) {
  Scene scene = stage();
  add_sphere(scene, {0.15f, -0.35f, 0.1f}, radius, add_material(scene, material));
  return finished(std::move(scene));
}

Scene with_rough_sphere(MaterialKind kind, Microfacet distribution, float alpha_u, float alpha_v) {
  return with_sphere(rough(kind, distribution, alpha_u, alpha_v));
}

// Room without lamp and ceiling, whose opening the camera does not see.
Scene open_stage() {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  set_camera(scene, {0, 0.8f, 3.5f}, {0, -0.5f, 0}, 22, 24, 24);
  add_open_room(scene);
  const uint32_t glossy = add_material(scene, rough(MaterialKind::roughconductor, Microfacet::ggx, 0.3f, 0.3f));
  add_sphere(scene, {0, -0.7f, 0}, 0.3f, glossy);
  return scene;
}

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

// What a mirror throws on a floor, of a lamp behind paper.
Scene caustic_through_paper() {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  set_camera(scene, {1.2f, 0, 0.8f}, {0, 0, 0}, 20, 24, 24);
  const uint32_t matt = add_diffuse(scene, Rgb(0.6f)), mirror = add_material(scene, of_kind(MaterialKind::conductor));
  const uint32_t paper = add_material(scene, of_kind(MaterialKind::difftrans));
  add_quad(scene, {-0.55f, -0.55f, 0}, {1.1f, 0, 0}, {0, 1.1f, 0}, matt);
  add_quad(scene, {-1.1f, -0.5f, 1}, {0, 1, 0}, {1, 0, 0}, mirror);
  add_quad(scene, {-1.5f, -0.3f, -0.1f}, {0.6f, 0, 0}, {0, 0.6f, 0}, paper);
  add_area_light(scene, add_quad(scene, {-1.3f, -0.1f, -0.4f}, {0.2f, 0, 0}, {0, 0.2f, 0}, matt), Rgb(20));
  return finished(std::move(scene));
}

Scene lit_by(LightKind kind, const Vec3& direction) {
  Scene scene = open_stage();
  Light& light = scene.lights[add_light(scene, kind, Rgb(3, 2, 1))];
  light.position = {0.3f, 0.8f, 0.4f};
  light.direction = glm::normalize(direction);
  light.to_world = look_at(light.position, light.position + light.direction);
  light.cutoff = 0.7f, light.beam = 0.4f;
  return finished(std::move(scene));
}

std::vector<float> sky(int width, int height) {
  std::vector<float> rgb;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float sun = x == width / 3 && y == 2 ? 60.0f : 0.2f + float((x * 7 + y * 3) % 5);
      rgb.insert(rgb.end(), {sun, 0.8f * sun, 0.5f * sun + 0.1f});
    }
  return rgb;
}

Scene with_envmap(bool polar) {
  Scene scene = open_stage();
  const Slot image = add_image(scene, 16, 8, sky(16, 8));
  Light& light = scene.lights[add_light(scene, LightKind::envmap, Rgb(1))];
  light.to_world = glm::rotate(Mat4(1), 0.7f, glm::normalize(Vec3(0.2f, 1, 0.1f)));
  scene.environments.push_back(make_environment(scene, scene.textures[image.texture].image, 0.5f, polar));
  light.environment = 0;
  return finished(std::move(scene));
}

// All light comes through the shade.
Scene with_lampshade(Scene scene, const Material& shade) {
  add_sphere(scene, {-0.2f, 0.3f, 0}, 0.35f, add_material(scene, shade));
  add_area_light(scene, add_sphere(scene, {-0.2f, 0.3f, 0}, 0.1f, add_diffuse(scene, Rgb(0.5f))), Rgb(20));
  return finished(std::move(scene));
}

// What is matt from within, where the light comes from, is a sharp mirror from without.
Scene with_two_faced_shade() {
  Scene scene = open_stage();
  Material blend = of_kind(MaterialKind::blend), faces = of_kind(MaterialKind::twosided);
  faces.nested = {add_material(scene, rough(MaterialKind::roughconductor, Microfacet::ggx, 0.05f, 0.05f)),
                  add_diffuse(scene, Rgb(0.5f)), none, none};
  blend.nested = {add_material(scene, of_kind(MaterialKind::difftrans)), add_material(scene, faces), none, none};
  blend.weight = Slot(0.3f);
  return with_lampshade(std::move(scene), blend);
}

// Lights of every kind at once, so that the choice among them counts.
Scene with_many_lights() {
  Scene scene = open_stage();
  add_light(scene, LightKind::constant, Rgb(0.3f));
  scene.lights[add_light(scene, LightKind::directional, Rgb(1, 0.5f, 0))].direction =
      glm::normalize(Vec3(-1, -2, -0.5f));
  scene.lights[add_light(scene, LightKind::point, Rgb(0, 0.5f, 1))].position = {-0.5f, 0.5f, 0.5f};
  add_lamp(scene, 0.2f, Rgb(5));
  add_area_light(scene, add_sphere(scene, {0.6f, -0.2f, 0}, 0.1f, add_diffuse(scene, Rgb(0.5f))), Rgb(4));
  return finished(std::move(scene));
}

Scene lit_by_shape(ShapeKind kind, const Mat4& to_world, bool flip = false) {
  Scene scene = stage();
  scene.lights.clear();
  scene.shapes.pop_back();
  const uint32_t shape = add_quadric(scene, kind, to_world, add_diffuse(scene, Rgb(0.3f)));
  scene.shapes[shape].flip = flip;
  add_area_light(scene, shape, Rgb(8, 7, 6));
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

// A group of a leaning globe and a sphere, seen twice: turned and mirrored with uneven scale.
Scene with_instances() {
  Scene scene = stage();
  scene.groups = 1;
  const uint32_t glossy = add_material(scene, rough(MaterialKind::roughconductor, Microfacet::ggx, 0.25f, 0.5f));
  const uint32_t first = add_mesh(scene, globe({0, 0.2f, 0}, 0.5f, 8, 0.3f), glossy);
  const uint32_t second = add_sphere(scene, {0.3f, -0.5f, 0.2f}, 0.3f, add_diffuse(scene, {0.2f, 0.4f, 0.8f}));
  scene.shapes[first].group = scene.shapes[second].group = 0;
  for (const float side : {-1.0f, 1.0f}) {
    const Mat4 turned = glm::rotate(glm::translate(Mat4(1), Vec3(side * 0.5f, -0.4f, 0)), side, Vec3(0, 1, 0));
    add_instance(scene, 0, glm::scale(turned, Vec3(side * 0.5f, 0.8f, 0.6f)));
  }
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

// It shines where its mask lets light pass, too: there it is no cut-out.
Scene with_masked_lamp() {
  Scene scene = stage();
  Material mask = of_kind(MaterialKind::mask);
  mask.weight = 0.4f;
  mask.nested[0] = add_diffuse(scene, Rgb(0.8f));
  const uint32_t low = add_quad(scene, {-0.5f, -0.4f, -0.3f}, {1, 0, 0.2f}, {0, 0.2f, 0.6f}, add_material(scene, mask));
  const uint32_t light = add_light(scene, LightKind::area, Rgb(1.5f));
  scene.lights[light].shape = low, scene.shapes[low].light = light;
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

Scene with_filter(FilterKind kind) {
  Scene scene = stage();
  scene.filter = make_filter(kind);
  return finished(std::move(scene));
}

Scene with_camera(CameraKind kind) {
  Scene scene = stage();
  Camera& c = scene.camera;
  if (kind == CameraKind::orthographic)
    set_orthographic(c, glm::scale(look_at({0.2f, 0.1f, 3}, {0, 0, 0}), Vec3(0.9f)));
  if (kind == CameraKind::thinlens) c.kind = kind, c.aperture = 0.3f, c.focus = 4;
  c.principal = {0.03f, -0.05f};
  return finished(std::move(scene));
}

Scene with_crop() {
  Scene scene = stage(48);
  Camera& c = scene.camera;
  c.crop_x = 9, c.crop_y = 20, c.crop_width = 30, c.crop_height = 18;
  scene.filter = make_filter(FilterKind::gaussian);
  return finished(std::move(scene));
}

// A wall between lens and near plane, which must not be seen nor shade; and a far plane within the room.
Scene with_clip_planes() {
  Scene scene = stage();
  add_quad(scene, {-1, -1, 4}, {2, 0, 0}, {0, 2, 0}, add_diffuse(scene, Rgb(0.5f)));
  scene.camera.near_clip = 0.5f;
  scene.camera.far_clip = 4.5f;
  return finished(std::move(scene));
}

// A plate just behind the near plane, which hides what is behind it.
Scene with_clipped_orthographic() {
  Scene scene = stage();
  set_orthographic(scene.camera, look_at({0, 0, 3}, {0, 0, 0}));
  scene.camera.near_clip = 1.8f;
  add_quad(scene, {-0.7f, -0.7f, 0.8f}, {0.9f, 0, 0}, {0, 0.9f, 0}, add_diffuse(scene, Rgb(0.2f)));
  return finished(std::move(scene));
}

// Lamps that scatter, and a sky, which the camera sees in what they light alone; one lamp is in the way of another.
Scene with_hidden_lamps(Lamps lamps) {
  Scene scene = open_stage();
  set_camera(scene, {0, 0.3f, 4}, {0, -0.1f, 0}, 50, 24, 24);
  const uint32_t grey = add_diffuse(scene, Rgb(0.6f));
  add_area_light(scene, add_mesh(scene, globe({0.3f, 0.4f, 0.8f}, 0.25f, 5), grey), Rgb(4, 3, 2));
  add_area_light(scene, add_sphere(scene, {-0.2f, -0.2f, 0.2f}, 0.3f, grey), Rgb(1, 2, 3));
  add_light(scene, LightKind::constant, Rgb(0.3f));
  scene.camera.lamps = lamps;
  return finished(std::move(scene));
}

// Surfaces that meet under small angles and lights that touch surfaces: vertices almost touch.
Scene with_corners() {
  Scene scene = stage();
  add_quad(scene, {-1, -1, -1}, {2, 0.02f, 0}, {0, 0.3f, 2}, scene.shapes[0].material);
  add_area_light(scene, add_sphere(scene, {-0.5f, -0.7f, 0.3f}, 0.25f, add_diffuse(scene, Rgb(0.5f))), Rgb(1));
  return finished(std::move(scene));
}

const Material glass = [] {
  Material m = of_kind(MaterialKind::dielectric);
  m.ior = 1.5f;
  return m;
}();

const Feature all[] = {
    {"diffuse", [] { return finished(stage()); }},
    {"balance", [] { return finished(stage()); }, "pb", -1, Heuristic::balance},
    {"depth1", [] { return finished(stage()); }, "pbl", 1},
    {"depth2", [] { return finished(stage()); }, "pbl", 2},
    {"depth3", [] { return finished(stage()); }, "pbl", 3},
    {"ggx", [] { return with_rough_sphere(MaterialKind::roughconductor, Microfacet::ggx, 0.2f, 0.2f); }},
    {"ggx_sharp", [] { return with_rough_sphere(MaterialKind::roughconductor, Microfacet::ggx, 0.02f, 0.02f); }, "pb"},
    {"beckmann", [] { return with_rough_sphere(MaterialKind::roughconductor, Microfacet::beckmann, 0.1f, 0.4f); }},
    {"conductor", [] { return with_sphere(of_kind(MaterialKind::conductor)); }, "pb"},
    {"glass", [] { return with_sphere(glass); }, "pb"},
    {"pane", [] { return with_sphere(of_kind(MaterialKind::thindielectric)); }, "pb", -1, Heuristic::power, 2},
    {"rough_glass", [] { return with_rough_sphere(MaterialKind::roughdielectric, Microfacet::ggx, 0.3f, 0.3f); }},
    {"rough_glass_beckmann",
     [] { return with_rough_sphere(MaterialKind::roughdielectric, Microfacet::beckmann, 0.2f, 0.4f); }},
    {"plastic", [] { return with_sphere(of_kind(MaterialKind::plastic)); }, "pb"},
    {"rough_plastic", [] { return with_rough_sphere(MaterialKind::roughplastic, Microfacet::ggx, 0.3f, 0.3f); }},
    {"phong", [] { return with_sphere(of_kind(MaterialKind::phong)); }},
    {"rough_diffuse", [] { return with_sphere(of_kind(MaterialKind::roughdiffuse)); }},
    {"diffuse_transmitter", [] { return with_sphere(of_kind(MaterialKind::difftrans)); }},
    {"lampshade", [] { return with_lampshade(open_stage(), of_kind(MaterialKind::difftrans)); }, "pbl", -1,
     Heuristic::power, 4},
    {"two_faced_shade", with_two_faced_shade},
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
    {"mask_of_lamp", with_masked_lamp, "pb"},
    {"caustic", [] { return caustic(glass, false); }},
    {"caustic_of_point", [] { return caustic(glass, true); }, "blv"},
    {"caustic_of_rough_glass",
     [] { return caustic(rough(MaterialKind::roughdielectric, Microfacet::ggx, 0.15f, 0.15f), true); }},
    {"caustic_through_paper", caustic_through_paper, "pb", 4},
    {"bent_normals", [] { return with_globe(0.5f, Material{}); }, "pbl", -1, Heuristic::power, 4},
    {"bent_rough_glass",
     [] { return with_globe(0.3f, rough(MaterialKind::roughdielectric, Microfacet::ggx, 0.3f, 0.3f)); }},
    {"bent_glass_caustic",
     [] {
       Scene scene;
       scene.filter = make_filter(FilterKind::box);
       set_camera(scene, {0, -0.2f, 2}, {0, -1, 0.1f}, 24, 24, 24);
       add_open_room(scene);
       add_mesh(scene, globe({0, 0.1f, 0}, 0.4f, 8, 0.2f), add_material(scene, glass));
       add_lamp(scene, 0.5f, Rgb(8));
       return finished(std::move(scene));
     }},
    {"bumpmap", [] { return with_bump_map(MaterialKind::bumpmap, 0); }},
    {"bumpmap_glossy", [] { return with_bump_map(MaterialKind::bumpmap, 1); }},
    {"normalmap", [] { return with_bump_map(MaterialKind::normalmap, 0); }},
    {"textures", with_textures},
    {"sphere_light",
     [] {
       return lit_by_shape(ShapeKind::sphere, glm::scale(glm::translate(Mat4(1), Vec3(0.2f, 0.5f, 0)), Vec3(0.2f)));
     },
     "pbl", -1, Heuristic::power, 4},
    {"disk_light",
     [] {
       const Mat4 m = glm::rotate(glm::translate(Mat4(1), Vec3(0.2f, 0.6f, 0)), 1.9f, Vec3(1, 0, 0));
       return lit_by_shape(ShapeKind::disk, glm::scale(m, Vec3(0.2f, 0.5f, 0.3f)));
     }},
    {"cylinder_light",
     [] {
       const Mat4 m = glm::rotate(glm::translate(Mat4(1), Vec3(-0.4f, 0.5f, 0)), 1.2f, Vec3(0, 1, 0));
       return lit_by_shape(ShapeKind::cylinder, glm::scale(m, Vec3(0.15f, 0.15f, 0.8f)));
     }},
    {"inner_cylinder_light",
     [] {
       const Mat4 m = glm::rotate(glm::translate(Mat4(1), Vec3(-0.1f, 0.9f, 0)), 1.3f, Vec3(1, 0, 0));
       return lit_by_shape(ShapeKind::cylinder, glm::scale(m, Vec3(0.3f, 0.3f, 0.4f)), true);
     }},
    {"mesh_light",
     [] {
       Scene scene = stage();
       add_area_light(scene, add_mesh(scene, globe({0.3f, 0, 0}, 0.25f, 5, 0.2f), add_diffuse(scene, Rgb(0.5f))),
                      Rgb(2, 3, 4));
       return finished(std::move(scene));
     }},
    {"point",
     [] {
       return lit_by(LightKind::point, {0, -1, 0});
     }},
    {"spot",
     [] {
       return lit_by(LightKind::spot, {-0.2f, -1, -0.5f});
     }},
    {"projector",
     [] {
       return lit_by(LightKind::projector, {-0.2f, -1, -0.5f});
     }},
    {"directional",
     [] {
       return lit_by(LightKind::directional, {-0.4f, -1, -0.6f});
     }},
    {"constant",
     [] {
       return lit_by(LightKind::constant, {0, -1, 0});
     }},
    {"envmap", [] { return with_envmap(false); }},
    {"envmap_polar", [] { return with_envmap(true); }},
    {"envmap_seen",
     [] {
       Scene scene = with_envmap(false);
       set_camera(scene, {0, 0.5f, 4.5f}, {0, 0.3f, 0}, 60, 24, 24);
       return finished(std::move(scene));
     },
     "pb"},
    {"many_lights", with_many_lights},
    {"instances", with_instances},
    {"thin_lens", [] { return with_camera(CameraKind::thinlens); }},
    {"orthographic", [] { return with_camera(CameraKind::orthographic); }},
    {"clipped_orthographic", with_clipped_orthographic},
    {"principal_point", [] { return with_camera(CameraKind::perspective); }},
    {"crop", with_crop},
    {"clip_planes", with_clip_planes},
    {"lamps_dark", [] { return with_hidden_lamps(Lamps::dark); }},
    {"lamps_gone", [] { return with_hidden_lamps(Lamps::gone); }},
    {"corners", with_corners},
    {"tent", [] { return with_filter(FilterKind::tent); }, "pbl", 3},
    {"gaussian", [] { return with_filter(FilterKind::gaussian); }, "pbl", 3},
    {"mitchell", [] { return with_filter(FilterKind::mitchell); }, "pbl", 3},
    {"catmullrom", [] { return with_filter(FilterKind::catmullrom); }, "pbl", 3},
    {"lanczos", [] { return with_filter(FilterKind::lanczos); }, "pbl", 3},
};

}  // namespace

std::span<const Feature> features() { return all; }

}  // namespace ajar
