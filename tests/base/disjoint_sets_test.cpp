// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/disjoint_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace axial {
namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

Pairs random_pairs(std::uint32_t count, std::size_t pairs, std::mt19937& random) {
  std::uniform_int_distribution<std::uint32_t> number(0, count - 1);
  Pairs result(pairs);
  for (auto& [a, b] : result) {
    a = number(random);
    b = number(random);
  }
  return result;
}

// Oracle: every number takes the smaller label of each of its pairs until nothing changes.
std::vector<std::uint32_t> smallest_members(std::uint32_t count, const Pairs& pairs) {
  std::vector<std::uint32_t> labels(count);
  for (std::uint32_t i = 0; i < count; ++i) labels[i] = i;
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [a, b] : pairs) {
      changed = changed || labels[a] != labels[b];
      labels[a] = labels[b] = std::min(labels[a], labels[b]);
    }
  }
  return labels;
}

template <class Index>
std::vector<std::uint32_t> roots(std::uint32_t count, const Pairs& pairs) {
  DisjointSets<Index> sets(count);
  for (const auto& [a, b] : pairs) sets.join(static_cast<Index>(a), static_cast<Index>(b));
  std::vector<std::uint32_t> result;
  for (std::uint32_t i = 0; i < count; ++i)
    result.push_back(static_cast<std::uint32_t>(sets.root(static_cast<Index>(i))));
  return result;
}

TEST(DisjointSets, TheRootIsTheSmallestMemberInAnyOrderOfPairs) {
  std::mt19937 random(1);
  for (const std::uint32_t count : {1u, 2u, 10u, 200u})
    for (const std::size_t density : {0u, 1u, 3u}) {
      Pairs pairs = random_pairs(count, density * count / 2, random);
      const std::vector<std::uint32_t> expected = smallest_members(count, pairs);
      for (int order = 0; order < 10; ++order) {
        EXPECT_EQ(roots<std::uint32_t>(count, pairs), expected);
        EXPECT_EQ(roots<std::uint64_t>(count, pairs), expected);
        std::ranges::shuffle(pairs, random);
        for (auto& [a, b] : pairs) std::swap(a, b);
      }
    }
}

TEST(DisjointSets, JoinTellsWhetherThereWereTwoSets) {
  std::mt19937 random(2);
  constexpr std::uint32_t kCount = 100;
  DisjointSets<std::uint32_t> sets(kCount);
  std::size_t left = kCount;
  for (const auto& [a, b] : random_pairs(kCount, 120, random)) {
    const bool two = sets.root(a) != sets.root(b);
    EXPECT_EQ(sets.join(a, b), two);
    EXPECT_EQ(sets.root(a), sets.root(b));
    if (two) --left;
  }
  std::size_t found = 0;
  for (std::uint32_t i = 0; i < kCount; ++i)
    if (sets.root(i) == i) ++found;
  EXPECT_EQ(found, left);
}

TEST(DisjointSets, LongChains) {
  constexpr std::uint32_t kCount = 1'000'000;
  DisjointSets<std::uint32_t> upwards(kCount), downwards(kCount);
  for (std::uint32_t i = 1; i < kCount; ++i) {
    upwards.join(i - 1, i);
    downwards.join(kCount - i, kCount - i - 1);
  }
  for (const std::uint32_t i : {0u, 1u, kCount / 2, kCount - 1}) {
    EXPECT_EQ(upwards.root(i), 0u);
    EXPECT_EQ(downwards.root(i), 0u);
  }
}

}  // namespace
}  // namespace axial
