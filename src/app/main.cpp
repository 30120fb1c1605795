// The command line: subcommands; one line on stderr with exit code 2 for every error, or with that of the signal for a
// command that was interrupted.

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <new>

#include "ajar/core/error.h"
#include "arguments.h"
#include "commands.h"
#include "progress.h"
#include "say.h"
#include "stop.h"
#include "version.h"

namespace {

using ajar::say, ajar::clear_line;

int fail(const std::string& what, int code = 2) {
  clear_line();
  say(stderr, "ajar: {}\n", what);
  return code;
}

// A mistyped word is told first: what else is missing may be what it was to be.
std::string explain(const CLI::App& command, const std::string& what) {
  for (const std::string& word : command.remaining())
    if (word.starts_with('-')) return fmt::format("{}: there is no such option", word);
  constexpr std::string_view twice = ": At Most 1 required but received ";
  if (const size_t at = what.find(twice); at != what.npos)
    return fmt::format("{}: given twice; leave one of them out", what.substr(0, at));
  return what;
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

// Of a pipe.
bool reader_has_gone() {
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  return ::poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0;
}

// The exit code.
int parse(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() != 0) throw ajar::Error(explain(app, e));
    app.exit(e);  // help
  }
  if (std::cout.flush() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return 0;
  if (reader_has_gone()) return 128 + SIGPIPE;  // who read has seen enough; the code is what shells have for it
  throw ajar::Error("standard output: cannot be written; check where it leads");
}

}  // namespace

int main(int argc, char** argv) {
  ajar::guard_streams();
  CLI::App app{"Ajar: bidirectional path tracing for scenes whose light is hard to find"};
  app.name("ajar");
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string("ajar ") + ajar::version);
  ajar::add_render(app);
  ajar::add_animate(app);
  ajar::add_compare(app);
  ajar::add_bench(app);
  ajar::add_fields(app);
  ajar::add_plan(app);
  ajar::add_report(app);
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) ajar::refuse_empty(*command);
  try {
    return parse(app, argc, argv);
  } catch (const ajar::Interrupted& e) {
    return fail(e.what, ajar::stop_code());
  } catch (const std::bad_alloc&) {
    return fail("out of memory; try a smaller --size");
  } catch (const std::exception& e) {
    return fail(e.what());
  }
}
