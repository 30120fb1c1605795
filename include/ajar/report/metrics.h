// Enters: an image, a reference, optionally their variances.
// Leaves: figures of difference, each as its source defines it (docs/notation.md, "Figures of difference").
#pragma once

#include <string>

#include "ajar/film/picture.h"

namespace ajar {

/// The test that all differences are noise. The per-pixel figures are over pixels and channels whose variance is not
/// zero.
struct ZTest {
  double mean = 0, variance = 0;  ///< of z = (I - R) / sqrt(Var I + Var R): 0 and 1 for equal expectations
  double worst = 0;               ///< the z of largest magnitude, with its sign
  int worst_x = 0, worst_y = 0;   ///< its pixel
  double p = 1;  ///< probability of a difference as significant as the worst of all regions, if all is noise
  int x = 0, y = 0, width = 0, height = 0;  ///< that region
  char channel = 'R';                       ///< and its channel
};

/// All over pixels and the channels R, G, B, linear unless said otherwise.
struct Metrics {
  double mean = 0, mean_reference = 0;
  double mse = 0;             ///< mean of (I - R)^2
  double relmse = 0;          ///< mean of (I - R)^2 / (R^2 + 0.01)
  double relmse_trimmed = 0;  ///< the same without the worst 0.1 % of pixels
  double mape = 0;            ///< mean of |I - R| / (|R| + 0.01)
  double ssim = 0;            ///< structural similarity of the tonemapped luminance; 1 for equal images
  double flip = 0;            ///< mean LDR-FLIP of the tonemapped images at 67 pixels per degree; 0 for equal images
  bool has_z = false;         ///< z is there: at least one of the images has channels Variance.R, .G, .B
  ZTest z;
};

/// Image and reference have the same size, and channels R, G, B, or Y or a single one (grey). Channels Variance.R, .G,
/// .B hold the variance of the pixel's value (not of one sample). Throws Error, also where a value is not finite or a
/// variance is negative.
/// FLIP costs more than all the rest; without it the figure is zero.
Metrics compare(const Picture& image, const Picture& reference, bool with_flip = true);

/// Mean structural similarity (Wang, Bovik, Sheikh and Simoncelli 2004, eq. 13: K1 = 0.01, K2 = 0.03, L = 1, Gaussian
/// window of 11x11 pixels and 1.5 pixels standard deviation) of the tonemapped luminances, over the windows that lie in
/// the image. In an image narrower than 11 pixels the window is the largest odd one that fits.
double ssim(const Picture& image, const Picture& reference);

/// LDR-FLIP per pixel, in [0,1] (Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild 2020), of the
/// images clipped to [0,1]; pixels_per_degree as the paper has it for a screen 0.7 m wide, 3840 pixels, seen from 0.7
/// m, above 0. One channel, "Flip". Throws Error.
Picture flip(const Picture& image, const Picture& reference, double pixels_per_degree = 3840 * std::numbers::pi / 180);

/// Throws Error unless at least one of the images has variance channels.
ZTest z_test(const Picture& image, const Picture& reference);
bool has_variance(const Picture& picture);
/// The image with the channels Variance.R, .G, .B of the other picture, or with its R, G, B under these names. Throws
/// Error.
Picture with_variance(const Picture& image, const Picture& variance);

/// Of all values of all channels.
double mean_of(const Picture& picture);

/// The signed relative difference of the luminances, (I - R) / (|R| + 0.01), in false colour: white for none, red where
/// the image is brighter, blue where it is darker; the tint grows with the square root and is full where the
/// image is twice as bright, or black. To be written by write_png.
Picture difference_picture(const Picture& image, const Picture& reference);

/// Throws Error unless the picture has channels R, G, B or is grey, these and its variances are finite, and no variance
/// is negative; the message names the channel, the pixel and the file.
void require_comparable(const Picture& picture, const std::string& file, const char* cure = "render it again");

/// One JSON line without the line's end, keys in a fixed order; z figures are null without variance.
std::string to_json(const Metrics& metrics);

}  // namespace ajar
