// Enters: a count, and what is to be done for every index or range below it.
// Leaves: it is done, by the threads of the arena one is in; what a call throws is thrown on.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>

#if defined(__SANITIZE_THREAD__)
#define AJAR_TSAN 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define AJAR_TSAN 1
#endif
#endif
#ifdef AJAR_TSAN
#include <sanitizer/tsan_interface.h>
#endif

namespace ajar {

/// As many as this process may use at a time: an affinity mask counts.
int processor_count();

inline constexpr int most_threads = 4096;

/// A number of threads that work together; loops that begin inside run() use these and no others.
class Threads {
 public:
  explicit Threads(int count);  ///< below 1: processor_count(); most_threads at most
  ~Threads();
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;
  int count() const;
  template <class F>
  void run(const F& f) {
    run([](const void* g) { (*static_cast<const F*>(g))(); }, &f);
  }

 private:
  void run(void (*call)(const void*), const void* f);
  struct Arena;
  std::unique_ptr<Arena> arena_;
};

/// As long as it lives no more than so many threads of the process work in loops, whoever begins them, the ray tracer's
/// too; of several the least count holds. Sees to no more than the number: loops run where they would.
class ThreadLimit {
 public:
  explicit ThreadLimit(int count);  ///< 0: none
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

/// Of the threads at work in one arena each has a slot of its own, 0 .. count - 1, for as long as one call of a loop's
/// function lasts.
uint32_t thread_slot();

namespace detail {

#ifdef AJAR_TSAN
// TBB is compiled without the thread sanitizer, which therefore must be told how it orders a loop: what came before the
// loop happens before each call, each call before what comes after the loop, calls in one slot one after the other. No
// other order exists between calls: what they do to the same memory is reported.
class LoopOrder {
 public:
  void begin() { __tsan_release(&begun_); }
  ~LoopOrder() { __tsan_acquire(&ended_); }

  class Call {
   public:
    explicit Call(LoopOrder& order) : order_(order), slot_(&order.slots_[thread_slot() % sizeof(order.slots_)]) {
      __tsan_acquire(&order_.begun_);
      __tsan_acquire(slot_);
    }
    ~Call() {
      __tsan_release(slot_);
      __tsan_release(&order_.ended_);
    }

   private:
    LoopOrder& order_;
    char* slot_;
  };

 private:
  char begun_, ended_, slots_[64];
};
#else
struct LoopOrder {
  void begin() {}
  struct Call {
    explicit Call(LoopOrder&) {}
  };
};
#endif

template <class F>
struct Loop {
  const F& f;
  LoopOrder order;

  static void call(void* loop, size_t from, size_t to) {
    Loop& l = *static_cast<Loop*>(loop);
    [[maybe_unused]] const LoopOrder::Call call(l.order);  // before anything is read
    l.f(from, to);
  }
};

void run_ranges(size_t n, size_t grain, void (*call)(void* loop, size_t from, size_t to), void* loop);

}  // namespace detail

/// Calls f(from, to) for ranges that make up [0, n); those longer than the grain may be divided.
template <class F>
void parallel_ranges(size_t n, size_t grain, const F& f) {
  detail::Loop<F> loop{f, {}};
  loop.order.begin();
  detail::run_ranges(n, grain, &detail::Loop<F>::call, &loop);
}

/// Calls f(i) for each i of [0, n).
template <std::integral I, class F>
void parallel_for(I n, const F& f) {
  if (n <= 0) return;
  parallel_ranges(size_t(n), 1, [&](size_t from, size_t to) {
    for (size_t i = from; i < to; ++i) f(I(i));
  });
}

}  // namespace ajar
