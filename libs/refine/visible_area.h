// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "refine/scaled_views.h"

namespace axial::refine {

// Returns for each face of `mesh` whether the area of its image is larger than `limit` [px^2] in at
// least two views that see all three corners of the face. `visibility` and `images`: of the
// vertices of `mesh` in `views`.
std::vector<bool> larger_than(double limit, const Mesh& mesh, const ScaledViews& views,
                              const Visibility& visibility, MeshImages& images);

}  // namespace axial::refine
