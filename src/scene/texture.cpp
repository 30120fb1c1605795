#include <array>
#include <span>

#include "ajar/scene/scene.h"

namespace ajar {
namespace {

// Coordinates are folded before they become integers, so that any number is safe; large ones have no fraction anyway.
float fold(Wrap wrap, float x) {
  if (!(std::abs(x) < 1e9f)) return 0;
  if (wrap == Wrap::repeat) return x - std::floor(x);
  if (wrap == Wrap::mirror) {
    const float in_two = x - 2 * std::floor(x * 0.5f);
    return in_two > 1 ? 2 - in_two : in_two;
  }
  return std::clamp(x, -1.0f, 2.0f);
}

// Index of a texel, -1 outside (zero, one). i lies within a texel of [0, n), or further out where it does not matter.
int wrapped(Wrap wrap, int i, int n) {
  if (i >= 0 && i < n) return i;
  switch (wrap) {
    case Wrap::repeat:
      return i < 0 ? n - 1 : 0;
    case Wrap::mirror:
    case Wrap::clamp:
      return i < 0 ? 0 : n - 1;
    default:
      return -1;
  }
}

Rgb outside(Wrap wrap) { return Rgb(wrap == Wrap::one ? 1.0f : 0.0f); }

// Position in texels, (0,0) the upper left corner of the image.
Vec2 texel_position(const Texture& t, const Image& image, const Vec2& uv) {
  const Vec3 at = t.to_uv * Vec3(uv, 1);
  const float x = fold(t.wrap_u, at.x), y = fold(t.wrap_v, at.y);
  return {x * float(image.width), (t.flip_v ? 1 - y : y) * float(image.height)};
}

Rgb texel_or_outside(const Texture& t, const Image& image, int x, int y) {
  if (x < 0) return outside(t.wrap_u);
  if (y < 0) return outside(t.wrap_v);
  return texel(image, x, y, t.channel);
}

// The four texels around a position, and where between them it lies.
struct Patch {
  Rgb c00, c10, c01, c11;
  Vec2 at;
};

// Colours within an 8-bit image, by far the most frequent: without a question per texel.
inline Patch inner_patch(const Image& image, int x, int y, const Vec2& at) {
  const size_t row = 3 * size_t(image.width);
  const uint8_t* p = &image.bytes[size_t(y) * row + 3 * size_t(x)];
  const auto color = [&](const uint8_t* c) { return Rgb(image.decode[c[0]], image.decode[c[1]], image.decode[c[2]]); };
  return {color(p), color(p + 3), color(p + row), color(p + row + 3), at};
}

inline Patch patch(const Texture& t, const Image& image, const Vec2& uv) {
  const Vec2 p = texel_position(t, image, uv) - 0.5f;
  const Vec2 corner(std::floor(p.x), std::floor(p.y)), at = p - corner;
  const int x = int(corner.x), y = int(corner.y);
  const bool inner = uint32_t(x) < uint32_t(image.width - 1) && uint32_t(y) < uint32_t(image.height - 1);
  if (inner && image.channels == 3 && !image.bytes.empty() && t.channel == Channel::color)
    return inner_patch(image, x, y, at);
  const int x0 = wrapped(t.wrap_u, x, image.width), x1 = wrapped(t.wrap_u, x + 1, image.width);
  const int y0 = wrapped(t.wrap_v, y, image.height), y1 = wrapped(t.wrap_v, y + 1, image.height);
  return {texel_or_outside(t, image, x0, y0), texel_or_outside(t, image, x1, y0), texel_or_outside(t, image, x0, y1),
          texel_or_outside(t, image, x1, y1), at};
}

Rgb eval_bitmap(const Scene& scene, const Texture& t, const Vec2& uv) {
  const Image& image = scene.images[t.image];
  if (t.nearest) {
    const Vec2 p = texel_position(t, image, uv);
    return texel_or_outside(t, image, wrapped(t.wrap_u, int(std::floor(p.x)), image.width),
                            wrapped(t.wrap_v, int(std::floor(p.y)), image.height));
  }
  const Patch q = patch(t, image, uv);
  return (q.c00 * (1 - q.at.x) + q.c10 * q.at.x) * (1 - q.at.y) + (q.c01 * (1 - q.at.x) + q.c11 * q.at.x) * q.at.y;
}

// The colour of a checkerboard or grid that is seen. Colour 0 where both coordinates lie in the same half of their
// period; where neither is near a whole number.
const Slot& seen(const Texture& t, const Vec2& uv) {
  Vec3 at = t.to_uv * Vec3(uv, 1);
  if (t.mirrored) at = glm::abs(at);
  const float x = at.x - std::floor(at.x), y = at.y - std::floor(at.y);
  if (t.kind == TextureKind::checkerboard) return (x < 0.5f) == (y < 0.5f) ? t.color0 : t.color1;
  const bool line = std::min(std::min(x, 1 - x), std::min(y, 1 - y)) < t.line_width;
  return line ? t.color1 : t.color0;
}

// The values of an attribute, none if the mesh lacks it.
std::span<const Rgb> values_of(const Mesh& mesh, const std::string& name, bool& of_faces) {
  of_faces = false;
  if (name == "vertex_color") return mesh.colors;
  for (const Attribute& a : mesh.attributes)
    if (a.name == name) {
      of_faces = a.of_faces;
      return a.values;
    }
  return {};
}

Rgb eval_attribute(const Scene& scene, const Texture& texture, const Surface& at) {
  if (at.shape == none) return Rgb(0);  // a picture that a lamp throws
  const Shape& shape = scene.shapes[at.shape];
  if (shape.kind != ShapeKind::mesh) return Rgb(0);
  const Mesh& mesh = scene.meshes[shape.mesh];
  bool of_faces;
  const std::span<const Rgb> values = values_of(mesh, texture.attribute, of_faces);
  if (values.empty()) return Rgb(0);
  if (of_faces) return glm::max(values[at.prim], Rgb(0));
  const glm::uvec3 t = mesh.triangles[at.prim];
  const Rgb between = values[t.x] * (1 - at.bary.x - at.bary.y) + values[t.y] * at.bary.x + values[t.z] * at.bary.y;
  return glm::max(between, Rgb(0));
}

// Derivatives to u and v, by channel.
struct Gradient {
  Rgb u{0}, v{0};
};

Gradient bitmap_gradient(const Scene& scene, const Texture& t, const Vec2& uv) {
  const Image& image = scene.images[t.image];
  const Patch q = patch(t, image, uv);
  Rgb dx = ((q.c10 - q.c00) * (1 - q.at.y) + (q.c11 - q.c01) * q.at.y) * float(image.width);
  Rgb dy = ((q.c01 - q.c00) * (1 - q.at.x) + (q.c11 - q.c10) * q.at.x) * float(image.height);
  if (t.flip_v) dy = -dy;
  const Vec3 at = t.to_uv * Vec3(uv, 1);
  const auto mirrored = [](Wrap wrap, float x) { return wrap == Wrap::mirror && x - 2 * std::floor(x * 0.5f) > 1; };
  if (mirrored(t.wrap_u, at.x)) dx = -dx;
  if (mirrored(t.wrap_v, at.y)) dy = -dy;
  return {dx * t.to_uv[0].x + dy * t.to_uv[0].y, dx * t.to_uv[1].x + dy * t.to_uv[1].y};
}

Rgb mean_texel(const Image& image, Channel channel) {
  glm::dvec3 sum(0);
  for (int y = 0; y < image.height; ++y) {
    Rgb row(0);
    for (int x = 0; x < image.width; ++x) row += texel(image, x, y, channel);
    sum += glm::dvec3(row);
  }
  return sum / (double(image.width) * double(image.height));
}

// By channel; at least 0.
template <class T>
std::array<T, 3> largest(const std::vector<T>& numbers, size_t channels) {
  std::array<T, 3> most{};
  for (size_t i = 0; i + channels <= numbers.size(); i += channels)
    for (size_t c = 0; c < channels; ++c) most[c] = std::max(most[c], numbers[i + c]);
  return most;
}

Rgb largest_texel(const Image& image, Channel channel) {
  if (channel == Channel::alpha) return Rgb(image.alpha.empty() ? 1 : float(largest(image.alpha, 1)[0]) / 255);
  const size_t channels = size_t(image.channels);
  std::array<float, 3> most = largest(image.floats, channels);
  if (const auto bytes = largest(image.bytes, channels); !image.bytes.empty())
    for (size_t c = 0; c < channels; ++c) most[c] = image.decode[bytes[c]];  // the table rises
  if (channels == 1) return Rgb(most[0]);
  if (channel != Channel::color) return Rgb(most[size_t(channel) - size_t(Channel::red)]);
  return {most[0], most[1], most[2]};
}

Rgb largest_value(const Texture& t, const Mesh* mesh) {
  if (mesh == nullptr) return Rgb(infinity);
  Rgb largest(0);
  bool of_faces;
  for (const Rgb& c : values_of(*mesh, t.attribute, of_faces)) largest = glm::max(largest, c);
  return largest;
}

Rgb mean_attribute(const Scene& scene, const Texture& texture) {
  glm::dvec3 sum(0);
  size_t n = 0;
  bool of_faces;
  for (const Mesh& mesh : scene.meshes) {
    const std::span<const Rgb> values = values_of(mesh, texture.attribute, of_faces);
    for (const Rgb& c : values) sum += glm::dvec3(glm::max(c, Rgb(0)));
    n += values.size();
  }
  return n > 0 ? Rgb(sum / double(n)) : Rgb(0);
}

}  // namespace

Rgb eval(const Scene& scene, const Slot& slot, const Surface& at) {
  if (slot.texture == none) return slot.value;
  const Texture& t = scene.textures[slot.texture];
  switch (t.kind) {
    case TextureKind::bitmap:
      return eval_bitmap(scene, t, at.uv);
    case TextureKind::checkerboard:
    case TextureKind::grid:
      return eval(scene, seen(t, at.uv), at);
    case TextureKind::scale:
      return eval(scene, t.color0, at) * eval(scene, t.color1, at);
    case TextureKind::mesh_attribute:
      return eval_attribute(scene, t, at);
    case TextureKind::limit:
      return glm::clamp(eval(scene, t.color0, at), Rgb(0), Rgb(1));
    case TextureKind::average:
      return averaged(eval(scene, t.color0, at));
  }
  return Rgb(0);
}

float eval_scalar(const Scene& scene, const Slot& slot, const Surface& at) { return scalar_of(eval(scene, slot, at)); }

namespace {

Gradient gradient_of(const Scene& scene, const Slot& slot, const Surface& at) {
  if (slot.texture == none) return {};
  const Texture& t = scene.textures[slot.texture];
  switch (t.kind) {
    case TextureKind::bitmap:
      return bitmap_gradient(scene, t, at.uv);
    case TextureKind::checkerboard:
    case TextureKind::grid:
      return gradient_of(scene, seen(t, at.uv), at);
    case TextureKind::scale: {
      const Gradient a = gradient_of(scene, t.color0, at), b = gradient_of(scene, t.color1, at);
      const Rgb value_a = eval(scene, t.color0, at), value_b = eval(scene, t.color1, at);
      return {a.u * value_b + b.u * value_a, a.v * value_b + b.v * value_a};
    }
    case TextureKind::mesh_attribute:
      return {};
    case TextureKind::limit:
      return gradient_of(scene, t.color0, at);
    case TextureKind::average: {
      const Gradient all = gradient_of(scene, t.color0, at);
      return {averaged(all.u), averaged(all.v)};
    }
  }
  return {};
}

}  // namespace

Vec2 eval_gradient(const Scene& scene, const Slot& slot, const Surface& at) {
  const Gradient all = gradient_of(scene, slot, at);
  return {scalar_of(all.u), scalar_of(all.v)};
}

Rgb mean(const Scene& scene, const Slot& slot) {
  if (slot.texture == none) return slot.value;
  const Texture& t = scene.textures[slot.texture];
  switch (t.kind) {
    case TextureKind::bitmap:
      return mean_texel(scene.images[t.image], t.channel);
    case TextureKind::checkerboard:
      return (mean(scene, t.color0) + mean(scene, t.color1)) * 0.5f;
    case TextureKind::grid: {
      const float between = sqr(std::max(1 - 2 * t.line_width, 0.0f));
      return mean(scene, t.color0) * between + mean(scene, t.color1) * (1 - between);
    }
    case TextureKind::scale:
      return mean(scene, t.color0) * mean(scene, t.color1);
    case TextureKind::mesh_attribute:
      return mean_attribute(scene, t);
    case TextureKind::limit:
      return glm::clamp(mean(scene, t.color0), Rgb(0), Rgb(1));
    case TextureKind::average:
      return averaged(mean(scene, t.color0));
  }
  return Rgb(0);
}

Rgb maximum(const Scene& scene, const Slot& slot, const Mesh* mesh) {
  if (slot.texture == none) return slot.value;
  const Texture& t = scene.textures[slot.texture];
  switch (t.kind) {
    case TextureKind::bitmap:
      return glm::max(largest_texel(scene.images[t.image], t.channel),
                      Rgb(t.wrap_u == Wrap::one || t.wrap_v == Wrap::one ? 1.0f : 0.0f));
    case TextureKind::checkerboard:
    case TextureKind::grid:
      return glm::max(maximum(scene, t.color0, mesh), maximum(scene, t.color1, mesh));
    case TextureKind::scale:
      return maximum(scene, t.color0, mesh) * maximum(scene, t.color1, mesh);
    case TextureKind::mesh_attribute:
      return largest_value(t, mesh);
    case TextureKind::limit:
      return glm::min(maximum(scene, t.color0, mesh), Rgb(1));
    case TextureKind::average:
      return averaged(maximum(scene, t.color0, mesh));
  }
  return Rgb(0);
}

}  // namespace ajar
