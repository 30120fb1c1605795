// Metrics against numbers worked out by hand, by other programs, and against what they promise.

#include "ajar/report/metrics.h"
#include "ajar/film/film.h"
#include "ajar/report/sequence.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "ajar/core/error.h"
#include "ajar/film/tone.h"
#include "kit/files.h"
#include "pictures.h"

namespace ajar {
namespace {

using kit::error_of, test::constant, test::pattern;

TEST(Metrics, TwoPixelsByHand) {
  const Picture image{2, 1, {"R", "G", "B"}, {0.5f, 1, 0, 2, 0.25f, 1}};
  const Picture reference{2, 1, {"R", "G", "B"}, {0.25f, 1, 0.1f, 1, 0.5f, 0}};
  const Metrics m = compare(image, reference);
  EXPECT_NEAR(m.mean, 4.75 / 6, 1e-7);
  EXPECT_NEAR(m.mean_reference, 2.85 / 6, 1e-7);
  // Squares of the differences 0.25, 0, -0.1, 1, -0.25, 1.
  EXPECT_NEAR(m.mse, (0.0625 + 0 + 0.01 + 1 + 0.0625 + 1) / 6, 1e-7);
  EXPECT_NEAR(m.relmse, (0.0625 / 0.0725 + 0 + 0.01 / 0.02 + 1 / 1.01 + 0.0625 / 0.26 + 1 / 0.01) / 6, 1e-5);
  EXPECT_EQ(m.relmse_trimmed, m.relmse) << "a thousandth of two pixels is none";
  EXPECT_NEAR(m.mape, (0.25 / 0.26 + 0 + 0.1 / 0.11 + 1 / 1.01 + 0.25 / 0.51 + 1 / 0.01) / 6, 1e-5);
  EXPECT_FALSE(m.has_z);
}

// After one pass the variance is 0 everywhere, which is no measure of noise.
TEST(Metrics, ImagesOfOnePassAreNotTestedForNoise) {
  const auto with = [](float value, float variance) {
    return Picture{1,
                   1,
                   {"R", "G", "B", "Variance.R", "Variance.G", "Variance.B"},
                   {value, value, value, variance, variance, variance}};
  };
  EXPECT_FALSE(compare(with(1, 0), with(2, 0)).has_z);
  EXPECT_TRUE(compare(with(1, 0.1f), with(2, 0)).has_z);
  const Picture part{1, 1, {"R", "G", "B", "Variance.R", "Variance.G"}, {1, 1, 1, 0.1f, 0.1f}};
  EXPECT_NE(error_of([&] { compare(with(1, 0), part); }).find("lacks Variance.B of the three channels"),
            std::string::npos);
}

TEST(Metrics, NegativeReferenceCountsByItsMagnitude) {
  const Metrics m = compare(constant(1, 1, Rgb(0.0f)), constant(1, 1, Rgb(-0.01f)));
  EXPECT_NEAR(m.mape, 0.5, 1e-6);
}

TEST(Metrics, TrimmingLeavesOutTheWorstThousandth) {
  const Picture reference = constant(50, 40, Rgb(1.0f));
  Picture image = reference;
  for (float& value : image.pixels) value = 1.1f;
  image.pixels[300] = 100;   // two of 2000 pixels go
  image.pixels[4000] = 200;  // one channel suffices
  image.pixels[5000] = 3;    // this one stays
  const Metrics m = compare(image, reference);
  const double usual = 0.1 * 0.1 / 1.01, third = 4 / 1.01;
  EXPECT_NEAR(m.relmse_trimmed, (1998 * 3 * usual - usual + third) / (1998 * 3), 1e-7);
  EXPECT_GT(m.relmse, 5);
}

TEST(Metrics, PicturesOfTooFewValuesAreErrors) {
  const Picture full{4, 4, {"R", "G", "B"}, std::vector<float>(48, 1.0f)}, lacking{4, 4, {"R", "G", "B"}, {1, 0, 0}};
  EXPECT_NO_THROW(compare(full, full));
  EXPECT_THROW(compare(lacking, full), Error);
  EXPECT_THROW(compare(full, lacking), Error);
  EXPECT_THROW(select(lacking, {"G"}), Error);
  EXPECT_THROW(crop(lacking, 0, 0, 2, 2), Error);
  EXPECT_THROW(develop(Film{}), Error);
}

TEST(Metrics, SamePicture) {
  const Metrics m = compare(pattern(40, 30), pattern(40, 30));
  EXPECT_EQ(m.mse, 0);
  EXPECT_EQ(m.relmse, 0);
  EXPECT_EQ(m.mape, 0);
  EXPECT_NEAR(m.ssim, 1, 1e-12);
  EXPECT_EQ(m.flip, 0);
}

// NumPy 1.24 in double precision on the same picture.
TEST(Metrics, AgreesWithNumPy) {
  const Metrics m = compare(pattern(64, 48, 0.6), pattern(64, 48));
  EXPECT_NEAR(m.mse, 0.010989478761740744, 1e-9);
  EXPECT_NEAR(m.relmse, 0.023250693003222047, 1e-9);
  EXPECT_NEAR(m.relmse_trimmed, 0.023200955569820637, 1e-9);
  EXPECT_NEAR(m.mape, 0.1405971524318695, 1e-8);
}

/// Root mean square that a command prints after "RMS error = "; negative if the program is missing.
double printed_rms(const std::string& command) {
  FILE* pipe = ::popen((command + " 2>/dev/null").c_str(), "r");
  if (!pipe) return -1;
  std::string text;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += char(c);
  ::pclose(pipe);
  const size_t at = text.find("RMS error = ");
  return at == std::string::npos ? -1 : std::strtod(text.c_str() + at + 12, nullptr);
}

TEST(Metrics, MseAgreesWithOpenImageIO) {
  const auto folder = std::filesystem::path(testing::TempDir()) / fmt::format("ajar_mse_{}", ::getpid());
  std::filesystem::create_directories(folder);
  const std::string a = (folder / "a.exr").string(), b = (folder / "b.exr").string();
  const Picture image = pattern(64, 48, 0.6), reference = pattern(64, 48);
  write_exr(a, image);
  write_exr(b, reference);
  const double idiff = printed_rms(fmt::format("idiff '{}' '{}'", a, b));
  const double oiiotool = printed_rms(fmt::format("oiiotool --diff '{}' '{}'", a, b));
  std::filesystem::remove_all(folder);
  if (idiff < 0 && oiiotool < 0) GTEST_SKIP() << "neither idiff nor oiiotool is installed (openimageio-tools)";
  const double rms = std::sqrt(compare(image, reference).mse);
  for (const double printed : {idiff, oiiotool})
    EXPECT_TRUE(printed < 0 || std::abs(rms - printed) < 1e-6 * rms + 1e-6);
}

TEST(Metrics, GreyPicturesAreColourless) {
  const Picture grey{2, 1, {"Y"}, {0.5f, 2}};
  const Metrics m = compare(grey, constant(2, 1, Rgb(1.0f)));
  EXPECT_NEAR(m.mse, (0.25 + 1) / 2, 1e-7);
  EXPECT_NEAR(compare({2, 1, {"A", "Y"}, {1, 0.5f, 1, 2}}, grey).mse, 0, 1e-12);
}

TEST(Metrics, ErrorsNameWhatIsWrong) {
  const Picture good = constant(4, 3, Rgb(1.0f));
  EXPECT_NE(error_of([&] { compare(good, constant(3, 4, Rgb(1.0f))); }).find("4x3 pixels, the reference 3x4"),
            std::string::npos);
  Picture bad = good;
  bad.pixels[3 * 7 + 1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(error_of([&] { require_comparable(bad, "a.exr"); }).find("a.exr: channel G of pixel (3, 1) is nan"), 0u);
  EXPECT_NE(error_of([&] { compare(good, bad); }).find("the reference: channel G of pixel (3, 1)"), std::string::npos);
  bad.pixels[3 * 7 + 1] = -infinity;
  EXPECT_NE(error_of([&] { compare(bad, good); }).find("is -inf"), std::string::npos);
  Picture variance = with_variance(good, good);
  require_comparable(variance, "a.exr");
  variance.pixels[4] = -1;
  EXPECT_NE(error_of([&] { require_comparable(variance, "a.exr"); }).find("channel Variance.G of pixel (0, 0) is -1"),
            std::string::npos);
  EXPECT_NE(error_of([&] {
              require_comparable({1, 1, {"X", "G"}, {1, 1}}, "a.exr");
            }).find("a.exr: channels R, G, B are missing"),
            std::string::npos);
  Picture normals{1, 1, {"R", "G", "B", "N.X"}, {1, 1, 1, infinity}};
  require_comparable(normals, "a.exr");  // a channel that nothing compares may hold anything
}

TEST(Metrics, ExtremesStayFinite) {
  const Metrics m = compare(constant(16, 16, Rgb(3e38f)), constant(16, 16, Rgb(-3e38f)));
  for (const double value : {m.mse, m.relmse, m.mape, m.ssim, m.flip}) EXPECT_TRUE(std::isfinite(value));
  EXPECT_TRUE(std::isfinite(compare(constant(1, 1, Rgb(0.0f)), constant(1, 1, Rgb(1e-38f))).relmse));
}

TEST(Metrics, JsonHasAFixedOrderAndEveryDigit) {
  Metrics m = compare(pattern(16, 16, 0.6), pattern(16, 16));
  const auto plain = nlohmann::ordered_json::parse(to_json(m));
  m.has_z = true;
  m.z = {0.1, 1.25, -4.5, 3, 2, 1e-9, 8, 0, 4, 16, 'B'};
  const auto with_z = nlohmann::ordered_json::parse(to_json(m));
  const std::vector<std::string> keys = {"mean",    "mean_reference", "mse",  "relmse",  "relmse_trimmed",
                                         "mape",    "ssim",           "flip", "z_mean",  "z_variance",
                                         "z_worst", "z_worst_pixel",  "z_p",  "z_region"};
  for (const auto* json : {&plain, &with_z}) {
    std::vector<std::string> found;
    for (const auto& [key, value] : json->items()) found.push_back(key);
    EXPECT_EQ(found, keys);
    EXPECT_EQ((*json)["mse"].get<double>(), m.mse);
  }
  EXPECT_TRUE(plain["z_p"].is_null());
  EXPECT_EQ(with_z["z_p"], 1e-9);
  EXPECT_EQ(with_z["z_worst_pixel"], (std::vector<int>{3, 2}));
  EXPECT_EQ(with_z["z_region"]["channel"], "B");
  EXPECT_EQ(with_z["z_region"]["height"], 16);
  EXPECT_EQ(to_json(m).find('\n'), std::string::npos);
}

TEST(Metrics, DifferencePictureHasTheDocumentedColours) {
  // A quarter brighter: half the tint; black against black: white; half: the root of 0.495 of it, blue; ten times: full
  // red.
  const Picture reference{4, 1, {"R", "G", "B"}, {0.99f, 0.99f, 0.99f, 0, 0, 0, 0.99f, 0.99f, 0.99f, 1, 1, 1}};
  const Picture image{4, 1, {"R", "G", "B"}, {1.24f, 1.24f, 1.24f, 0, 0, 0, 0.495f, 0.495f, 0.495f, 10, 10, 10}};
  const Picture colours = difference_picture(image, reference);
  std::vector<int> bytes;
  for (const float value : colours.pixels) bytes.push_back(int(255 * tone_curve(value) + 0.5));
  const double tint = std::sqrt(0.495);
  const auto blue = [&](int end) { return int(255 + tint * (end - 255) + 0.5); };
  EXPECT_EQ(bytes, (std::vector<int>{217, 140, 149, 255, 255, 255, blue(33), blue(102), blue(172), 178, 24, 43}));
}

// --- Structural similarity ---

TEST(Ssim, ConstantPicturesByHand) {
  // No structure: only the luminance term (2 a b + C1) / (a^2 + b^2 + C1) of the encoded values is left.
  const double a = encode_srgb(0.2f), b = encode_srgb(0.3f), c1 = 1e-4;
  const double expected = (2 * a * b + c1) / (a * a + b * b + c1);
  for (const int size : {1, 2, 8, 11, 30})
    EXPECT_NEAR(ssim(constant(size, size + 3, Rgb(0.2f)), constant(size, size + 3, Rgb(0.3f))), expected, 1e-6) << size;
}

TEST(Ssim, ClippedValuesAreEqual) {
  EXPECT_NEAR(ssim(constant(12, 12, Rgb(1.0f)), constant(12, 12, Rgb(50.0f))), 1, 1e-12);
}

TEST(Ssim, SymmetricAndNegativeForTheNegative) {
  const Picture a = pattern(40, 30, 0.6), b = pattern(40, 30);
  EXPECT_NEAR(ssim(a, b), ssim(b, a), 1e-14);
  Picture checks{32, 32, {"Y"}, {}}, opposite = checks;
  for (int i = 0; i < 32 * 32; ++i) {
    const bool on = (i % 32 + i / 32) % 2 == 0;
    checks.pixels.push_back(on);
    opposite.pixels.push_back(!on);
  }
  EXPECT_LT(ssim(checks, opposite), -0.99);
}

// scikit-image 0.19.3: structural_similarity(gaussian_weights=True, sigma=1.5, use_sample_covariance=False,
// data_range=1).
TEST(Ssim, AgreesWithScikitImage) {
  EXPECT_NEAR(ssim(pattern(64, 48, 0.6), pattern(64, 48)), 0.5049747331178178, 1e-7);
}

/// The definition, window by window, from deviations rather than moments.
double slow_ssim(const Picture& image, const Picture& reference) {
  const auto value = [](const Picture& picture, int x, int y) {
    const float* p = &picture.pixels[size_t(y * picture.width + x) * 3];
    return tone_curve(0.212671 * double(p[0]) + 0.715160 * double(p[1]) + 0.072169 * double(p[2]));
  };
  double total = 0, count = 0;
  for (int y = 5; y + 5 < image.height; ++y)
    for (int x = 5; x + 5 < image.width; ++x) {
      double w_sum = 0, ma = 0, mb = 0, va = 0, vb = 0, cov = 0;
      const auto window = [&](const auto& visit) {
        for (int j = -5; j <= 5; ++j)
          for (int i = -5; i <= 5; ++i)
            visit(std::exp(-(i * i + j * j) / 4.5), value(image, x + i, y + j), value(reference, x + i, y + j));
      };
      window([&](double w, double a, double b) { w_sum += w, ma += w * a, mb += w * b; });
      ma /= w_sum, mb /= w_sum;
      window([&](double w, double a, double b) {
        va += w * (a - ma) * (a - ma), vb += w * (b - mb) * (b - mb), cov += w * (a - ma) * (b - mb);
      });
      total +=
          (2 * ma * mb + 1e-4) * (2 * cov / w_sum + 9e-4) / ((ma * ma + mb * mb + 1e-4) * ((va + vb) / w_sum + 9e-4));
      ++count;
    }
  return total / count;
}

TEST(Ssim, AgreesWithTheDefinition) {
  const Picture a = pattern(37, 29, 0.6), b = pattern(37, 29);
  EXPECT_NEAR(ssim(a, b), slow_ssim(a, b), 1e-12);
}

// Changes that the reference has, too, are no flicker; others count relative to its brightness.
TEST(Flicker, IsOfChangesThatTheReferenceLacks) {
  const auto grey = [](float value) { return Picture{2, 1, {"R", "G", "B"}, std::vector<float>(6, value)}; };
  EXPECT_EQ(flicker(grey(1), grey(3), grey(2), grey(4)), 0);
  EXPECT_NEAR(flicker(grey(1), grey(1.5f), grey(2), grey(2)), 0.25 / 4.01, 1e-9);
  EXPECT_NEAR(flicker(grey(0), grey(0), grey(0), grey(0.1f)), 0.01 / 0.02, 1e-6);
  EXPECT_THROW(flicker(grey(0), grey(0), grey(0), Picture{1, 1, {"R", "G", "B"}, {0, 0, 0}}), Error);
}

TEST(Flicker, FiguresOfAllFrames) {
  std::vector<FrameFigures> frames(3);
  for (int i = 0; i < 3; ++i) frames[size_t(i)].frame = i, frames[size_t(i)].relmse = i + 1;
  frames[1].flicker = 0.5, frames[2].flicker = 1.5;
  frames[2].parameters["sun"] = "1, 2", frames[1].parameters["sun"] = "the \"low\" one";
  EXPECT_EQ(mean_of(frames).relmse, 2);
  EXPECT_EQ(mean_of(frames).flicker, 1);
  const std::string csv = sequence_csv(frames);
  EXPECT_EQ(csv,
            "frame,sun,seconds,cpu_seconds,spp,mean,relmse,relmse_trimmed,flicker\n"
            "0,,0,0,0,0,1,,\n1,\"the \"\"low\"\" one\",0,0,0,0,2,,0.5\n2,\"1, 2\",0,0,0,0,3,,1.5\n");
  const auto j = nlohmann::json::parse(sequence_json(frames));
  EXPECT_TRUE(j["frames"][0]["flicker"].is_null());
  EXPECT_EQ(j["mean"]["flicker"], 1);
  EXPECT_NE(sequence_svg(frames, "a < b").find("a &lt; b"), std::string::npos);
  EXPECT_NE(sequence_svg(frames, "a\xe9\x01 b").find("a\xef\xbf\xbd  b"), std::string::npos) << "XML has no such bytes";
  frames[2].parameters["sun"] = "\xe9";
  EXPECT_NE(sequence_json(frames).find("\xef\xbf\xbd"), std::string::npos);
  frames.resize(1);
  EXPECT_EQ(sequence_svg(frames, "a").find("nan"), std::string::npos);
}

TEST(Flicker, ColumnsOfParametersAreNotThoseOfFigures) {
  FrameFigures f;
  f.parameters = {{"frame", "1"}, {"spp", "4"}, {"sun", "2"}};
  EXPECT_EQ(sequence_csv({f}),
            "frame,parameter_frame,parameter_spp,sun,seconds,cpu_seconds,spp,mean,relmse,relmse_trimmed,flicker\n"
            "0,1,4,2,0,0,0,0,,,\n");
  f.parameters = {{"spp", "4"}, {"parameter_spp", "2"}};
  EXPECT_EQ(sequence_csv({f}).substr(0, 50), "frame,parameter_spp,parameter_parameter_spp,second");
}

}  // namespace
}  // namespace ajar
