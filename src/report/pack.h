// Enters: an HDR picture; bytes.
// Leaves: text to be embedded in a page, from which its script makes the picture again.
#pragma once

#include <span>
#include <string>

#include "ajar/film/picture.h"

namespace ajar {

/// R, G, B as half floats times 2^exponent, where the exponent is 0 unless a finite value would overflow. The bit
/// patterns of G, R - G and B - G (modulo 2^16: noise is much the same in the three) in three planes, each first all
/// high and then all low bytes, each byte less the one before it (modulo 256), in zlib's format, in base64.
struct Packed {
  std::string text;
  int exponent = 0;
};

/// The picture has the channels R, G, B in this order, and no other.
Packed pack(const Picture& picture);

/// Averages of squares of pixels, as many as it takes for a width of at most the given one; those at the right and
/// lower edge have what is left of a square.
Picture reduced(const Picture& picture, int width);

std::string base64(std::span<const unsigned char> bytes);

}  // namespace ajar
