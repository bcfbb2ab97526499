// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/first_error.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "base/error.h"
#include "base/parallel.h"
#include "support/error_of.h"

namespace axial {
namespace {

TEST(FirstError, IsThatOfTheFirstItemForAnyNumberOfThreads) {
  std::mt19937 random(3);
  for (int round = 0; round < 50; ++round) {
    std::set<std::size_t> bad;
    while (bad.size() < 5) bad.insert(random() % 300);
    for (const unsigned threads : {1u, 3u, 8u}) {
      const ThreadLimit limit(threads);
      std::atomic<std::size_t> before = 0;
      FirstError error;
      parallel_for(300, [&](std::size_t i) {
        error.run(299 - i, [&] {
          if (bad.contains(299 - i)) fail("item {}", 299 - i);
          if (299 - i < *bad.begin()) ++before;
        });
      });
      EXPECT_EQ(test::error_of([&] { error.rethrow(); }), fmt::format("item {}", *bad.begin()));
      EXPECT_EQ(before, *bad.begin()) << "items before it are all done";
    }
  }
}

TEST(FirstError, IsNoneWithoutErrors) {
  FirstError error;
  parallel_for(10, [&](std::size_t i) { error.run(i, [] {}); });
  EXPECT_NO_THROW(error.rethrow());
}

}  // namespace
}  // namespace axial
