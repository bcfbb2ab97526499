// SPDX-License-Identifier: GPL-3.0-or-later
// Ropes and the branches of corals: smooth round tubes, closed at both ends.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulate/triangle_mesh.h"

namespace axial::simulate {

struct Tube {
  std::vector<Eigen::Vector3d> spine;  // at least two points, each apart from the one before
  std::vector<double> radii;           // one a point of the spine, above 0
};

// About `cell` metres between vertices, fewer where the tube is thinner: at least eight around it.
// Every vertex has the tube's diameter there as its thickness.
TriangleMesh tube_mesh(const Tube& tube, double cell);

}  // namespace axial::simulate
