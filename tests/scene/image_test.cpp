// Reading images: every common format, colour spaces, alpha, and refusals of damaged files.
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "ajar/core/error.h"
#include "ajar/scene/texture.h"

namespace ajar {
namespace {

// A folder of its own for each test, gone afterwards.
class ImageFile : public testing::Test {
 protected:
  std::filesystem::path folder;
  OIIO::ParamValueList attributes;  // what files that are written say
  void SetUp() override {
    folder = std::filesystem::path(testing::TempDir()) /
             (std::string("ajar-image-") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  template <class T>
  std::string write(const std::string& name, int width, int height, int channels, OIIO::TypeDesc type,
                    const std::vector<T>& values, OIIO::TypeDesc stored = OIIO::TypeDesc::UNKNOWN) {
    const std::string path = (folder / name).string();
    auto out = OIIO::ImageOutput::create(path);
    if (!out) throw std::runtime_error("cannot write " + name);
    OIIO::ImageSpec spec(width, height, channels, stored == OIIO::TypeDesc::UNKNOWN ? type : stored);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("CompressionQuality", 100);
    spec.extra_attribs.merge(attributes);
    EXPECT_TRUE(out->open(path, spec)) << name;
    EXPECT_TRUE(out->write_image(type, values.data())) << name;
    out->close();
    return path;
  }
};

float decode_srgb(int byte) {
  const float x = float(byte) / 255;
  return float(x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4));
}

// Rows of red, green, blue and grey: which end is up, which channel is which.
TEST_F(ImageFile, EightBitFormats) {
  constexpr int w = 16, h = 32;
  std::vector<uint8_t> pixels;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x)
      for (int c = 0; c < 3; ++c) pixels.push_back(y < h / 2 ? (c == 0 ? 200 : 50) : (c == 2 ? 120 : 30));
  for (const char* name : {"a.png", "a.jpg", "a.tga", "a.bmp", "a.tif", "with space.PNG"}) {
    const Image image = load_image(write(name, w, h, 3, OIIO::TypeDesc::UINT8, pixels));
    EXPECT_EQ(image.width, w);
    EXPECT_EQ(image.height, h);
    EXPECT_EQ(image.channels, 3) << name;
    EXPECT_EQ(image.bytes.size(), size_t(w * h * 3)) << name;
    EXPECT_TRUE(image.floats.empty() && image.alpha.empty());
    const float tolerance = std::string(name) == "a.jpg" ? 0.02f : 1e-6f;
    EXPECT_NEAR(texel(image, 3, 2).x, decode_srgb(200), tolerance) << name;
    EXPECT_NEAR(texel(image, 3, 2).y, decode_srgb(50), tolerance) << name;
    EXPECT_NEAR(texel(image, 3, 29).z, decode_srgb(120), tolerance) << name;
    const Image raw = load_image((folder / name).string(), {.raw = true});
    EXPECT_NEAR(texel(raw, 3, 2).x, 200 / 255.0f, 0.02f) << name;
    const Image gamma = load_image((folder / name).string(), {.gamma = 3});
    EXPECT_NEAR(texel(gamma, 3, 2).x, std::pow(200 / 255.0f, 3.0f), 0.02f) << name;
  }
}

// Maps of normals are kept so.
TEST_F(ImageFile, ChannelsXyzAreNoGrey) {
  const std::string path = (folder / "n.exr").string();
  OIIO::ImageSpec spec(1, 1, 3, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"X", "Y", "Z"};
  const float values[3] = {0.25f, 0.5f, 0.75f};
  auto out = OIIO::ImageOutput::create(path);
  ASSERT_TRUE(out->open(path, spec) && out->write_image(OIIO::TypeDesc::FLOAT, values) && out->close());
  const Image image = load_image(path, {.raw = true});
  EXPECT_EQ(image.channels, 3);
  EXPECT_EQ(texel(image, 0, 0), Rgb(0.25f, 0.5f, 0.75f));
}

// As Blender writes them: a layer's colours, wherever they stand.
TEST_F(ImageFile, OfLayersTheFirstWithColoursIsShown) {
  const auto shown = [&](const std::vector<std::string>& names) {
    const std::string path = (folder / "layers.exr").string();
    OIIO::ImageSpec spec(1, 1, int(names.size()), OIIO::TypeDesc::FLOAT);
    spec.channelnames = names;
    const std::vector<float> values{0.1f, 0.2f, 0.3f, 0.4f, 0.5f};
    const auto out = OIIO::ImageOutput::create(path);
    EXPECT_TRUE(out->open(path, spec) && out->write_image(OIIO::TypeDesc::FLOAT, values.data()) && out->close());
    return load_image(path);
  };
  const Image layers = shown({"Depth.Z", "View.Combined.A", "View.Combined.B", "View.Combined.G", "View.Combined.R"});
  EXPECT_EQ(layers.guessed, "View.Combined.R, View.Combined.G, View.Combined.B");
  EXPECT_EQ(texel(layers, 0, 0), Rgb(0.5f, 0.4f, 0.3f));
  EXPECT_EQ(layers.alpha, std::vector<uint8_t>{51});
  const Image parts = shown({"one", "three", "two"});
  EXPECT_EQ(parts.guessed, "one, three, two");
  EXPECT_EQ(texel(parts, 0, 0), Rgb(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(shown({"B", "G", "R", "a.B", "a.R"}).guessed, "");
}

TEST_F(ImageFile, GreyAlphaAndSixteenBit) {
  const Image grey = load_image(write<uint8_t>("g.png", 2, 1, 1, OIIO::TypeDesc::UINT8, {0, 188}));
  EXPECT_EQ(grey.channels, 1);
  EXPECT_EQ(texel(grey, 1, 0), Rgb(decode_srgb(188)));
  const Image la = load_image(write<uint8_t>("la.png", 2, 1, 2, OIIO::TypeDesc::UINT8, {10, 0, 188, 128}));
  EXPECT_EQ(la.channels, 1);
  EXPECT_EQ(la.alpha, (std::vector<uint8_t>{0, 128}));
  EXPECT_EQ(texel(la, 0, 0).x, decode_srgb(10));  // not multiplied by alpha
  const Image rgba = load_image(write<uint8_t>("rgba.png", 1, 1, 4, OIIO::TypeDesc::UINT8, {100, 150, 200, 64}));
  EXPECT_EQ(rgba.channels, 3);
  EXPECT_EQ(rgba.alpha, std::vector<uint8_t>{64});
  EXPECT_EQ(texel(rgba, 0, 0), Rgb(decode_srgb(100), decode_srgb(150), decode_srgb(200)));
  const Image opaque = load_image(write<uint8_t>("o.png", 1, 1, 4, OIIO::TypeDesc::UINT8, {1, 2, 3, 255}));
  EXPECT_TRUE(opaque.alpha.empty());
  const Image deep = load_image(write<uint16_t>("d.png", 1, 1, 3, OIIO::TypeDesc::UINT16, {25700, 0, 65535}));
  EXPECT_NEAR(texel(deep, 0, 0).x, decode_srgb(100), 1e-6f);
  EXPECT_EQ(texel(deep, 0, 0).z, 1);
}

TEST_F(ImageFile, FloatFormatsAreLinear) {
  const std::vector<float> values{0.25f, 2, 1000, 1e-3f, 0.5f, 1};
  for (const char* name : {"f.exr", "f.hdr", "f.tif"}) {
    const Image image = load_image(write(name, 2, 1, 3, OIIO::TypeDesc::FLOAT, values));
    EXPECT_TRUE(image.bytes.empty());
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(texel(image, 0, 0)[c] / values[size_t(c)], 1, std::string(name) == "f.hdr" ? 1 : 1e-6) << name;
    EXPECT_NEAR(texel(image, 0, 0).z, 1000, 10) << name;
  }
  const Image half = load_image(write("h.exr", 2, 1, 3, OIIO::TypeDesc::FLOAT, values, OIIO::TypeDesc::HALF));
  EXPECT_NEAR(texel(half, 0, 0).x, 0.25f, 1e-6f);
}

// Tall ones, in tiles too, and those whose rows do not count from 0.
TEST_F(ImageFile, AreReadInStripsToTheSamePixels) {
  constexpr int w = 5, h = 700;
  std::vector<float> floats;
  std::vector<uint8_t> bytes;
  for (int i = 0; i < 4 * w * h; ++i) floats.push_back(float(i) / 4096), bytes.push_back(uint8_t(i % 255 + i / 5000));
  const auto expect_floats = [&](const std::string& path) {
    const Image image = load_image(path, {.raw = true});
    ASSERT_EQ(image.floats.size(), 3u * w * h) << path;
    for (size_t i = 0; i < w * h; ++i)
      for (size_t c = 0; c < 3; ++c) ASSERT_EQ(image.floats[3 * i + c], floats[4 * i + c]) << path << " " << i;
    for (size_t i = 0; i < w * h; ++i)
      ASSERT_EQ(image.alpha[i], uint8_t(std::min(floats[4 * i + 3], 1.0f) * 255 + 0.5f)) << path;
  };
  for (const char* name : {"tall.exr", "tall.tif"}) expect_floats(write(name, w, h, 4, OIIO::TypeDesc::FLOAT, floats));
  for (const int tile_height : {0, 16, 64}) {
    const std::string path = (folder / fmt::format("placed-{}.exr", tile_height)).string();
    OIIO::ImageSpec spec(w, h, 4, OIIO::TypeDesc::FLOAT);
    spec.x = 3, spec.y = -100;
    if (tile_height > 0) spec.tile_width = 16, spec.tile_height = tile_height;
    const auto out = OIIO::ImageOutput::create(path);
    ASSERT_TRUE(out->open(path, spec) && out->write_image(OIIO::TypeDesc::FLOAT, floats.data()) && out->close());
    expect_floats(path);
  }
  for (const char* name : {"tall.png", "tall-bytes.tif", "tall.tga"}) {
    const Image image = load_image(write(name, w, h, 4, OIIO::TypeDesc::UINT8, bytes));
    ASSERT_EQ(image.bytes.size(), 3u * w * h) << name;
    for (size_t i = 0; i < w * h; ++i) {
      for (size_t c = 0; c < 3; ++c) ASSERT_EQ(image.bytes[3 * i + c], bytes[4 * i + c]) << name << " " << i;
      ASSERT_EQ(image.alpha[i], bytes[4 * i + 3]) << name;
    }
  }
}

// By the file's primaries and white, in the order of OpenEXR; numbers by its matrices.
TEST_F(ImageFile, OtherPrimariesAreConverted) {
  const std::vector<float> values{0.8f, 0.2f, 0.1f, 0.4123908f, 0.2126390f, 0.0193308f};
  const auto of = [&](const std::array<float, 8>& chromaticities, const ImageOptions& options = {}) {
    attributes.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), chromaticities.data());
    return load_image(write("c.exr", 2, 1, 3, OIIO::TypeDesc::FLOAT, values), options);
  };
  const std::array<float, 8> rec709{0.64f, 0.33f, 0.3f, 0.6f, 0.15f, 0.06f, 0.3127f, 0.329f};
  const std::array<float, 8> aces{0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f};
  const std::array<float, 8> xyz{1, 0, 0, 1, 0, 0, 1 / 3.0f, 1 / 3.0f};
  const auto near = [](const Rgb& a, const Rgb& b) { return max_component(glm::abs(a - b)) < 1e-4f; };
  EXPECT_TRUE(near(texel(of(aces), 0, 0), Rgb(1.2562f, 0.1208f, 0.06176f)));
  EXPECT_TRUE(near(texel(of(xyz), 1, 0), Rgb(1, 0, 0)));
  EXPECT_EQ(texel(of(rec709), 0, 0), Rgb(0.8f, 0.2f, 0.1f));
  EXPECT_EQ(texel(of(aces, {.raw = true}), 0, 0), Rgb(0.8f, 0.2f, 0.1f));
  const std::array<float, 8> line{0.1f, 0.1f, 0.2f, 0.2f, 0.3f, 0.3f, 0.3127f, 0.329f};
  for (const std::array<float, 8>& none_at_all :
       {line, std::array<float, 8>{}, {std::nanf(""), 0, 0, 1, 0, 0, 0.3f, 0.3f}})
    EXPECT_THROW(of(none_at_all), Error);
}

// A PNG may say one; Mitsuba listens to it in version 0.x.
TEST_F(ImageFile, GammaOfAPngCountsWhereAskedFor) {
  attributes.attribute("oiio:ColorSpace", "Linear");
  const std::string path = write<uint8_t>("g.png", 1, 1, 3, OIIO::TypeDesc::UINT8, {188, 188, 188});
  EXPECT_EQ(texel(load_image(path), 0, 0), Rgb(decode_srgb(188)));
  EXPECT_EQ(texel(load_image(path, {.png_gamma = true}), 0, 0), Rgb(188 / 255.0f));
  attributes.clear();
  const std::string silent = write<uint8_t>("s.png", 1, 1, 3, OIIO::TypeDesc::UINT8, {188, 188, 188});
  EXPECT_EQ(texel(load_image(silent, {.png_gamma = true}), 0, 0), Rgb(decode_srgb(188)));
}

TEST_F(ImageFile, DamagedFilesAreErrors) {
  EXPECT_THROW(load_image((folder / "missing.png").string()), Error);
  std::ofstream(folder / "text.png") << "no image at all";
  EXPECT_THROW(load_image((folder / "text.png").string()), Error);
  std::ofstream(folder / "empty.exr") << "";
  EXPECT_THROW(load_image((folder / "empty.exr").string()), Error);
  std::vector<uint8_t> noise(64 * 64 * 3);
  for (size_t i = 0; i < noise.size(); ++i) noise[i] = uint8_t(i * i * 31 + i * 7);
  for (const char* name : {"cut.png", "cut.exr", "cut.tif", "cut.tga", "cut.bmp", "cut.jpg", "cut.hdr"}) {
    const std::string path = write(name, 64, 64, 3, OIIO::TypeDesc::UINT8, noise,
                                   std::string(name) == "cut.exr" ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::UINT8);
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
    testing::internal::CaptureStderr();
    EXPECT_THROW(load_image(path), Error) << name;
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << name;
  }
}

// Checksums tell, before libpng writes to standard error.
TEST_F(ImageFile, IconsAreRefused) {
  const std::string path = (folder / "a.ico").string();
  std::ofstream(path, std::ios::binary) << std::string("\0\0\1\0\1\0", 6) + std::string(40, 'x');
  std::string what;
  try {
    load_image(path);
  } catch (const Error& e) {
    what = e.what();
  }
  EXPECT_EQ(what, path + ": icons are not read; convert it to PNG");
}

TEST_F(ImageFile, DamagedPngsAreErrorsOfOneLine) {
  const std::vector<uint8_t> grey(64 * 64 * 3, 77);
  const std::string path = write("a.png", 64, 64, 3, OIIO::TypeDesc::UINT8, grey);
  std::string bytes;
  {
    std::ifstream in(path, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(in), {});
  }
  const size_t data = bytes.find("IDAT");
  ASSERT_NE(data, bytes.npos);
  const auto said = [&](const std::string& content) -> std::string {
    std::ofstream(path, std::ios::binary) << content;
    testing::internal::CaptureStderr();
    std::string what;
    try {
      load_image(path);
    } catch (const Error& e) {
      what = e.what();
    }
    return what + testing::internal::GetCapturedStderr();
  };
  EXPECT_EQ(said(bytes), "");
  std::string flipped = bytes;
  flipped[data + 10] = char(flipped[data + 10] ^ 1);
  EXPECT_EQ(said(flipped), path + ": the image is damaged: a checksum in it is wrong; copy it anew");
  for (const size_t left : {size_t(12), size_t(20), data, data + 10})
    EXPECT_EQ(said(bytes.substr(0, left)), path + ": the image is cut off; copy it anew") << left;
}

// The message says where; or they become 0, and are counted.
TEST_F(ImageFile, NonsenseTexelsAreErrors) {
  for (const float bad : {infinity, -infinity, std::nanf("")}) {
    std::vector<float> values(3 * 4 * 3, 0.5f);
    values[size_t((1 * 4 + 2) * 3 + 1)] = bad;
    const std::string path = write("bad.exr", 4, 3, 3, OIIO::TypeDesc::FLOAT, values);
    try {
      load_image(path);
      ADD_FAILURE() << bad;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("bad.exr: pixel (2, 1)"), std::string::npos) << e.what();
    }
    EXPECT_THROW(load_image(path, {.raw = true}), Error);
    const Image mended = load_image(path, {.mend = true});
    EXPECT_EQ(texel(mended, 2, 1), Rgb(0.5f, 0, 0.5f));
    EXPECT_EQ(mended.not_finite, 1u);
    EXPECT_EQ(mended.negative, 0u);
  }
}

// Resized maps of bright lights have some.
TEST_F(ImageFile, NegativeTexelsBecomeZero) {
  std::vector<float> values(3 * 4 * 3, 0.5f);
  values[size_t((1 * 4 + 2) * 3 + 1)] = -1e-6f;
  const std::string path = write("dark.exr", 4, 3, 3, OIIO::TypeDesc::FLOAT, values);
  const Image image = load_image(path);
  EXPECT_EQ(texel(image, 2, 1), Rgb(0.5f, 0, 0.5f));
  EXPECT_EQ(image.negative, 1u);
  EXPECT_EQ(texel(load_image(path, {.raw = true}), 2, 1).y, -1e-6f) << "raw: a displacement may be negative";
}

// A header that promises more than memory holds.
TEST_F(ImageFile, AbsurdSizesAreErrors) {
  std::ofstream(folder / "huge.hdr") << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 200000 +X 200000\n";
  EXPECT_THROW(load_image((folder / "huge.hdr").string()), Error);
}

}  // namespace
}  // namespace ajar
