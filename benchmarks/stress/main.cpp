// Renders the cases of the stress suite with every integrator, each in a process of its own, and writes a table: is it
// finite, is it right, what does it cost next to the ordinary case of its group? docs/stress.md has what came of it.

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "ajar/core/error.h"
#include "ajar/film/picture.h"
#include "lessons.h"
#include "run.h"

namespace {

using namespace ajar;
using namespace ajar::stress;
using Json = nlohmann::json;

struct Arguments {
  std::string out, pictures;
  std::vector<std::string> groups, names, integrators = integrator_names();
  int batches = 32;
  double passes = 1;
  unsigned limit = 300;
  bool large = false, lessons = false, quiet = false;
};

// What a process of its own made of a case.
struct Trial {
  Outcome outcome;
  double megabytes = 0;  // at its peak
  std::string death;     // how it ended, if not as it should
};

std::string pack(const Outcome& o) {
  const Json j = {{"width", o.width},       {"height", o.height}, {"runs", o.runs},   {"refusal", o.refusal},
                  {"rejected", o.rejected}, {"replay", o.replay}, {"paths", o.paths}, {"cpu", o.cpu_seconds},
                  {"cells", o.cells},       {"noise", o.noise}};
  std::string bytes;
  Json::to_cbor(j, bytes);
  return bytes;
}

Outcome unpack(const std::string& bytes) {
  const Json j = Json::from_cbor(bytes);
  Outcome o;
  j.at("width").get_to(o.width), j.at("height").get_to(o.height), j.at("runs").get_to(o.runs);
  j.at("refusal").get_to(o.refusal), j.at("rejected").get_to(o.rejected), j.at("replay").get_to(o.replay);
  j.at("paths").get_to(o.paths), j.at("cpu").get_to(o.cpu_seconds), j.at("cells").get_to(o.cells);
  j.at("noise").get_to(o.noise);
  return o;
}

std::string read_all(int file) {
  std::string all;
  char part[1 << 16];
  for (ssize_t n; (n = read(file, part, sizeof part)) > 0;) all.append(part, size_t(n));
  return all;
}

[[noreturn]] void work(int file, unsigned limit, const std::function<Outcome()>& make) {
  const rlimit seconds = {limit, limit + 5};
  setrlimit(RLIMIT_CPU, &seconds);
  const std::string bytes = pack(make());
  for (size_t done = 0; done < bytes.size();) {
    const ssize_t n = write(file, bytes.data() + done, bytes.size() - done);
    if (n <= 0) _exit(3);
    done += size_t(n);
  }
  _exit(0);
}

Trial apart(unsigned limit, const std::function<Outcome()>& make) {
  int ends[2];
  if (pipe(ends) != 0) throw Error("no pipe");
  const pid_t child = fork();
  if (child < 0) throw Error("no process");
  if (child == 0) work(ends[1], limit, make);
  close(ends[1]);
  const std::string bytes = read_all(ends[0]);
  close(ends[0]);
  int status = 0;
  rusage used{};
  wait4(child, &status, 0, &used);
  Trial t;
  t.megabytes = double(used.ru_maxrss) / 1024;
  if (WIFSIGNALED(status))
    t.death = WTERMSIG(status) == SIGXCPU ? fmt::format("no end after {} CPU seconds", limit)
                                          : fmt::format("killed by signal {}", WTERMSIG(status));
  else if (WEXITSTATUS(status) != 0)
    t.death = fmt::format("ended with {}", WEXITSTATUS(status));
  else
    t.outcome = unpack(bytes);
  return t;
}

void save_picture(const Arguments& a, const Case& c, const std::string& integrator, const Outcome& o) {
  if (a.pictures.empty() || o.runs.empty()) return;
  make_folder(a.pictures);
  const kit::Estimate e = kit::estimate(o.width, o.height, o.runs);
  const Picture p{o.width, o.height, {"R", "G", "B"}, std::vector<float>(e.mean.begin(), e.mean.end())};
  std::string name = fmt::format("{} {} {}.exr", c.group, c.name, integrator);
  std::replace(name.begin(), name.end(), '/', '-');
  write_exr(a.pictures + "/" + name, p);
}

// By a process of their own: OpenEXR begins threads, and a process that has any cannot be forked any more.
void save_pictures(const Arguments& a, const Case& c, const std::string& integrator, const Outcome& o,
                   const Outcome& right) {
  const pid_t child = fork();
  if (child == 0) {
    save_picture(a, c, integrator, o), save_picture(a, c, "right", right);
    _exit(0);
  }
  if (child > 0) waitpid(child, nullptr, 0);
}

struct Table {
  std::string text;
  int wrong = 0;
  std::map<std::string, Outcome> ordinary;  // by integrator, of the group at work
};

double seconds_per_path(const Outcome& o) { return o.paths > 0 ? o.cpu_seconds / o.paths : 0; }

std::string what_is_right(const Case& c, const std::string& integrator, const Verdict& v) {
  if (c.answer == 0) return "black";
  if (c.answer < 0 && c.judge.empty()) return "ends";
  return judges_itself(c, integrator) ? "judge" : fmt::format("{:.2f} ({:g} %)", v.p, 100 * v.noticed);
}

std::string cell(Table& table, const Case& c, const std::string& integrator, const Trial& t, const Verdict& v) {
  const Outcome& o = t.outcome;
  if (!t.death.empty()) return ++table.wrong, fmt::format("**{}**", t.death);
  if (!v.ok && c.limit) return "limit";
  if (!v.ok) return ++table.wrong, v.noticed == infinity ? "**blind**" : fmt::format("**wrong** (p {:.0e})", v.p);
  if (!c.refused.empty()) return "refused";
  std::string text = what_is_right(c, integrator, v);
  const auto usual = table.ordinary.find(integrator);
  if (usual == table.ordinary.end()) {
    table.ordinary[integrator] = o;
    return text + fmt::format(" · {:.2g} · {:.2g} µs", o.noise, 1e6 * seconds_per_path(o));
  }
  if (c.answer != 0 && usual->second.noise > 0) text += fmt::format(" · ×{:.2g}", o.noise / usual->second.noise);
  return text + fmt::format(" · ×{:.2g}", seconds_per_path(o) / seconds_per_path(usual->second));
}

void begin_group(const Arguments& a, Table& table, const std::string& group) {
  table.ordinary.clear();
  table.text += fmt::format("\n**{}{}**\n\n| case |", char(std::toupper(group[0])), group.substr(1));
  for (const std::string& i : a.integrators) table.text += fmt::format(" {} |", i);
  table.text += " MB | rejected |\n|---|";
  for (size_t i = 0; i < a.integrators.size(); ++i) table.text += "---|";
  table.text += "--:|--:|\n";
}

void add_row(const Arguments& a, Table& table, const Case& c) {
  Trial right = apart(a.limit, [&] { return reference(c, 2 * a.batches); });
  if (!right.death.empty()) right.outcome.refusal = right.death;
  table.text += fmt::format("| {} |", c.name);
  double megabytes = 0;
  uint64_t rejected = 0;
  for (const std::string& integrator : a.integrators) {
    if (!can_find(c, integrator)) {
      table.text += " – |";
      continue;
    }
    const Trial t = apart(a.limit, [&] { return run(c, integrator, a.batches, a.passes); });
    const Verdict v = t.death.empty() ? judge(c, integrator, t.outcome, right.outcome) : Verdict{false, 0, 0, t.death};
    table.text += fmt::format(" {} |", cell(table, c, integrator, t, v));
    megabytes = std::max(megabytes, t.megabytes), rejected += t.outcome.rejected;
    if (!a.quiet)
      fmt::print(stderr, "{}, {}, {}: {:.1f} s, p {:.2g} {}{}\n", c.group, c.name, integrator, t.outcome.cpu_seconds,
                 v.p, v.message, c.refused.empty() ? "" : t.outcome.refusal);
    if (!v.ok) save_pictures(a, c, integrator, t.outcome, right.outcome);
  }
  table.text += fmt::format(" {:.0f} | {} |\n", megabytes, rejected);
}

bool is_in(const std::string& name, const std::vector<std::string>& list) {
  return list.empty() || std::find(list.begin(), list.end(), name) != list.end();
}

bool is_wanted(const Arguments& a, const Case& c) {
  return (a.large || !c.large) && is_in(c.group, a.groups) && is_in(c.name, a.names);
}

void write_or_print(const Arguments& a, const std::string& text) {
  if (a.out.empty())
    fmt::print("{}", text);
  else
    write_text(a.out, text);
}

// How what is learned of a closed box approaches its answer while it renders, as a share of it; where there is none,
// as it is.
std::string lessons_of_renders() {
  constexpr uint32_t shown[] = {2, 3, 4, 6, 8, 10, 12, 14};
  std::string text = "| rule | albedo | 1/(1−a) |";
  for (const uint32_t n : shown) text += fmt::format(" {} |", n);
  text += " largest cell |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n";
  LearnOptions learn;
  for (const Rule rule : {Rule::expected, Rule::max, Rule::returned})
    for (const float albedo : {0.5f, 0.9f, 0.99f, 0.999f, 1.0f}) {
      learn.rule = rule;
      const double answer = albedo < 1 ? 1 / (1 - double(albedo)) : 1;
      const std::vector<Lesson> all = lessons(albedo, learn, 512);
      text += fmt::format("| {} | {:g} | {} |", rule_names[int(rule)], albedo,
                          albedo < 1 ? fmt::format("{:.0f}", answer) : "∞");
      for (const uint32_t n : shown)
        text += n <= all.size() ? fmt::format(" {:.3g} |", all[n - 1].mean / answer) : " |";
      text += fmt::format(" {:.3g} |\n", all.back().most / answer);
      fmt::print(stderr, "{} {}: {} lessons\n", rule_names[int(rule)], albedo, all.size());
    }
  return text;
}

// Lessons that learning takes when every pass is one, next to what a contraction by the albedo would take were every
// entry updated in every lesson, and how far any cell goes beyond the answer on the way. A box of albedo 1 has none:
// its field may grow by 1 a lesson. Cells that are never divided are few enough to be met by every lesson.
std::string lessons_to_converge(bool large) {
  constexpr int edges = 8, size = 16;
  constexpr double converged = 0.95;
  std::string text =
      "| albedo | 1/(1−a) | cells | lessons to 5 % | if all were updated | ratio | after the last | "
      "largest cell ever |\n|--:|--:|--:|--:|--:|--:|--:|--:|\n";
  for (const bool divided : {false, true})
    for (const float albedo : {0.9f, 0.99f, 0.999f, 1.0f}) {
      const double inverse = 1 - double(albedo), ideal = std::log(1 - converged) / std::log(double(albedo));
      if (albedo > 0.995f && albedo < 1 && (divided || !large)) continue;  // many thousands of lessons
      const uint32_t most = albedo < 1 ? 2 * uint32_t((divided ? 6 : 4) * ideal / 2) : 500;
      LearnOptions learn;
      learn.forget = 0, learn.train = most;
      if (!divided) learn.divide_cell = 1e30f, learn.divide_stratum = 2;
      const std::vector<Lesson> all = lessons(albedo, learn, 0, size, edges);
      double largest = 0;
      for (const Lesson& l : all) largest = std::max(largest, l.most * (albedo < 1 ? inverse : 1.0 / l.number));
      const uint32_t n = albedo < 1 ? lesson_of_convergence(all, albedo, converged) : 0;
      text += fmt::format(
          "| {:g} | {} | {} | {} | {} | {} | {:.3f} ({}) | {:.3f} |\n", albedo,
          albedo < 1 ? fmt::format("{:.0f}", 1 / inverse) : "∞", all.back().cells, n > 0 ? fmt::format("{}", n) : "–",
          albedo < 1 ? fmt::format("{:.0f}", ideal) : "–", n > 0 ? fmt::format("{:.2f}", n / ideal) : "–",
          all.back().mean * (albedo < 1 ? inverse : 1.0 / all.back().number), all.back().number, largest);
      fmt::print(stderr, "albedo {}, {} cells: {} lessons\n", albedo, all.back().cells, all.size());
    }
  return text;
}

int show_lessons(const Arguments& a) {
  const std::string table = lessons_to_converge(a.large);
  write_or_print(a, a.large ? table + "\n" + lessons_of_renders() : table);
  return 0;
}

// Throws Error for what is no group, case or integrator.
void require_known(const Arguments& a, const std::vector<Case>& all) {
  std::vector<std::string> groups, names;
  for (const Case& c : all) {
    if (groups.empty() || groups.back() != c.group) groups.push_back(c.group);
    if (is_in(c.group, a.groups)) names.push_back(c.name);
  }
  const auto require = [](const char* what, const std::vector<std::string>& asked,
                          const std::vector<std::string>& known) {
    for (const std::string& one : asked)
      if (!is_in(one, known))
        throw Error(fmt::format("there is no {} \"{}\"; there are {}", what, one, fmt::join(known, ", ")));
  };
  require("group", a.groups, groups);
  require("case", a.names, names);
  require("integrator", a.integrators, integrator_names());
  if (std::none_of(all.begin(), all.end(), [&](const Case& c) { return is_wanted(a, c); }))
    throw Error("all of these cases are large; add --large");
}

int measure(const Arguments& a) {
  const std::vector<Case> all = cases();
  require_known(a, all);
  Table table;
  std::string group;
  for (const Case& c : all) {
    if (!is_wanted(a, c)) continue;
    if (c.group != group) begin_group(a, table, group = c.group);
    add_row(a, table, c);
    if (!a.out.empty()) write_text(a.out, table.text);
  }
  if (a.out.empty()) fmt::print("{}", table.text);
  return table.wrong > 0;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments a;
  CLI::App app{"The stress suite: stiff and extreme cases, every integrator"};
  app.add_option("groups", a.groups, "groups of cases; all if none is named");
  app.add_option("--case", a.names, "names of cases; what is said of noise and time is then of the first that is left");
  app.add_option("--passes", a.passes, "factor on the passes of every render");
  app.add_option("-o", a.out, "Markdown file of the table; else it is printed");
  app.add_option("--pictures", a.pictures, "folder for the mean images of cases that are wrong");
  app.add_option("--integrators", a.integrators, "those to try");
  app.add_option("--batches", a.batches, "independent renders of each")->check(CLI::Range(4, 1024));
  app.add_option("--limit", a.limit, "CPU seconds after which a case is given up");
  app.add_flag("--lessons", a.lessons,
               "instead: what is learned of closed boxes, lesson by lesson; --large: albedo 0.999, and renders too");
  app.add_flag("--large", a.large, "cases of minutes and gigabytes too");
  app.add_flag("-q,--quiet", a.quiet, "no line for every case");
  CLI11_PARSE(app, argc, argv);
  try {
    return a.lessons ? show_lessons(a) : measure(a);
  } catch (const Error& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 2;
  }
}
