// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "refine/scaled_views.h"

namespace axial::refine {

// Returns for each face whether its area [px^2] is larger than `limit` in at least two views that
// see all three corners of the face.
std::vector<bool> larger_than(double limit, const Mesh& mesh, const ScaledViews& views,
                              const Visibility& visibility, MeshImages& images);

}  // namespace axial::refine
