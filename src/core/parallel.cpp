// The only file that includes TBB. It is compiled without the thread sanitizer, as TBB itself is (see LoopOrder).
#include "ajar/core/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <optional>

namespace ajar {

// TBB starts no more threads than there are processors unless told. Of several who tell, the least holds for all of
// the process: who wants no more says nothing.
struct Threads::Arena {
  explicit Arena(int count) : arena(count) {}
  tbb::task_arena arena;
  std::optional<tbb::global_control> most;
};

int processor_count() { return tbb::info::default_concurrency(); }

Threads::Threads(int count) {
  const int processors = processor_count();
  count = count <= 0 ? processors : std::min(count, most_threads);
  arena_.reset(new Arena(count));
  if (count > processors) arena_->most.emplace(tbb::global_control::max_allowed_parallelism, size_t(count));
}
Threads::~Threads() = default;
int Threads::count() const { return arena_->arena.max_concurrency(); }
void Threads::run(void (*call)(const void*), const void* f) {
  arena_->arena.execute([&] { call(f); });
}

struct ThreadLimit::Control {
  tbb::global_control most;
};

ThreadLimit::ThreadLimit(int count) {
  if (count > 0) control_.reset(new Control{{tbb::global_control::max_allowed_parallelism, size_t(count)}});
}
ThreadLimit::~ThreadLimit() = default;

uint32_t thread_slot() { return uint32_t(tbb::this_task_arena::current_thread_index()); }

void detail::run_ranges(size_t n, size_t grain, void (*call)(void* loop, size_t from, size_t to), void* loop) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, n, grain), [=](const auto& r) { call(loop, r.begin(), r.end()); });
}

}  // namespace ajar
