// SPDX-License-Identifier: GPL-3.0-or-later
// Aligns a cloud rigidly with the true surface.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "geometry/surface.h"
#include "scene/decompositions.h"

namespace axial::geometry {

struct IcpOptions {
  std::size_t samples = 20000;  // number of used points; all points if the cloud has fewer
  std::uint64_t seed = 1;       // of the random choice of the used points
  int max_iterations = 100;     // largest number of steps
  // A step ignores the points that are farther from the surface than trim * the median distance of
  // the used points before the step.
  double trim = 3;
  // The iteration ends after a step that is shorter than stop * radius. The radius is the RMS
  // distance of the used points from their mean. Let t be the translation of the mean by the step
  // [m], and a the angle of the step's rotation [rad]. The square of the step's length is
  // |t|^2 + (radius * a)^2.
  double stop = 1e-7;
};

struct IcpResult {
  Similarity transform;    // from the cloud to the surface; scale 1
  int iterations = 0;      // number of steps
  bool converged = false;  // false: the iteration ended only because of `max_iterations`
  // Median distances of the used points from the surface before the first and after the last step
  // [m].
  double median_before = 0, median_after = 0;
};

// Finds the rigid motion that aligns `points` with `surface`. Minimises the sum of the squared
// distances of the used points to the surface with Gauss-Newton steps. The used points are a random
// subsample, which is the same in all steps. A step replaces the surface near each point by the
// plane through the nearest point of the surface, perpendicular to the line from the nearest point
// to the point. The cloud does not move in directions that the surface does not constrain, such as
// sliding on a plane. Error if there are fewer than 6 points, if the used points coincide, or if
// one of them is not finite.
IcpResult refine_rigid(std::span<const Eigen::Vector3f> points, const Surface& surface,
                       const IcpOptions& options = {});

}  // namespace axial::geometry
