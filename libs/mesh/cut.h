// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "mesh/tetrahedra.h"
#include "mesh/votes.h"

namespace axial::mesh {

// Decides which tetrahedra are occupied, by the cut of least cost: the votes of free tetrahedra for
// inside, of occupied ones for outside, and the costs of the facets between them. Tetrahedra that
// the votes leave undecided are free. One entry per tetrahedron. Error if there are 2^29 tetrahedra
// or more.
std::vector<bool> occupied(const Tetrahedra& tetrahedra, const Votes& votes);

}  // namespace axial::mesh
