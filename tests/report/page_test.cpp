// The page of a bench: one file, sound whatever the names are, and every pixel as it was.

#include "ajar/report/page.h"

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <Imath/half.h>

#include <fstream>
#include <regex>

#include "ajar/core/error.h"
#include "kit/files.h"
#include "pictures.h"
#include "report/pack.h"
#include "synthetic.h"

namespace ajar {
namespace {

using nlohmann::json;

/// What stands between the first such opening and the next closing.
std::string between(const std::string& text, const std::string& open, const std::string& close) {
  const size_t from = text.find(open);
  if (from == std::string::npos) return "nothing after " + open;
  return text.substr(from + open.size(), text.find(close, from) - from - open.size());
}

std::vector<unsigned char> decode_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes;
  uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | uint32_t(digits.find(c));
    if ((count += 6) >= 8) bytes.push_back(static_cast<unsigned char>(bits >> (count -= 8) & 255));
  }
  return bytes;
}

/// As the page's script does it (src/report/page/image.js), written again from pack.h.
std::vector<float> unpack(const std::string& text, int exponent, size_t count) {
  const auto packed = decode_base64(text);
  std::vector<unsigned char> bytes(6 * count);
  uLongf size = uLongf(bytes.size());
  EXPECT_EQ(uncompress(bytes.data(), &size, packed.data(), uLong(packed.size())), Z_OK);
  EXPECT_EQ(size, bytes.size());
  for (size_t i = 1; i < bytes.size(); ++i) bytes[i] = static_cast<unsigned char>(bytes[i] + bytes[i - 1]);
  std::vector<float> pixels(3 * count);
  for (size_t i = 0; i < count; ++i) {
    const auto plane = [&](size_t p) {
      return uint16_t(bytes[2 * p * count + i] << 8 | bytes[(2 * p + 1) * count + i]);
    };
    const uint16_t green = plane(0), bits[3] = {uint16_t(green + plane(1)), green, uint16_t(green + plane(2))};
    for (size_t c = 0; c < 3; ++c) {
      half h;
      h.setBits(bits[c]);
      pixels[3 * i + c] = std::ldexp(float(h), -exponent);
    }
  }
  return pixels;
}

struct Page : testing::Test {
  std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("ajar page " + std::to_string(::getpid()));
  json results = test::make_synthetic(folder);

  void TearDown() override { std::filesystem::remove_all(folder); }

  std::string page() const {
    write_report(results, folder);
    return kit::bytes_of(folder / "report.html");
  }
  std::string error() const {
    try {
      write_report(results, folder);
    } catch (const Error& e) {
      return e.what();
    }
    return {};
  }
};

TEST_F(Page, NeedsNoOtherFileAndNoNetwork) {
  const std::string html = page();
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos) << "the browser itself must refuse what is outside";
  const std::regex outside("(src|href|action|poster|@import|url)\\s*[=(]\\s*[\"']?\\s*(https?:|file:|//|\\.|/)");
  EXPECT_FALSE(std::regex_search(html, outside));
  EXPECT_EQ(std::regex_search(std::regex_replace(html, std::regex("http://www\\.w3\\.org/2000/svg"), ""),
                              std::regex("https?://")),
            false)
      << "but for the name of SVG no address is in the page";
  EXPECT_EQ(html.find("<link"), std::string::npos);
  EXPECT_TRUE(html.ends_with("</html>\n"));
}

TEST_F(Page, HoldsTheResultsAndAnIndexOfImages) {
  const std::string html = page();
  EXPECT_EQ(json::parse(between(html, "id=\"results\">", "</script>")), results);
  const json files = json::parse(between(html, "id=\"files\">", "</script>"));
  EXPECT_EQ(files["images/room/reference.exr"]["width"], test::synthetic_width);
  EXPECT_EQ(files["images/room/reference.exr"]["height"], test::synthetic_height);
  EXPECT_EQ(files["fields/q.png"]["png"], true);
  EXPECT_EQ(files.size(), 4 + 1 + 20 + 1 + 1u) << "methods, reference, strategies, a field, the other scene";
  for (const json& file : files)
    EXPECT_GT(between(html, "id=\"" + file["id"].get<std::string>() + "\">", "</script>").size(), 40u);
}

TEST_F(Page, CurvesAreOfTheseResults) {
  page();
  EXPECT_TRUE(std::filesystem::exists(folder / "curves.svg"));
  for (json& scene : results["scenes"])
    for (json& method : scene["methods"]) method["runs"] = json::array();
  page();
  EXPECT_FALSE(std::filesystem::exists(folder / "curves.svg")) << "of results that had some";
}

TEST_F(Page, NamesCannotBreakOut) {
  const std::string html = page();
  EXPECT_NE(html.find("<title>Doors &lt;/title>&lt;b>&amp; \"more\"</title>"), std::string::npos);
  EXPECT_EQ(html.find("window.broken = 1</script>"), std::string::npos);
  results["title"] = "{{script}} <!-- {{";
  results["scenes"][0]["name"] = "{{results}}<!--<script>";
  const std::string odd = page();
  EXPECT_NE(odd.find("<title>{{script}} &lt;!-- {{</title>"), std::string::npos)
      << "what is put in is not filled in again";
  EXPECT_EQ(json::parse(between(odd, "id=\"results\">", "</script>")), results);
  results["title"] = "bad UTF-8 \xff";
  EXPECT_NE(page().find("id=\"results\">{"), std::string::npos);
}

TEST_F(Page, PixelsAreHalvesOfTheImage) {
  const std::string html = page();
  const json file = json::parse(between(html, "id=\"files\">", "</script>"))["images/room/path.exr"];
  const Picture image = read_picture((folder / "images/room/path.exr").string());
  const auto pixels = unpack(between(html, "id=\"" + file["id"].get<std::string>() + "\">", "</script>"),
                             file["exponent"], image.pixels.size() / 3);
  for (size_t i = 0; i < image.pixels.size(); ++i) ASSERT_EQ(pixels[i], float(half(image.pixels[i]))) << i;
}

TEST(Pack, KeepsWhatAHalfCannotHold) {
  const float inf = std::numeric_limits<float>::infinity();
  const Picture picture{2, 2, {"R", "G", "B"}, {1e6f, 1, 0, -1e6f, 3e-3f, 65504, inf, -inf, NAN, 0.5f, 0.25f, 2}};
  const Packed packed = pack(picture);
  EXPECT_EQ(packed.exponent, -4);
  const auto pixels = unpack(packed.text, packed.exponent, 4);
  for (size_t i = 0; i < pixels.size(); ++i) {
    if (std::isnan(picture.pixels[i]))
      EXPECT_TRUE(std::isnan(pixels[i]));
    else if (std::isinf(picture.pixels[i]))
      EXPECT_EQ(pixels[i], picture.pixels[i]);
    else
      EXPECT_NEAR(pixels[i], picture.pixels[i], std::abs(picture.pixels[i]) / 1024 + 1e-6) << i;
  }
}

TEST(Pack, Base64OfTheStandard) {  // RFC 4648, section 10
  const auto of = [](const std::string& s) {
    return base64({reinterpret_cast<const unsigned char*>(s.data()), s.size()});
  };
  EXPECT_EQ(of(""), "");
  EXPECT_EQ(of("f"), "Zg==");
  EXPECT_EQ(of("fo"), "Zm8=");
  EXPECT_EQ(of("foo"), "Zm9v");
  EXPECT_EQ(of("foobar"), "Zm9vYmFy");
}

TEST(Pack, ReducedKeepsTheMeanAndTheEdge) {
  Picture picture = test::pattern(321, 7);
  const Picture small = reduced(picture, 160);
  EXPECT_EQ(small.width, 107);
  EXPECT_EQ(small.height, 3);
  double sum = 0;
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) sum += double(picture.pixels[size_t(3 * (y * 321 + x))]);
  EXPECT_NEAR(small.pixels[0], sum / 9, 1e-6);
  sum = 0;  // the last square is 3 x 1
  for (int x = 318; x < 321; ++x) sum += double(picture.pixels[size_t(3 * (6 * 321 + x) + 2)]);
  EXPECT_NEAR(small.pixels[3 * (2 * 107 + 106) + 2], sum / 3, 1e-6);
  EXPECT_EQ(reduced(picture, 321).pixels, picture.pixels);
}

TEST_F(Page, LargeStrategyImagesAreReduced) {
  write_exr((folder / "techniques/room/bdpt/s0t2.exr").string(), test::pattern(640, 360));
  const json files = json::parse(between(page(), "id=\"files\">", "</script>"));
  EXPECT_EQ(files["techniques/room/bdpt/s0t2.exr"]["width"], 160);
  EXPECT_EQ(files["techniques/room/bdpt/s0t2.exr"]["height"], 90);
}

TEST_F(Page, MissingImageIsNamedAndNothingIsWritten) {
  std::filesystem::remove(folder / "images/room/path.exr");
  const std::string what = error();
  for (const char* part : {"images/room/path.exr: there is no such file", "scenes[0].methods[1].image", "results.json",
                           "; run the bench again"})
    EXPECT_NE(what.find(part), std::string::npos) << what;
  EXPECT_FALSE(std::filesystem::exists(folder / "report.html"));
  write_text((folder / "images/room/path.exr").string(), "no image");
  EXPECT_NE(error().find("images/room/path.exr: cannot be read as an image"), std::string::npos) << error();
}

TEST_F(Page, WrongImagesAreNamed) {
  write_exr((folder / "images/room/path.exr").string(), test::pattern(8, 9));
  EXPECT_NE(error().find("images/room/path.exr: has 8x9 pixels, its reference images/room/reference.exr has 96x54"),
            std::string::npos)
      << error();
  results["scenes"][0]["methods"][1]["image"] = nullptr;
  write_text((folder / "fields/q.png").string(), "no image");
  EXPECT_NE(error().find("fields/q.png: is no PNG"), std::string::npos) << error();
}

TEST_F(Page, WrongResultsAreNamed) {
  results["format"] = 2;
  EXPECT_NE(error().find("results.json: format is 2, this version reads 1"), std::string::npos) << error();
  results["format"] = 1;
  results["scenes"][0]["methods"][0]["image"] = 7;
  EXPECT_NE(error().find("results.json: is not what a bench writes"), std::string::npos) << error();
  results.erase("scenes");
  EXPECT_NE(error().find("results.json: is not what a bench writes"), std::string::npos) << error();
}

TEST_F(Page, ResultsAreReadFromTheFolder) {
  write_text((folder / "results.json").string(), results.dump());
  EXPECT_EQ(read_results(folder), results);
  for (const char* damaged : {"{", ""}) {
    write_text((folder / "results.json").string(), damaged);
    const std::string error = kit::error_of([&] { read_results(folder); });
    EXPECT_EQ(error.find("permissions"), std::string::npos) << error;
    EXPECT_NE(error.find("results.json"), std::string::npos) << error;
  }
  std::filesystem::remove(folder / "results.json");
  EXPECT_THROW(read_results(folder), Error);
}

}  // namespace
}  // namespace ajar
