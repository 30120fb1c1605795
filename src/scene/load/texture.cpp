#include <fmt/format.h>

#include <algorithm>

#include "ajar/core/error.h"

#include "loader.h"

namespace ajar {
namespace {

constexpr const char* supported = "supported: bitmap, checkerboard, scale, mesh_attribute";

// Affine map of (u, v): scale and offset (0.x), then the transform (2.x, 3.x).
Mat3 uv_map(Params& p, double u_scale, double v_scale) {
  const double uniform = number(p, "uvscale", number(p, "uv_scale", 1));
  DMat4 m(1);
  m[0][0] = number(p, "uscale", uniform) * u_scale;
  m[1][1] = number(p, "vscale", uniform) * v_scale;
  m[3][0] = number(p, "uoffset", 0);
  m[3][1] = number(p, "voffset", 0);
  if (const Node* node = find(p, {"to_uv"})) {
    if (node->tag != "transform") fail(p.loader, *node, "should be a <transform>");
    m = transform_of(p.loader, *node) * m;
  }
  // a 3x3 matrix has its offset in the third column, the steps have it in the fourth
  return Mat3(Vec3(float(m[0][0]), float(m[0][1]), 0), Vec3(float(m[1][0]), float(m[1][1]), 0),
              Vec3(float(m[2][0] + m[3][0]), float(m[2][1] + m[3][1]), 1));
}

Wrap wrap_of(Params& p, const char* name, Wrap otherwise) {
  static constexpr std::pair<const char*, Wrap> words[] = {{"repeat", Wrap::repeat}, {"mirror", Wrap::mirror},
                                                           {"clamp", Wrap::clamp},   {"zero", Wrap::zero},
                                                           {"one", Wrap::one},       {"black", Wrap::zero},
                                                           {"white", Wrap::one}};
  const std::string word =
      choice(p, name, "", {"repeat", "mirror", "clamp", "zero", "one", "black", "white"});
  for (const auto& [w, wrap] : words)
    if (word == w) return wrap;
  return otherwise;
}

Texture bitmap(Params& p) {
  Texture t;
  t.flip_v = false;  // v = 0 is the top row, as in Mitsuba; obj files are turned when they are read
  const std::string path = file(p, "filename");
  const std::string filter =
      choice(p, "filter_type", "bilinear", {"nearest", "bilinear", "trilinear", "ewa"});
  t.nearest = filter == "nearest";
  t.wrap_u = t.wrap_v = wrap_of(p, "wrap_mode", Wrap::repeat);
  t.wrap_u = wrap_of(p, "wrap_mode_u", t.wrap_u);
  t.wrap_v = wrap_of(p, "wrap_mode_v", t.wrap_v);
  const bool raw = boolean(p, "raw", false);
  const double gamma = number(p, "gamma", 0);
  const std::string channel = choice(p, "channel", "", {"r", "g", "b", "a", "x", "y", "z"});
  t.image = load_image_file(p.loader, p.node, path, raw, gamma, channel);
  t.to_uv = uv_map(p, 1, 1);
  finish(p, {"cache", "max_anisotropy", "format", "accel", "id"});
  return t;
}

Texture checkerboard(Params& p, Colour kind) {
  Texture t;
  t.kind = TextureKind::checkerboard;
  t.color0 = slot(p, {"color0"}, 0.4f, kind);
  t.color1 = slot(p, {"color1"}, 0.2f, kind);
  t.to_uv = uv_map(p, 1, 1);
  finish(p);
  return t;
}

Texture scaled(Params& p, Colour kind) {
  Texture t;
  t.kind = TextureKind::scale;
  t.color1 = slot(p, {"scale"}, 1.0f, Colour::ratio);
  bool found = false;
  for (size_t i = 0; i < p.node.children.size() && !found; ++i) {
    const Node& child = p.node.children[i];
    if (child.name == "scale") continue;
    p.used[i] = found = true;
    t.color0 = slot_of(p.loader, child, kind);
  }
  if (!found) fail(p.loader, p.node, "needs a nested <texture> to scale");
  finish(p);
  return t;
}

// Of the attributes that meshes carry, Ajar keeps the vertices' colours.
Texture mesh_attribute(Params& p) {
  Texture t;
  t.kind = TextureKind::mesh_attribute;
  const std::string name = text(p, "name", "");
  if (name != "vertex_color")
    unsupported(p.loader, p.node, fmt::format("the mesh attribute \"{}\" is not supported; vertex_color is", name),
                "vertex_color is taken");
  const double scale = number(p, "scale", 1);
  if (scale != 1) {
    p.loader.scene.textures.push_back(t);
    t = {};
    t.kind = TextureKind::scale;
    t.color0.texture = uint32_t(p.loader.scene.textures.size() - 1);
    t.color1 = Slot(float(scale));
  }
  finish(p);
  return t;
}

// One channel of an image as an image of its own.
Image extract(const Image& from, char channel) {
  Image out;
  out.width = from.width;
  out.height = from.height;
  out.channels = 1;
  const size_t pixels = size_t(from.width) * size_t(from.height);
  if (channel == 'a') {
    out.bytes = from.alpha.empty() ? std::vector<uint8_t>(pixels, 255) : from.alpha;
    for (int i = 0; i < 256; ++i) out.decode[i] = float(i) / 255;
    return out;
  }
  const size_t at = from.channels == 1 || channel == 'r' || channel == 'x' ? 0 : channel == 'g' || channel == 'y' ? 1 : 2;
  const size_t n = size_t(from.channels);
  std::copy(std::begin(from.decode), std::end(from.decode), out.decode);
  for (size_t i = 0; i < pixels && !from.bytes.empty(); ++i) out.bytes.push_back(from.bytes[i * n + at]);
  for (size_t i = 0; i < pixels && !from.floats.empty(); ++i) out.floats.push_back(from.floats[i * n + at]);
  return out;
}

}  // namespace

uint32_t load_image_file(Loader& loader, const Node& node, const std::string& path, bool raw, double gamma,
                         const std::string& channel) {
  if (gamma > 0 && std::abs(gamma - 1) < 1e-6) raw = true;
  if (gamma > 100) fail(loader, node, fmt::format("gamma {} should be from 0 to 100", gamma));
  const std::string key = fmt::format("{}|{}|{}|{}", raw, raw ? 0 : std::max(gamma, 0.0), channel, path);
  const auto found = loader.images.find(key);
  if (found != loader.images.end()) return found->second;
  Image image;
  try {
    image = load_image(path, raw, raw ? 0.0f : float(std::max(gamma, 0.0)));
  } catch (const Error& error) {
    fail(loader, node, error.what());
  }
  if (!channel.empty()) image = extract(image, channel[0]);
  const uint32_t index = uint32_t(loader.scene.images.size());
  loader.scene.images.push_back(std::move(image));
  loader.images.emplace(key, index);
  return index;
}

bool is_texture(const Node& node) {
  if (node.tag != "texture" && node.tag != "spectrum") return false;
  static constexpr const char* constants[] = {"uniform", "d65",     "srgb",      "srgb_d65",
                                              "regular", "irregular", "blackbody", "rawconstant"};
  if (node.type.empty()) return node.tag == "texture";
  return std::find(std::begin(constants), std::end(constants), node.type) == std::end(constants);
}

uint32_t load_texture(Loader& loader, const Node& node, Colour kind) {
  const auto found = loader.textures.find({&node, kind});
  if (found != loader.textures.end()) return found->second;
  const Open open(loader, node);
  Params p(loader, node);
  Texture t;
  if (node.type == "bitmap") {
    t = bitmap(p);
  } else if (node.type == "checkerboard") {
    t = checkerboard(p, kind);
  } else if (node.type == "scale") {
    t = scaled(p, kind);
  } else if (node.type == "mesh_attribute") {
    t = mesh_attribute(p);
  } else {
    unsupported(loader, node, fmt::format("unknown texture; {}", supported), "grey 0.5 in its place");
    t.kind = TextureKind::checkerboard;
    t.color0 = t.color1 = Slot(0.5f);
  }
  const uint32_t index = uint32_t(loader.scene.textures.size());
  loader.scene.textures.push_back(t);
  loader.textures.emplace(std::pair{&node, kind}, index);
  return index;
}

Slot slot(Params& params, std::initializer_list<const char*> names, const Slot& otherwise, Colour kind) {
  const Node* node = find(params, names);
  return node == nullptr ? otherwise : slot_of(params.loader, *node, kind);
}

Slot slot_of(Loader& loader, const Node& node, Colour kind) {
  const Node& meant = follow(loader, node);
  if (!is_texture(meant)) return Slot(colour_of(loader, meant, kind));
  Slot s;
  s.texture = load_texture(loader, meant, kind);
  return s;
}

}  // namespace ajar
