#include "ajar/render/clock.h"

#include <chrono>
#include <ctime>

#include "ajar/render/render.h"

namespace ajar {

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double process_cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

bool is_over(const RenderOptions& options, const RenderStats& stats, double share) {
  return (options.seconds > 0 && stats.seconds >= share * options.seconds) ||
         (options.cpu_seconds > 0 && stats.cpu_seconds >= share * options.cpu_seconds);
}

Stopwatch::Stopwatch() : wall_(wall_seconds()), cpu_(process_cpu_seconds()) {}

void Stopwatch::add_to(double& seconds, double& cpu_seconds) {
  const Stopwatch now;
  seconds += now.wall_ - wall_, cpu_seconds += now.cpu_ - cpu_;
  *this = now;
}

}  // namespace ajar
