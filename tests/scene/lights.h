// Enters: names of lights.
// Leaves: scenes with one light each, for the tests of this folder.
#pragma once

#include <memory>
#include <vector>

#include "shapes.h"

namespace ajar::kit {

struct LitScene {
  const char* name = "";
  Scene scene;
};

/// A grey image of floats; value(x, y) for each texel.
template <class F>
Image float_image(int width, int height, const F& value) {
  Image image;
  image.name = "made";
  image.width = width, image.height = height, image.channels = 3;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) image.floats.push_back(value(x, y) * (1.0f - 0.2f * float(c)));
  return image;
}

inline Mesh icosphere_like() {
  Mesh mesh;  // an octahedron: eight triangles of unequal size
  mesh.positions = {{1, 0, 0}, {-0.6f, 0, 0}, {0, 1.4f, 0}, {0, -1, 0}, {0, 0, 0.8f}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return mesh;
}

inline LitScene area_scene(const char* name, ShapeKind kind, const Mat4& m, bool flip = false,
                           const Mesh* mesh = nullptr) {
  LitScene lit{name, {}};
  const uint32_t id = add_shape(lit.scene, kind, m, mesh);
  lit.scene.shapes[id].flip = flip;
  light_up(lit.scene, id, Rgb(1, 2, 3));
  finish(lit.scene);
  return lit;
}

inline LitScene map_scene(const char* name, const Mat4& to_world, const Image& image, bool polar = false) {
  LitScene lit{name, {}};
  add_mesh(lit.scene, rectangle(placed(0, Vec3(2), {1, 2, 3})));
  lit.scene.images.push_back(image);
  lit.scene.environments.push_back(make_environment(lit.scene, 0, 2, polar));
  Light light;
  light.kind = LightKind::envmap;
  light.environment = 0;
  light.to_world = to_world;
  add_light(lit.scene, light);
  finish(lit.scene);
  return lit;
}

inline std::vector<LitScene> area_scenes() {
  std::vector<LitScene> all;
  const Mat4 m = placed(0.4f, Vec3(0.5f), {1, 2, 3});
  const Mesh rect = rectangle(placed(0.4f, {0.5f, 1, 1}, {1, 2, 3})), solid = icosphere_like();
  Mesh triangle = rect;
  triangle.triangles.pop_back();
  all.push_back(area_scene("rectangle", ShapeKind::mesh, Mat4(1), false, &rect));
  all.push_back(area_scene("triangle", ShapeKind::mesh, Mat4(1), false, &triangle));
  all.push_back(area_scene("octahedron", ShapeKind::mesh, Mat4(1), false, &solid));
  all.push_back(area_scene("sphere", ShapeKind::sphere, m));
  all.push_back(area_scene("sphere shining inwards", ShapeKind::sphere, placed(0.4f, Vec3(3), {1, 2, 3}), true));
  all.push_back(area_scene("disk", ShapeKind::disk, placed(0.4f, {0.5f, 1, 1}, {1, 2, 3})));
  all.push_back(area_scene("cylinder", ShapeKind::cylinder, placed(0.4f, {0.5f, 1, 2}, {1, 2, 3})));
  return all;
}

inline std::vector<LitScene> infinite_scenes() {
  std::vector<LitScene> all;
  all.push_back({"constant", {}});
  add_mesh(all.back().scene, rectangle(placed(0, Vec3(2), {1, 2, 3})));
  Light light;
  light.kind = LightKind::constant;
  light.radiance = Slot(Rgb(1, 2, 3));
  add_light(all.back().scene, light);
  finish(all.back().scene);
  const Image smooth = float_image(16, 8, [](int x, int y) { return 1 + 0.8f * std::sin(float(x)) + 0.1f * float(y); });
  const Image sun =
      float_image(32, 16, [](int x, int y) { return x == 7 && y == 4 ? 5000.0f : (y < 8 ? 0.3f : 0.0f); });
  const Image pole = float_image(16, 8, [](int, int y) { return y == 0 ? 10.0f : 0.01f; });
  const Mat4 turned = glm::rotate(Mat4(1), 1.0f, glm::normalize(Vec3(1, 2, 3)));
  all.push_back(map_scene("map", Mat4(1), smooth));
  all.push_back(map_scene("map, turned", turned, smooth));
  all.push_back(map_scene("map, mirrored and stretched", turned * glm::scale(Mat4(1), Vec3(-2, 1, 1)), smooth));
  all.push_back(map_scene("sun", turned, sun));
  all.push_back(map_scene("bright pole", turned, pole));
  all.push_back(map_scene("map, polar", turned, smooth, true));
  all.push_back(map_scene("sun, polar", turned, sun, true));
  all.push_back(map_scene("bright pole, polar", turned, pole, true));
  all.push_back(map_scene("two rows, polar", turned, float_image(1, 2, [](int, int y) { return 1 + float(y); }), true));
  all.push_back(map_scene("one texel", Mat4(1), float_image(1, 1, [](int, int) { return 1.0f; })));
  return all;
}

/// Points from which lights are looked at: near, far, on each side, inside, very near the surface.
inline std::vector<Vec3> view_points() {
  return {{1.1f, 2.3f, 3.2f}, {4, 2.5f, 6},          {-30, 20, 50},  {1, 2, 0.5f},
          {2.2f, 2.1f, 3.4f}, {1.02f, 2.01f, 3.49f}, {0, 0.1f, 0.2f}};
}

}  // namespace ajar::kit
