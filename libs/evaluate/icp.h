// SPDX-License-Identifier: GPL-3.0-or-later
// Aligns a cloud rigidly with the true surface.
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
  double trim = 3;     // points beyond this factor of the median distance do not count
  double stop = 1e-7;  // ends when a step is shorter than this factor of the cloud's radius
};

struct IcpResult {
  Similarity transform;  // scale 1
  int iterations = 0;
  bool converged = false;
  double median_before = 0, median_after = 0;  // of the distances of the points used [m]
};

// Minimises the distances of a fixed subsample to the surface with Gauss-Newton steps (point to
// plane inside faces, point to point beyond the edges of the surface). The cloud does not move in
// directions that the surface does not constrain, such as sliding on a plane. Error for fewer than
// 6 points, or for points without extent.
IcpResult refine_rigid(std::span<const Eigen::Vector3f> points, const Surface& surface,
                       const IcpOptions& options = {});

}  // namespace axial::evaluate
