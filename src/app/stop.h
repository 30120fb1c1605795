// Enters: Ctrl-C, SIGTERM, or that the terminal has gone (SIGHUP).
// Leaves: that the user wants an end; who renders writes what is there.
#pragma once

#include <string>

namespace ajar {

/// What a command throws that was to stop, once what it had done is written. The program says it, and exits with
/// stop_code().
struct Interrupted {
  std::string what;
};

/// From now on a signal asks to stop; Ctrl-C once more, a second or two later, ends the program at once.
void catch_stop();
bool stop_asked();
/// 128 + the signal, as shells have it.
int stop_code();

}  // namespace ajar
