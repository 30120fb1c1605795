// Enters: images and texture descriptions.
// Leaves: slots (a constant or a texture) and their values at a surface point.
#pragma once

#include <string>
#include <vector>

#include "ajar/scene/surface.h"

namespace ajar {

struct Scene;
struct Mesh;

/// A colour or a number of a material or light: a constant, or a texture that replaces it.
struct Slot {
  Rgb value{0};
  uint32_t texture = none;

  Slot() = default;
  Slot(float grey) : value(grey) {}
  Slot(const Rgb& rgb) : value(rgb) {}
};

/// Which numbers of an image a texture shows: its colour, or one channel as grey. alpha of an image without it is 1.
enum class Channel : uint8_t { color, red, green, blue, alpha };

/// Decoded image, row 0 on top. 8-bit images stay 8-bit with a decoding table (sRGB or gamma to linear); others are
/// float, linear.
struct Image {
  int width = 0, height = 0, channels = 0;  ///< channels 1 or 3 (alpha is kept apart)
  std::vector<uint8_t> bytes;               ///< height*width*channels, or empty
  std::vector<float> floats;                ///< height*width*channels, or empty
  std::vector<uint8_t> alpha;               ///< height*width, or empty
  float decode[256] = {};                   ///< value of each byte, linear
  size_t negative = 0, not_finite = 0;      ///< how many of its numbers were so in the file, and are 0
  std::string name;                         ///< for messages
  std::string guessed;                      ///< the channels that are shown, where the file has no R, G, B
};

/// One texel, 0 <= x < width, 0 <= y < height.
inline Rgb texel(const Image& image, int x, int y, Channel channel = Channel::color) {
  const size_t pixel = size_t(y) * size_t(image.width) + size_t(x);
  if (channel == Channel::alpha) return Rgb(image.alpha.empty() ? 1.0f : float(image.alpha[pixel]) / 255);
  const size_t i = pixel * size_t(image.channels);
  const auto value = [&](size_t c) {
    return image.bytes.empty() ? image.floats[i + c] : image.decode[image.bytes[i + c]];
  };
  if (image.channels == 1) return Rgb(value(0));
  if (channel != Channel::color) return Rgb(value(size_t(channel) - size_t(Channel::red)));
  return {value(0), value(1), value(2)};
}

enum class Wrap : uint8_t { repeat, mirror, clamp, zero, one };
enum class TextureKind : uint8_t { bitmap, checkerboard, grid, scale, mesh_attribute, limit, average };

struct Texture {
  TextureKind kind = TextureKind::bitmap;
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
  Channel channel = Channel::color;
  bool nearest = false;
  bool flip_v = true;     ///< bitmap: v = 0 is the lowest row of the image
  uint32_t image = none;  ///< bitmap: index into Scene::images
  Mat3 to_uv{1};          ///< applied to (u, v, 1) before the look-up
  Slot color0{0.4f};  ///< checkerboard, where floor(2u) + floor(2v) is even; grid, its ground; scale: the nested slot;
                      ///< limit: what is kept from 0 to 1; average: what is made grey
  Slot color1{0.2f};  ///< checkerboard, elsewhere; grid, its lines; scale: the factor
  bool mirrored = false;  ///< checkerboard: at u = 0 and v = 0
  float line_width = 0;   ///< grid: how far a line reaches to either side of a whole number
  std::string attribute;  ///< mesh_attribute: its name; black where the mesh has none of this name
};

/// A grey of the mean of red, green and blue; exactly itself where it is grey.
inline Rgb averaged(const Rgb& c) { return c.x == c.y && c.y == c.z ? c : Rgb((c.x + c.y + c.z) / 3); }

/// A colour as one number: any channel where it is grey, exactly, else its luminance.
inline float scalar_of(const Rgb& c) { return c.x == c.y && c.y == c.z ? c.x : luminance(c); }

/// Value of a slot at a surface point; linear RGB. Bilinear unless the texture says nearest.
Rgb eval(const Scene& scene, const Slot& slot, const Surface& at);
/// The same reduced to one number: the only channel, or the luminance of three.
float eval_scalar(const Scene& scene, const Slot& slot, const Surface& at);
/// Derivative of eval_scalar to u and v at the point (for bump maps), per unit of the mesh's uv; bitmaps as if
/// bilinear, limits as if not reached.
Vec2 eval_gradient(const Scene& scene, const Slot& slot, const Surface& at);
/// Mean value over the unit square of uv; exact for constants and bitmaps that fill it.
Rgb mean(const Scene& scene, const Slot& slot);
/// What the channels do not exceed: the largest texels, constants, products of these. Mesh attributes have their
/// largest value in the mesh; without one they are infinite.
Rgb maximum(const Scene& scene, const Slot& slot, const Mesh* mesh = nullptr);

/// How the numbers of a file become those of an image.
struct ImageOptions {
  bool raw = false;        ///< as they stand
  float gamma = 0;         ///< this exponent; below 0 sRGB, 0: by the file (8- and 16-bit sRGB, float linear)
  bool mend = false;       ///< those that are not finite become 0
  bool png_gamma = false;  ///< a PNG that says its gamma has that, as in Mitsuba 0.x; else all are sRGB
};

/// Reads any image that OpenImageIO reads. Files with alpha keep colours that are not multiplied by it as they stand.
/// Colours of primaries other than those of Rec. 709, as EXR files may say, are converted unless raw. Negative numbers
/// become 0 (unless raw), and with mend those that are not finite; both are counted. Of a file without channels R, G
/// and B the first layer with some of these names is shown, or else the first three channels. Throws Error where the
/// file is missing, damaged or larger than 2 GiB decoded, and where a texel is not finite.
Image load_image(const std::string& path, const ImageOptions& options = {});

}  // namespace ajar
