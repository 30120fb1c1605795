#include "command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <regex>

#include "ajar/core/error.h"
#include "arguments.h"
#include "commands.h"
#include "options.h"
#include "version.h"

namespace ajar {
namespace {

// What the parser says of one option, in words of our own and with the cure. Patterns of <regex> recurse with the
// length of the text.
std::string reworded(const std::string& what) {
  static const std::pair<std::regex, const char*> table[] = {
      {std::regex("Could not convert: (\\S+) = ([^]*)"), "$1 $2: is no number that fits here; write one, such as 8"},
      {std::regex("(\\S+): \\d+ required [^]* missing"), "$1: has no value; write one after it"},
      {std::regex("(\\S+): At least (\\d+) required but received (\\d+)"),
       "$1: takes $2 values, not $3; write them all"},
      {std::regex("(\\S+): At Most (\\d+) required but received (\\d+)"),
       "$1: takes $2 values, not $3; leave the rest out"},
      {std::regex("The following arguments? (?:was|were) not expected: ([^]*)"),
       "$1: more words than are asked for; leave them out, or put an option before them"},
      {std::regex("(\\S+): ([^]*) not in \\{([^]*)\\}"), "$1 $2: is none of $3; write one of these"}};
  constexpr size_t longest = 4096;
  for (const auto& [pattern, words] : table)
    if (what.size() <= longest && std::regex_match(what, pattern)) return std::regex_replace(what, pattern, words);
  return what;
}

// A mistyped word is told first: what else is missing may be what it was to be.
std::string explain(const CLI::App& command, const std::string& what) {
  for (const std::string& word : command.remaining())
    if (word.starts_with('-')) return fmt::format("{}: there is no such option", word);
  constexpr std::string_view twice = ": At Most 1 required but received ";
  if (const size_t at = what.find(twice); at != what.npos)
    return fmt::format("{}: given twice; leave one of them out", what.substr(0, at));
  return reworded(what);
}

std::string explain(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> used = app.get_subcommands();
  if (!used.empty())
    return fmt::format("{}; see ajar {} --help", explain(*used[0], std::string(error.what())), used[0]->get_name());
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    known.push_back(command->get_name());
  for (const std::string& word : app.remaining())
    if (!word.starts_with('-'))
      return fmt::format("{}: there is no such command; known are {}", word, fmt::join(known, ", "));
  return fmt::format("{}; see ajar --help", explain(app, std::string(error.what())));
}

}  // namespace

void run_command_line(std::vector<std::string> words) {
  CLI::App app{"Ajar: bidirectional path tracing for scenes whose light is hard to find"};
  app.name("ajar");
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("ajar ") + version);
  add_render(app);
  add_animate(app);
  add_compare(app);
  add_bench(app);
  add_fields(app);
  add_plan(app);
  add_report(app);
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    read_decimal(*command), refuse_empty(*command);
  std::reverse(words.begin(), words.end());  // as CLI11 takes them
  try {
    app.parse(std::move(words));
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() != 0) throw Error(explain(app, e));
    app.exit(e);  // help
  }
}

}  // namespace ajar
