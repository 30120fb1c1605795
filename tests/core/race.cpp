// Two calls of one loop add to one plain number: the thread sanitizer must say so, although it knows nothing of TBB.
#include "ajar/core/parallel.h"

int main() {
  int shared = 0;
  ajar::Threads threads(2);
  threads.run([&] { ajar::parallel_for(100000, [&](int) { ++shared; }); });
  return shared == 0;
}
