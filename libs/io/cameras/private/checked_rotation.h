// SPDX-License-Identifier: GPL-3.0-or-later
// Private to libs/io: rotations in files.
#pragma once

#include <Eigen/Core>
#include <string>

#include "bytes/private/only_for_io.h"

namespace axial::io {

// Returns a rotation for the matrix `r`. Let d be the largest absolute element of r r^T - I. If d
// is less than 1e-9, the result is `r`. Otherwise the result is the orthonormal matrix nearest to
// `r`. Error that starts with `where` if `r` is not finite, if d exceeds 1e-3, or if det r < 0.
Eigen::Matrix3d checked_rotation(const Eigen::Matrix3d& r, const std::string& where);

}  // namespace axial::io
