// The command line: subcommands; one line on stderr with exit code 2 for every error, or with that of the signal for a
// command that was interrupted.

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <new>
#include <string>
#include <vector>

#include "ajar/core/error.h"
#include "command_line.h"
#include "progress.h"
#include "say.h"
#include "stop.h"

namespace {

using ajar::say, ajar::clear_line;

int fail(const std::string& what, int code = 2) {
  clear_line();
  say(stderr, "ajar: {}\n", what);
  return code;
}

// Of a pipe.
bool reader_has_gone() {
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  return ::poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0;
}

// The exit code.
int run(const std::vector<std::string>& words) {
  ajar::run_command_line(words);
  if (std::cout.flush() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return 0;
  if (reader_has_gone()) return 128 + SIGPIPE;  // who read has seen enough; the code is what shells have for it
  throw ajar::Error("standard output: cannot be written; check where it leads");
}

}  // namespace

int main(int argc, char** argv) {
  ajar::guard_streams();
  try {
    return run({argv + 1, argv + std::max(argc, 1)});
  } catch (const ajar::Interrupted& e) {
    return fail(e.what, ajar::stop_code());
  } catch (const std::bad_alloc&) {
    return fail("out of memory; try a smaller image (--size, or a suite's \"size\")");
  } catch (const std::exception& e) {
    return fail(e.what());
  }
}
