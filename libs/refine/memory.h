// SPDX-License-Identifier: GPL-3.0-or-later
// How much memory refinement needs, and how many images of the vertices are kept with what is left.
#pragma once

#include <cstdint>

#include "refine/refine.h"

namespace axial::refine {

struct Sizes {
  std::uint64_t vertices = 0, faces = 0, views = 0;
  std::uint64_t pixels = 0;  // of the largest view
};

// The number of views whose VertexImages are kept: as many as Options::max_bytes allows, at least
// two. Error that names max_memory, its value and the need if this does not suffice.
std::size_t views_to_keep(const Sizes& sizes, const Options& options);

// An upper bound of the memory [bytes] with `kept` views.
std::uint64_t bytes_needed(const Sizes& sizes, std::uint64_t kept);

}  // namespace axial::refine
