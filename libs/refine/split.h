// SPDX-License-Identifier: GPL-3.0-or-later
// Splits faces, for a mesh that is coarser than the pixels.
#pragma once

#include <cstddef>
#include <vector>

#include "scene/mesh.h"

namespace axial::refine {

// Splits the edges of the faces that are marked, in the middle. A marked face becomes four, and its
// neighbours up to four, so that no vertex lies on an edge of another face. The order of the faces
// is kept; colours of new vertices are the mean of their edge's. Returns the number of new faces.
std::size_t split_faces(Mesh& mesh, const std::vector<bool>& marked);

}  // namespace axial::refine
