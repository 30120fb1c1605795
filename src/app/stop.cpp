#include "stop.h"

#include <csignal>

namespace ajar {
namespace {

volatile std::sig_atomic_t asked = 0;  // the one thing a signal handler may touch

void ask(int signal) {
  asked = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void catch_stop() {
  std::signal(SIGINT, ask);
  std::signal(SIGTERM, ask);
}

bool stop_asked() { return asked != 0; }

}  // namespace ajar
