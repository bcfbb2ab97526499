// SPDX-License-Identifier: GPL-3.0-or-later
// Mends a small part of a mesh.
#pragma once

#include <cstddef>
#include <vector>

#include "scene/mesh.h"

namespace axial::mesh {

// Returns `patch`, a part of a mesh, without gaps and self-intersections. `fixed`: per vertex,
// whether faces outside of the patch have this vertex. Fixed vertices keep their positions. Gaps
// are closed if their border has at most `close_gaps` edges and no fixed vertex. Faces that
// intersect each other, and faces at gaps that cannot be closed, are removed with their neighbours,
// and the gaps are closed. If this does not help after a few rounds, the gaps stay open. The
// vertices of the result have no order.
Mesh mend_patch(const Mesh& patch, const std::vector<bool>& fixed, std::size_t close_gaps);

}  // namespace axial::mesh
