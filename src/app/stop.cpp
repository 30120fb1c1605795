#include "stop.h"

#include <csignal>

namespace ajar {
namespace {

volatile std::sig_atomic_t asked = 0;  // the signal; the one thing that its handler may touch

void ask(int signal) {
  asked = signal;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void catch_stop() {
  std::signal(SIGINT, ask);
  std::signal(SIGTERM, ask);
  if (std::signal(SIGHUP, ask) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // nohup
}

bool stop_asked() { return asked != 0; }
int stop_code() { return 128 + asked; }

}  // namespace ajar
