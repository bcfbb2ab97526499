// SPDX-License-Identifier: GPL-3.0-or-later
// Smooth round tubes, closed at both ends: ropes and branches of coral.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulate/triangle_mesh.h"

namespace axial::simulate {

// A tube along a polyline, the spine. Lengths are metres.
struct Tube {
  std::vector<Eigen::Vector3d> spine;  // at least two points; successive points differ
  std::vector<double> radii;           // one for each point of the spine, above 0
};

// Makes the mesh of a tube: a ring of vertices at each point of the spine, and a nearly
// point-like ring beyond each end. All rings have the same number of vertices, from 8 to 48.
// Within these limits, vertices of the widest ring are at most about `cell` metres apart.
// TriangleMesh::thickness of a vertex is the diameter of the tube at the vertex.
TriangleMesh tube_mesh(const Tube& tube, double cell);

}  // namespace axial::simulate
