#include "say.h"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>

namespace ajar {

void guard_streams() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0) static_cast<void>(::open("/dev/null", O_RDWR));  // takes the lowest that is free
}

void say_notes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) say(stderr, "ajar: note: {}\n", note);
}

}  // namespace ajar
