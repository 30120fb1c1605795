// The command line: subcommands, and one line on stderr with exit code 2 for every error of the user's making.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <new>

#include "ajar/core/error.h"
#include "commands.h"
#include "version.h"

namespace {

int fail(const std::string& what) {
  std::fprintf(stderr, "ajar: %s\n", what.c_str());
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
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
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);
    return fail(std::string(e.what()) + "; see ajar --help");
  } catch (const ajar::Error& e) {
    return fail(e.what());
  } catch (const std::bad_alloc&) {
    return fail("out of memory; try a smaller --size");
  }
  return 0;
}
