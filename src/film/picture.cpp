#include "ajar/film/picture.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstring>
#include <filesystem>
#include <memory>
#include <set>

#include "ajar/core/error.h"
#include "ajar/core/files.h"
#include "ajar/film/tone.h"

namespace ajar {
namespace {

constexpr float half_max = 65504;
// The least that a half holds to its 11 bits is 2^-14: where a channel's largest value is below this, what is a
// thousandth of it would have fewer.
constexpr float half_dim = 0x1p-4f;
constexpr int64_t most_values = int64_t(1) << 30;  // 4 GiB of floats: more is a damaged header, not a picture

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  return text;
}

/// Encodes in memory, so that every error of the disk is seen by write_aside.
void encode_and_write(const std::string& path, const char* format, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
                      const void* pixels) {
  auto output = OIIO::ImageOutput::create(format);
  OIIO::Filesystem::IOVecOutput bytes;
  const bool done = output && output->set_ioproxy(&bytes) && output->open(std::string("picture.") + format, spec) &&
                    output->write_image(type, pixels) && output->close();
  if (!done) {
    const std::string why = output ? output->geterror() : OIIO::geterror();
    throw Error(fmt::format("{}: cannot be encoded ({}); check OpenImageIO's installation", path, one_line(why)));
  }
  output.reset();
  write_aside(path, bytes.buffer().data(), bytes.buffer().size());
}

/// Of variances and positions, whose range no half has.
bool is_wide(const std::string& name) { return name.starts_with("Variance.") || name.starts_with("P."); }

/// Per channel: half unless a finite value would overflow, or most would be too small for all its bits.
std::vector<OIIO::TypeDesc> channel_formats(const Picture& picture, PixelType type) {
  const size_t channels = picture.names.size();
  std::vector<OIIO::TypeDesc> formats(channels, OIIO::TypeDesc::FLOAT);
  if (type == PixelType::float32) return formats;
  std::vector<float> largest(channels, 0);
  for (size_t i = 0; i < picture.pixels.size(); ++i)
    if (std::isfinite(picture.pixels[i]))
      largest[i % channels] = std::max(largest[i % channels], std::abs(picture.pixels[i]));
  for (size_t c = 0; c < channels; ++c)
    if (!is_wide(picture.names[c]) && (largest[c] == 0 || (largest[c] >= half_dim && largest[c] <= half_max)))
      formats[c] = OIIO::TypeDesc::HALF;
  return formats;
}

std::unique_ptr<OIIO::ImageInput> open_picture(const std::string& path) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (!std::filesystem::exists(status)) throw Error(fmt::format("{}: there is no such file; check the name", path));
  if (std::filesystem::is_directory(status)) throw Error(fmt::format("{}: is a folder; name an image file", path));
  require_readable(path);
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);  // colours as they are stored
  auto input = OIIO::ImageInput::open(path, &config);
  if (!input)
    throw Error(fmt::format("{}: cannot be read as an image ({}); write it again, or convert it to EXR", path,
                            one_line(OIIO::geterror())));
  if (input->spec().deep) throw Error(fmt::format("{}: is a deep image; flatten it first", path));
  return input;
}

/// The file's data window as floats.
std::vector<float> read_window(const std::string& path, OIIO::ImageInput& input) {
  const OIIO::ImageSpec spec = input.spec();
  const int64_t most = most_values / std::max(spec.nchannels, 1);
  if (spec.nchannels <= 0 || spec.width <= 0 || spec.height <= 0 || spec.depth > 1 ||
      int64_t(spec.width) * spec.height > most || int64_t(spec.full_width) * spec.full_height > most)
    throw Error(fmt::format("{}: {}x{} pixels of {} channels cannot be read; is the file damaged?", path, spec.width,
                            spec.height, spec.nchannels));
  std::vector<float> pixels(size_t(spec.width) * size_t(spec.height) * size_t(spec.nchannels));
  // Some readers say so where the file ends too early, others only leave an error.
  if (!input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels.data()) || input.has_error()) {
    const std::string why = one_line(input.geterror());
    throw Error(fmt::format("{}: its pixels cannot be read{}; the file is damaged or cut short, write it again", path,
                            why.empty() ? "" : " (" + why + ")"));
  }
  return pixels;
}

bool is_encoded(const OIIO::ImageInput& input, int channel) {
  const OIIO::ImageSpec& spec = input.spec();
  return !spec.channelformat(channel).is_floating_point() && channel != spec.alpha_channel &&
         std::string(input.format_name()) != "openexr" &&
         !OIIO::Strutil::iequals(spec.get_string_attribute("oiio:ColorSpace"), "linear");
}

}  // namespace

void require_sound(const std::string& name, const Picture& picture) {
  if (picture.width <= 0 || picture.height <= 0 || picture.names.empty() ||
      picture.pixels.size() != size_t(picture.width) * size_t(picture.height) * picture.names.size())
    throw Error(fmt::format("{}: a picture of {}x{} with {} channels does not match its {} values; fill every pixel",
                            name, picture.width, picture.height, picture.channels(), picture.pixels.size()));
  std::set<std::string> seen;
  for (const std::string& channel : picture.names)
    if (channel.empty() || !seen.insert(channel).second)
      throw Error(
          fmt::format("{}: channel name \"{}\" is empty or there twice; name each channel once", name, channel));
}

PictureThreads::PictureThreads(int count) {
  if (count <= 0 || !OIIO::getattribute("threads", before_) || !OIIO::getattribute("exr_threads", exr_before_)) return;
  OIIO::attribute("threads", count), OIIO::attribute("exr_threads", count);
}

PictureThreads::~PictureThreads() {
  if (before_ > 0) OIIO::attribute("threads", before_), OIIO::attribute("exr_threads", exr_before_);
}

void write_exr(const std::string& path, const Picture& picture, const Metadata& metadata, PixelType type) {
  require_sound(path, picture);
  OIIO::ImageSpec spec(picture.width, picture.height, picture.channels(), OIIO::TypeDesc::FLOAT);
  spec.channelnames = picture.names;
  const auto index = [&](const char* name) {
    const auto found = std::find(picture.names.begin(), picture.names.end(), name);
    return found == picture.names.end() ? -1 : int(found - picture.names.begin());
  };
  spec.alpha_channel = index("A");
  spec.z_channel = index("Z");
  const auto formats = channel_formats(picture, type);
  spec.set_format(formats[0]);
  if (std::find(formats.begin(), formats.end(),
                formats[0] == OIIO::TypeDesc::HALF ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::HALF) != formats.end())
    spec.channelformats = formats;
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "");  // else it is the time of writing, and no two runs make the same file
  for (const auto& [name, value] : metadata) {
    if (const auto* text = std::get_if<std::string>(&value))
      spec.attribute(name, *text);
    else
      spec.attribute(name, OIIO::TypeDesc::DOUBLE, &std::get<double>(value));
  }
  encode_and_write(path, "exr", spec, OIIO::TypeDesc::FLOAT, picture.pixels.data());
}

void write_png(const std::string& path, const Picture& picture, float exposure) {
  require_sound(path, picture);
  if (!(std::abs(exposure) <= 100))
    throw Error(fmt::format("{}: an exposure of {} is none; give -100 to 100 stops", path, exposure));
  const int channels = picture.channels() >= 3 ? 3 : 1;
  const size_t count = size_t(picture.width) * size_t(picture.height);
  std::vector<uint8_t> bytes(count * size_t(channels));
  for (size_t i = 0; i < count; ++i)
    for (int c = 0; c < channels; ++c) {
      const float value = picture.pixels[i * picture.names.size() + size_t(c)];
      if (std::isnan(value))
        throw Error(fmt::format("{}: pixel ({}, {}) of channel {} is not a number; a PNG cannot hold it, write an EXR",
                                path, i % size_t(picture.width), i / size_t(picture.width), picture.names[size_t(c)]));
      bytes[i * size_t(channels) + size_t(c)] = uint8_t(255 * tone_curve(value, exposure) + 0.5);
    }
  OIIO::ImageSpec spec(picture.width, picture.height, channels, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  encode_and_write(path, "png", spec, OIIO::TypeDesc::UINT8, bytes.data());
}

Picture read_picture(const std::string& path) {
  auto input = open_picture(path);
  const OIIO::ImageSpec spec = input->spec();
  std::vector<float> window = read_window(path, *input);
  const size_t channels = size_t(spec.nchannels);
  for (size_t c = 0; c < channels; ++c)
    if (is_encoded(*input, int(c)))
      for (size_t i = c; i < window.size(); i += channels) window[i] = float(decode_srgb(window[i]));

  Picture picture{spec.full_width, spec.full_height, spec.channelnames, {}};
  for (size_t c = 0; c < channels; ++c) {
    if (picture.names.size() <= c) picture.names.emplace_back();
    if (picture.names[c].empty()) picture.names[c] = c < 3 ? std::string(1, "RGB"[c]) : fmt::format("channel{}", c);
  }
  if (picture.width <= 0 || picture.height <= 0) {
    picture.width = spec.width;
    picture.height = spec.height;
  }
  if (picture.width == spec.width && picture.height == spec.height && spec.x == spec.full_x && spec.y == spec.full_y) {
    picture.pixels = std::move(window);
    return picture;
  }
  picture.pixels.assign(size_t(picture.width) * size_t(picture.height) * channels, 0.0f);
  const int left = spec.x - spec.full_x, top = spec.y - spec.full_y;  // of the data window in the display window
  const int x0 = std::max(left, 0), x1 = std::min(left + spec.width, picture.width);
  const int y0 = std::max(top, 0), y1 = std::min(top + spec.height, picture.height);
  if (x0 >= x1 || y0 >= y1) throw Error(fmt::format("{}: no pixel lies in its display window; write it again", path));
  for (int y = y0; y < y1; ++y)
    std::copy_n(window.data() + (size_t(y - top) * size_t(spec.width) + size_t(x0 - left)) * channels,
                size_t(x1 - x0) * channels,
                picture.pixels.data() + (size_t(y) * size_t(picture.width) + size_t(x0)) * channels);
  return picture;
}

Metadata read_metadata(const std::string& path) {
  const auto input = open_picture(path);
  Metadata metadata;
  for (const OIIO::ParamValue& value : input->spec().extra_attribs) {
    const OIIO::TypeDesc type = value.type();
    const bool number = type.basetype >= OIIO::TypeDesc::UINT8 && type.basetype <= OIIO::TypeDesc::DOUBLE;
    if (number && type.basevalues() == 1 && value.nvalues() == 1) {
      double x = type.is_floating_point() ? double(value.get_float()) : double(value.get_int());
      if (type == OIIO::TypeDesc::DOUBLE) std::memcpy(&x, value.data(), sizeof x);
      metadata[value.name().string()] = x;
    } else {
      metadata[value.name().string()] = value.get_string();
    }
  }
  return metadata;
}

Picture select(const Picture& picture, const std::vector<std::string>& names) {
  require_sound("select", picture);
  std::vector<size_t> from;
  for (const std::string& name : names) {
    const auto found = std::find(picture.names.begin(), picture.names.end(), name);
    if (found == picture.names.end())
      throw Error(fmt::format("channel {} is missing (the picture has {}); render with that channel", name,
                              fmt::join(picture.names, ", ")));
    from.push_back(size_t(found - picture.names.begin()));
  }
  Picture selected{picture.width, picture.height, names, {}};
  const size_t count = size_t(picture.width) * size_t(picture.height);
  selected.pixels.reserve(count * names.size());
  for (size_t i = 0; i < count; ++i)
    for (const size_t c : from) selected.pixels.push_back(picture.pixels[i * picture.names.size() + c]);
  return selected;
}

std::array<size_t, 3> rgb_channels(const Picture& picture) {
  const auto index = [&](const char* name) {
    return size_t(std::find(picture.names.begin(), picture.names.end(), name) - picture.names.begin());
  };
  const size_t missing = picture.names.size();
  const std::array<size_t, 3> rgb = {index("R"), index("G"), index("B")};
  if (std::find(rgb.begin(), rgb.end(), missing) == rgb.end()) return rgb;
  if (missing == 1) return {0, 0, 0};
  if (const size_t grey = index("Y"); grey != missing && index("X") == missing) return {grey, grey, grey};
  throw Error(fmt::format("channels R, G, B are missing (there are {}); write the image with these",
                          fmt::join(picture.names, ", ")));
}

Picture read_rgb(const std::string& path) {
  const Picture picture = read_picture(path);
  try {
    const auto [r, g, b] = rgb_channels(picture);
    Picture out = select(picture, {picture.names[r], picture.names[g], picture.names[b]});
    out.names = {"R", "G", "B"};
    return out;
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
}

Picture crop(const Picture& picture, int x, int y, int width, int height) {
  require_sound("crop", picture);
  if (x < 0 || y < 0 || width <= 0 || height <= 0 || x > picture.width - width || y > picture.height - height)
    throw Error(
        fmt::format("a crop of {}x{} pixels at ({}, {}) does not lie in the picture of {}x{}; choose a smaller one",
                    width, height, x, y, picture.width, picture.height));
  Picture part{width, height, picture.names, {}};
  const size_t channels = picture.names.size();
  part.pixels.reserve(size_t(width) * size_t(height) * channels);
  for (int row = y; row < y + height; ++row) {
    const auto begin = picture.pixels.begin() + (ptrdiff_t(row) * picture.width + x) * ptrdiff_t(channels);
    part.pixels.insert(part.pixels.end(), begin, begin + width * ptrdiff_t(channels));
  }
  return part;
}

}  // namespace ajar
