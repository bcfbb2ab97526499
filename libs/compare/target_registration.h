// SPDX-License-Identifier: GPL-3.0-or-later
// Aligns a survey with an earlier one by targets that stayed where they are.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "axial/compare.h"
#include "map/frame.h"
#include "scene/decompositions.h"

namespace axial::compare {

// Targets of both surveys. The places [m] are in the world of each survey, one column for each
// target. The covariances [m^2] are those of all coordinates of a survey, x before y before z.
struct CommonTargets {
  std::vector<std::string> labels;
  Eigen::Matrix3Xd before, after;
  Eigen::MatrixXd covariance_before, covariance_after;
};

struct TargetRegistration {
  Similarity motion;  // from the world of the later survey to that of the earlier one; scale 1
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // of the used targets, in the earlier world
  // Covariance of a small further motion about `centre`, along the axes of the earlier world:
  // rotation vector [rad], translation [m].
  Matrix6d covariance = Matrix6d::Zero();
  // Indices of the targets, in increasing order.
  std::vector<std::size_t> used, moved;
  // Targets of which one moved, although it is not clear which one. They are among `used`.
  std::vector<std::size_t> doubtful;
  Eigen::Matrix3Xd residuals;  // of all targets: moved later place minus earlier place [m]
  // The squared residuals of the used targets, in standard deviations, and how many there are on
  // average if the covariances are right (the degrees of freedom).
  double chi_squared = 0;
  int freedom = 0;
  bool agrees = true;  // false: by chance, `chi_squared` is so large once in a thousand surveys
  // The lengths of the earlier survey, divided by those of the later one, and its standard
  // deviation. The motion does not contain it.
  double scale = 1, scale_sigma = 0;
};

// Finds the rigid motion of the later survey that moves its targets to those of the earlier one, by
// generalised least squares with both covariances.
//
// The frame of a survey may be known badly: all targets then have errors in common, as one rigid
// body. The mesh of the survey has these errors, too, so that they are no errors of the
// registration. So the covariance is first reduced by the rigid motion that explains the
// covariances between different targets best. Three targets do not show all of it: the standard
// deviation along the normal of their plane is then at most twice the largest one in the plane.
//
// A target moved if the sum of the squared residuals becomes smaller by more than 22 without this
// target, which happens by chance once in 15,000 targets, and if the sum is larger by 9 without any
// other target instead. At least four targets are needed to find one, and less than half of the
// targets can be found. If the others do not agree, the covariance is multiplied by the ratio of
// `chi_squared` and `freedom`.
//
// Error for fewer than three targets, for targets on a line, and for numbers that are not finite.
TargetRegistration register_targets(const CommonTargets& targets);

// The registration of a survey on a map. `frame`: of a mesh in `mesh_frame`.
Registration on_map(const TargetRegistration& found, const map::MapFrame& frame,
                    const LocalFrame& mesh_frame);

}  // namespace axial::compare
