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
  std::size_t samples = 20000;  // points used; all points if the cloud has fewer
  std::uint64_t seed = 1;
  int max_iterations = 100;
  double trim = 3;  // a step ignores points farther from the surface than trim * median distance
  // The iteration ends when a step is shorter than stop * radius. The radius is the RMS distance of
  // the used points from their mean. The length of a step combines its translation and radius *
  // rotation [rad].
  double stop = 1e-7;
};

struct IcpResult {
  Similarity transform;  // from the cloud to the surface; scale 1
  int iterations = 0;
  bool converged = false;
  double median_before = 0, median_after = 0;  // of the used points' distances [m]
};

// Finds the rigid motion that aligns `points` with `surface`. Minimises the squared distances of a
// fixed subsample of the points to the surface with Gauss-Newton steps. A step replaces the surface
// near each point by the plane through the nearest point of the surface, perpendicular to the line
// from the nearest point to the point. The cloud does not move in directions that the surface does
// not constrain, such as sliding on a plane. Error if there are fewer than 6 points, or if the
// points coincide or are not finite.
IcpResult refine_rigid(std::span<const Eigen::Vector3f> points, const Surface& surface,
                       const IcpOptions& options = {});

}  // namespace axial::evaluate
