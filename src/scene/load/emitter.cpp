#include <fmt/format.h>

#include <algorithm>

#include "ajar/scene/geometry.h"
#include "loader.h"

namespace ajar {
namespace {

constexpr const char* supported_emitters =
    "supported: area, envmap, constant, point, spot, directional, projector, sky, sun, sunsky";

DVec3 checked_direction(const Loader& loader, const Node& node, const DVec3& d) {
  const double length = glm::length(d);
  if (!(length > 1e-30)) fail(loader, node, "its direction is the zero vector; it should point somewhere");
  return d / length;
}

Light make_light(Params& p, LightKind kind) {
  Light light;
  light.kind = kind;
  const double weight = number(p, "sampling_weight", 1);
  if (weight < 0) fail(p.loader, p.node, "sampling_weight should not be negative");
  light.sampling_weight = float(weight);
  return light;
}

// Where a list of wavelengths would stand, or a number in its place: a <spectrum>, or the value of a plugin called so.
const Node* list_in(const Node& node) {
  if (node.tag == "spectrum" && node.type.empty()) return &node;
  if (node.type == "spectrum")
    for (const Node& child : node.children)
      if (child.name == "value" && child.tag != "rgb") return &child;
  return nullptr;
}

// What a colour of light is multiplied by: a number in a <spectrum> is a flat list to Mitsuba 3, and so of the tint of
// equal energy. In version 0.x it is white.
Rgb tint(Params& p, const char* name) {
  const Node* node = find(p, {name});
  const Node* list = node != nullptr ? list_in(*node) : nullptr;
  const std::string* value = list != nullptr ? attribute(*list, "value") : nullptr;
  const auto numbers = value == nullptr || p.loader.document.old ? std::nullopt : to_numbers(*value);
  if (!numbers || numbers->size() != 1) return Rgb(1);
  return rgb_of_list({{300, 1}, {900, 1}}, Colour::emission);
}

Slot one_colour(Params& p, const char* name) { return colour(p, name, Rgb(1), Colour::emission) * tint(p, name); }

Slot colour_or_texture(Params& p, const char* name) {
  Slot s = slot(p, {name}, 1.0f, Colour::emission);
  s.value *= tint(p, name);
  return s;
}

// Factors that are numbers each may have a product that is none. Texels alone are numbers.
void add(Params& p, Light&& light) {
  const Scene& scene = p.loader.scene;
  const uint32_t texture = light.radiance.texture;
  Shown shown;
  list_shown(scene, light.radiance, shown);
  const bool may_overflow = texture == none || scene.textures[texture].kind != TextureKind::bitmap;
  if (may_overflow && shown.attributes.empty() && !is_finite(maximum(scene, light.radiance)))
    fail(p.loader, p.node, "its largest value times its scale is beyond what numbers hold");
  p.loader.scene.lights.push_back(std::move(light));
}

void area(Params& p, uint32_t shape) {
  Light light = make_light(p, LightKind::area);
  light.radiance = colour_or_texture(p, "radiance");
  light.shape = shape;
  p.loader.scene.shapes[shape].light = uint32_t(p.loader.scene.lights.size());
  add(p, std::move(light));
}

void constant(Params& p) {
  Light light = make_light(p, LightKind::constant);
  light.radiance = one_colour(p, "radiance");
  add(p, std::move(light));
}

void envmap(Params& p) {
  Light light = make_light(p, LightKind::envmap);
  const std::string path = file(p, "filename");
  const double scale = number(p, "scale", 1);
  if (scale < 0) fail(p.loader, p.node, "scale should not be negative");
  const uint32_t stored = load_image_file(p.loader, p.node, path, boolean(p, "raw", false), number(p, "gamma", 0));
  const uint32_t image = limited_image(p.loader, p.node, stored, Colour::emission);
  light.to_world = orientation(regular_to_world(p));
  light.environment = uint32_t(p.loader.scene.environments.size());
  p.loader.scene.environments.push_back(make_environment(p.loader.scene, image, float(scale), !p.loader.document.old));
  add(p, std::move(light));
}

void point(Params& p) {
  Light light = make_light(p, LightKind::point);
  light.radiance = one_colour(p, "intensity");
  const Node* position = find(p, {"position"});
  const DVec3 at = position == nullptr ? DVec3(0) : vector_of(p.loader, *position, 0);
  const DVec3 place(to_world(p) * glm::dvec4(at, 1));
  require_near(p, place);
  light.position = Vec3(place);
  add(p, std::move(light));
}

// Where a light stands that throws a cone or a picture, and how it is turned.
void put(Params& p, const DMat4& m, Light& light) {
  require_near(p, DVec3(m[3]));
  light.to_world = orientation(m);
  light.position = Vec3(DVec3(m[3]));
  light.to_world[3] = Vec4(light.position, 1);
}

// A picture that is thrown is of no mesh.
void refuse_attributes(Params& p, const Slot& picture) {
  Shown shown;
  list_shown(p.loader.scene, picture, shown);
  if (!shown.attributes.empty())
    unsupported(p.loader, p.node, "its picture shows a mesh attribute, and it has no mesh", "black in its place");
}

// The picture that a spot throws is its texture times its intensity.
void project_texture(Params& p, double cutoff, Light& light) {
  const Node* node = find(p, {"texture"});
  if (node == nullptr) return;
  const Slot picture = slot_of(p.loader, *node, Colour::ratio);
  if (picture.texture != none && !(cutoff < 90))
    fail(p.loader, p.node, "with a texture cutoff_angle should be less than 90 degrees");
  refuse_attributes(p, picture);
  light.radiance = product(p, picture, light.radiance);
}

void spot(Params& p) {
  Light light = make_light(p, LightKind::spot);
  light.radiance = one_colour(p, "intensity");
  const double cutoff = number(p, "cutoff_angle", 20), beam = number(p, "beam_width", cutoff * 3 / 4);
  if (!(cutoff > 0 && cutoff <= 180)) fail(p.loader, p.node, "cutoff_angle should be above 0, at most 180 degrees");
  if (!(beam >= 0 && beam <= cutoff)) fail(p.loader, p.node, "beam_width should be from 0 to cutoff_angle");
  light.cutoff = std::min(float(glm::radians(cutoff)), pi);
  light.beam = float(glm::radians(beam));
  project_texture(p, cutoff, light);
  const DMat4 m = regular_to_world(p);
  if (!is_similarity(m, off_by_rounding))
    unsupported(p.loader, p.node, "its to_world stretches its cone: turn, move and scale alone", "round in its place");
  put(p, m, light);
  light.direction = Vec3(checked_direction(p.loader, p.node, DVec3(m[2])));
  add(p, std::move(light));
}

void directional(Params& p) {
  Light light = make_light(p, LightKind::directional);
  light.radiance = one_colour(p, "irradiance");
  const Node* direction = find(p, {"direction"});
  const DVec3 d = direction == nullptr ? DVec3(0, 0, 1) : vector_of(p.loader, *direction, 0);
  light.direction = Vec3(checked_direction(p.loader, p.node, DVec3(to_world(p) * glm::dvec4(d, 0))));
  add(p, std::move(light));
}

// A picture thrown through a pinhole: the reverse of a perspective camera. Mitsuba's irradiance lacks a factor of pi.
void projector(Params& p) {
  Light light = make_light(p, LightKind::projector);
  const double scale = number(p, "scale", 1);
  if (scale < 0) fail(p.loader, p.node, "scale should not be negative");
  const Slot picture = colour_or_texture(p, "irradiance");
  refuse_attributes(p, picture);
  light.radiance = product(p, picture, float(scale * std::numbers::pi));
  Camera camera;
  camera.width = camera.height = 1;
  const Scene& scene = p.loader.scene;
  if (picture.texture != none && scene.textures[picture.texture].kind == TextureKind::bitmap) {
    const Image& image = scene.images[scene.textures[picture.texture].image];
    camera.width = image.width, camera.height = image.height;
  }
  const double x = tan_half_x(p, camera);
  light.plane = Vec2(float(x), float(x * camera.height / camera.width));
  const DMat4 m = regular_to_world(p);
  if (!is_similarity(m, off_by_rounding))
    fail(p.loader, p.node, "its to_world should not stretch: turn, move and scale alone");
  put(p, m, light);
  light.direction = Vec3(light.to_world[2]);
  add(p, std::move(light));
}

void sky(Params& p) { load_daylight(p, true, false); }
void sun(Params& p) { load_daylight(p, false, true); }
void sunsky(Params& p) { load_daylight(p, true, true); }

struct EmitterReader {
  const char* type;
  void (*read)(Params&);
};
constexpr EmitterReader emitter_readers[] = {
    {"constant", constant},   {"envmap", envmap}, {"point", point}, {"spot", spot},    {"directional", directional},
    {"projector", projector}, {"sky", sky},       {"sun", sun},     {"sunsky", sunsky}};

}  // namespace

DMat4 regular_to_world(Params& p) {
  const DMat4 m = to_world(p);
  const DVec3 x(m[0]), y(m[1]), z(m[2]);
  const double size = glm::length(x) * glm::length(y) * glm::length(z);
  if (!(size > 0) || !(std::abs(glm::dot(x, glm::cross(y, z))) > 1e-9 * size))
    fail(p.loader, p.node, "its to_world is singular");
  return m;
}

void require_near(const Params& p, const DVec3& at) {
  const double most = std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)});
  if (!(most <= farthest))
    fail(p.loader, p.node, fmt::format("it stands farther than {} units away; move it nearer", farthest));
}

Mat4 orientation(const DMat4& m) {
  DMat4 r(1);
  for (int i = 0; i < 3; ++i) r[i] = DMat4::col_type(glm::normalize(DVec3(m[i])), 0);
  return Mat4(r);
}

void load_emitter(Loader& loader, const Node& node, uint32_t shape) {
  Params p(loader, node);
  const bool is_area = node.type == "area";
  const auto reader = std::find_if(std::begin(emitter_readers), std::end(emitter_readers),
                                   [&](const EmitterReader& e) { return node.type == e.type; });
  if (!is_area && reader == std::end(emitter_readers))
    return unsupported(loader, node, fmt::format("{}; {}", unknown(node), supported_emitters), "left out");
  if (is_area && shape == none) fail(loader, node, "an area light belongs inside the <shape> that emits");
  if (!is_area && shape != none)
    return unsupported(loader, node, "only an area light can be inside a shape", "left out");
  if (is_area)
    area(p, shape);
  else
    reader->read(p);
  finish(p, {"id", "cache", "mis_compensation", "albedo", "resolution"});
}

}  // namespace ajar
