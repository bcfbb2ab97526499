// SPDX-License-Identifier: GPL-3.0-or-later
// The linear system of one Gauss-Newton step: the displacement of every vertex along its normal.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "refine/data_term.h"
#include "refine/topology.h"

namespace axial::refine {

struct SystemOptions {
  double smoothness = 1;  // lambda
  unsigned max_iterations = 100;
  std::span<const double> anchor;
  std::span<const float> offset;
  double tolerance = 1e-3;  // of the residual, relative to that of no displacement
};

struct Solution {
  std::vector<float> displacement;  // of every vertex, along its normal [mesh units]
  std::vector<bool> measured;       // the vertex has equations
};

// Solves by conjugate gradients with the diagonal as preconditioner. The sums are added in an order
// that does not depend on the number of threads. A vertex whose neighbourhood has no equations
// stays.
//
// The bending of the surface at vertex i is n_i . (mean of the neighbours - vertex), which is the
// mean curvature times half the squared distance of the neighbours. Its square counts with lambda *
// area / edge^4. Vertices on borders have no bending.
Solution solve(const Mesh& mesh, const Topology& topology, const Shape& shape,
               std::span<const FaceEquations> equations, const SystemOptions& options);

}  // namespace axial::refine
