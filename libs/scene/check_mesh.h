// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "scene/mesh.h"

namespace axial {

// Throws an Error if `mesh` has no faces, if a face refers to a vertex that does not exist, if a
// coordinate is not finite, if there are colours but not one for each vertex, or if there are marks
// of unseen faces but not one for each face. The message names the face or the vertex.
void check_mesh(const Mesh& mesh);

}  // namespace axial
