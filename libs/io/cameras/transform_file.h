// SPDX-License-Identifier: GPL-3.0-or-later
// Text files with a similarity transformation, as OpenMVS's TransformScene reads them.
#pragma once

#include <filesystem>

#include "scene/decompositions.h"

namespace axial::io {

// Reads 12 or 16 numbers: the first three rows, or all four rows, of a homogeneous matrix that maps
// world coordinates to world coordinates. Words that are not numbers are skipped, and commas and
// semicolons separate numbers as blanks do. Error that names the file for another count, a number
// that is not finite, a last row other than 0 0 0 1, or a matrix that is not a uniform positive
// scale, a rotation and a translation (by more than 1e-3 of the scale). A smaller deviation is
// removed: the rotation is made exactly orthonormal.
Similarity read_transform(const std::filesystem::path& file);

}  // namespace axial::io
