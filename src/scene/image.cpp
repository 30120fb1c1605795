#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include <array>
#include <cstring>
#include <fstream>

#include "ajar/core/error.h"
#include "ajar/core/files.h"
#include "ajar/core/srgb.h"
#include "ajar/scene/texture.h"
#include "primaries.h"

namespace ajar {
namespace {

constexpr size_t most_bytes = size_t(2) << 30;
constexpr int longest_side = 1 << 17;

// How stored numbers become linear ones. exponent 1: as they stand; 0: sRGB.
struct Transfer {
  float exponent = 1;
  float operator()(float x) const {
    if (exponent == 1) return x;
    return exponent == 0 ? float(decode_srgb(double(x))) : std::pow(std::max(x, 0.0f), exponent);
  }
};

// says: whether what the file says of its gamma counts.
Transfer transfer_of(const OIIO::ImageSpec& spec, const ImageOptions& options, bool says) {
  if (options.raw) return {1};
  if (options.gamma != 0) return {std::max(options.gamma, 0.0f)};
  if (spec.format.basetype == OIIO::TypeDesc::HALF || spec.format.basetype == OIIO::TypeDesc::FLOAT ||
      spec.format.basetype == OIIO::TypeDesc::DOUBLE)
    return {1};
  if (!says) return {0};
  const float said = spec.get_float_attribute("oiio:Gamma", 0);
  if (said > 0) return {said};
  return {OIIO::Strutil::iequals(spec.get_string_attribute("oiio:ColorSpace"), "linear") ? 1.0f : 0.0f};
}

// Where the colours and alpha are among the file's channels; alpha -1: nowhere.
struct Layout {
  int color[3] = {0, 1, 2};
  int colors = 3;
  int alpha = -1;
  bool normals = false;  // a map of normals
  bool guessed = false;  // the file does not say which are the colours
};

// Whether a layer of the file has colours: NAME.R, NAME.G and NAME.B. The first that does is taken.
bool take_layer(const OIIO::ImageSpec& spec, Layout& layout) {
  for (int r = 0; r < spec.nchannels; ++r) {
    std::string layer(spec.channel_name(r));
    if (layer.empty() || layer.back() != 'R') continue;
    layer.pop_back();
    const int g = spec.channelindex(layer + "G"), b = spec.channelindex(layer + "B");
    if (g < 0 || b < 0) continue;
    layout.color[0] = r, layout.color[1] = g, layout.color[2] = b;
    layout.alpha = spec.channelindex(layer + "A");
    return true;
  }
  return false;
}

std::string names_of(const OIIO::ImageSpec& spec, const Layout& layout) {
  std::string names;
  for (const int c : layout.color)
    names += fmt::format("{}{}", names.empty() ? "" : ", ", std::string(spec.channel_name(c)));
  return names;
}

Layout layout_of(const OIIO::ImageSpec& spec) {
  const int r = spec.channelindex("R"), g = spec.channelindex("G"), b = spec.channelindex("B");
  Layout layout;
  layout.alpha = spec.alpha_channel;
  if (r >= 0 && g >= 0 && b >= 0) {
    layout.color[0] = r, layout.color[1] = g, layout.color[2] = b;
  } else if (const int x = spec.channelindex("X"), y = spec.channelindex("Y"), z = spec.channelindex("Z");
             x >= 0 && y >= 0 && z >= 0) {
    layout.normals = true;
    layout.color[0] = x, layout.color[1] = y, layout.color[2] = z;
  } else if (take_layer(spec, layout)) {
    layout.guessed = true;
  } else if (spec.nchannels < 3 || layout.alpha == 1 || spec.channelindex("Y") >= 0) {
    layout.colors = 1;
    layout.color[0] = std::max(spec.channelindex("Y"), 0);
  } else {
    layout.guessed = true;  // the first three
  }
  return layout;
}

// What makes the file's colours those of Rec. 709, if they are others.
std::optional<Mat3> conversion_of(const std::string& path, const OIIO::ImageSpec& spec, const Layout& layout,
                                  bool raw) {
  Chromaticities said{};
  const OIIO::ParamValue* attribute = spec.find_attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8));
  if (raw || layout.colors != 3 || layout.normals || attribute == nullptr) return {};
  std::memcpy(said.data(), attribute->data(), sizeof said);
  if (are_rec709(said)) return {};
  const std::optional<Mat3> conversion = to_rec709(said);
  if (!conversion)
    throw Error(fmt::format("{}: its chromaticities ({}) make no colours; correct them, or take them out of the file",
                            path, fmt::join(said, ", ")));
  return conversion;
}

void convert(std::vector<float>& all, const Layout& layout, int channels, const Mat3& conversion) {
  for (size_t i = 0; i < all.size(); i += size_t(channels)) {
    const auto part = [&](int c) -> float& { return all[i + size_t(layout.color[c])]; };
    const Rgb converted = conversion * Rgb(part(0), part(1), part(2));
    for (int c = 0; c < 3; ++c) part(c) = converted[c];
  }
}

// Only what an image can hold: a damaged header must not ask for all memory.
void check_size(const std::string& path, const OIIO::ImageSpec& spec) {
  const size_t per_channel = spec.format == OIIO::TypeDesc::UINT8 ? 1 : sizeof(float);
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1 || spec.nchannels > 256)
    throw Error(fmt::format("{}: not a two-dimensional image ({}x{}x{}, {} channels): convert it", path, spec.width,
                            spec.height, spec.depth, spec.nchannels));
  if (spec.width > longest_side || spec.height > longest_side ||
      size_t(spec.width) * size_t(spec.height) > most_bytes / (per_channel * size_t(spec.nchannels)))
    throw Error(fmt::format("{}: {}x{} with {} channels is more than {} GiB decoded: make it smaller", path, spec.width,
                            spec.height, spec.nchannels, most_bytes >> 30));
}

bool take(std::ifstream& in, unsigned char* to, size_t n) {
  return bool(in.read(reinterpret_cast<char*>(to), std::streamsize(n)));
}

uint32_t number_at(const unsigned char* p) {
  return uint32_t(p[0]) << 24 | uint32_t(p[1]) << 16 | uint32_t(p[2]) << 8 | p[3];
}

// The kind of the chunk of a PNG file that was passed; empty at the end of the file.
std::string pass_chunk(std::ifstream& in, const std::string& path) {
  std::array<unsigned char, 8> head{};  // length and kind
  if (!take(in, head.data(), 8)) return {};
  const std::string kind(head.begin() + 4, head.end());
  std::vector<unsigned char> piece(size_t(1) << 16);
  uLong sum = crc32(0, head.data() + 4, 4);
  for (size_t left = number_at(head.data()); left > 0;) {
    const size_t n = std::min(left, piece.size());
    if (!take(in, piece.data(), n)) throw Error(path + ": the image is cut off; copy it anew");
    sum = crc32(sum, piece.data(), uInt(n));
    left -= n;
  }
  if (!take(in, head.data(), 4)) throw Error(path + ": the image is cut off; copy it anew");
  const bool needed = kind[0] >= 'A' && kind[0] <= 'Z';
  if (needed && sum != number_at(head.data()))
    throw Error(path + ": the image is damaged: a checksum in it is wrong; copy it anew");
  return kind;
}

// libpng writes a line of its own to standard error where a file is damaged: most of those are found before it reads.
void check_png(const std::string& path) {
  constexpr std::array<unsigned char, 8> signature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  std::ifstream in(path, std::ios::binary);
  std::array<unsigned char, 8> head{};
  if (!take(in, head.data(), head.size()) || head != signature) return;
  bool has_data = false;
  for (std::string kind; !(kind = pass_chunk(in, path)).empty() && kind != "IEND";) has_data |= kind == "IDAT";
  if (!has_data) throw Error(path + ": the image is cut off; copy it anew");
}

// Rows that are decoded at a time: whole strips of a TIFF file, whole tiles.
int rows_of_strip(const OIIO::ImageSpec& spec) {
  constexpr int least = 256;
  const int unit = std::clamp(spec.tile_width > 0 ? spec.tile_height : spec.get_int_attribute("tiff:RowsPerStrip", 64),
                              1, spec.height);
  return std::min((least + unit - 1) / unit * unit, spec.height);
}

// Calls keep(values, number of the first pixel) for one strip of the image after another: it is never held as a whole.
template <class T, class F>
void read_strips(const std::string& path, OIIO::ImageInput& input, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
                 const F& keep) {
  const int each = rows_of_strip(spec);
  std::vector<T> strip;
  for (int y = 0; y < spec.height; y += each) {
    const int from = spec.y + y, to = spec.y + std::min(y + each, spec.height);
    strip.resize(size_t(spec.width) * size_t(to - from) * size_t(spec.nchannels));
    const bool read = spec.tile_width > 0
                          ? input.read_tiles(0, 0, spec.x, spec.x + spec.width, from, to, spec.z, spec.z + 1, 0,
                                             spec.nchannels, type, strip.data())
                          : input.read_scanlines(0, 0, from, to, spec.z, 0, spec.nchannels, type, strip.data());
    if (!read || input.has_error()) {
      const std::string why = input.geterror();
      throw Error(fmt::format("{}: the image is damaged or cut off{}; copy it anew", path,
                              why.empty() ? "" : fmt::format(" ({})", why)));
    }
    keep(strip, size_t(y) * size_t(spec.width));
  }
}

void keep_bytes(Image& image, const Layout& layout, int channels, const std::vector<uint8_t>& strip, size_t first) {
  const size_t pixels = strip.size() / size_t(channels);
  for (size_t i = 0; i < pixels; ++i)
    for (int c = 0; c < image.channels; ++c)
      image.bytes[(first + i) * size_t(image.channels) + size_t(c)] =
          strip[i * size_t(channels) + size_t(layout.color[c])];
  if (layout.alpha < 0) return;
  for (size_t i = 0; i < pixels; ++i) image.alpha[first + i] = strip[i * size_t(channels) + size_t(layout.alpha)];
}

// A number of a pixel, linear. Filters that make images smaller leave slightly negative ones beside bright spots.
float take_number(Image& image, float stored, size_t pixel, const Transfer& transfer, const ImageOptions& options) {
  const float value = transfer(stored);
  if (!std::isfinite(value)) {
    if (!options.mend)
      throw Error(fmt::format("{}: pixel ({}, {}) holds {}; repair the image; with --lenient: 0 in its place",
                              image.name, pixel % size_t(image.width), pixel / size_t(image.width), stored));
    ++image.not_finite;
    return 0;
  }
  if (!(stored < 0) || options.raw) return value;
  ++image.negative;
  return 0;
}

void keep_floats(Image& image, const Layout& layout, int channels, const Transfer& transfer,
                 const ImageOptions& options, const std::vector<float>& strip, size_t first) {
  const size_t pixels = strip.size() / size_t(channels);
  for (size_t i = 0; i < pixels; ++i)
    for (int c = 0; c < image.channels; ++c)
      image.floats[(first + i) * size_t(image.channels) + size_t(c)] =
          take_number(image, strip[i * size_t(channels) + size_t(layout.color[c])], first + i, transfer, options);
  if (layout.alpha < 0) return;
  for (size_t i = 0; i < pixels; ++i) {
    const float a = strip[i * size_t(channels) + size_t(layout.alpha)];
    image.alpha[first + i] = a > 0 ? uint8_t(std::min(a, 1.0f) * 255 + 0.5f) : 0;
  }
}

// Fully opaque images need no alpha.
void drop_idle_alpha(Image& image) {
  if (std::all_of(image.alpha.begin(), image.alpha.end(), [](uint8_t a) { return a == 255; })) {
    image.alpha.clear();
    image.alpha.shrink_to_fit();
  }
}

// OpenImageIO's reader of icons may end the program where one is damaged.
bool is_icon(const std::string& path) {
  constexpr char mark[] = {0, 0, 1, 0};
  char begin[sizeof mark] = {1};
  std::ifstream(path, std::ios::binary).read(begin, sizeof begin);
  return std::equal(begin, begin + sizeof begin, mark);
}

}  // namespace

Image load_image(const std::string& path, const ImageOptions& options) {
  require_readable(path);
  check_png(path);
  if (is_icon(path)) throw Error(fmt::format("{}: icons are not read; convert it to PNG", path));
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);  // colours as they are stored
  const auto input = OIIO::ImageInput::open(path, &config);
  if (!input)
    throw Error(fmt::format("{}: cannot be read as an image ({}); write it again, or convert it to EXR", path,
                            OIIO::geterror()));
  const OIIO::ImageSpec spec = input->spec();
  check_size(path, spec);
  const Layout layout = layout_of(spec);
  const bool is_png = std::string_view(input->format_name()) == "png";
  const Transfer transfer = transfer_of(spec, options, !is_png || options.png_gamma);
  Image image;
  image.name = path;
  image.width = spec.width, image.height = spec.height, image.channels = layout.colors;
  if (layout.guessed) image.guessed = names_of(spec, layout);
  const size_t pixels = size_t(spec.width) * size_t(spec.height);
  if (layout.alpha >= 0) image.alpha.resize(pixels);
  if (spec.format == OIIO::TypeDesc::UINT8) {
    for (int i = 0; i < 256; ++i) image.decode[i] = transfer(float(i) / 255);
    image.bytes.resize(pixels * size_t(image.channels));
    read_strips<uint8_t>(path, *input, spec, OIIO::TypeDesc::UINT8, [&](const auto& strip, size_t first) {
      keep_bytes(image, layout, spec.nchannels, strip, first);
    });
  } else {
    const std::optional<Mat3> conversion = conversion_of(path, spec, layout, options.raw);
    image.floats.resize(pixels * size_t(image.channels));
    read_strips<float>(path, *input, spec, OIIO::TypeDesc::FLOAT, [&](auto& strip, size_t first) {
      if (conversion) convert(strip, layout, spec.nchannels, *conversion);
      keep_floats(image, layout, spec.nchannels, transfer, options, strip, first);
    });
  }
  drop_idle_alpha(image);
  return image;
}

}  // namespace ajar
