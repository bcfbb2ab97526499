// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces that only few points support, such as surfaces without texture (Jancosek and Pajdla,
// "Multi-view reconstruction preserving weakly-supported surfaces", CVPR 2011). Where the support
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

class WeakSupport {
 public:
  // Takes the support of free space from `votes`: the sum of the costs of a cell's four facets. The
  // references must outlive the object; the votes need not.
  WeakSupport(const Tetrahedra& tetrahedra, std::span<const Eigen::Vector3f> points,
              const Stars& stars, const Votes& votes);

  // Compares the support in front of the point `start`, up to 3 sigma along the unit vector
  // `direction` to a camera, with the support up to 4 sigma behind it. Returns the last tetrahedron
  // behind the point and the votes for inside that it gains for a ray of weight 1; no votes if the
  // support does not fall steeply.
  std::pair<std::uint32_t, double> gain(std::uint32_t start, const Eigen::Vector3d& direction,
                                        double sigma) const;

 private:
  const Tetrahedra& tetrahedra_;
  std::span<const Eigen::Vector3f> points_;
  const Stars& stars_;
  std::vector<float> support_;  // per tetrahedron, in votes
};

}  // namespace axial::mesh
