// Enters: pixels with named channels, metadata.
// Leaves: EXR and PNG files, written aside and renamed; and what such files hold.
#pragma once

#include <array>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "ajar/core/files.h"
#include "ajar/core/vec.h"

namespace ajar {

/// Pixels in rows from the top, channels interleaved: pixels[(y * width + x) * channels() + channel]. Linear,
/// scene-referred.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::string> names;  ///< "R", "G", "B", "Albedo.R", "N.X", "Variance.R", ...
  std::vector<float> pixels;

  int channels() const { return int(names.size()); }
};

using Metadata = std::map<std::string, std::variant<std::string, double>>;

/// As long as it lives OpenImageIO and OpenEXR read and write with so many threads. Not for several at a time.
class PictureThreads {
 public:
  explicit PictureThreads(int count);  ///< 0: as many as before
  ~PictureThreads();
  PictureThreads(const PictureThreads&) = delete;
  PictureThreads& operator=(const PictureThreads&) = delete;

 private:
  int before_ = 0, exr_before_ = 0;
};

/// Of the channels of an OpenEXR file.
enum class PixelType { half, float32 };
/// Writes channels and metadata to an OpenEXR file, ZIP-compressed; the same arguments give the same bytes. Names of
/// metadata need a prefix of their own ("ajar:seed"): of others OpenEXR takes some for itself, and drops or renames
/// them. half: a channel that holds a finite value beyond the range of half (65504) stays float, so that nothing turns
/// into infinity; so does one whose largest value is below 1/16, so that what is dim keeps its bits, and "Variance."
/// and "P." do. Throws Error; a failure leaves no file, and an older one as it was.
void write_exr(const std::string& path, const Picture& picture, const Metadata& metadata = {},
               PixelType type = PixelType::float32);
/// Writes the first three channels (or, of fewer, the first as grey) to an 8-bit PNG by the fixed tone curve of
/// docs/notation.md; exposure in stops. Throws Error, also where such a channel holds NaN, or for more than
/// 100 stops either way.
void write_png(const std::string& path, const Picture& picture, float exposure = 0);
/// Reads any image that OpenImageIO reads (of several parts the first); integer files are decoded from sRGB, except
/// alpha and where the file says that it is linear. The picture is the file's display window: black where the file's
/// data window does not reach, without what lies outside. Channels come in the file's order as OpenImageIO gives it (R,
/// G, B, A first). NaN and infinity stay. Throws Error.
Picture read_picture(const std::string& path);
/// The file's attributes: single numbers as double, everything else as text. Throws Error.
Metadata read_metadata(const std::string& path);
/// Throws Error, which begins with the name, unless there are pixels, as many values as channels ask for, and channels
/// have names of their own.
void require_sound(const std::string& name, const Picture& picture);
/// The same pixels with the named channels only, in that order; throws Error where one is missing.
Picture select(const Picture& picture, const std::vector<std::string>& names);
/// Indices of the channels R, G, B; thrice that of the only channel or of Y in a grey picture. Throws Error without
/// them.
std::array<size_t, 3> rgb_channels(const Picture& picture);
/// Reads R, G and B, which a grey picture has thrice. Throws Error that names the file.
Picture read_rgb(const std::string& path);
/// The part of width x height pixels whose top left pixel is (x, y); throws Error where it does not lie in the picture.
Picture crop(const Picture& picture, int x, int y, int width, int height);

}  // namespace ajar
