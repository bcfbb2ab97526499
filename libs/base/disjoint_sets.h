// SPDX-License-Identifier: GPL-3.0-or-later
// Groups of numbers that are connected by pairs (union-find).
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <numeric>
#include <vector>

namespace axial {

// Disjoint sets of the numbers 0 to count - 1. At first each number is a set of its own. The root
// of a set is its smallest member. So the sets and their roots depend only on which pairs were
// joined, and not on the order of the pairs. Takes sizeof(Index) bytes per number. The time of a
// call grows with the logarithm of `count` at most, averaged over many calls. Not thread-safe:
// root() changes the object, too. Precondition: all numbers are below `count`.
template <std::unsigned_integral Index>
class DisjointSets {
 public:
  // Precondition: `count` - 1 fits into Index.
  explicit DisjointSets(std::size_t count) : parents_(count) {
    std::iota(parents_.begin(), parents_.end(), Index{0});
  }

  // Returns the smallest member of the set of `i`.
  Index root(Index i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }

  // Makes one set of the sets of `a` and `b`. Returns true if these were two sets.
  bool join(Index a, Index b) {
    a = root(a);
    b = root(b);
    parents_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

 private:
  std::vector<Index> parents_;  // never larger than the number itself
};

}  // namespace axial
