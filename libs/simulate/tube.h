// SPDX-License-Identifier: GPL-3.0-or-later
// Smooth round tubes, closed at both ends: ropes and branches of coral.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulate/triangle_mesh.h"

namespace axial::simulate {

struct Tube {
  std::vector<Eigen::Vector3d> spine;  // at least two points; successive points differ
  std::vector<double> radii;           // one for each point of the spine, above 0
};

// Makes the mesh of a tube. Vertices are about `cell` metres apart around the tube, and there are 8
// to 48 of them in a ring. There is a ring at each point of the spine. The thickness of a vertex is
// the tube's diameter there.
TriangleMesh tube_mesh(const Tube& tube, double cell);

}  // namespace axial::simulate
