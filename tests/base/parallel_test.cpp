// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "base/error.h"

namespace axial {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnce) {
  for (const std::size_t count : {0u, 1u, 2u, 1000u}) {
    for (const std::size_t grain : {1u, 7u, 5000u}) {
      std::vector<std::atomic<int>> visits(count);
      parallel_for(
          count, [&](std::size_t i) { ++visits.at(i); }, grain);
      for (const auto& visit : visits) EXPECT_EQ(visit, 1);
    }
  }
}

TEST(ParallelFor, RethrowsWhatABodyThrows) {
  for (const unsigned threads : {1u, 2u}) {
    const ThreadLimit limit(threads);
    try {
      parallel_for(1000, [](std::size_t i) {
        if (i == 437) fail("item {} is bad", i);
      });
      ADD_FAILURE() << "nothing thrown";
    } catch (const Error& error) {
      EXPECT_STREQ(error.what(), "item 437 is bad");
    }
    // Loops work after an exception, too.
    std::atomic<int> visits = 0;
    parallel_for(100, [&](std::size_t) { ++visits; });
    EXPECT_EQ(visits, 100);
  }
}

TEST(ParallelFor, CanBeNested) {
  std::vector<std::atomic<int>> visits(60);
  parallel_for(
      6, [&](std::size_t i) { parallel_for(10, [&](std::size_t k) { ++visits[10 * i + k]; }); });
  for (const auto& visit : visits) EXPECT_EQ(visit, 1);
}

// The second item throws while the loop inside the first one runs.
TEST(ForEachInFlight, AnItemThatHasBegunGoesToItsEndThoughAnotherThrows) {
  const ThreadLimit limit(2);
  std::atomic<bool> begun = false;
  std::atomic<int> visits = 0;
  const auto first = [&](std::size_t) {
    begun = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ++visits;
  };
  const auto item = [&](std::size_t i) {
    if (i == 0) return parallel_for(200, first);
    while (!begun) std::this_thread::yield();
    fail("item {} is bad", i);
  };
  EXPECT_THROW(for_each_in_flight(2, 2, item), Error);
  EXPECT_EQ(visits, 200);
  visits = 0;
  EXPECT_THROW(parallel_for(2, item), Error);
  EXPECT_EQ(visits, 200);
}

TEST(ForEachInFlight, RunsNoMoreThanItMay) {
  const ThreadLimit limit(4);
  for (const std::size_t most : {1u, 2u, 3u}) {
    std::atomic<std::size_t> running = 0, worst = 0, done = 0;
    for_each_in_flight(20, most, [&](std::size_t) {
      const std::size_t now = ++running;
      for (std::size_t seen = worst; now > seen && !worst.compare_exchange_weak(seen, now);) {
      }
      // Idle threads take part in the inner loop. They must not begin further items.
      parallel_for(10, [](std::size_t) { std::this_thread::yield(); });
      --running;
      ++done;
    });
    EXPECT_EQ(done, 20u);
    EXPECT_LE(worst, most);
  }
}

TEST(ForEachInFlight, BeginsInOrderAndRethrows) {
  const ThreadLimit limit(1);
  std::vector<std::size_t> order;
  for_each_in_flight(5, 3, [&](std::size_t i) { order.push_back(i); });
  EXPECT_EQ(order, (std::vector<std::size_t>{0, 1, 2, 3, 4}));
  EXPECT_THROW(for_each_in_flight(5, 3,
                                  [](std::size_t i) {
                                    if (i == 2) fail("bad");
                                  }),
               Error);
  for_each_in_flight(0, 3, [](std::size_t) { FAIL(); });
}

// A thread that waits in an inner loop must not begin another item of the outer loop: it would hold
// the memory of both items.
TEST(ParallelFor, DoesNotBeginAnotherItemWhileItWaits) {
  const ThreadLimit limit(4);
  thread_local int depth = 0;
  std::atomic<int> deepest = 0;
  parallel_for(60, [&](std::size_t) {
    deepest = std::max<int>(deepest, ++depth);
    parallel_for(10, [](std::size_t) { std::this_thread::yield(); });
    --depth;
  });
  EXPECT_EQ(deepest, 1);
}

TEST(ThreadCount, IsTheLimit) {
  const ThreadLimit limit(3);
  EXPECT_EQ(thread_count(), 3u);
}

std::size_t threads_used() {
  std::mutex mutex;
  std::set<std::thread::id> threads;
  parallel_for(200, [&](std::size_t) {
    std::this_thread::yield();
    const std::lock_guard lock(mutex);
    threads.insert(std::this_thread::get_id());
  });
  return threads.size();
}

TEST(ThreadLimit, HoldsWhileItLives) {
  const ThreadLimit outer(3);
  {
    const ThreadLimit limit(1);
    EXPECT_EQ(threads_used(), 1u);
  }
  EXPECT_LE(threads_used(), 3u);
}

}  // namespace
}  // namespace axial
