// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid refinement of a cloud's place against the true surface.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "evaluate/alignment.h"
#include "evaluate/surface.h"

namespace axial::evaluate {

struct IcpOptions {
  std::size_t samples = 20000;  // points used
  std::uint64_t seed = 1;
  int max_iterations = 100;
  double trim = 3;     // points farther than this times the median distance do not count
  double stop = 1e-7;  // end when a step moves the cloud by less than this times its radius
};

struct IcpResult {
  Similarity transform;  // scale 1
  int iterations = 0;
  bool converged = false;
  double median_before = 0, median_after = 0;  // distance [m] of the points used
};

// Gauss-Newton on the distances to the surface (point to plane inside faces, point to point beyond
// its edges), over a fixed subsample. Directions in which the surface does not hold the cloud
// (sliding on a plane) stay as they are. Error for fewer than 6 points.
IcpResult refine_rigid(std::span<const Eigen::Vector3f> points, const Surface& surface,
                       const IcpOptions& options = {});

}  // namespace axial::evaluate
