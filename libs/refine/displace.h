// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "refine/topology.h"

namespace axial::refine {

// Moves every vertex along its normal. A step is at most a third of the vertex's edge. Where a face
// would turn by more than 60 degrees from its former plane, the steps of its corners are shortened.
void displace(Mesh& mesh, const Topology& topology, const Shape& shape,
              std::span<const float> displacement);

// Flattens folds: moves the vertices of faces that turn away from the surface around them by more
// than 90 degrees to the mean of their neighbours, in some rounds. Vertices on borders stay. A fold
// is narrower than the noise of the cloud; its hidden side has no measurement, and a step would
// push its visible side through it.
void flatten_folds(Mesh& mesh, const Topology& topology);

}  // namespace axial::refine
