// Pictures: files that come back as they went out, whole or not at all.

#include "ajar/film/picture.h"

#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "ajar/core/error.h"
#include "ajar/core/sampler.h"
#include "ajar/film/tone.h"
#include "kit/files.h"

namespace ajar {
namespace {

namespace fs = std::filesystem;
using kit::error_of;

/// An empty folder of its own for each test case, gone afterwards.
struct PictureFile : testing::Test {
  fs::path folder;

  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder = fs::path(testing::TempDir()) / ("ajar_" + std::string(info->name()) + "_" + std::to_string(::getpid()));
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }

  std::string file(const std::string& name) const { return (folder / name).string(); }
  size_t file_count() const { return size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator())); }
};

std::string read_bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_bytes(const std::string& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

/// Numbers over the whole range of float, of both signs.
Picture noise(int width, int height, const std::vector<std::string>& names, double exponents = 30) {
  Picture picture{width, height, names, {}};
  Sampler sampler = make_sampler(SamplerKind::independent, 7, Side::camera, 0, 0);
  for (size_t i = 0; i < size_t(width) * size_t(height) * names.size(); ++i) {
    const Vec2 u = sampler.next2();
    picture.pixels.push_back(float((u.x - 0.5) * std::pow(10.0, (u.y - 0.5) * 2 * exponents)));
  }
  return picture;
}

TEST_F(PictureFile, FloatExrComesBackExactly) {
  const Picture out = noise(37, 23, {"R", "G", "B", "Albedo.R", "N.X", "P.Z", "Variance.G"});
  write_exr(file("a.exr"), out);
  const Picture in = read_picture(file("a.exr"));
  EXPECT_EQ(in.width, 37);
  EXPECT_EQ(in.height, 23);
  EXPECT_EQ(std::set<std::string>(in.names.begin(), in.names.end()),
            std::set<std::string>(out.names.begin(), out.names.end()));
  EXPECT_EQ(select(in, out.names).pixels, out.pixels);
  EXPECT_EQ(in.names[0] + in.names[1] + in.names[2], "RGB");
}

TEST_F(PictureFile, ChannelsNamedLikeAlphaAndDepthStayApart) {
  const Picture out = noise(5, 4, {"Z", "A", "B", "G", "R"});
  write_exr(file("a.exr"), out);
  EXPECT_EQ(select(read_picture(file("a.exr")), out.names).pixels, out.pixels);
}

TEST_F(PictureFile, HalfRoundsToElevenBits) {
  const Picture out = noise(64, 64, {"R", "G", "B"}, 3);
  write_exr(file("a.exr"), out, {}, PixelType::half);
  const Picture in = select(read_picture(file("a.exr")), out.names);
  size_t changed = 0;
  for (size_t i = 0; i < out.pixels.size(); ++i) {
    EXPECT_LE(std::abs(in.pixels[i] - out.pixels[i]), std::max(std::abs(out.pixels[i]) * 0x1p-11f, 0x1p-25f));
    changed += in.pixels[i] != out.pixels[i];
  }
  EXPECT_GT(changed, out.pixels.size() / 2) << "nothing was rounded: is the file float?";
}

TEST_F(PictureFile, HalfNeverOverflows) {
  Picture out = noise(8, 8, {"R", "G", "B"}, 1);
  out.pixels[3 * 5 + 1] = 1e8f;
  write_exr(file("a.exr"), out, {}, PixelType::half);
  const Picture in = select(read_picture(file("a.exr")), out.names);
  EXPECT_EQ(in.pixels[3 * 5 + 1], 1e8f);
  for (size_t i = 0; i < 64; ++i) EXPECT_EQ(in.pixels[3 * i + 1], out.pixels[3 * i + 1]) << "green is float";
  const auto spec = OIIO::ImageInput::open(file("a.exr"))->spec();
  EXPECT_EQ(spec.channelformat(0), OIIO::TypeDesc::HALF);
  EXPECT_EQ(spec.channelformat(1), OIIO::TypeDesc::FLOAT);
}

TEST_F(PictureFile, HalfKeepsWhatIsDim) {
  const std::vector<std::string> names = {"R", "G", "B", "Variance.R", "P.X", "N.X"};
  Picture out = noise(8, 8, names, 1);
  const auto channel = [&](size_t c, float factor) {
    for (size_t i = c; i < out.pixels.size(); i += names.size()) out.pixels[i] *= factor;
  };
  channel(1, 1e-9f), channel(5, 0);
  write_exr(file("a.exr"), out, {}, PixelType::half);
  const Picture in = select(read_picture(file("a.exr")), names);
  for (const size_t c : {1, 3, 4})
    for (size_t i = c; i < out.pixels.size(); i += names.size()) EXPECT_EQ(in.pixels[i], out.pixels[i]) << names[c];
  const auto spec = OIIO::ImageInput::open(file("a.exr"))->spec();
  for (const char* half : {"R", "B", "N.X"})
    EXPECT_EQ(spec.channelformat(spec.channelindex(half)), OIIO::TypeDesc::HALF) << half;
}

TEST_F(PictureFile, NanAndInfinitySurvive) {
  Picture out = noise(4, 1, {"R", "G", "B"}, 1);
  out.pixels[1] = std::numeric_limits<float>::quiet_NaN();
  out.pixels[5] = -infinity;
  for (const PixelType type : {PixelType::float32, PixelType::half}) {
    write_exr(file("a.exr"), out, {}, type);
    const Picture in = read_picture(file("a.exr"));
    EXPECT_TRUE(std::isnan(in.pixels[1]));
    EXPECT_EQ(in.pixels[5], -infinity);
  }
}

TEST_F(PictureFile, MetadataComesBack) {
  const Metadata out = {{"ajar:version", "0.1.0"},
                        {"ajar:seed", 4294967297.0},
                        {"ajar:seconds", 0.1},
                        {"ajar:options", "a \"b\"\n{c}"},
                        {"ajar:huge", 1e300}};
  write_exr(file("a.exr"), noise(2, 2, {"R", "G", "B"}), out);
  const Metadata in = read_metadata(file("a.exr"));
  for (const auto& [name, value] : out) {
    ASSERT_TRUE(in.contains(name)) << name;
    EXPECT_EQ(in.at(name), value) << name;
  }
}

TEST_F(PictureFile, SameBytesTwice) {
  const Picture picture = noise(100, 70, {"R", "G", "B"});
  for (const char* name : {"a.exr", "b.exr"}) write_exr(file(name), picture, {{"ajar:seed", 1.0}});
  EXPECT_EQ(read_bytes(file("a.exr")), read_bytes(file("b.exr")));
  const Metadata metadata = read_metadata(file("a.exr"));
  EXPECT_TRUE(!metadata.contains("DateTime") || metadata.at("DateTime") == Metadata::mapped_type(""))
      << "the clock would make every file differ";
  EXPECT_EQ(OIIO::ImageInput::open(file("a.exr"))->spec().get_string_attribute("compression"), "zip");
}

TEST_F(PictureFile, ThreadsAreLimitedForAWhile) {
  const auto counts = [] {
    std::array<int, 2> found{};
    OIIO::getattribute("threads", found[0]), OIIO::getattribute("exr_threads", found[1]);
    return found;
  };
  const std::array<int, 2> before = counts(), three = {3, 3};
  {
    const PictureThreads threads(3), as_they_are(0);
    EXPECT_EQ(counts(), three);
  }
  EXPECT_EQ(counts(), before);
}

TEST_F(PictureFile, ExistingFileIsReplacedAndLinksAreFollowed) {
  write_text(file("a.txt"), "old");
  fs::create_symlink(file("a.txt"), file("link.txt"));
  write_text(file("link.txt"), "new");
  EXPECT_EQ(read_bytes(file("a.txt")), "new");
  EXPECT_TRUE(fs::is_symlink(file("link.txt")));
  write_exr(file("a.txt"), noise(2, 2, {"R"}));  // the name does not choose the format
  EXPECT_EQ(read_picture(file("a.txt")).width, 2);
  EXPECT_EQ(file_count(), 2u);
}

TEST_F(PictureFile, WritesThatFailSayWhyAndLeaveNothing) {
  const Picture picture = noise(4, 4, {"R", "G", "B"});
  write_text(file("file"), "x");
  const auto exr = [&](const std::string& path) { return error_of([&] { write_exr(path, picture); }); };
  EXPECT_NE(exr(file("file/a.exr")).find("file/a.exr: cannot be written"), std::string::npos);
  EXPECT_NE(exr(folder.string()).find("name a file"), std::string::npos);
  EXPECT_NE(exr(file(std::string(300, 'a'))).find("shorter name"), std::string::npos);
  EXPECT_NE(exr("").find("empty"), std::string::npos);
  EXPECT_EQ(file_count(), 1u);
  if (::geteuid() == 0) return;  // root may write anywhere
  fs::permissions(folder, fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_NE(exr(file("a.exr")).find("may write to"), std::string::npos);
  fs::permissions(folder, fs::perms::owner_all);
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(PictureFile, WhatMayNotBeReadIsToldAsSuch) {
  write_exr(file("a.exr"), noise(4, 4, {"R", "G", "B"}));
  fs::permissions(file("a.exr"), fs::perms::none);
  fs::permissions(folder, fs::perms::all);
  const uid_t user = ::geteuid(), nobody = 65534;
  ASSERT_EQ(::seteuid(user == 0 ? nobody : user), 0);  // root may read anything
  const std::string error = error_of([&] { read_picture(file("a.exr")); });
  ASSERT_EQ(::seteuid(user), 0);
  EXPECT_NE(error.find("a.exr: may not be read; check its permissions"), std::string::npos) << error;
}

TEST_F(PictureFile, FullDiskLeavesTheOldFile) {
  write_text(file("a.exr"), "old");
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{20000, old.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string error = error_of([&] { write_exr(file("a.exr"), noise(100, 100, {"R", "G", "B"})); });
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(error.find("free some space"), std::string::npos) << error;
  EXPECT_EQ(read_bytes(file("a.exr")), "old");
  EXPECT_EQ(file_count(), 1u);
}

// A pipe stands for every name that is no regular file: a device that is renamed over is gone for the whole machine.
TEST_F(PictureFile, PipesAreWrittenToNotReplaced) {
  const std::string pipe = file("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  write_text(pipe, "text");
  char bytes[8] = {};
  EXPECT_EQ(::read(reader, bytes, sizeof bytes), 4);
  EXPECT_STREQ(bytes, "text");
  ::close(reader);
  EXPECT_TRUE(fs::is_fifo(pipe));
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(PictureFile, UnsoundPicturesAreErrors) {
  Picture picture = noise(4, 4, {"R", "G", "B"});
  picture.pixels.pop_back();
  EXPECT_NE(error_of([&] { write_exr(file("a.exr"), picture); }), "");
  EXPECT_NE(error_of([&] { write_png(file("a.png"), picture); }), "");
  EXPECT_NE(error_of([&] { write_exr(file("a.exr"), Picture{}); }), "");
  EXPECT_NE(error_of([&] { write_exr(file("a.exr"), noise(4, 4, {"R", "R"})); }).find("twice"), std::string::npos);
  EXPECT_EQ(file_count(), 0u);
}

TEST_F(PictureFile, DamagedFilesAreErrors) {
  write_exr(file("a.exr"), noise(100, 100, {"R", "G", "B"}));
  const std::string bytes = read_bytes(file("a.exr"));
  for (const size_t size : {size_t(0), size_t(3), size_t(200), size_t(1000), bytes.size() / 2, bytes.size() - 1}) {
    write_bytes(file("b.exr"), bytes.substr(0, size));
    const std::string error = error_of([&] { read_picture(file("b.exr")); });
    EXPECT_NE(error.find("b.exr: "), std::string::npos) << size << ": " << error;
    EXPECT_EQ(error.find('\n'), std::string::npos);
  }
  std::vector<uint8_t> colours(3 * 64 * 64);
  for (size_t i = 0; i < colours.size(); ++i) colours[i] = uint8_t(i * 37 % 251);
  for (const char* name : {"d.tif", "d.jpg"}) {  // their readers give pixels, and leave an error
    auto output = OIIO::ImageOutput::create(file(name));
    ASSERT_TRUE(output->open(file(name), OIIO::ImageSpec(64, 64, 3, OIIO::TypeDesc::UINT8)) &&
                output->write_image(OIIO::TypeDesc::UINT8, colours.data()) && output->close());
    const std::string all = read_bytes(file(name));
    EXPECT_EQ(error_of([&] { read_picture(file(name)); }), "");
    write_bytes(file(name), all.substr(0, all.size() * 6 / 10));
    EXPECT_NE(error_of([&] { read_picture(file(name)); }).find(name), std::string::npos);
  }
  write_bytes(file("c.png"), "no image");
  EXPECT_NE(error_of([&] { read_picture(file("c.png")); }).find("c.png: cannot be read"), std::string::npos);
  EXPECT_NE(error_of([&] { read_picture(file("none.exr")); }).find("no such file"), std::string::npos);
  EXPECT_NE(error_of([&] { read_picture(folder.string()); }).find("folder"), std::string::npos);
  EXPECT_NE(error_of([&] { read_metadata(file("none.exr")); }).find("no such file"), std::string::npos);
}

TEST_F(PictureFile, PngHoldsTheToneCurve) {
  // By hand: 0.5 -> 1.055 * 0.5^(1/2.4) - 0.055 = 0.735357 -> 187.5 -> 188; 0.002 -> 0.02584 -> 6.6 -> 7; 0.18 -> 117.6
  // -> 118.
  const Picture out{
      4, 1, {"R", "G", "B"}, {0, 1, 2, 0.5f, 0.002f, 0.18f, -1, 1e30f, infinity, 0.25f, 0.75f, 0.0031308f}};
  write_png(file("a.png"), out);
  auto input = OIIO::ImageInput::open(file("a.png"));
  ASSERT_TRUE(input);
  ASSERT_EQ(input->spec().format, OIIO::TypeDesc::UINT8);
  std::vector<uint8_t> bytes(12);
  ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, bytes.data()));
  EXPECT_EQ(bytes, (std::vector<uint8_t>{0, 255, 255, 188, 7, 118, 0, 255, 255, 137, 225, 10}));

  write_png(file("b.png"), Picture{1, 1, {"R", "G", "B"}, {0.25f, 0.09f, 0.001f}}, 1);  // a stop more: twice the value
  input = OIIO::ImageInput::open(file("b.png"));
  ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, bytes.data()));
  EXPECT_EQ(bytes[0], 188);
  EXPECT_EQ(bytes[1], 118);
  EXPECT_EQ(bytes[2], 7);
}

TEST_F(PictureFile, PngComesBackWithinItsStep) {
  Picture out{256, 1, {"R", "G", "B"}, {}};
  for (int i = 0; i < 256; ++i)
    for (const double shift : {-0.4, 0.0, 0.4})
      out.pixels.push_back(float(decode_srgb(std::clamp((i + shift) / 255, 0.0, 1.0))));
  write_png(file("a.png"), out);
  const Picture in = read_picture(file("a.png"));
  EXPECT_EQ(in.names, out.names);
  for (size_t i = 0; i < 256; ++i)
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(in.pixels[3 * i + c], decode_srgb(double(i) / 255), 1e-6) << i;
}

TEST_F(PictureFile, PngsNeedAFiniteExposure) {
  const Picture white{1, 1, {"R", "G", "B"}, {1, 0, infinity}};
  for (const float bad : {std::nanf(""), infinity, -infinity, 1e4f})
    EXPECT_THROW(write_png(file("e.png"), white, bad), Error) << bad;
  EXPECT_EQ(file_count(), 0u);
  EXPECT_NO_THROW(write_png(file("e.png"), white, 100));
}

TEST_F(PictureFile, GreyPngAndNan) {
  write_png(file("a.png"), Picture{2, 1, {"Y", "Z"}, {1, 0, 0.5f, 0}});
  const Picture in = read_picture(file("a.png"));
  ASSERT_EQ(in.channels(), 1);
  EXPECT_EQ(in.pixels[0], 1);
  EXPECT_NEAR(in.pixels[1], 0.5, 0.003);
  const Picture bad{2, 1, {"R", "G", "B"}, {0, 0, 0, 0, std::numeric_limits<float>::quiet_NaN(), 0}};
  const std::string error = error_of([&] { write_png(file("b.png"), bad); });
  EXPECT_NE(error.find("pixel (1, 0) of channel G"), std::string::npos) << error;
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(PictureFile, SixteenBitsAreDecodedAlphaIsNot) {
  OIIO::ImageSpec spec(1, 1, 4, OIIO::TypeDesc::UINT16);
  const uint16_t pixel[4] = {65535, 32768, 0, 32768};
  auto output = OIIO::ImageOutput::create("png");
  spec.attribute("oiio:UnassociatedAlpha", 1);
  ASSERT_TRUE(output->open(file("a.png"), spec) && output->write_image(OIIO::TypeDesc::UINT16, pixel) &&
              output->close());
  const Picture in = read_picture(file("a.png"));
  ASSERT_EQ(in.channels(), 4);
  EXPECT_NEAR(in.pixels[0], 1, 1e-6);
  EXPECT_NEAR(in.pixels[1], decode_srgb(32768.0 / 65535), 1e-6);
  EXPECT_NEAR(in.pixels[3], 32768.0 / 65535, 1e-6);
}

TEST_F(PictureFile, BytesThatSayTheyAreLinearAre) {
  OIIO::ImageSpec spec(1, 1, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "Linear");
  spec.attribute("oiio:Gamma", 1.0f);
  const uint8_t pixel[3] = {188, 0, 255};
  auto output = OIIO::ImageOutput::create("png");
  ASSERT_TRUE(output->open(file("a.png"), spec) && output->write_image(OIIO::TypeDesc::UINT8, pixel) &&
              output->close());
  EXPECT_NEAR(read_picture(file("a.png")).pixels[0], 188.0 / 255, 1e-6);
}

TEST_F(PictureFile, GreyOnesHaveThreeEqualChannels) {
  write_exr(file("a.exr"), Picture{1, 1, {"Y"}, {0.25f}});
  EXPECT_EQ(read_rgb(file("a.exr")).pixels, (std::vector<float>{0.25f, 0.25f, 0.25f}));
  write_exr(file("b.exr"), Picture{1, 1, {"X", "Y", "Z"}, {1, 2, 3}});
  EXPECT_NE(error_of([&] { read_rgb(file("b.exr")); }).find("b.exr: channels R, G, B are missing"), std::string::npos);
}

/// 4x3 data window at (x, y) in a display window of 8x6 whose corner is (10, 20); values count 1, 2, 3 ...
void write_window(const std::string& path, int x, int y) {
  OIIO::ImageSpec spec(4, 3, 1, OIIO::TypeDesc::FLOAT);
  spec.x = x, spec.y = y;
  spec.full_x = 10, spec.full_y = 20, spec.full_width = 8, spec.full_height = 6;
  std::vector<float> pixels(12);
  for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = float(i + 1);
  auto output = OIIO::ImageOutput::create(path);
  ASSERT_TRUE(output->open(path, spec) && output->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) && output->close());
}

TEST_F(PictureFile, DataWindowIsPlacedInTheDisplayWindow) {
  write_window(file("a.exr"), 12, 21);
  const Picture inside = read_picture(file("a.exr"));
  ASSERT_EQ(inside.width, 8);
  ASSERT_EQ(inside.height, 6);
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 8; ++x) {
      const bool covered = x >= 2 && x < 6 && y >= 1 && y < 4;
      EXPECT_EQ(inside.pixels[size_t(y * 8 + x)], covered ? float((y - 1) * 4 + x - 2 + 1) : 0.0f) << x << ' ' << y;
    }
  write_window(file("b.exr"), 8, 24);  // reaches out on the left and below
  const Picture across = read_picture(file("b.exr"));
  EXPECT_EQ(across.pixels[4 * 8 + 0], 3);
  EXPECT_EQ(across.pixels[4 * 8 + 1], 4);
  EXPECT_EQ(across.pixels[5 * 8 + 1], 8);
  EXPECT_EQ(across.pixels[5 * 8 + 2], 0);
  write_window(file("d.exr"), 16, 19);  // and on the right and above
  const Picture corner = read_picture(file("d.exr"));
  EXPECT_EQ(corner.pixels[6], 5);
  EXPECT_EQ(corner.pixels[7], 6);
  EXPECT_EQ(corner.pixels[8 + 7], 10);
  EXPECT_EQ(corner.pixels[2 * 8 + 7], 0);
  write_window(file("c.exr"), 100, 24);
  EXPECT_NE(error_of([&] { read_picture(file("c.exr")); }), "");
}

TEST(Picture, SelectAndCrop) {
  const Picture picture{3, 2, {"R", "G"}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}};
  EXPECT_EQ(select(picture, {"G", "R"}).pixels, (std::vector<float>{1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10}));
  EXPECT_NE(error_of([&] { select(picture, {"B"}); }).find("channel B is missing (the picture has R, G)"),
            std::string::npos);
  EXPECT_EQ(crop(picture, 1, 0, 2, 2).pixels, (std::vector<float>{2, 3, 4, 5, 8, 9, 10, 11}));
  EXPECT_EQ(crop(picture, 0, 1, 1, 1).pixels, (std::vector<float>{6, 7}));
  for (const auto& c : {std::array{2, 0, 2, 1}, {-1, 0, 1, 1}, {0, 0, 0, 1}, {0, 2, 1, 1}, {1, 0, 2147483647, 1}})
    EXPECT_NE(error_of([&] { crop(picture, c[0], c[1], c[2], c[3]); }), "");
}

TEST(Tone, CurveAndInverse) {
  EXPECT_EQ(tone_curve(0), 0);
  EXPECT_EQ(tone_curve(-1), 0);
  EXPECT_NEAR(tone_curve(1), 1, 1e-12);
  EXPECT_NEAR(tone_curve(3), 1, 1e-12);
  EXPECT_NEAR(tone_curve(0.5), 0.735356983, 1e-8);
  EXPECT_NEAR(tone_curve(0.125, 2), 0.735356983, 1e-8);
  for (double x = 0; x <= 1; x += 1.0 / 1024) EXPECT_NEAR(decode_srgb(encode_srgb(x)), x, 1e-6);
}

}  // namespace
}  // namespace ajar
