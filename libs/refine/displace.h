// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "refine/topology.h"

namespace axial::refine {

// Moves every vertex along its normal. A step is at most a third of the vertex's edge. Where a face
// would turn by more than 60 degrees from its former plane, the steps of its corners are shortened.
void displace(Mesh& mesh, const Topology& topology, const Shape& shape,
              std::span<const float> displacement);

}  // namespace axial::refine
