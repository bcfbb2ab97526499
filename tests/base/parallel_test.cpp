// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
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
    // And works on afterwards.
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
