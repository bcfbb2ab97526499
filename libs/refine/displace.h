// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "refine/topology.h"

namespace axial::refine {

// Moves every vertex along its normal in `shape`, by its entry of `displacement` [mesh units].
// `topology` and `shape`: of `mesh` before the call. Exceptions, in this order:
//   - A displacement that is not finite counts as zero.
//   - A step longer than a third of Shape::edge is reduced to this length.
//   - If a face turns by more than 60 degrees from its former normal, the steps of its three
//     corners are halved, and all faces are checked again. The sixth check is the last: it sets the
//     steps to zero instead of halving them.
// After the sixth check, a face beside the corners whose steps became zero may still turn by more
// than 60 degrees.
void displace(Mesh& mesh, const Topology& topology, const Shape& shape,
              std::span<const float> displacement);

// Flattens folds of `mesh`, in three rounds. `topology`: of `mesh`. A face is part of a fold if its
// normal is more than 90 degrees from the sum of the normals (Shape::normals) of its three corners.
// Each round moves the corners of such faces to the mean of their neighbours' positions before the
// round. Vertices on borders stay.
//
// Reason: folds are narrower than the noise of the cloud, so they show no detail of the surface. No
// view measures the hidden side of a fold, and a step of displace() would push the visible side
// through the hidden side.
void flatten_folds(Mesh& mesh, const Topology& topology);

}  // namespace axial::refine
