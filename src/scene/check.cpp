#include "check.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "ajar/core/error.h"
#include "ajar/scene/geometry.h"
#include "bounds.h"

namespace ajar {
namespace {

// A part of the scene, for messages: "material 3".
struct Named {
  const char* kind;
  size_t index;
};

[[noreturn]] void refuse(const Named& part, const std::string& what) {
  throw Error(fmt::format("scene: {} {}: {}", part.kind, part.index, what));
}

template <class T>
void check_index(const Named& part, const char* name, uint32_t index, const std::vector<T>& list, const char* lists) {
  if (index < list.size()) return;
  refuse(part, index == none ? fmt::format("has no {}; give it one of the scene's {}", name, lists)
                             : fmt::format("its {} is {}, and the scene has {} {}", name, index, list.size(), lists));
}

void check_slot(const Scene& scene, const Named& part, const char* name, const Slot& slot, bool is_light) {
  if (slot.texture != none) return check_index(part, name, slot.texture, scene.textures, "textures");
  if (!is_finite(slot.value)) refuse(part, fmt::format("its {} is not finite; give it numbers", name));
  if (is_light && std::min({slot.value.x, slot.value.y, slot.value.z}) < 0)
    refuse(part, fmt::format("its {} is negative; give it 0 or more", name));
}

void check_image(const Named& part, const Image& image) {
  const size_t pixels = size_t(std::max(image.width, 0)) * size_t(std::max(image.height, 0));
  if (pixels == 0 || (image.channels != 1 && image.channels != 3))
    refuse(part, fmt::format("is of {}x{} pixels of {} channels; it needs one pixel or more, of 1 or 3 channels",
                             image.width, image.height, image.channels));
  const size_t numbers = image.bytes.empty() ? image.floats.size() : image.bytes.size();
  if (numbers != pixels * size_t(image.channels))
    refuse(part, fmt::format("has {} numbers; {}x{} pixels of {} channels are {}", numbers, image.width, image.height,
                             image.channels, pixels * size_t(image.channels)));
  if (!image.alpha.empty() && image.alpha.size() != pixels)
    refuse(part, fmt::format("its alpha has {} numbers, and there are {} pixels", image.alpha.size(), pixels));
}

constexpr int most_textures_deep = 256;

// Textures in each other on the longest way down from one, itself included. found: of those that are known, else 0.
int texture_depth(const Scene& scene, uint32_t id, int above, std::vector<int>& found) {
  if (found[id] > 0) return found[id];
  int below = 0;
  if (above < most_textures_deep)
    for (const Slot* slot : {&scene.textures[id].color0, &scene.textures[id].color1})
      if (slot->texture != none) below = std::max(below, texture_depth(scene, slot->texture, above + 1, found));
  if (above >= most_textures_deep || below >= most_textures_deep)
    refuse({"texture", id}, fmt::format("is nested more than {} deep, or inside itself", most_textures_deep));
  return found[id] = below + 1;
}

void check_textures(const Scene& scene) {
  for (size_t i = 0; i < scene.textures.size(); ++i) {
    const Texture& t = scene.textures[i];
    const Named part{"texture", i};
    if (t.kind == TextureKind::bitmap) {
      check_index(part, "image", t.image, scene.images, "images");
      check_image({"image", t.image}, scene.images[t.image]);
    }
    check_slot(scene, part, "color0", t.color0, false), check_slot(scene, part, "color1", t.color1, false);
  }
  std::vector<int> found(scene.textures.size());
  for (uint32_t i = 0; i < scene.textures.size(); ++i) texture_depth(scene, i, 0, found);
}

constexpr std::pair<const char*, Slot Material::*> reflecting_slots[] = {{"reflectance", &Material::reflectance},
                                                                         {"specular", &Material::specular},
                                                                         {"transmittance", &Material::transmittance}};
constexpr std::pair<const char*, Slot Material::*> other_slots[] = {{"alpha_u", &Material::alpha_u},
                                                                    {"alpha_v", &Material::alpha_v},
                                                                    {"exponent", &Material::exponent},
                                                                    {"weight", &Material::weight},
                                                                    {"map", &Material::map},
                                                                    {"roughness", &Material::roughness},
                                                                    {"anisotropic", &Material::anisotropic},
                                                                    {"metallic", &Material::metallic},
                                                                    {"spec_trans", &Material::spec_trans},
                                                                    {"spec_tint", &Material::spec_tint},
                                                                    {"sheen", &Material::sheen},
                                                                    {"sheen_tint", &Material::sheen_tint},
                                                                    {"clearcoat", &Material::clearcoat},
                                                                    {"clearcoat_gloss", &Material::clearcoat_gloss},
                                                                    {"flatness", &Material::flatness}};

void check_materials(const Scene& scene) {
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& m = scene.materials[i];
    const Named part{"material", i};
    for (const auto& [name, slot] : reflecting_slots) check_slot(scene, part, name, m.*slot, true);
    for (const auto& [name, slot] : other_slots) check_slot(scene, part, name, m.*slot, false);
    for (const uint32_t nested : m.nested)
      if (nested != none) check_index(part, "nested material", nested, scene.materials, "materials");
    if (m.ior <= 0) refuse(part, fmt::format("its ior is {}; give it more than 0", m.ior));
    if (!is_finite(m.eta) || !is_finite(m.k) || !std::isfinite(m.ior + m.map_scale))
      refuse(part, "its eta, k, ior or map_scale is not finite; give it numbers");
    for (const float w : m.weights)
      if (!(w >= 0 && w < infinity)) refuse(part, fmt::format("one of its weights is {}; give it 0 or more", w));
  }
}

void check_length(const Named& part, const std::string& name, size_t length, size_t wanted, const char* of) {
  if (length != 0 && length != wanted)
    refuse(part, fmt::format("has {} {} and {} {}; give it as many, or none", length, name, wanted, of));
}

uint32_t largest(const glm::uvec3& t) { return std::max(t.x, std::max(t.y, t.z)); }

uint32_t largest_index(const std::vector<glm::uvec3>& triangles) {
  return reduce(
      triangles.size(), 0u,
      [&](size_t from, size_t to) {
        uint32_t most = 0;
        for (size_t i = from; i < to; ++i) most = std::max(most, largest(triangles[i]));
        return most;
      },
      [](uint32_t a, uint32_t b) { return std::max(a, b); });
}

// Not finite where one of them is not.
Vec3 sum_of(const std::vector<Vec3>& positions) {
  return reduce(
      positions.size(), Vec3(0),
      [&](size_t from, size_t to) {
        Vec3 sum(0);
        for (size_t i = from; i < to; ++i) sum += glm::abs(positions[i]) * 1e-10f;
        return sum;
      },
      [](const Vec3& a, const Vec3& b) { return a + b; });
}

void check_mesh(const Named& part, const Mesh& mesh) {
  const size_t vertices = mesh.positions.size();
  check_length(part, "normals", mesh.normals.size(), vertices, "positions");
  check_length(part, "uvs", mesh.uvs.size(), vertices, "positions");
  check_length(part, "colors", mesh.colors.size(), vertices, "positions");
  if (!is_finite(sum_of(mesh.positions))) refuse(part, "one of its positions is not finite, or beyond measure");
  for (const Attribute& a : mesh.attributes)
    check_length(part, fmt::format("values of its attribute \"{}\"", a.name), a.values.size(),
                 a.of_faces ? mesh.triangles.size() : vertices, a.of_faces ? "triangles" : "positions");
  if (mesh.triangles.empty() || largest_index(mesh.triangles) < vertices) return;
  for (size_t i = 0; i < mesh.triangles.size(); ++i)
    if (const uint32_t index = largest(mesh.triangles[i]); index >= vertices)
      refuse(part, fmt::format("its triangle {} has a corner {}, and there are {} positions, counted from 0", i, index,
                               vertices));
}

bool all_finite(const Mat4& m) {
  return is_finite(Vec3(m[0])) && is_finite(Vec3(m[1])) && is_finite(Vec3(m[2])) && is_finite(Vec3(m[3]));
}

void check_shape(const Scene& scene, uint32_t id) {
  const Shape& s = scene.shapes[id];
  const Named part{"shape", id};
  if (!all_finite(s.to_world) || !all_finite(s.to_object))
    refuse(part, "its to_world cannot be inverted; give it finite numbers, and an extent each way");
  if (s.kind == ShapeKind::sphere && !is_similarity(glm::dmat4(s.to_world), 0.01))
    refuse(part, "its to_world stretches the sphere; take add_globe and transform that, or an instance");
  if (s.kind == ShapeKind::mesh) check_index(part, "mesh", s.mesh, scene.meshes, "meshes");
  check_index(part, "material", s.material, scene.materials, "materials");
  if (s.mask != none) check_index(part, "mask", s.mask, scene.materials, "materials");
  if (s.group != none && s.group >= scene.groups)
    refuse(part, fmt::format("its group is {}, and the scene has {}", s.group, scene.groups));
  if (s.light == none) return;
  if (s.group != none) refuse(part, "is a light and in a group; lights stand by themselves");
  check_index(part, "light", s.light, scene.lights, "lights");
  if (const Light& light = scene.lights[s.light]; light.kind != LightKind::area || light.shape != id)
    refuse(part,
           fmt::format("its light {} is not an area light of this shape; let add_area_light join the two", s.light));
}

void check_instance(const Scene& scene, size_t id) {
  const Instance& i = scene.instances[id];
  if (i.group >= scene.groups)
    refuse({"instance", id}, fmt::format("its group is {}, and the scene has {}", i.group, scene.groups));
  if (!all_finite(i.to_world) || !all_finite(i.to_object))
    refuse({"instance", id}, "its to_world cannot be inverted; give it finite numbers, and an extent each way");
}

bool is_extent(const Vec2& v, float most) { return v.x > 0 && v.y > 0 && v.x < most && v.y < most; }

void check_light(const Scene& scene, uint32_t id) {
  const Light& light = scene.lights[id];
  const Named part{"light", id};
  check_slot(scene, part, "radiance", light.radiance, true);
  if (!(light.sampling_weight >= 0 && light.sampling_weight < infinity))
    refuse(part, fmt::format("its sampling_weight is {}; give it 0 or more", light.sampling_weight));
  if (!(max_abs(light.position) <= farthest)) refuse(part, fmt::format("stands farther than {} units away", farthest));
  if (!is_finite(light.direction) || light.direction == Vec3(0)) refuse(part, "its direction is none");
  if (light.kind == LightKind::sun && !(light.cone > 0 && light.cone <= 1))
    refuse(part,
           fmt::format("its cone is {}; give a sun one above 0, 1 at most, or take a directional light", light.cone));
  if (light.kind == LightKind::spot && !(light.cutoff > 0 && light.cutoff <= pi && light.beam <= light.cutoff))
    refuse(part, fmt::format("its cutoff is {} and its beam {}; give a spot a cutoff above 0, pi at most, and a beam "
                             "within it",
                             light.cutoff, light.beam));
  if (light.kind == LightKind::projector && !is_extent(light.plane, infinity))
    refuse(part, "its picture has no extent; give its plane two numbers above 0");
  if (light.kind == LightKind::area) {
    check_index(part, "shape", light.shape, scene.shapes, "shapes");
    if (scene.shapes[light.shape].light != id)
      refuse(part,
             fmt::format("its shape {} has another light, or none; let add_area_light join the two", light.shape));
  }
  if (light.kind != LightKind::envmap) return;
  check_index(part, "environment", light.environment, scene.environments, "environments");
  const float scale = scene.environments[light.environment].scale;
  if (!(scale >= 0 && scale < infinity)) refuse(part, fmt::format("its scale is {}; give it 0 or more", scale));
  const uint32_t image = scene.environments[light.environment].image;
  check_index({"environment", light.environment}, "image", image, scene.images, "images");
  check_image({"image", image}, scene.images[image]);
}

constexpr float nearest_focus = 1e-12f;  // nearer, rays have no direction in single precision

// Whether it holds what no light is: negative numbers, as maps of normals do, or such as are not finite.
bool is_no_light(const Image& image) {
  return !std::all_of(image.floats.begin(), image.floats.end(), [](float x) { return x >= 0 && x < infinity; });
}

// The first image that a texture shows, itself or by those in it, and that is no light; none. found: of textures that
// were asked for.
uint32_t image_without_light(const Scene& scene, uint32_t texture, const std::vector<bool>& refused,
                             std::vector<std::optional<uint32_t>>& found) {
  if (texture == none) return none;
  if (found[texture]) return *found[texture];
  const Texture& t = scene.textures[texture];
  uint32_t image = t.kind == TextureKind::bitmap && refused[t.image] ? t.image : none;
  for (const Slot* slot : {&t.color0, &t.color1})
    if (image == none) image = image_without_light(scene, slot->texture, refused, found);
  found[texture] = image;
  return image;
}

void check_images(const Scene& scene) {
  std::vector<bool> refused;
  for (const Image& image : scene.images) refused.push_back(is_no_light(image));
  std::vector<std::optional<uint32_t>> found(scene.textures.size());
  const auto check = [&](const Named& part, const char* name, const Slot& slot) {
    if (const uint32_t image = image_without_light(scene, slot.texture, refused, found); image != none)
      refuse(part, fmt::format("image {} of its {} holds negative numbers, or such as are not finite; give it others",
                               image, name));
  };
  for (size_t i = 0; i < scene.materials.size(); ++i)
    for (const auto& [name, slot] : reflecting_slots) check({"material", i}, name, scene.materials[i].*slot);
  for (size_t i = 0; i < scene.lights.size(); ++i) check({"light", i}, "radiance", scene.lights[i].radiance);
}

}  // namespace

void check_camera(const Camera& c) {
  const auto refuse_camera = [](const std::string& what) { throw Error(fmt::format("scene: its camera {}", what)); };
  if (c.width < 1 || c.height < 1) refuse_camera("has less than a pixel; set its width and height");
  if (c.crop_width < 1 || c.crop_height < 1 || c.crop_x < 0 || c.crop_y < 0 || c.crop_width > c.width - c.crop_x ||
      c.crop_height > c.height - c.crop_y)
    refuse_camera("has a crop window that is not inside its film");
  if (!all_finite(c.to_world) || !all_finite(c.to_camera))
    refuse_camera("looks nowhere; give it a target apart from its eye, and a to_world that can be inverted");
  if (!(max_abs(Vec3(c.to_world[3])) <= farthest))
    refuse_camera(fmt::format("stands farther than {} units away", farthest));
  const bool flat = c.kind == CameraKind::orthographic;
  if (!is_extent(c.plane, farthest)) refuse_camera("has no view; give it a field of view between 0 and 180 degrees");
  if (!(c.aperture >= 0 && c.aperture <= farthest && c.focus > nearest_focus && c.focus < infinity))
    refuse_camera(fmt::format("has a lens that is none; give it an aperture of 0 to {}, and a focus beyond {}",
                              farthest, nearest_focus));
  if (!(c.near_clip >= (flat ? -farthest : 0) && c.near_clip <= farthest && c.far_clip > c.near_clip))
    refuse_camera(fmt::format("has clip planes that are none; give it a near one of {} to {}, and a far one beyond it",
                              flat ? -farthest : 0, farthest));
  if (!(std::abs(c.principal.x) <= 100 && std::abs(c.principal.y) <= 100))
    refuse_camera("has a principal point more than 100 images away");
}

void check_parts(const Scene& scene) {
  check_camera(scene.camera);
  check_textures(scene);
  check_materials(scene);
  for (size_t i = 0; i < scene.meshes.size(); ++i) check_mesh({"mesh", i}, scene.meshes[i]);
  for (uint32_t i = 0; i < scene.shapes.size(); ++i) check_shape(scene, i);
  for (uint32_t i = 0; i < scene.lights.size(); ++i) check_light(scene, i);
  for (size_t i = 0; i < scene.instances.size(); ++i) check_instance(scene, i);
  check_images(scene);
}

}  // namespace ajar
