#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "ajar/core/error.h"
#include "ajar/core/srgb.h"
#include "ajar/scene/geometry.h"
#include "obj.h"
#include "parts.h"

namespace ajar {
namespace {

constexpr const char* supported_shapes =
    "supported: obj, ply, serialized, rectangle, cube, sphere, disk, cylinder, shapegroup, instance, merge";
constexpr int sphere_rings = 128, sphere_segments = 256;  // of a sphere that its transform makes an ellipsoid

double determinant(const DMat4& m) { return glm::dot(DVec3(m[0]), glm::cross(DVec3(m[1]), DVec3(m[2]))); }

// Flat shapes do not use the z column: one that is zero or lies in the plane is replaced, the surface stays the same.
void repair_flat(DMat4& m) {
  const DVec3 x(m[0]), y(m[1]), z(m[2]), n = glm::cross(x, y);
  const double area = glm::length(n);
  if (area > 0 && std::abs(glm::dot(n, z)) <= 1e-12 * area * std::max(glm::length(z), std::sqrt(area)))
    m[2] = DMat4::col_type(n / std::sqrt(area), 0);
}

void check_invertible(const Loader& loader, const Node& node, const DMat4& m) {
  const double size = glm::length(DVec3(m[0])) * glm::length(DVec3(m[1])) * glm::length(DVec3(m[2]));
  if (!(size > 1e-90) || !(std::abs(determinant(m)) > 1e-14 * size))
    fail(loader, node, "its to_world is singular: it flattens the shape; scale every axis by more than 0");
  const Mat4 inverse = Mat4(glm::inverse(m));
  for (int i = 0; i < 4; ++i)
    if (!is_finite(Vec3(inverse[i]))) fail(loader, node, "its to_world is beyond the range of numbers");
}

DMat4 shape_to_world(Params& p, bool flat) {
  DMat4 m = to_world(p);
  if (flat) repair_flat(m);
  check_invertible(p.loader, p.node, m);
  return m;
}

void place_quadric(Params& p, Shape& shape, const DMat4& m) {
  check_invertible(p.loader, p.node, m);
  shape.to_world = Mat4(m);
}

void turn(Mesh& mesh) {
  for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  for (Vec3& n : mesh.normals) n = -n;
}

uint32_t add_mesh(Params& p, Mesh&& mesh) {
  p.loader.scene.meshes.push_back(std::move(mesh));
  return uint32_t(p.loader.scene.meshes.size() - 1);
}

// A mesh without a file.
void simple_mesh(Params& p, Shape& shape, Mesh&& mesh, const DMat4& m) {
  try {
    transform(mesh, Mat4(m));
  } catch (const Error& error) {
    fail(p.loader, p.node, error.what());
  }
  if (boolean(p, "flip_normals", false)) turn(mesh);
  if (boolean(p, "face_normals", false)) mesh.normals.clear();
  shape.mesh = add_mesh(p, std::move(mesh));
}

// Axes at right angles, of one length, where those given are so but for rounding.
DMat4 squared_up(const DMat4& m) {
  const double size = std::cbrt(std::abs(determinant(m)));
  const DVec3 x = glm::normalize(DVec3(m[0])), y = glm::normalize(DVec3(m[1]) - x * glm::dot(x, DVec3(m[1])));
  const DVec3 z = determinant(m) < 0 ? glm::cross(y, x) : glm::cross(x, y);
  return DMat4(DMat4::col_type(size * x, 0), DMat4::col_type(size * y, 0), DMat4::col_type(size * z, 0), m[3]);
}

void sphere(Params& p, Shape& shape, const MeshPart&) {
  const Node* at = find(p, {"center"});
  DVec3 center = at == nullptr ? DVec3(0) : vector_of(p.loader, *at, 0);
  const double radius = positive(p, "radius", 1);
  const DMat4 placed = shape_to_world(p, false);
  if (p.loader.document.old) center /= glm::length(DVec3(placed[0]));  // which 0.x does not scale
  DMat4 local(radius);
  local[3] = DMat4::col_type(center, 1);
  const DMat4 m = placed * local;
  check_invertible(p.loader, p.node, m);
  const bool mirrored = !p.loader.document.old && determinant(m) < 0;
  if (!is_similarity(m, off_by_rounding)) {
    note(p.loader, p.node,
         fmt::format("to_world makes an ellipsoid of it: rendered as a mesh of {} x {} cells (Mitsuba's stays round)",
                     sphere_rings, sphere_segments));
    simple_mesh(p, shape, make_sphere(sphere_rings, sphere_segments), m);
    if (mirrored) turn(p.loader.scene.meshes[shape.mesh]);
    return;
  }
  shape.kind = ShapeKind::sphere;
  shape.flip = boolean(p, "flip_normals", false) != mirrored;
  place_quadric(p, shape, squared_up(m));
}

void disk(Params& p, Shape& shape, const MeshPart&) {
  shape.kind = ShapeKind::disk;
  shape.flip = boolean(p, "flip_normals", false);
  DMat4 m = shape_to_world(p, true);
  const double radius = positive(p, "radius", 1);
  m[0] *= radius;
  m[1] *= radius;
  place_quadric(p, shape, m);
}

void cylinder(Params& p, Shape& shape, const MeshPart&) {
  shape.kind = ShapeKind::cylinder;
  const Node *from = find(p, {"p0"}), *to = find(p, {"p1"});
  const DVec3 p0 = from == nullptr ? DVec3(0) : vector_of(p.loader, *from, 0);
  const DVec3 p1 = to == nullptr ? DVec3(0, 0, 1) : vector_of(p.loader, *to, 0);
  const double radius = positive(p, "radius", 1), length = glm::length(p1 - p0);
  if (!(length > 0)) fail(p.loader, p.node, "p0 and p1 are the same point; move one of them");
  const DVec3 z = (p1 - p0) / length, x = across(z, p.loader.document.old);  // where u begins
  DMat4 local(1);
  local[0] = DMat4::col_type(x * radius, 0);
  local[1] = DMat4::col_type(glm::cross(z, x) * radius, 0);
  local[2] = DMat4::col_type(p1 - p0, 0);
  local[3] = DMat4::col_type(p0, 1);
  const DMat4 placed = shape_to_world(p, false);
  shape.flip = boolean(p, "flip_normals", false) != (determinant(placed) < 0);
  const DMat4 m = placed * local;
  place_quadric(p, shape, m);
  DMat4 section = m;
  section[2] *= glm::length(DVec3(m[0])) / glm::length(DVec3(m[2]));
  if (!is_similarity(section)) note(p.loader, p.node, "to_world stretches it across or shears it: it is not round");
}

void rectangle(Params& p, Shape& shape, const MeshPart&) {
  simple_mesh(p, shape, make_rectangle(), shape_to_world(p, true));
}
void cube(Params& p, Shape& shape, const MeshPart&) { simple_mesh(p, shape, make_cube(), shape_to_world(p, false)); }

// The mesh of the shape that comes next, if an earlier load placed it where it is now.
bool take_placed(const Loader& loader, const std::string& source, const DMat4& m, Mesh& out) {
  if (!loader.cache) return false;
  const auto kept = loader.cache->meshes.find(loader.scene.shapes.size());
  if (kept == loader.cache->meshes.end() || kept->second.source != source || kept->second.to_world != m) return false;
  out = kept->second.mesh;
  return true;
}

void keep_placed(Loader& loader, const std::string& source, const DMat4& m, const Mesh& mesh) {
  if (loader.cache)
    loader.cache->meshes.insert_or_assign(loader.scene.shapes.size(), LoadCache::Placed{source, m, mesh});
}

// Meshes from files: what more than one shape names is parsed once, where moving it afterwards changes nothing.
template <class Read>
void file_mesh(Params& p, Shape& shape, const std::string& key, MeshOptions options, const Read& read) {
  const DMat4 m = shape_to_world(p, false);
  options.face_normals = boolean(p, "face_normals", false);
  options.flip_normals = boolean(p, "flip_normals", false);
  options.max_smooth_angle = float(number(p, "max_smooth_angle", -1));
  options.flip_v = boolean(p, "flip_tex_coords", options.flip_v);
  Mesh mesh;
  try {
    const std::string exact = fmt::format("{}|{}{}{}{}{}{}{}|{}|{}", key, options.face_normals, options.flip_normals,
                                          options.flip_v, options.srgb, options.encoded, options.weld, options.apart,
                                          options.group, options.max_smooth_angle);
    const int left = --p.loader.mesh_uses[key];
    if (take_placed(p.loader, exact, m, mesh)) {
      shape.mesh = add_mesh(p, std::move(mesh));
      return;
    }
    const auto kept = p.loader.meshes.find(exact);
    const bool known = kept != p.loader.meshes.end();
    if ((left > 0 || known) && is_similarity(m) && determinant(m) > 0) {
      mesh = known ? left > 0 ? kept->second : std::move(kept->second) : read(options);
      if (left > 0 && !known) p.loader.meshes.emplace(exact, mesh);
      if (left <= 0 && known) p.loader.meshes.erase(kept);
      transform(mesh, Mat4(m));
    } else {
      options.to_world = Mat4(m);
      mesh = read(options);
    }
    keep_placed(p.loader, exact, m, mesh);
  } catch (const Error& error) {
    fail(p.loader, p.node, error.what());
  }
  shape.mesh = add_mesh(p, std::move(mesh));
}

void obj(Params& p, Shape& shape, const MeshPart& part) {
  const std::string path = file(p, "filename");
  MeshOptions options;
  options.flip_v = true;
  options.material = part.name, options.without = part.without;
  options.weld = p.loader.document.old;
  options.apart = p.loader.document.old && !boolean(p, "collapse", false);
  options.group = obj_group(p);
  const std::string key = options.group < 0 ? path : fmt::format("{}#{}", path, options.group);
  file_mesh(p, shape, is_some(part) ? key + "#" + part.name : key, options, [&](const MeshOptions& o) {
    const bool open = is_some(part) || o.group >= 0 || (p.loader.obj && p.loader.obj->name == path);
    return open ? join(open_obj(p.loader, path), o) : read_obj(path, o);
  });
}

// Colours of vertices that are encoded as sRGB, as linear ones.
void decode(std::vector<Rgb>& colors) {
  const auto linear = [](float x) { return float(std::min(decode_srgb(x), 1e30)); };  // finite
  for (Rgb& c : colors) c = {linear(c.x), linear(c.y), linear(c.z)};
}

void ply(Params& p, Shape& shape, const MeshPart&) {
  const std::string path = file(p, "filename");
  std::vector<std::string> notes;
  MeshOptions options;
  options.notes = &notes;
  options.srgb = p.loader.document.old && boolean(p, "srgb", true);
  options.encoded = !p.loader.document.old;
  file_mesh(p, shape, path, options, [&](const MeshOptions& o) {
    Mesh mesh = read_ply(path, o);
    if (o.srgb) decode(mesh.colors);
    return mesh;
  });
  for (const std::string& text : notes) note(p.loader, p.node, text);
}

void serialized(Params& p, Shape& shape, const MeshPart&) {
  const std::string path = file(p, "filename");
  const int index = integer(p, "shape_index", 0, 0, 1 << 24);
  MeshOptions options;
  options.keeps_side = p.loader.document.old;
  file_mesh(p, shape, fmt::format("{}#{}", path, index), options,
            [&](const MeshOptions& o) { return read_serialized(path, index, o); });
}

struct ShapeReader {
  const char* type;
  void (*read)(Params&, Shape&, const MeshPart&);
};
constexpr ShapeReader shape_readers[] = {
    {"obj", obj}, {"rectangle", rectangle}, {"sphere", sphere}, {"serialized", serialized},
    {"ply", ply}, {"cube", cube},           {"disk", disk},     {"cylinder", cylinder}};

void list_shown(const Scene& scene, uint32_t material, Shown& out) {
  const Material& m = scene.materials[material];
  for (const Slot* slot : {&m.reflectance, &m.specular, &m.transmittance, &m.alpha_u, &m.alpha_v, &m.exponent,
                           &m.weight, &m.map, &m.roughness, &m.anisotropic, &m.metallic, &m.spec_trans, &m.spec_tint,
                           &m.sheen, &m.sheen_tint, &m.clearcoat, &m.clearcoat_gloss, &m.flatness})
    list_shown(scene, *slot, out);
  for (const uint32_t nested : m.nested)
    if (nested != none) list_shown(scene, nested, out);
}

void note_limits(Loader& loader, const Node& node, const Shown& shown, const Mesh& mesh) {
  for (const uint32_t limit : shown.limits)
    if (max_component(maximum(loader.scene, loader.scene.textures[limit].color0, &mesh)) > 1)
      note(loader, node, "its mesh attributes make reflectances above 1: there they become 1");
}

void note_negative(Loader& loader, const Node& node, const std::string& name, const std::vector<Rgb>& values) {
  if (std::any_of(values.begin(), values.end(), [](const Rgb& c) { return std::min({c.x, c.y, c.z}) < 0; }))
    note(loader, node, fmt::format("the mesh attribute \"{}\" has negative numbers: they show as 0", name));
}

// What the textures of a shape show has to be in its mesh.
void check_attributes(Loader& loader, const Node& node, const Shape& shape) {
  const Scene& scene = loader.scene;
  Shown shown;
  std::set<std::string> there;
  list_shown(scene, shape.material, shown);
  if (shape.light != none) list_shown(scene, scene.lights[shape.light].radiance, shown);
  if (shown.attributes.empty()) return;
  if (shape.kind == ShapeKind::mesh) {
    const Mesh& mesh = scene.meshes[shape.mesh];
    if (!mesh.colors.empty()) there.insert("vertex_color");
    if (shown.attributes.contains("vertex_color")) note_negative(loader, node, "vertex_color", mesh.colors);
    for (const Attribute& a : mesh.attributes) {
      there.insert(a.name);
      if (shown.attributes.contains(a.name) && !std::all_of(a.values.begin(), a.values.end(), is_finite))
        fail(loader, node, fmt::format("the mesh attribute \"{}\" has values that are not finite", a.name));
      if (shown.attributes.contains(a.name)) note_negative(loader, node, a.name, a.values);
    }
    note_limits(loader, node, shown, mesh);
  }
  for (const std::string& name : shown.attributes)
    if (!there.contains(name))
      unsupported(loader, node,
                  fmt::format("its textures show the mesh attribute \"{}\", which it lacks; it has {}",
                              name.substr(0, 80), there.empty() ? "none" : fmt::format("{}", fmt::join(there, ", "))),
                  "black in its place");
}

void refuse_media(Params& p) {
  for (const Node* medium : nested(p, "medium"))
    unsupported(p.loader, *medium, fmt::format("participating media are not supported (shape at line {})", p.node.line),
                "left out");
  for (const Node* inside : nested(p, "subsurface"))
    unsupported(p.loader, *inside, "subsurface scattering is not supported", "left out");
}

// Mitsuba has sensors that measure what arrives at a shape.
void refuse_sensors(Params& p) {
  for (const Node* sensor : nested(p, "sensor"))
    unsupported(p.loader, *sensor,
                is_camera(*sensor) ? "a sensor inside a shape is not supported; put it beside the shape"
                                   : unknown_sensor(*sensor),
                "left out");
}

// What stands in a shape by a misunderstanding.
void note_strays(Params& p, const char* tag, const char* text) {
  for (size_t i = 0; i < p.node.children.size(); ++i) {
    const Node& child = p.node.children[i];
    if (p.used[i] || follow(p.loader, child).tag != tag) continue;
    p.used[i] = true;
    note(p.loader, child, text);
  }
}

void load_instance(Loader& loader, const Node& node, uint32_t group) {
  if (group != none)
    return unsupported(loader, node,
                       "an instance inside a shapegroup is not supported; put the shapes that it shows there",
                       "left out");
  Params p(loader, node);
  const std::vector<const Node*> groups = nested(p, "shape");
  if (groups.size() != 1 || groups.front()->type != "shapegroup")
    fail(loader, node, "needs a <ref> to one <shape type=\"shapegroup\">");
  Instance instance;
  const DMat4 m = shape_to_world(p, false);
  instance.group = load_shape_group(loader, *groups.front());
  instance.to_world = Mat4(m);
  loader.scene.instances.push_back(instance);
  note_strays(p, "bsdf", "an instance shows its shapegroup as it is: not used; give it to the shapes of the group");
  note_strays(p, "emitter", "an instance shows its shapegroup as it is: not used; a light stands beside the group");
  finish(p, {"id"});
}

void note_empty(Params& p, const MeshPart& part) {
  if (is_some(part) && part.name.empty()) return;  // nothing is left for the rest
  const std::string of = is_some(part) ? fmt::format(" of usemtl {}", part.name) : "";
  note(p.loader, p.node, fmt::format("{} has no faces{}: left out", text(p, "filename", ""), of));
}

// Whether a mesh that emits has somewhere to do so.
bool has_area(const Scene& scene, const Shape& shape) {
  if (shape.kind != ShapeKind::mesh) return true;
  const Mesh& mesh = scene.meshes[shape.mesh];
  for (uint32_t i = 0; i < mesh.triangles.size(); ++i)
    if (triangle_area(mesh, i) > 0) return true;
  return false;
}

void load_part(Params& p, void (*read)(Params&, Shape&, const MeshPart&), const MeshPart& part, uint32_t group) {
  Loader& loader = p.loader;
  Shape shape;
  shape.group = group;
  shape.name = !p.node.id.empty() ? p.node.id : fmt::format("{}:{}", p.node.type, p.node.line);
  if (!part.name.empty()) shape.name += ":" + part.name;
  read(p, shape, part);
  refuse_media(p);
  refuse_sensors(p);
  std::vector<const Node*> emitters = nested(p, "emitter");
  if (emitters.size() > 1) fail(loader, p.node, "has more than one emitter; keep one of them");
  shape.material = material_of(p, part, !emitters.empty());
  if (!emitters.empty() && group != none) {
    unsupported(loader, *emitters.front(),
                "a light inside a shapegroup is not supported; put the shape beside the group", "left out");
    emitters.clear();
  }
  if (shape.kind == ShapeKind::mesh && loader.scene.meshes[shape.mesh].triangles.empty()) {
    note_empty(p, part);
    loader.scene.meshes.pop_back();
    return;
  }
  loader.scene.shapes.push_back(std::move(shape));
  if (!emitters.empty()) load_emitter(loader, *emitters.front(), uint32_t(loader.scene.shapes.size() - 1));
  if (!emitters.empty() && !has_area(loader.scene, loader.scene.shapes.back()))
    note(loader, p.node, "its faces have no area: it emits nothing");
  check_attributes(loader, p.node, loader.scene.shapes.back());
}

}  // namespace

uint32_t load_shape_group(Loader& loader, const Node& node) {
  const auto found = loader.groups.find(&node);
  if (found != loader.groups.end()) return found->second;
  const Open open(loader, node);
  const uint32_t group = loader.scene.groups++;
  loader.groups.emplace(&node, group);
  Params p(loader, node);
  const std::vector<const Node*> shapes = nested(p, "shape");
  if (shapes.empty()) note(loader, node, "holds no shapes: nothing is seen of it");
  for (const Node* shape : shapes) load_shape(loader, *shape, group);
  finish(p);
  return group;
}

void load_shape(Loader& loader, const Node& node, uint32_t group) {
  if (node.type == "shapegroup") {
    if (group != none)
      return unsupported(loader, node, "a shapegroup inside a shapegroup is not supported; put its shapes there",
                         "left out");
    load_shape_group(loader, node);
    return;
  }
  const Open open(loader, node);
  if (node.type == "instance") return load_instance(loader, node, group);
  Params p(loader, node);
  if (node.type == "merge") {
    for (const Node* shape : nested(p, "shape")) load_shape(loader, *shape, group);
    return finish(p);
  }
  const auto reader = std::find_if(std::begin(shape_readers), std::end(shape_readers),
                                   [&](const ShapeReader& e) { return node.type == e.type; });
  if (reader == std::end(shape_readers))
    return unsupported(loader, node, fmt::format("{}; {}", unknown(node), supported_shapes), "left out");
  for (const MeshPart& part : parts_of(p)) load_part(p, reader->read, part, group);
  note_strays(p, "texture", "a texture is no bsdf: not used; put it inside one, <bsdf type=\"diffuse\">");
  finish(p, {"id", "velocity", "collapse", "silhouette_sampling_weight"});
}

}  // namespace ajar
