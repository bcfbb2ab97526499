// SPDX-License-Identifier: GPL-3.0-or-later
// Evidence of free and occupied space, as capacities of an s-t cut between the tetrahedra. The
// weights are those of Labatut, Pons and Keriven, "Robust and efficient surface reconstruction from
// range data", Computer Graphics Forum 28(8), 2009.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/progress.h"
#include "mesh/merge_points.h"
#include "mesh/ray_walk.h"
#include "mesh/tetrahedra.h"
#include "mesh/view_rays.h"

namespace axial::mesh {

// All numbers are multiples of 1 / kVoteScale of a vote and at most kLargestVote. Sums of integers
// do not depend on the order in which threads add.
inline constexpr std::int32_t kVoteScale = 64;
inline constexpr std::int32_t kLargestVote = 1 << 28;

struct Votes {
  std::vector<std::int32_t> outside;  // per tetrahedron: evidence that it is free space
  std::vector<std::int32_t> inside;   // per tetrahedron: evidence that it is occupied
  // [cell][i]: the cost of a surface in the facet opposite of corner i, if `cell` is free and the
  // tetrahedron behind the facet is occupied.
  std::vector<std::array<std::int32_t, 4>> facets;
};

struct VoteOptions {
  bool constant_weight = true;  // every view of a merged point has the weight 1
  bool weak_support = false;    // free_space_support (weak_support.h)
  double thickness_factor = 1;  // multiplies the expected error of a point, 2.5 pixel widths
  double quality_factor = 1;    // multiplies the cost of facets of badly shaped tetrahedra
};

// The expected error of point i along its rays [m]: the sigma of the weights.
double expected_error(const MergedPoints& points, std::size_t i, const VoteOptions& options);

// Casts the votes of all rays between `points`, which are the corners of `tetrahedra`, and the
// cameras of their views. Every facet that a ray crosses in front of its point gets the weight of
// the view times 1 - exp(-d^2 / (2 sigma^2)), with the distance d [m] from the point; so do the
// facets behind it, up to one sigma. The tetrahedron at the end of the ray is outside. The
// tetrahedron one sigma behind the point gets a vote for inside. Each facet also gets a vote for
// surfaces through well shaped tetrahedra.
Votes cast_votes(const Tetrahedra& tetrahedra, const MergedPoints& points, const ViewRays& rays,
                 const VoteOptions& options = {}, const ProgressSink& progress = {});

}  // namespace axial::mesh
