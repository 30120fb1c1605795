// The options of all commands, and those that the documents name: the same; those of scripts are among them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>

#include "app/command_line.h"
#include "kit/files.h"

namespace ajar {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

Names options_in(const std::string& text) {
  Names out;
  for (size_t at = text.find("--"); at != text.npos; at = text.find("--", at + 2)) {
    const size_t end = std::min(text.find_first_not_of("abcdefghijklmnopqrstuvwxyz-", at + 2), text.size());
    const bool begins = at == 0 || (text[at - 1] != '-' && !std::isalnum(static_cast<unsigned char>(text[at - 1])));
    if (begins && end > at + 2 && text[at + 2] != '-') out.insert(text.substr(at, end - at));
  }
  return out;
}

Names options_of(const std::string& command) {
  testing::internal::CaptureStdout();
  run_command_line({command, "--help"});
  return options_in(testing::internal::GetCapturedStdout());
}

std::vector<fs::path> documents() {
  std::vector<fs::path> out = {kit::source_path("README.md")};
  for (const auto& entry : fs::directory_iterator(kit::source_path("docs")))
    if (entry.path().extension() == ".md") out.push_back(entry.path());
  return out;
}

Names options_of_all() {
  Names out;
  for (const char* command : {"render", "animate", "compare", "bench", "fields", "plan", "report"})
    out.merge(options_of(command));
  EXPECT_TRUE(out.contains("--integrator"));
  return out;
}

TEST(Options, ScriptsHaveNoOthers) {
  const Names helped = options_of_all();
  int scripts = 0;
  for (const auto& entry : fs::directory_iterator(kit::source_path("benchmarks"))) {
    if (entry.path().extension() != ".sh") continue;
    ++scripts;
    for (const std::string& option : options_in(kit::bytes_of(entry.path())))
      EXPECT_TRUE(helped.contains(option) || option == "--mosaic") << entry.path() << " has " << option;  // of oiiotool
  }
  EXPECT_GT(scripts, 10);
}

TEST(Options, AreThoseOfTheDocuments) {
  Names helped = options_of_all(), told;
  const Names of_cmake = {"--build", "--install", "--preset", "--prefix"};
  for (const fs::path& document : documents()) {
    const Names here = options_in(kit::bytes_of(document));
    told.insert(here.begin(), here.end());
    if (document.filename() == "stress.md") continue;  // has those of bench_stress
    for (const std::string& option : here)
      EXPECT_TRUE(helped.contains(option) || of_cmake.contains(option)) << document << " has " << option;
  }
  helped.erase("--out");  // -o
  for (const std::string& option : helped) EXPECT_TRUE(told.contains(option)) << option << " is in no document";
}

}  // namespace
}  // namespace ajar
