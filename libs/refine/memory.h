// SPDX-License-Identifier: GPL-3.0-or-later
// The memory that refinement needs, and the number of views whose VertexImages fit into the memory.
#pragma once

#include <cstdint>

#include "axial/refine.h"

namespace axial::refine {

// The numbers on which the memory depends.
struct Sizes {
  std::uint64_t vertices = 0, faces = 0, views = 0;  // of the mesh, and of all views
  std::uint64_t pixels = 0;                          // number of pixels of the largest view
};

// Returns the number of views whose VertexImages are kept in memory: the largest number for which
// bytes_needed() is within `budget`, but at most max(sizes.views, 2). Throws the Error of
// MemoryBudget::require() with the number of vertices if bytes_needed() for two views, or the
// memory of the caller afterwards (Options::bytes_afterwards), is more.
std::size_t views_to_keep(const Sizes& sizes, const Options& options, const MemoryBudget& budget);

// An estimate of the memory [bytes] that refine() needs if the VertexImages of `kept` views are
// kept. Counted: the arrays over vertices and faces, the images of one reference view and the
// pixels of one source view. Not counted: the mesh, and memory that the function Pictures keeps
// between calls. The estimate assumes six faces and six neighbours per vertex.
std::uint64_t bytes_needed(const Sizes& sizes, std::uint64_t kept);

// The memory [bytes] while `marked` faces of the mesh are split (split.h), besides the mesh.
std::uint64_t bytes_to_split(const Sizes& sizes, std::uint64_t marked);

}  // namespace axial::refine
