#include "feature_parts.h"

#include <glm/gtc/matrix_transform.hpp>

namespace ajar {
namespace {

using namespace kit;

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

const Feature of_lights[] = {
    {"lampshade", [] { return with_lampshade(open_stage(), of_kind(MaterialKind::difftrans)); }, "pbl", -1,
     Heuristic::power, 4},
    {"two_faced_shade", with_two_faced_shade},
    {"mask_of_lamp", with_masked_lamp, "pb"},
    {"caustic_through_paper", caustic_through_paper, "pb", 4},
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
    {"lamps_dark", [] { return with_hidden_lamps(Lamps::dark); }},
    {"lamps_gone", [] { return with_hidden_lamps(Lamps::gone); }},
};

}  // namespace

std::span<const Feature> features_of_lights() { return of_lights; }

}  // namespace ajar
