// SPDX-License-Identifier: GPL-3.0-or-later
// The faces of a mesh that are marked as unseen (Mesh::unseen).
#pragma once

#include <cstddef>

#include "axial/scene_images.h"
#include "scene/mesh.h"

namespace axial {

// Remove the marked faces, the vertices that no face uses then, and all marks. The other faces and
// vertices keep their order. Without marks, nothing changes. Return the number of removed faces.
// Precondition: there are no marks or one per face, and check_mesh() accepts the mesh.
std::size_t remove_marked_faces(Mesh& mesh);
std::size_t remove_marked_faces(TexturedMesh& mesh);

}  // namespace axial
