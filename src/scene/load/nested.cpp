#include "nested.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace ajar {
namespace {

// b2 before b10: what stands before a name's last digits comes first, then their number.
bool comes_first(const std::string& a, const std::string& b) {
  const auto parts = [](std::string_view name) {
    const size_t digits = name.find_last_not_of("0123456789") + 1;
    std::string_view number = name.substr(digits);
    number.remove_prefix(std::min(number.find_first_not_of('0'), number.size()));
    return std::tuple(name.substr(0, digits), number.size(), number);
  };
  return parts(a) < parts(b);
}

// Versions from 2 to 3.6 take them in the order of their names, others in that of the file.
void sort_by_name(Params& p, std::vector<std::pair<std::string, const Node*>>& list) {
  const auto before = [](const auto& a, const auto& b) { return comes_first(a.first, b.first); };
  if (!p.loader.document.by_name || std::is_sorted(list.begin(), list.end(), before)) return;
  std::stable_sort(list.begin(), list.end(), before);
  note(p.loader, p.node,
       "its nested bsdfs are taken in the order of their names, as before version 3.7; since then it is that of the "
       "file");
}

// The nested bsdfs: as many as asked for, where one without a name is called _arg_0, _arg_1 and so on.
void take_nested(Params& p, Material& m, size_t low, size_t high) {
  std::vector<std::pair<std::string, const Node*>> list;
  for (size_t i = 0; i < p.node.children.size(); ++i) {
    const Node& meant = follow(p.loader, p.node.children[i]);
    if (meant.tag != "bsdf") continue;
    p.used[i] = true;
    const std::string& named = p.node.children[i].named;
    list.emplace_back(named.empty() ? fmt::format("_arg_{}", i) : named, &meant);
  }
  if (list.size() < low || list.size() > high)
    fail(p.loader, p.node,
         fmt::format("needs {} nested bsdf{}, has {}",
                     low == high ? fmt::format("{}", low) : fmt::format("{} to {}", low, high), high == 1 ? "" : "s",
                     list.size()));
  sort_by_name(p, list);
  for (size_t i = 0; i < list.size(); ++i) m.nested[i] = load_bsdf(p.loader, *list[i].second);
}

bool transmits(const Scene& scene, uint32_t id) {
  const Material& m = scene.materials[id];
  switch (m.kind) {
    case MaterialKind::dielectric:
    case MaterialKind::roughdielectric:
    case MaterialKind::thindielectric:
    case MaterialKind::difftrans:
    case MaterialKind::null:
    case MaterialKind::mask:
      return true;
    case MaterialKind::principled:
      return m.spec_trans.texture != none || luminance(m.spec_trans.value) > 0;
    default:
      return std::any_of(m.nested.begin(), m.nested.end(),
                         [&](uint32_t nested) { return nested != none && transmits(scene, nested); });
  }
}

// What Mitsuba 3.7.1 added to bump and normal maps. Left out of a file it is true there, but is not told of each time.
void refuse_folds(Params& p) {
  const bool flips = boolean(p, "flip_invalid_normals", false), shades = boolean(p, "use_shadowing_function", false);
  if (flips || shades)
    note(p.loader, p.node,
         fmt::format("{} is not supported: normals are bent as in Mitsuba up to 3.7.0, as with false",
                     flips && shades ? "flip_invalid_normals, like use_shadowing_function,"
                     : flips         ? "flip_invalid_normals"
                                     : "use_shadowing_function"));
}

// The one nested texture, whatever its name, but since version 2 not one that is called scale; null where there is
// none.
const Node* nested_texture(Params& p) {
  const Node* map = nullptr;
  for (size_t i = 0; i < p.node.children.size(); ++i) {
    const Node& child = p.node.children[i];
    if ((child.name == "scale" && !p.loader.document.old) || !is_texture(follow(p.loader, child))) continue;
    if (map != nullptr) fail(p.loader, child, fmt::format("a {} takes one texture", p.node.type));
    map = &child;
    p.used[i] = true;
  }
  return map;
}

// Slopes of a height along u and v as the colours of a normal map.
void slopes_to_normals(Image& image) {
  if (image.channels != 3) return;
  for (const uint8_t byte : image.bytes) image.floats.push_back(image.decode[byte]);
  image.bytes.clear();
  for (size_t i = 0; i + 2 < image.floats.size(); i += 3) {
    const Vec3 n = glm::normalize(Vec3(-image.floats[i], -image.floats[i + 1], 1));
    for (int c = 0; c < 3; ++c) image.floats[i + size_t(c)] = n[c] * 0.5f + 0.5f;
  }
}

// A normal map named by its file, without a texture around it.
Slot normals_of_file(Params& p) {
  Texture t;
  t.flip_v = false;
  t.image = load_image_file(p.loader, p.node, file(p, "filename"), true, 0);
  t.to_uv[0][0] = t.to_uv[1][1] = float(positive(p, "tiles", 1));
  if (boolean(p, "use_slopes", false)) {
    std::vector<Image>& images = p.loader.scene.images;
    images.push_back(Image(images[t.image]));
    slopes_to_normals(images.back());
    t.image = uint32_t(images.size() - 1);
  }
  Slot slot;
  slot.texture = add_texture(p.loader, p.node, std::move(t));
  return slot;
}

}  // namespace

void load_twosided(Params& p, Material& m) {
  take_nested(p, m, 1, 2);
  for (const uint32_t side : m.nested)
    if (side != none && transmits(p.loader.scene, side))
      fail(p.loader, p.node,
           "what is nested lets light through; only opaque bsdfs have two sides: take twosided away, or put a mask "
           "around it");
}

void load_mask(Params& p, Material& m) {
  m.weight = main_slot(p, {"opacity"}, 0.5f, Colour::reflectance);
  if (!p.loader.document.old) m.weight = as_number(p, m.weight);
  take_nested(p, m, 1, 1);
}

void load_blend(Params& p, Material& m) {
  m.weight = as_number(p, main_slot(p, {"weight"}, 0.5f, Colour::reflectance));
  take_nested(p, m, 2, 2);
}

void load_mixture(Params& p, Material& m) {
  take_nested(p, m, 1, m.nested.size());
  std::string list = text(p, "weights", "");
  std::replace(list.begin(), list.end(), ';', ',');
  const auto weights = to_numbers(list);
  const bool conserve = boolean(p, "ensure_energy_conservation", true);
  const size_t count = size_t(std::count_if(m.nested.begin(), m.nested.end(), [](uint32_t n) { return n != none; }));
  if (!weights || weights->size() != count)
    fail(p.loader, p.node, fmt::format("needs <string name=\"weights\" value=\"...\"/> with {} numbers", count));
  double sum = 0;
  for (const double w : *weights) {
    if (!(w >= 0 && w <= 1e6)) fail(p.loader, p.node, "a weight should not be negative");
    sum += w;
  }
  if (sum > 1 + 1e-6 && !conserve) fail(p.loader, p.node, "its weights add up to more than 1");
  if (sum > 1 + 1e-6) note(p.loader, p.node, "its weights add up to more than 1: they were scaled down");
  for (size_t i = 0; i < count; ++i) m.weights[i] = float((*weights)[i] / std::max(sum, 1.0));
}

void load_bumpmap(Params& p, Material& m) {
  if (!p.loader.document.old) m.map_scale = float(number(p, "scale", 1));  // 0.x has a texture for that
  const Node* map = nested_texture(p);
  if (map == nullptr) fail(p.loader, p.node, "needs a nested <texture> of heights");
  m.map = slot_of(p.loader, *map, Colour::ratio);
  refuse_folds(p);
  take_nested(p, m, 1, 1);
}

void load_normalmap(Params& p, Material& m) {
  const Slot missing(-1.0f);
  if (has(p, "filename")) {
    m.map = normals_of_file(p);
  } else if (const Node* map = p.loader.document.old ? nested_texture(p) : nullptr) {
    m.map = slot_of(p.loader, *map, Colour::ratio);
  } else {
    m.map = main_slot(p, {"normalmap", "map"}, missing, Colour::ratio);
  }
  if (m.map.texture == none && m.map.value == missing.value)
    fail(p.loader, p.node, "needs <texture name=\"normalmap\" ...>");
  refuse_folds(p);
  take_nested(p, m, 1, 1);
}

}  // namespace ajar
