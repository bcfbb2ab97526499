// SPDX-License-Identifier: GPL-3.0-or-later
// Splits faces, for a mesh whose faces are large compared with the pixels.
#pragma once

#include <cstddef>
#include <vector>

#include "scene/mesh.h"

namespace axial::refine {

// Splits all edges of the marked faces in the middle. `marked` has one entry per face. A marked
// face becomes four faces. An unmarked face that shares edges with marked faces is split at these
// edges, too, and becomes two to four faces, so that no vertex lies inside an edge. The parts of a
// face take the place of the face in the order of the faces. Vertices keep their indices, and new
// vertices follow. The colour of a new vertex is the mean of the colours of its edge's two ends.
// Returns by how many the number of faces has grown.
std::size_t split_faces(Mesh& mesh, const std::vector<bool>& marked);

}  // namespace axial::refine
