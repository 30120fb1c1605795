// Enters: the clocks of the wall and of this process.
// Leaves: what they say, and sums of the time that was spent on something.
#pragma once

namespace ajar {

/// Seconds on the wall and of all threads of this process.
double wall_seconds();
double process_cpu_seconds();

struct Stopwatch {
  Stopwatch();  ///< starts
  /// Adds the seconds since it was started, or since they were last added.
  void add_to(double& seconds, double& cpu_seconds);

 private:
  double wall_, cpu_;
};

}  // namespace ajar
