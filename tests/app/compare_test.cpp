// ajar compare, as a user calls it.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "ajar/core/error.h"
#include "ajar/film/picture.h"
#include "app/command_line.h"

namespace ajar {
namespace {

struct Compare : testing::Test {
  std::filesystem::path folder;
  std::string a, b, variance, diff;

  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder = std::filesystem::path(testing::TempDir()) /
             ("ajar compare " + std::string(info->name()) + " " + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    a = (folder / "a.exr").string();
    b = (folder / "b.exr").string();
    variance = (folder / "variance.exr").string();
    diff = (folder / "diff.png").string();
    write_exr(a, grey(8, 6, 1.5f));
    write_exr(b, grey(8, 6, 1));
    write_exr(variance, grey(8, 6, 0.01f));
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  static Picture grey(int width, int height, float value) {
    return {width, height, {"R", "G", "B"}, std::vector<float>(size_t(3 * width * height), value)};
  }

  /// Standard output of a run; throws what the command throws.
  static std::string run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "compare");
    testing::internal::CaptureStdout();
    try {
      run_command_line(arguments);
    } catch (...) {
      testing::internal::GetCapturedStdout();
      throw;
    }
    return testing::internal::GetCapturedStdout();
  }

  static std::string error_of(const std::vector<std::string>& arguments) {
    try {
      run(arguments);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }
};

TEST_F(Compare, PrintsOneLine) {
  const std::string line = run({a, b});
  EXPECT_EQ(line.find('\n'), line.size() - 1);
  const auto json = nlohmann::json::parse(line);
  EXPECT_DOUBLE_EQ(json["mean"], 1.5);
  EXPECT_DOUBLE_EQ(json["mse"], 0.25);
  EXPECT_TRUE(json["z_p"].is_null());
}

TEST_F(Compare, VarianceFileAddsTheTest) {
  const auto json = nlohmann::json::parse(run({a, b, "--variance", variance}));
  EXPECT_NEAR(json["z_mean"].get<double>(), 5, 1e-3);
  EXPECT_LT(json["z_p"].get<double>(), 1e-6);
  write_exr(variance, grey(8, 6, -0.01f));
  EXPECT_NE(error_of({a, b, "--variance", variance}).find("variance.exr: channel Variance.R of pixel (0, 0)"),
            std::string::npos);
  write_exr(variance, grey(8, 5, 0.01f));
  EXPECT_NE(error_of({a, b, "--variance", variance}).find("variance.exr: "), std::string::npos);
}

TEST_F(Compare, CropComparesAPart) {
  Picture picture = grey(8, 6, 1);
  picture.pixels[size_t(3 * (2 * 8 + 5))] = std::numeric_limits<float>::quiet_NaN();
  write_exr(a, picture);
  EXPECT_NE(error_of({a, b}).find("a.exr: channel R of pixel (5, 2) is nan"), std::string::npos) << error_of({a, b});
  EXPECT_EQ(nlohmann::json::parse(run({a, b, "--crop", "0", "0", "5", "6"}))["mse"], 0);
  EXPECT_NE(error_of({a, b, "--crop", "0", "0", "9", "6"}).find("a.exr: a crop of 9x6"), std::string::npos);
}

TEST_F(Compare, DiffIsAPicture) {
  run({a, b, "--diff", diff});
  const Picture picture = read_picture(diff);
  EXPECT_EQ(picture.width, 8);
  EXPECT_GT(picture.pixels[0], picture.pixels[2]) << "brighter is red";
}

TEST_F(Compare, DiffOverwritesNothing) {
  const std::string png = (folder / "a.png").string();
  write_png(png, grey(8, 6, 1));
  EXPECT_NE(error_of({a, b, "--diff", (folder / "d.exr").string()}).find("name a file that ends with .png"),
            std::string::npos);
  EXPECT_NE(error_of({png, b, "--diff", (folder / "." / "a.png").string()}).find("is one of the images"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "d.exr"));
}

TEST_F(Compare, ErrorsNameBothSizesOrTheFile) {
  write_exr(b, grey(7, 6, 1));
  const std::string error = error_of({a, b});
  for (const char* part : {"a.exr", "8x6", "b.exr", "7x6", "--crop"})
    EXPECT_NE(error.find(part), std::string::npos) << error;
  EXPECT_NE(error_of({a, b + "x"}).find("b.exrx: there is no such file"), std::string::npos);
  EXPECT_NE(error_of({a, a, "--diff", a + "/d.png"}).find("d.png: cannot be written"), std::string::npos);
  EXPECT_THROW(run({a}), Error);
}

}  // namespace
}  // namespace ajar
