// SPDX-License-Identifier: GPL-3.0-or-later
// Splits faces that are too large for linear texture coordinates. Texture coordinates are linear
// inside a face, but the exact image of a face is not, because of perspective, refraction and lens
// distortion.
#pragma once

#include <cstddef>
#include <span>

#include "axial/texture.h"
#include "base/context.h"
#include "scene/mesh.h"

namespace axial::texture {

// Splits edges in the middle, together with the faces at the edges, until the error of each edge is
// at most 3/4 of the tolerance. The error of an edge in a view is the distance [px] from the exact
// image of the edge's middle to the middle of the images of its two ends. A view counts for an edge
// if a face at the edge is turned towards the view and the image contains both ends and the middle
// of the edge. Views that other faces hide from the edge count, too.
//
// The factor 3/4: an error that is quadratic along the edges is, inside a face, at most 4/3 of the
// largest error at the face's edges.
//
// Splitting ends early in two cases: after 16 rounds, or before a round that could give more than
// max_faces faces (with a warning in the log). Faces stay joined along their edges. The parts of a
// face take the place of the face in the order of the faces. The parts of a marked face are marked
// (Mesh::unseen). Vertices keep their indices, and new vertices follow. Returns by how many the
// number of faces has grown. Error if a round needs more memory than `budget` allows; earlier
// rounds have then changed the mesh.
std::size_t split_faces(Mesh& mesh, std::span<const View> views, const SplitOptions& options = {},
                        const MemoryBudget& budget = {}, const Context& context = {});

// The memory [bytes] of a round of split_faces() for a mesh of this size, besides the mesh.
// `split`: the number of edges that the round splits.
std::uint64_t bytes_to_split(std::uint64_t faces, std::uint64_t split);

}  // namespace axial::texture
