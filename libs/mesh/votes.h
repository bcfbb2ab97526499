// SPDX-License-Identifier: GPL-3.0-or-later
// Votes about tetrahedra: free space or occupied.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace axial::mesh {

// Votes are stored as integers: the integer n means n / kVoteScale votes. An integer or a sum above
// kLargestVote is reduced to kLargestVote. Sums of integers do not depend on the order in which
// threads add.
inline constexpr std::int32_t kVoteScale = 64;
inline constexpr std::int32_t kLargestVote = 1 << 28;

// The capacities of the cut, as integers (see kVoteScale).
struct Votes {
  std::vector<std::int32_t> outside;  // per tetrahedron: evidence that it is free space
  std::vector<std::int32_t> inside;   // per tetrahedron: evidence that it is occupied
  // [cell][i]: the cost of a surface in the facet opposite of corner i, if `cell` is free and the
  // tetrahedron behind the facet is occupied.
  std::vector<std::array<std::int32_t, 4>> facets;
};

}  // namespace axial::mesh
