// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: checks that a matrix from a file is a rotation.
#pragma once

#include <Eigen/Core>
#include <string>

#include "private/only_for_io.h"

namespace axial::io {

// Returns `r`, made orthonormal if rounding in the file left it inexact. Error that starts with
// `where` if it is not finite, an element of R R^T differs from I by more than 1e-3, or det R < 0.
Eigen::Matrix3d checked_rotation(const Eigen::Matrix3d& r, const std::string& where);

}  // namespace axial::io
