// ajar bench: error against run time, of the methods of a suite on its scenes.

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "ajar/core/bytes.h"
#include "ajar/core/error.h"
#include "ajar/core/files.h"
#include "ajar/film/picture.h"
#include "ajar/render/render.h"
#include "ajar/report/bench.h"
#include "ajar/report/page.h"
#include "apart.h"
#include "arguments.h"
#include "command_threads.h"
#include "commands.h"
#include "options.h"
#include "progress.h"
#include "say.h"
#include "stop.h"
#include "version.h"

namespace ajar {
namespace {

namespace fs = std::filesystem;

struct BenchArguments {
  std::string suite, out, references;
  bool quick = false, quiet = false;
  int threads = 0;
};

/// One line on a terminal, rewritten in place; in a log one now and then.
struct Line {
  bool shown = true, terminal = isatty(STDERR_FILENO) != 0;
  double next = 0;

  void show(const BenchProgress& p) {
    const double now = wall_seconds();
    if (!shown || now < next) return;
    next = now + (terminal ? 0.25 : 60);
    std::string line = fmt::format("{:5.1f} %  {}", 100 * p.share, p.what);
    if (p.left < infinity) line += fmt::format("  {} left", clock_text(p.left));
    put_line(std::move(line), false);
  }
  void clear() const {
    if (shown) clear_line();
  }
};

// As a shell takes it for one word.
std::string quoted(const std::string& word) {
  constexpr const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789/._-+:=,@%";
  if (!word.empty() && word.find_first_not_of(plain) == word.npos) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

std::string command_of(const BenchArguments& a) {
  std::string command = fmt::format("ajar bench {} -o {}", quoted(a.suite), quoted(a.out));
  if (a.quick) command += " --quick";
  if (!a.references.empty()) command += " --references " + quoted(a.references);
  if (a.threads > 0) command += fmt::format(" --threads {}", a.threads);
  return command;
}

// The stress suite's cases are scenes that code builds; the program that has them is built with the tests.
bool is_stress(const std::string& suite) {
  if (!is_file(suite)) return false;  // load_suite says what is wrong
  const nlohmann::json json = nlohmann::json::parse(std::ifstream(suite), nullptr, false);
  return json.is_object() && json.value("cases", nlohmann::json()) == "stress";
}

// Becomes that program, which stands beside this one or where the build puts it.
[[noreturn]] void run_stress(const BenchArguments& a) {
  if (!a.references.empty() || a.threads > 0)
    throw Error(fmt::format("{}: the stress suite takes neither --references nor --threads; leave them out", a.suite));
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path(), out = fs::path(a.out) / "stress.md";
  for (const char* place : {"bench_stress", "benchmarks/stress/bench_stress"}) {
    const std::string program = (folder / place).string();
    if (access(program.c_str(), X_OK) != 0) continue;
    make_folder(a.out);
    std::vector<std::string> words = {program, "-o", out.string(), "--pictures", (fs::path(a.out) / "wrong").string()};
    if (a.quick) words.insert(words.end(), {"--batches", "8"});
    if (a.quiet) words.push_back("--quiet");
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    for (const int ignored : {SIGPIPE, SIGXFSZ}) std::signal(ignored, SIG_DFL);  // here alone; see guard_streams
    execv(program.c_str(), argv.data());
  }
  throw Error(
      fmt::format("{}: needs bench_stress beside ajar; build it, with -DBUILD_TESTING=ON (docs/stress.md)", a.suite));
}

// Builds of one version are told apart by their bytes.
std::string build_of_this_program() {
  std::ifstream file("/proc/self/exe", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  return fmt::format("{:016x}", checksum(bytes.data(), bytes.size(), 0));
}

bool is_within(const fs::path& file, const fs::path& folder) {
  if (file.empty()) return false;
  const fs::path inner = place_of(file.string()), outer = place_of(folder.string());
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

void check_apart(const BenchArguments& a, const Suite& suite) {
  std::vector<Named> written, read = {{"the suite", a.suite}};
  for (const char* name : bench_files) written.push_back({"-o, file", (fs::path(a.out) / name).string()});
  for (const BenchScene& scene : suite.scenes)
    if (scene.missing.empty()) read.push_back({"the scene", scene.file});
  require_apart(written, read);
  for (const BenchScene& scene : suite.scenes)
    for (const char* part : {"runs", "images", "techniques", "fields"})
      if (is_within(scene.reference, fs::path(a.out) / part))
        throw Error(
            fmt::format("{}: scenes \"{}\".reference: {} lies where bench writes its own; move it, or name "
                        "another folder with -o",
                        a.suite, scene.name, scene.reference.string()));
}

void run_bench_command(const BenchArguments& a) {
  if (is_stress(a.suite)) run_stress(a);
  if (is_file(a.references)) throw Error(fmt::format("--references {}: is a file; name a folder", a.references));
  const Suite suite = load_suite(a.suite, a.quick);
  check_apart(a, suite);
  for (const BenchScene& scene : suite.scenes)
    if (!scene.missing.empty() && !a.quiet)
      say(stderr, "ajar: note: scene {} is left out: {}\n", scene.name, scene.missing);
  BenchOptions options;
  options.folder = a.out;
  options.references =
      a.references.empty() ? suite.path.parent_path() / "references" : std::filesystem::path(a.references);
  options.threads = a.threads;
  options.command = command_of(a);
  options.version = version, options.build = build_of_this_program();
  Line line;
  line.shown = !a.quiet;
  options.watch = [&](const BenchProgress& p) {
    line.show(p);
    return !stop_asked();
  };
  catch_stop();
  const nlohmann::ordered_json results = run_bench(suite, options);
  line.clear();
  say(stdout, "{}", results_table(results));
  write_report(nlohmann::json(results), options.folder);
  if (!a.quiet) say(stdout, "{}\n", (options.folder / "report.html").string());
  if (results["interrupted"]) throw Interrupted{"interrupted; the same command goes on from here"};
  if (const nlohmann::ordered_json& refused = results["refused"]; !refused.empty())
    throw Error(
        fmt::format("{}{}", refused[0].get<std::string>(),
                    refused.size() > 1 ? fmt::format("; {} more references are refused", refused.size() - 1) : ""));
}

}  // namespace

void add_bench(CLI::App& app) {
  auto a = std::make_shared<BenchArguments>();
  CLI::App* c = app.add_subcommand("bench", "Measure error against run time of the methods of a suite");
  c->add_option("suite", a->suite, "JSON file that names scenes, methods, seeds and a budget (docs/bench.md)")
      ->required();
  c->add_option("-o,--out", a->out, "folder for results; finished runs in it are kept and not run again")->required();
  c->add_flag("--quick", a->quick, "the suite's smaller version of itself");
  c->add_option("--references", a->references,
                "folder of references that are made once (default: the folder references beside the suite)");
  add_threads(*c, a->threads);
  c->add_flag("-q,--quiet", a->quiet, "no progress, no notes");
  c->callback([a] {
    const CommandThreads threads(a->threads);
    run_bench_command(*a);
  });
}

}  // namespace ajar
