#include "pack.h"

#include <Imath/half.h>
#include <zlib.h>

#include <cmath>

#include "ajar/core/error.h"

namespace ajar {
namespace {

/// Such that every finite value times 2^exponent is a finite half.
int exponent_of(const Picture& picture) {
  float largest = 0;
  for (const float v : picture.pixels)
    if (std::isfinite(v)) largest = std::max(largest, std::abs(v));
  int exponent = 0;
  while (std::ldexp(largest, exponent) > HALF_MAX) --exponent;
  return exponent;
}

std::vector<unsigned char> byte_planes(const Picture& picture, int exponent) {
  const size_t count = picture.pixels.size() / 3;
  std::vector<unsigned char> bytes(6 * count);
  for (size_t i = 0; i < count; ++i) {
    uint16_t bits[3];
    for (size_t c = 0; c < 3; ++c) bits[c] = half(std::ldexp(picture.pixels[3 * i + c], exponent)).bits();
    const uint16_t planes[3] = {bits[1], uint16_t(bits[0] - bits[1]), uint16_t(bits[2] - bits[1])};
    for (size_t p = 0; p < 3; ++p) {
      bytes[2 * p * count + i] = static_cast<unsigned char>(planes[p] >> 8);
      bytes[(2 * p + 1) * count + i] = static_cast<unsigned char>(planes[p] & 255);
    }
  }
  for (size_t i = bytes.size(); i-- > 1;) bytes[i] = static_cast<unsigned char>(bytes[i] - bytes[i - 1]);
  return bytes;
}

std::vector<unsigned char> deflated(const std::vector<unsigned char>& bytes) {
  uLongf size = compressBound(uLong(bytes.size()));
  std::vector<unsigned char> out(size);
  if (compress2(out.data(), &size, bytes.data(), uLong(bytes.size()), Z_DEFAULT_COMPRESSION) != Z_OK)
    throw Error("an image cannot be compressed (out of memory); close other programs");
  out.resize(size);
  return out;
}

}  // namespace

Packed pack(const Picture& picture) {
  const int exponent = exponent_of(picture);
  return {base64(deflated(byte_planes(picture, exponent))), exponent};
}

Picture reduced(const Picture& picture, int width) {
  const int step = (picture.width + width - 1) / width, channels = picture.channels();
  if (step <= 1) return picture;
  const auto size = [&](int n) { return (n + step - 1) / step; };
  Picture out{size(picture.width), size(picture.height), picture.names, {}};
  out.pixels.reserve(size_t(out.width) * size_t(out.height) * size_t(channels));
  for (int y = 0; y < picture.height; y += step)
    for (int x = 0; x < picture.width; x += step)
      for (int c = 0; c < channels; ++c) {
        const int x1 = std::min(x + step, picture.width), y1 = std::min(y + step, picture.height);
        double sum = 0;
        for (int v = y; v < y1; ++v)
          for (int u = x; u < x1; ++u)
            sum +=
                double(picture.pixels[(size_t(v) * size_t(picture.width) + size_t(u)) * size_t(channels) + size_t(c)]);
        out.pixels.push_back(float(sum / ((x1 - x) * (y1 - y))));
      }
  return out;
}

std::string base64(std::span<const unsigned char> bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t n = std::min<size_t>(3, bytes.size() - i);
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k) group = group << 8 | (k < n ? bytes[i + k] : 0u);
    for (size_t k = 0; k < 4; ++k) text += k <= n ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

}  // namespace ajar
