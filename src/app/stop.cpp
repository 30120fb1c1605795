#include "stop.h"

#include <csignal>
#include <ctime>

namespace ajar {
namespace {

volatile std::sig_atomic_t asked = 0;  // the signal; the one thing that its handler may touch

volatile std::sig_atomic_t since = 0;  // the second of the first one

// A terminal that closes may say so twice, and a key is easily pressed twice: only who presses it again after a while
// does not want to wait for what is written.
void ask(int signal) {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const auto second = std::sig_atomic_t(now.tv_sec & 0x3fffffff);
  if (asked == 0) {
    asked = signal;
    since = second;
  } else if (signal == SIGINT && second > since + 1) {
    std::signal(SIGINT, SIG_DFL);
    std::raise(SIGINT);
  }
}

void catch_unless_ignored(int signal) {
  if (std::signal(signal, ask) == SIG_IGN) std::signal(signal, SIG_IGN);
}

}  // namespace

void catch_stop() {
  std::signal(SIGINT, ask);
  catch_unless_ignored(SIGTERM);
  catch_unless_ignored(SIGHUP);  // nohup
}

bool stop_asked() { return asked != 0; }
int stop_code() { return 128 + asked; }

}  // namespace ajar
