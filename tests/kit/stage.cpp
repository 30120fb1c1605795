#include "kit/stage.h"

#include <glm/gtc/matrix_transform.hpp>

namespace ajar::kit {

uint32_t add(Scene& scene, const Material& material) {
  scene.materials.push_back(material);
  return uint32_t(scene.materials.size() - 1);
}

uint32_t add_diffuse(Scene& scene, const Rgb& reflectance) {
  Material m;
  m.reflectance = reflectance;
  return add(scene, m);
}

uint32_t add_mesh(Scene& scene, Mesh mesh, uint32_t material) {
  Shape shape;
  shape.mesh = uint32_t(scene.meshes.size());
  shape.material = material;
  scene.meshes.push_back(std::move(mesh));
  scene.shapes.push_back(shape);
  return uint32_t(scene.shapes.size() - 1);
}

uint32_t add_quad(Scene& scene, const Vec3& corner, const Vec3& u, const Vec3& v, uint32_t material) {
  Mesh mesh;
  mesh.positions = {corner, corner + u, corner + u + v, corner + v};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return add_mesh(scene, std::move(mesh), material);
}

uint32_t add_quadric(Scene& scene, ShapeKind kind, const Mat4& to_world, uint32_t material) {
  Shape shape;
  shape.kind = kind;
  shape.material = material;
  shape.to_world = to_world;
  shape.to_object = glm::inverse(to_world);
  scene.shapes.push_back(shape);
  return uint32_t(scene.shapes.size() - 1);
}

uint32_t add_sphere(Scene& scene, const Vec3& centre, float radius, uint32_t material) {
  return add_quadric(scene, ShapeKind::sphere, glm::scale(glm::translate(Mat4(1), centre), Vec3(radius)), material);
}

Mesh globe(const Vec3& centre, float radius, int n, float bend) {
  Mesh mesh;
  const auto columns = uint32_t(2 * n);
  for (int i = 0; i <= n; ++i)
    for (uint32_t j = 0; j <= columns; ++j) {
      const float theta = pi * float(i) / float(n), phi = 2 * pi * float(j % columns) / float(columns);
      const Vec3 d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
      mesh.positions.push_back(centre + radius * d);
      mesh.normals.push_back(glm::normalize(d + bend * Vec3(std::sin(9 * phi), std::cos(7 * theta), 0)));
      mesh.uvs.push_back({float(j) / float(columns), float(i) / float(n)});
    }
  for (uint32_t i = 0; i < uint32_t(n); ++i)
    for (uint32_t j = 0; j < columns; ++j) {
      const uint32_t a = i * (columns + 1) + j, b = a + columns + 1;
      if (i + 1 < uint32_t(n)) mesh.triangles.push_back({a, b + 1, b});
      if (i > 0) mesh.triangles.push_back({a, a + 1, b + 1});
    }
  return mesh;
}

uint32_t add_light(Scene& scene, LightKind kind, const Slot& radiance) {
  Light light;
  light.kind = kind;
  light.radiance = radiance;
  scene.lights.push_back(light);
  return uint32_t(scene.lights.size() - 1);
}

uint32_t emit(Scene& scene, uint32_t shape, const Slot& radiance) {
  const uint32_t light = add_light(scene, LightKind::area, radiance);
  scene.lights[light].shape = shape;
  scene.shapes[shape].light = light;
  return light;
}

Slot add_texture(Scene& scene, int width, int height, std::vector<float> rgb) {
  Image image;
  image.width = width, image.height = height, image.channels = 3;
  image.floats = std::move(rgb);
  scene.images.push_back(std::move(image));
  Texture texture;
  texture.image = uint32_t(scene.images.size() - 1);
  scene.textures.push_back(texture);
  Slot slot;
  slot.texture = uint32_t(scene.textures.size() - 1);
  return slot;
}

Mat4 look_at(const Vec3& eye, const Vec3& target) {
  const Vec3 z = glm::normalize(target - eye), up = std::abs(z.y) > 0.99f ? Vec3(0, 0, 1) : Vec3(0, 1, 0);
  const Vec3 x = glm::normalize(glm::cross(up, z)), y = glm::cross(z, x);
  return {Vec4(x, 0), Vec4(y, 0), Vec4(z, 0), Vec4(eye, 1)};
}

void look(Scene& scene, const Vec3& eye, const Vec3& target, float fov_x_degrees, int width, int height) {
  Camera& c = scene.camera;
  c.width = c.crop_width = width;
  c.height = c.crop_height = height;
  set_perspective(c, fov_x_degrees, look_at(eye, target));
}

void add_open_room(Scene& scene, uint32_t floor_material) {
  const uint32_t grey = add_diffuse(scene, Rgb(0.6f)), red = add_diffuse(scene, {0.6f, 0.1f, 0.1f});
  const uint32_t green = add_diffuse(scene, {0.1f, 0.6f, 0.1f});
  add_quad(scene, {-1, -1, 1}, {2, 0, 0}, {0, 0, -2}, floor_material == none ? grey : floor_material);
  add_quad(scene, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, grey);
  add_quad(scene, {-1, -1, 1}, {0, 0, -2}, {0, 2, 0}, red);
  add_quad(scene, {1, -1, -1}, {0, 0, 2}, {0, 2, 0}, green);
}

void add_ceiling(Scene& scene) { add_quad(scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, add_diffuse(scene, Rgb(0.6f))); }

uint32_t add_lamp(Scene& scene, float half, const Slot& radiance) {
  const uint32_t black = add_diffuse(scene, Rgb(0));
  return emit(scene, add_quad(scene, {-half, 0.98f, -half}, {2 * half, 0, 0}, {0, 0, 2 * half}, black), radiance);
}

Scene stage(int size) {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  look(scene, {0, 0, 4.2f}, {0, 0, 0}, 36, size, size);
  add_open_room(scene);
  add_ceiling(scene);
  add_lamp(scene, 0.4f, Rgb(12, 10, 8));
  return scene;
}

}  // namespace ajar::kit
