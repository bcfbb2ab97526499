// SPDX-License-Identifier: GPL-3.0-or-later
// Text files with a similarity transformation, as OpenMVS's TransformScene reads them.
#pragma once

#include <filesystem>

#include "scene/decompositions.h"

namespace axial::io {

// Reads a homogeneous 4 x 4 matrix that maps world coordinates to world coordinates. The file holds
// all 16 numbers row by row, or the 12 numbers of the first three rows. Words that are not numbers
// are skipped. Commas and semicolons separate numbers as blanks do.
//
// Let A be the upper left 3 x 3 block, s the cube root of det A, and R = A / s. The result has the
// scale s, the rotation R, and the translation in the last column of the matrix. A small deviation
// of R from a rotation is removed. Error that names the file for a file that cannot be read,
// another count of numbers, a number that is not finite, a last row that is not (0, 0, 0, 1), an s
// that is not positive, or an R for which an element of R R^T - I exceeds 1e-3.
Similarity read_transform(const std::filesystem::path& file);

}  // namespace axial::io
