// SPDX-License-Identifier: GPL-3.0-or-later
// Splits faces that are too large for texture coordinates, which are linear inside a face: the
// image of a face is not, because of perspective, refraction and lens distortion.
#pragma once

#include <cstddef>
#include <span>

#include "scene/mesh.h"
#include "texture/views.h"

namespace axial::texture {

struct SplitOptions {
  double tolerance = 0.25;             // largest error of a linear image inside a face [px]
  std::size_t max_faces = 20'000'000;  // no more splits beyond this number
};

// Splits edges in their middle, and the faces at them, until the exact image of the middle of each
// edge is near the middle of the images of its ends, in each view that looks at a front of the
// edge and has it in its image. An error that is quadratic along the edges is inside a face at most
// 4/3 of the largest error at its edges; so 3/4 of the tolerance is allowed there. Faces stay
// joined along their edges. Returns the number of new faces. Views are not asked what hides the
// face.
std::size_t split_faces(Mesh& mesh, std::span<const View> views, const SplitOptions& options = {});

}  // namespace axial::texture
