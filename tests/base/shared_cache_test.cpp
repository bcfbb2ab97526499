// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/shared_cache.h"

#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <thread>
#include <vector>

#include "base/error.h"

namespace axial {
namespace {

// A cache of squares that counts how often each square is made.
struct Squares {
  explicit Squares(std::size_t capacity)
      : cache(
            [this](std::size_t key) {
              ++made[key];
              return key * key;
            },
            capacity) {}

  std::map<std::size_t, int> made;
  SharedCache<std::size_t> cache;
};

TEST(SharedCache, KeepsWhatWasUsedLast) {
  Squares squares(2);
  for (const std::size_t key : {3u, 4u, 3u, 5u, 3u, 4u})
    EXPECT_EQ(*squares.cache.get(key), key * key);
  EXPECT_EQ(squares.made[3], 1);
  EXPECT_EQ(squares.made[5], 1);
  EXPECT_EQ(squares.made[4], 2);  // was evicted for 5
}

TEST(SharedCache, KeepsWhatIsInUse) {
  Squares squares(1);
  {
    const auto held = squares.cache.get(3);
    squares.cache.get(4);
    EXPECT_EQ(squares.cache.get(3), held);
  }
  squares.cache.get(5);
  squares.cache.get(3);
  EXPECT_EQ(squares.made[3], 2);
}

TEST(SharedCache, MakesAValueOnceHoweverManyWantIt) {
  std::atomic<int> made = 0, waiting = 0;
  SharedCache<int> cache(
      [&](std::size_t) {
        while (waiting < 4) std::this_thread::yield();
        return ++made;
      },
      2);
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&] {
      ++waiting;
      EXPECT_EQ(*cache.get(7), 1);
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(made, 1);
}

TEST(SharedCache, HandsOnExceptionsAndTriesAgain) {
  int tries = 0;
  SharedCache<int> cache(
      [&](std::size_t) {
        if (++tries == 1) fail("not today");
        return tries;
      },
      2);
  EXPECT_THROW(cache.get(1), Error);
  EXPECT_EQ(*cache.get(1), 2);
}

}  // namespace
}  // namespace axial
