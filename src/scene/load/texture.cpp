#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "ajar/core/error.h"

#include "loader.h"

namespace ajar {
namespace {

// What a <spectrum> may be beside a texture.
constexpr const char* constants[] = {"uniform", "d65",       "rgb",       "srgb",        "srgb_d65",
                                     "regular", "irregular", "blackbody", "rawconstant", "spectrum"};
constexpr const char* types[] = {"bitmap", "checkerboard", "gridtexture", "scale", "mesh_attribute", "vertexcolors"};

// Affine map of (u, v): scale and offset (0.x), then the transform (2.x, 3.x). Later versions, which read the names of
// 0.x, move before they scale.
Mat3 uv_map(Params& p) {
  const double uniform = number(p, "uvscale", number(p, "uv_scale", 1));
  DMat4 m(1);
  m[0][0] = number(p, "uscale", uniform);
  m[1][1] = number(p, "vscale", uniform);
  const bool old = p.loader.document.old;
  m[3][0] = number(p, "uoffset", 0) * (old ? 1 : m[0][0]);
  m[3][1] = number(p, "voffset", 0) * (old ? 1 : m[1][1]);
  if (const Node* node = find(p, {"to_uv"})) {
    if (node->tag != "transform") fail(p.loader, *node, "should be a <transform>");
    m = transform_of(p.loader, *node) * m;
  }
  // a 3x3 matrix has its offset in the third column, the steps have it in the fourth
  return Mat3(Vec3(float(m[0][0]), float(m[0][1]), 0), Vec3(float(m[1][0]), float(m[1][1]), 0),
              Vec3(float(m[2][0] + m[3][0]), float(m[2][1] + m[3][1]), 1));
}

Wrap wrap_of(Params& p, const char* name, Wrap otherwise) {
  static constexpr std::pair<const char*, Wrap> words[] = {
      {"repeat", Wrap::repeat}, {"mirror", Wrap::mirror}, {"clamp", Wrap::clamp}, {"zero", Wrap::zero},
      {"one", Wrap::one},       {"black", Wrap::zero},    {"white", Wrap::one}};
  const std::string word = choice(p, name, "", {"repeat", "mirror", "clamp", "zero", "one", "black", "white"});
  for (const auto& [w, wrap] : words)
    if (word == w) return wrap;
  return otherwise;
}

Texture checkerboard(Params& p, Colour kind) {
  Texture t;
  t.kind = TextureKind::checkerboard;
  t.color0 = slot(p, {"color0"}, 0.4f, kind);
  t.color1 = slot(p, {"color1"}, 0.2f, kind);
  t.mirrored = p.loader.document.old;  // there coordinates are cut to whole numbers, not rounded down
  t.to_uv = uv_map(p);
  finish(p);
  return t;
}

Texture grid(Params& p, Colour kind) {
  Texture t;
  t.kind = TextureKind::grid;
  t.color0 = slot(p, {"color0"}, 0.2f, kind);
  t.color1 = slot(p, {"color1"}, 0.4f, kind);
  t.line_width = float(number(p, "line_width", 0.01));
  if (!(t.line_width >= 0)) fail(p.loader, p.node, "line_width should not be negative");
  t.to_uv = uv_map(p);
  finish(p, {"filter_type"});
  return t;
}

// What is scaled has no limit of its own: the product has.
Texture scaled(Params& p, Colour kind) {
  if (kind == Colour::reflectance) kind = Colour::ratio;
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

Texture mesh_attribute(Params& p) {
  Texture t;
  t.kind = TextureKind::mesh_attribute;
  t.attribute = text(p, "name", p.node.type == "vertexcolors" ? "vertex_color" : "");
  if (!t.attribute.starts_with("vertex_") && !t.attribute.starts_with("face_"))
    fail(p.loader, p.node, "needs a <string name=\"name\" .../> that begins with vertex_ or face_: vertex_color");
  const double scale = number(p, "scale", 1);
  if (scale < 0) fail(p.loader, p.node, "scale should not be negative");
  if (scale != 1) {
    Slot inner;
    inner.texture = add_texture(p.loader, p.node, std::move(t));
    t = {};
    t.kind = TextureKind::scale;
    t.color0 = inner;
    t.color1 = Slot(float(scale));
  }
  finish(p);
  return t;
}

Channel channel_of(Params& p) {
  const std::string word = choice(p, "channel", "", {"r", "g", "b", "a", "x", "y", "z", "all"});
  if (word == "r" || word == "x") return Channel::red;
  if (word == "g" || word == "y") return Channel::green;
  if (word == "b" || word == "z") return Channel::blue;
  return word == "a" ? Channel::alpha : Channel::color;
}

Texture bitmap(Params& p, Colour kind) {
  Texture t;
  t.flip_v = false;  // v = 0 is the top row, as in Mitsuba; obj files are turned when they are read
  const std::string path = file(p, "filename");
  t.nearest =
      choice(p, "filter_type", "bilinear", {"nearest", "bilinear", "trilinear", "ewa", "anisotropic"}) == "nearest";
  t.wrap_u = t.wrap_v = wrap_of(p, "wrap_mode", Wrap::repeat);
  t.wrap_u = wrap_of(p, "wrap_mode_u", t.wrap_u);
  t.wrap_v = wrap_of(p, "wrap_mode_v", t.wrap_v);
  const bool raw = boolean(p, "raw", false);
  t.image = load_image_file(p.loader, p.node, path, raw, number(p, "gamma", 0));
  t.image = limited_image(p.loader, p.node, t.image, kind);
  t.channel = channel_of(p);
  t.to_uv = uv_map(p);
  finish(p, {"cache", "max_anisotropy", "format", "accel", "id"});
  return t;
}

// The texture, or one around it that keeps it from 0 to 1 where it may be more. What mesh attributes have is known to
// the shapes that show them.
uint32_t add_limited(Loader& loader, const Node& node, Texture&& texture) {
  Slot inner;
  inner.texture = add_texture(loader, node, std::move(texture));
  const float most = max_component(maximum(loader.scene, inner));
  if (most <= 1) return inner.texture;
  if (std::isfinite(most))
    note(loader, node, "reflectances above 1 would make light from nothing: where it is more, it becomes 1");
  Texture limit;
  limit.kind = TextureKind::limit;
  limit.color0 = inner;
  return add_texture(loader, node, std::move(limit));
}

bool is_grey(const Scene& scene, const Texture& t) {
  if (t.kind == TextureKind::average) return true;
  return t.kind == TextureKind::bitmap && (scene.images[t.image].channels == 1 || t.channel != Channel::color);
}

const Image* find_value(const std::map<std::string, Image>& images, const std::string& key) {
  const auto found = images.find(key);
  return found == images.end() ? nullptr : &found->second;
}

void note_mended(Loader& loader, const Node& node, const Image& image) {
  const auto say = [&](const char* what, size_t count) {
    if (count > 0)
      note(loader, node, fmt::format("{}: {} ({} of {}) were set to 0", image.name, what, count, image.floats.size()));
  };
  say("negative numbers", image.negative);
  say("numbers that are not finite", image.not_finite);
  if (!image.guessed.empty())
    note(loader, node,
         fmt::format("{}: has no channels R, G and B: {} are shown in their place", image.name, image.guessed));
}

}  // namespace

uint32_t load_image_file(Loader& loader, const Node& node, const std::string& path, bool raw, double gamma) {
  if (std::abs(gamma - 1) < 1e-6) raw = true;
  if (gamma > 100) fail(loader, node, fmt::format("gamma {} should be from 0 to 100", gamma));
  const std::string key = fmt::format("{}|{}|{}|{}", raw, loader.lenient, raw ? 0 : std::max(gamma, -1.0), path);
  const auto found = loader.images.find(key);
  if (found != loader.images.end()) return found->second;
  const uint32_t index = uint32_t(loader.scene.images.size());
  const Image* kept = loader.cache ? find_value(loader.cache->images, key) : nullptr;
  try {
    const ImageOptions options{raw, float(gamma), loader.lenient, loader.document.old};
    loader.scene.images.push_back(kept ? *kept : load_image(path, options));
  } catch (const Error& error) {
    fail(loader, node, error.what());
  }
  if (loader.cache && !kept) loader.cache->images.emplace(key, loader.scene.images.back());
  loader.images.emplace(key, index);
  note_mended(loader, node, loader.scene.images.back());
  return index;
}

uint32_t limited_image(Loader& loader, const Node& node, uint32_t index, Colour kind) {
  if (kind == Colour::ratio) return index;
  const float most = kind == Colour::reflectance ? 1 : infinity;
  std::vector<Image>& images = loader.scene.images;
  const std::vector<float>& floats = images[index].floats;
  if (std::all_of(floats.begin(), floats.end(), [&](float x) { return x >= 0 && x <= most; })) return index;
  note(loader, node,
       fmt::format("{}: {}", images[index].name,
                   most == 1 ? "numbers below 0 or above 1 are no reflectances: they were set to 0 or 1"
                             : "negative numbers are no light: they were set to 0"));
  const auto [known, added] = loader.images.emplace(fmt::format("{}|to {}", index, most), uint32_t(images.size()));
  if (!added) return known->second;
  images.push_back(Image(images[index]));
  for (float& x : images.back().floats) x = std::clamp(x, 0.0f, most);
  return known->second;
}

bool is_texture(const Node& node) {
  if (node.tag != "texture" && node.tag != "spectrum") return false;
  if (node.type.empty()) return node.tag == "texture";
  return std::find(std::begin(constants), std::end(constants), node.type) == std::end(constants);
}

uint32_t add_texture(Loader& loader, const Node& node, Texture&& texture) {
  int size = 1;
  for (const Slot* s : {&texture.color0, &texture.color1})
    if (s->texture != none) size += loader.texture_sizes[s->texture];
  if (size > max_tree) fail(loader, node, fmt::format("is made of more than {} textures; leave some out", max_tree));
  loader.texture_sizes.push_back(size);
  loader.scene.textures.push_back(std::move(texture));
  return uint32_t(loader.scene.textures.size() - 1);
}

void check_texture(Loader& loader, const Node& node) {
  if (!is_texture(node) || std::find(std::begin(types), std::end(types), node.type) != std::end(types)) return;
  const std::string plain = node.tag == "spectrum" ? fmt::format("{}, ", fmt::join(constants, ", ")) : "";
  unsupported(loader, node, fmt::format("{}; supported: {}{}", unknown(node), plain, fmt::join(types, ", ")),
              "grey 0.5 in its place");
}

uint32_t load_texture(Loader& loader, const Node& node, Colour kind) {
  const auto found = loader.textures.find({&node, kind});
  if (found != loader.textures.end()) return found->second;
  check_texture(loader, node);
  const Open open(loader, node);
  Params p(loader, node);
  Texture t;
  if (node.type == "bitmap") {
    t = bitmap(p, kind);
  } else if (node.type == "checkerboard") {
    t = checkerboard(p, kind);
  } else if (node.type == "gridtexture") {
    t = grid(p, kind);
  } else if (node.type == "scale") {
    t = scaled(p, kind);
  } else if (node.type == "mesh_attribute" || node.type == "vertexcolors") {
    t = mesh_attribute(p);
  } else {
    t.kind = TextureKind::checkerboard;
    t.color0 = t.color1 = Slot(0.5f);
  }
  const bool may_exceed = t.kind == TextureKind::scale || t.kind == TextureKind::mesh_attribute;
  const uint32_t index = may_exceed && kind == Colour::reflectance ? add_limited(loader, node, std::move(t))
                                                                   : add_texture(loader, node, std::move(t));
  loader.textures.emplace(std::pair{&node, kind}, index);
  return index;
}

Slot slot(Params& params, std::initializer_list<const char*> names, const Slot& otherwise, Colour kind) {
  const Node* node = find(params, names);
  return node == nullptr ? otherwise : slot_of(params.loader, *node, kind);
}

namespace {

// Asked for a number, checkerboards of Mitsuba 2 and 3 show color1 where they show color0 as colours.
Slot exchanged(Params& params, const Slot& s) {
  if (s.texture == none) return s;
  Texture t = params.loader.scene.textures[s.texture];
  if (t.kind != TextureKind::checkerboard) return s;
  const Slot color0 = exchanged(params, t.color1);
  t.color1 = exchanged(params, t.color0);
  t.color0 = color0;
  Slot other;
  other.texture = add_texture(params.loader, params.node, std::move(t));
  return other;
}

}  // namespace

void list_shown(const Scene& scene, const Slot& slot, Shown& out) {
  if (slot.texture == none) return;
  const Texture& t = scene.textures[slot.texture];
  if (t.kind == TextureKind::mesh_attribute) out.attributes.insert(t.attribute);
  if (t.kind == TextureKind::limit) out.limits.insert(slot.texture);
  if (t.kind != TextureKind::bitmap && t.kind != TextureKind::mesh_attribute)
    for (const Slot* inner : {&t.color0, &t.color1}) list_shown(scene, *inner, out);
}

Slot as_number(Params& params, const Slot& s) {
  const Scene& scene = params.loader.scene;
  if (!params.loader.document.old) return exchanged(params, s);
  if (s.texture == none) return averaged(s.value);
  if (is_grey(scene, scene.textures[s.texture])) return s;
  Texture t;
  t.kind = TextureKind::average;
  t.color0 = s;
  Slot grey;
  grey.texture = add_texture(params.loader, params.node, std::move(t));
  return grey;
}

Slot number_slot(Params& params, const char* name, const Slot& otherwise, Colour kind) {
  const Node* node = find(params, {name});
  return node == nullptr ? otherwise : as_number(params, slot_of(params.loader, *node, kind));
}

Slot product(Params& params, const Slot& a, const Slot& b) {
  if (a.texture == none && b.texture == none) return a.value * b.value;
  Texture t;
  t.kind = TextureKind::scale;
  t.color0 = a, t.color1 = b;
  Slot s;
  s.texture = add_texture(params.loader, params.node, std::move(t));
  return s;
}

Slot main_slot(Params& p, std::initializer_list<const char*> names, const Slot& otherwise, Colour kind) {
  if (std::none_of(names.begin(), names.end(), [&](const char* name) { return has(p, name); }))
    for (size_t i = 0; i < p.node.children.size(); ++i)
      if (p.node.children[i].name.empty() && is_texture(follow(p.loader, p.node.children[i]))) {
        p.used[i] = true;
        return slot_of(p.loader, p.node.children[i], kind);
      }
  return slot(p, names, otherwise, kind);
}

Slot slot_of(Loader& loader, const Node& node, Colour kind) {
  const Node& meant = meant_by(loader, node);
  if (!is_texture(meant)) return Slot(colour_of(loader, meant, kind));
  Slot s;
  s.texture = load_texture(loader, meant, kind);
  return s;
}

}  // namespace ajar
