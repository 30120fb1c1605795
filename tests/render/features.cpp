#include "features.h"

#include <glm/gtc/matrix_transform.hpp>

#include "feature_parts.h"

namespace ajar {
namespace {

using namespace kit;

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

// Surfaces that meet under small angles and lights that touch surfaces: vertices almost touch.
Scene with_corners() {
  Scene scene = stage();
  add_quad(scene, {-1, -1, -1}, {2, 0.02f, 0}, {0, 0.3f, 2}, scene.shapes[0].material);
  add_area_light(scene, add_sphere(scene, {-0.5f, -0.7f, 0.3f}, 0.25f, add_diffuse(scene, Rgb(0.5f))), Rgb(1));
  return finished(std::move(scene));
}

const Feature of_all_kinds[] = {
    {"diffuse", [] { return finished(stage()); }},
    {"balance", [] { return finished(stage()); }, "pb", -1, Heuristic::balance},
    {"depth1", [] { return finished(stage()); }, "pbl", 1},
    {"depth2", [] { return finished(stage()); }, "pbl", 2},
    {"depth3", [] { return finished(stage()); }, "pbl", 3},
    {"instances", with_instances},
    {"corners", with_corners},
};

}  // namespace

std::vector<Feature> features() {
  std::vector<Feature> all;
  for (const auto some :
       {std::span<const Feature>(of_all_kinds), features_of_materials(), features_of_lights(), features_of_cameras()})
    all.insert(all.end(), some.begin(), some.end());
  return all;
}

}  // namespace ajar
