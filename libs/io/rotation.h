// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: whether a matrix read from a file is a rotation.
#pragma once

#include <Eigen/Core>
#include <string>

namespace axial::io {

// `r`, made exactly orthonormal where a writer's rounding left it short of that. Error that starts
// with `where` if it is not finite, R R^T differs from I by more than 1e-3, or det R < 0.
Eigen::Matrix3d checked_rotation(const Eigen::Matrix3d& r, const std::string& where);

}  // namespace axial::io
