// Loops: every index once, ranges that make up the whole, slots of their own, errors thrown on.
#include "ajar/core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace ajar {
namespace {

TEST(Parallel, CallsEachIndexOnce) {
  std::vector<int> calls(1000);
  parallel_for(1000, [&](int i) { ++calls[size_t(i)]; });
  EXPECT_EQ(calls, std::vector<int>(1000, 1));
  parallel_for(0u, [](uint32_t) { ADD_FAILURE(); });
  parallel_for(-3, [](int) { ADD_FAILURE(); });
}

TEST(Parallel, RangesMakeUpTheWhole) {
  std::vector<int> calls(10007);
  std::atomic<int> ranges = 0;
  parallel_ranges(calls.size(), 100, [&](size_t from, size_t to) {
    EXPECT_LT(from, to);
    ++ranges;
    for (size_t i = from; i < to; ++i) ++calls[i];
  });
  EXPECT_EQ(calls, std::vector<int>(10007, 1));
  EXPECT_LE(ranges, 10007 / 50);
  parallel_ranges(0, 100, [](size_t, size_t) { ADD_FAILURE(); });
}

// Each of so many threads waits in its slot until all are there.
void meet(Threads& threads, int count) {
  ASSERT_EQ(threads.count(), count);
  std::vector<std::atomic<int>> inside(static_cast<size_t>(count));
  std::atomic<int> here = 0;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  threads.run([&] {
    parallel_for(count, [&](int) {
      const uint32_t slot = thread_slot();
      ASSERT_LT(slot, uint32_t(count));
      EXPECT_EQ(inside[slot]++, 0);
      ++here;
      while (here < count && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
      --inside[slot];
    });
  });
  EXPECT_EQ(here, count);
  EXPECT_LT(std::chrono::steady_clock::now(), deadline);
}

// Four threads even where there are fewer processors.
TEST(Parallel, ThreadsHaveSlotsOfTheirOwn) {
  Threads threads(4);
  meet(threads, 4);
}

TEST(Parallel, WhoWantsFewThreadsLeavesOthersTheirs) {
  const int many = int(std::thread::hardware_concurrency()) + 2;
  Threads threads(many), one(1), usual(0);
  meet(threads, many);
}

TEST(Parallel, OneThreadIsTheCaller) {
  Threads one(1);
  EXPECT_EQ(one.count(), 1);
  const auto caller = std::this_thread::get_id();
  one.run([&] { parallel_for(100, [&](int) { EXPECT_EQ(std::this_thread::get_id(), caller); }); });
}

// In a thread of its own, whose loops no worker is in yet.
TEST(Parallel, ALimitHoldsForAllLoopsAsLongAsItLives) {
  {
    const ThreadLimit none(0), one(1);
    std::thread([] {
      const auto caller = std::this_thread::get_id();
      parallel_for(50, [&](int) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      });
    }).join();
  }
  Threads threads(2);
  meet(threads, 2);
}

TEST(Parallel, ThrowsOnWhatACallThrows) {
  Threads threads(2);
  const auto loop = [&] {
    threads.run([] { parallel_for(100, [](int i) { i == 57 ? throw std::runtime_error("57") : void(); }); });
  };
  EXPECT_THROW(loop(), std::runtime_error);
}

}  // namespace
}  // namespace ajar
