// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "mesh/tetrahedra.h"
#include "mesh/votes.h"

namespace axial::mesh {

// Decides which tetrahedra are occupied: inside the object, not free space. Returns one entry per
// tetrahedron; true: occupied. The decision minimises the sum of three costs: the votes for inside
// of the free tetrahedra, the votes for outside of the occupied tetrahedra, and the costs of the
// facets between free and occupied tetrahedra. A tetrahedron that the votes leave undecided is
// free. Precondition: `votes` has one entry per tetrahedron in each array, and no vote is negative.
// Throws an Error if there are 2^29 tetrahedra or more.
std::vector<bool> occupied(const Tetrahedra& tetrahedra, const Votes& votes);

}  // namespace axial::mesh
