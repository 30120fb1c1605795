// The page in a browser without a window: scripts drive it as readers do (drive.js).

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <fstream>
#include <sstream>

#include "ajar/film/tone.h"
#include "ajar/report/metrics.h"
#include "ajar/report/page.h"
#include "kit/files.h"
#include "synthetic.h"

namespace ajar {
namespace {

using nlohmann::json;

/// Bytes as a PNG would hold them.
json bytes_at(const Picture& picture, int x, int y, double exposure) {
  json bytes = json::array();
  for (int c = 0; c < 3; ++c)
    bytes.push_back(
        int(255 * tone_curve(double(picture.pixels[size_t(3 * (y * picture.width + x) + c)]), exposure) + 0.5));
  return bytes;
}

/// What the script compares with; figures that Ajar's own functions give.
json expectations(const json& results, const std::filesystem::path& folder) {
  const Picture reference = read_picture((folder / "images/room/reference.exr").string());
  const Picture path = read_picture((folder / "images/room/path.exr").string());
  const Picture difference = difference_picture(path, reference);
  json pixels = json::array();
  for (const auto& [x, y] : {std::pair(37, 22), std::pair(3, 50), std::pair(90, 5), std::pair(52, 33)}) {
    json values = json::array();
    for (int c = 0; c < 3; ++c) values.push_back(reference.pixels[size_t(3 * (y * reference.width + x) + c)]);
    pixels.push_back({{"x", x},
                      {"y", y},
                      {"reference", bytes_at(reference, x, y, 0)},
                      {"darker", bytes_at(reference, x, y, -1.5)},
                      {"path", bytes_at(path, x, y, 0)},
                      {"difference", bytes_at(difference, x, y, 0)},
                      {"values", values}});
  }
  size_t estimates = 0;
  for (const json& method : results["scenes"][0]["methods"])
    for (const json& run : method["runs"])
      for (const json& sample : run["samples"]) estimates += !sample["estimated_relmse"].is_null();
  const double ratio = results["scenes"][0]["methods"][2]["summary"]["relmse"]["error_ratio"]["value"];
  return {{"width", test::synthetic_width},
          {"height", test::synthetic_height},
          {"pixels", pixels},
          {"relmse", compare(path, reference).relmse},
          {"odd_name", results["scenes"][1]["name"]},
          {"guided_ratio", fmt::format("{:.3g}", ratio)},
          {"estimates", estimates}};
}

void insert(std::string& text, const std::string& before, const std::string& what) {
  const size_t at = text.rfind(before);
  ASSERT_NE(at, std::string::npos) << before;
  text.insert(at, what);
}

/// Empty where there is no such program.
std::string browser() {
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"})
    if (std::system(fmt::format("command -v {} >/dev/null 2>&1", name).c_str()) == 0) return name;
  return {};
}

/// What the browser wrote on standard error until the page closed its window.
std::string open_page(const std::string& program, const std::filesystem::path& folder, const std::string& window) {
  const std::string command = fmt::format(
      "cd '{}' && timeout 100 {} --headless --no-sandbox --disable-gpu --disable-dev-shm-usage --user-data-dir=profile "
      "--enable-logging=stderr --v=0 --window-size={} "
      "\"file://$PWD/driven.html\" "
      ">log.txt 2>&1",
      folder.string(), program, window);
  const int status = std::system(command.c_str());
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << command << "\n" << kit::bytes_of(folder / "log.txt");
  return kit::bytes_of(folder / "log.txt");
}

std::filesystem::path empty_folder(const std::string& name) {
  // Stays beside the test program in the build folder, from wherever that is run, to be looked at.
  const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe").parent_path() / name;
  std::filesystem::remove_all(folder);
  return folder;
}

/// Writes the page and opens it with a script of tests/report that gets what it compares with.
void drive(const json& results, const json& expected, const std::string& script, const std::filesystem::path& folder,
           const std::string& window, size_t fewest_checks) {
  write_report(results, folder);
  std::string page = kit::bytes_of(folder / "report.html");
  insert(page, "<title>",
         "<script>const errors = [];\n"
         "for (const kind of ['error', 'unhandledrejection', 'securitypolicyviolation'])\n"
         "  addEventListener(kind, event => errors.push(`${kind}: ${event.message ?? event.reason ?? "
         "event.blockedURI}`));\n"
         "</script>\n");
  std::string quoted;  // a name may hold "</script>"
  for (const char c : expected.dump()) quoted += c == '<' ? std::string("\\u003c") : std::string(1, c);
  insert(page, "</body>",
         "<script type=\"module\">const expected = " + quoted + ";\n" +
             kit::bytes_of(kit::source_path("tests/report/drive.js")) +
             kit::bytes_of(kit::source_path("tests/report/" + script)) + "</script>\n");
  write_text((folder / "driven.html").string(), page);

  const std::string log = open_page(browser(), folder, window);
  ASSERT_NE(log.find("\ndone\""), std::string::npos) << "the script did not come to its end\n" << log;
  std::istringstream lines(log);
  size_t passed = 0;
  for (std::string line; std::getline(lines, line);) {
    passed += line.starts_with("PASS ");
    EXPECT_FALSE(line.starts_with("FAIL ")) << line;
    EXPECT_TRUE(line.find(":CONSOLE") == std::string::npos || line.ends_with("\"selftest")) << line;
  }
  EXPECT_GE(passed, fewest_checks);
}

class Browser : public testing::TestWithParam<const char*> {
  void SetUp() override {
    if (browser().empty())
      GTEST_SKIP() << "needs Chromium (Debian: chromium), which is not there; the page was not tried";
  }
};

TEST_P(Browser, PageWorks) {
  const std::filesystem::path folder = empty_folder(fmt::format("page-{}", GetParam()));
  const json results = test::make_synthetic(folder);
  drive(results, expectations(results, folder), "selftest.js", folder, GetParam(), 69);
}

/// A budget in samples: some seeds are faster, and all end at the same samples.
TEST_P(Browser, SamplesAsBudget) {
  const std::filesystem::path folder = empty_folder(fmt::format("samples-{}", GetParam()));
  json results = test::make_synthetic(folder);
  results["budget"] = {{"spp", 273}};  // bdpt's
  for (json& method : results["scenes"][0]["methods"])
    for (json& sample : method["runs"][0]["samples"]) sample["cpu_seconds"] = sample["cpu_seconds"].get<double>() / 9;
  size_t i = 0;
  for (json& sample : results["scenes"][1]["methods"][0]["runs"][0]["samples"]) {  // on narrow axes
    sample["cpu_seconds"] = 2.2 + 0.02 * double(i);
    sample["relmse"] = 0.53 - 0.008 * double(i++);
  }
  drive(results, {}, "samplestest.js", folder, GetParam(), 7);
}

/// More than there are colours and digits.
TEST_P(Browser, TenMethods) {
  const std::filesystem::path folder = empty_folder(fmt::format("ten-{}", GetParam()));
  json results = test::make_synthetic(folder);
  json& methods = results["scenes"][0]["methods"];
  for (size_t i = 4; i < 10; ++i) {
    methods.push_back(methods[i % 4]);
    methods.back()["name"] = fmt::format("method {}", i + 1);
    for (const char* list : {"techniques", "fields"}) methods.back()[list] = json::array();
  }
  results["scenes"][0]["reference"]["relmse"] = nullptr;
  results["machine"]["threads"] = results["scenes"][0]["max_depth"] = 1;
  drive(results, {}, "tentest.js", folder, GetParam(), 15);
}

INSTANTIATE_TEST_SUITE_P(Windows, Browser, testing::Values("1280,900", "420,800"), [](const auto& window) {
  return std::string(window.param).starts_with("4") ? "Phone" : "Desk";
});

}  // namespace
}  // namespace ajar
