// What measures: programs and scripts of benchmarks/ still run, and print figures.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>

#include "kit/files.h"

namespace ajar {
namespace {

namespace fs = std::filesystem;

struct Measuring : kit::InFolder {
  /// What a command prints, which has to end well: its lines that have all of `words`.
  size_t lines(const std::string& command, const std::vector<std::string>& words) const {
    const fs::path out = folder / "out", said = folder / "said";
    const int status = std::system((command + " >'" + out.string() + "' 2>'" + said.string() + "'").c_str());
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << command << '\n' << kit::bytes_of(said);
    std::ifstream file(out);
    size_t count = 0;
    for (std::string line; std::getline(file, line);)
      count += std::all_of(words.begin(), words.end(), [&](const auto& w) { return line.find(w) != line.npos; });
    return count;
  }
};

std::string quoted(const std::string& path) { return "'" + path + "' "; }
const std::string box = quoted(kit::source_path("scenes/box/box.xml"));
std::string script(const std::string& name) { return "bash " + quoted(kit::source_path("benchmarks/" + name)); }
const std::string program = quoted(AJAR_PROGRAM);

TEST_F(Measuring, ProgramsRun) {
  for (const char* integrator : {"path", "bdpt"})
    EXPECT_EQ(lines(quoted(AJAR_BENCH_RAYS) + box + integrator + " 16 16 1 2", {"bare ", "ratio ", "at most "}), 2u);
  EXPECT_GE(lines(quoted(AJAR_BENCH_ERROR) + box + "path 2 4 8 8", {"cost"}), 1u);
  EXPECT_EQ(lines(quoted(AJAR_BENCH_FIELD) + box + "16 16 4 1", {"ns a vertex", "look-up"}), 1u);
}

TEST_F(Measuring, ScriptsRun) {
  if (std::system("python3 -c 'import json' 2>/dev/null") != 0) GTEST_SKIP() << "no python3, which scripts use";
  EXPECT_EQ(lines(script("speed.sh") + box + program + "8x8 1", {"us CPU/sample", "MB"}), 6u);
  EXPECT_EQ(lines(script("builds.sh") + program + program + "1 1 " + box, {"geometric mean of 1 scenes"}), 3u);
  EXPECT_EQ(lines(script("ray_cost.sh") + program + "0.05 " + box, {"| box |", " ns, 1.00"}), 1u);
  EXPECT_EQ(lines(script("lights.sh") + box + "path 1 0.1s " + program + "8x8 1", {"tree over uniform: "}), 1u);
  EXPECT_EQ(lines(script("lights.sh") + box + "vcm 1 0.1s " + program + "8x8 1 'power tree'", {"tree over power: "}),
            1u);
  EXPECT_EQ(lines(script("lights_number.sh") + program + "'' 10", {"10 tree "}), 1u);
}

}  // namespace
}  // namespace ajar
