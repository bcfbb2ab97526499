// SPDX-License-Identifier: GPL-3.0-or-later
// The directions of a mesh at its vertices.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "scene/mesh.h"

namespace axial::geometry {

// Returns one unit normal for each vertex, in the frame of the mesh: the mean of the normals of the
// faces with this vertex, weighted by their areas. The normal of a face points to the side from
// which its corners are counterclockwise. The result is zero for a vertex without a face, and where
// the faces have no area or cancel each other. Precondition: the vertices of the faces exist.
std::vector<Eigen::Vector3f> vertex_normals(const Mesh& mesh);

}  // namespace axial::geometry
