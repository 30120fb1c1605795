// Enters: how many threads the user allows.
// Leaves: a command that has no more, whatever it does: loading, building, rendering, writing.
#pragma once

#include "ajar/core/parallel.h"
#include "ajar/film/picture.h"

namespace ajar {

/// For as long as the command runs. 0: as many as there are processors.
struct CommandThreads {
  explicit CommandThreads(int count) : loops(count), pictures(count) {}
  ThreadLimit loops;
  PictureThreads pictures;
};

}  // namespace ajar
