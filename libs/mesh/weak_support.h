// SPDX-License-Identifier: GPL-3.0-or-later
// Votes that keep surfaces with few points, such as surfaces without texture (Jancosek and Pajdla,
// "Multi-view reconstruction preserving weakly-supported surfaces", CVPR 2011). Where the evidence
// of free space falls steeply at a point, the space behind the point is occupied.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mesh/ray_walk.h"
#include "mesh/tetrahedra.h"

namespace axial::mesh {

struct Votes;

// Computes these votes.
class WeakSupport {
 public:
  // Computes the support of free space from `votes`. The support of a tetrahedron is the sum of the
  // costs of its four facets (Votes::facets). The support is in votes, not in their integers
  // (kVoteScale). The arguments except `votes` must outlive the object. Precondition: `votes` holds
  // the votes of all rays, and no costs of shape yet.
  WeakSupport(const Tetrahedra& tetrahedra, std::span<const Eigen::Vector3f> points,
              const Stars& stars, const Votes& votes);

  // Compares the support of free space on both sides of the point number `start`. The front is the
  // largest support up to 3 `sigma` [m] along the unit vector `direction`, which points to a
  // camera. The back is the mean of the smallest and the largest support up to 4 `sigma` in the
  // opposite direction. Returns the index of the tetrahedron in which the path in the opposite
  // direction ends, and the votes for inside that this tetrahedron gains for a ray of weight 1. The
  // support falls steeply if the back is below a tenth of the front and below 400 votes, and the
  // front minus the back is above 1000 votes. The votes are then the front minus the back, and
  // otherwise 0. If `start` is no corner of any tetrahedron, the result is Tetrahedra::kInfinity
  // with 0 votes.
  std::pair<std::uint32_t, double> gain(std::uint32_t start, const Eigen::Vector3d& direction,
                                        double sigma) const;

 private:
  const Tetrahedra& tetrahedra_;
  std::span<const Eigen::Vector3f> points_;
  const Stars& stars_;
  std::vector<float> support_;  // per tetrahedron, in votes
};

}  // namespace axial::mesh
