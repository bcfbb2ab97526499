// SPDX-License-Identifier: GPL-3.0-or-later
// The uncertainty of places relative to each other.
#pragma once

#include <Eigen/Core>

namespace axial::pose {

// The standard deviations of places after the best similarity transformation of all places. A
// similarity moves, turns and scales all places together, so what is left is the uncertainty of
// their shape: the bending of a strip of photographs, for example.
//
// `places`: one column for each place [m]. `covariance`: of the coordinates, x, y and z of the
// first place, then of the second place, and so on [m^2]. The result has one number for each place
// [m]: the square root of the sum of the three variances. To first order, the similarity removes
// the part of the errors in the space of its seven derivatives; the rest is the projection on the
// complement of this space. Returns zeros for fewer than three places.
Eigen::VectorXd sigmas_after_similarity(const Eigen::Matrix3Xd& places,
                                        const Eigen::MatrixXd& covariance);

}  // namespace axial::pose
