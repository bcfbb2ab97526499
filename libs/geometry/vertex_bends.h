// SPDX-License-Identifier: GPL-3.0-or-later
// How far the vertices of a mesh stand out from their neighbours.
#pragma once

#include <vector>

#include "scene/mesh.h"

namespace axial::geometry {

// For each vertex the distance [m] from the vertex to the mean of its neighbours, along the normal
// (vertex_normals()). The neighbours are the other corners of its faces, weighted by the number of
// faces. 0 for a vertex without a face. Independent errors with the standard deviation s give a
// bend with the variance s^2 (1 + 1/n), with n neighbours. Precondition: the vertices of the faces
// exist, and the faces share them (join_vertices()).
std::vector<float> vertex_bends(const Mesh& mesh);

// The mesh whose vertices are moved along their normals to the mean of themselves and of six
// neighbours: the same faces with about half of the resolution.
Mesh smoothed(const Mesh& mesh);

}  // namespace axial::geometry
