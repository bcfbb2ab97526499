// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/memory.h"

#include <fmt/format.h>

#include <algorithm>

#include "refine/data_term.h"
#include "refine/vertex_images.h"

namespace axial::refine {
namespace {

// First positions, shape, topology with 6 neighbours and 6 faces, the system (with 13 numbers in
// double and two in float of every neighbour), visibility, and the numbers of a reference view.
constexpr std::uint64_t kOfVertex = 12 + 20 + 12 + 60 + 104 + 48 + 28 + 12;
// Equations, former planes, lists of pixels, lists of bands.
constexpr std::uint64_t kOfFace = sizeof(FaceEquations) + 12 + 8 + 8;
// Of a reference view: depths and faces twice while they are drawn, corners, six images in float,
// the list of pixels; and the pixels of the source view.
constexpr std::uint64_t kOfPixel = 8 + 8 + 6 * 4 + 4 + 1 + 6;

}  // namespace

std::uint64_t bytes_needed(const Sizes& sizes, std::uint64_t kept) {
  return sizes.vertices * (kOfVertex + (sizes.views + 63) / 64 * 8 + kept * sizeof(VertexImage)) +
         sizes.faces * kOfFace + sizes.pixels * kOfPixel;
}

std::uint64_t bytes_to_split(const Sizes& sizes, std::uint64_t marked) {
  // The topology; a hash table of the split edges, at most three of each marked face, with a node
  // of the heap and a place each; the new vertices, and all faces, which are in memory twice.
  constexpr std::uint64_t kOfEdge = 32 + 16 + 2 * (12 + 3);
  return sizes.vertices * 60 + 3 * marked * kOfEdge + (sizes.faces + 3 * marked) * 2 * 12;
}

std::size_t views_to_keep(const Sizes& sizes, const Options& options, const MemoryBudget& budget) {
  const std::uint64_t most = std::max<std::uint64_t>(sizes.views, 2);
  const std::uint64_t least = bytes_needed(sizes, 2);
  budget.require(std::max(least, sizes.vertices * options.bytes_afterwards),
                 fmt::format("refining a mesh of {} vertices", sizes.vertices));
  const std::uint64_t each = sizes.vertices * sizeof(VertexImage);
  return 2 + std::min(most - 2, (budget.left() - least) / std::max<std::uint64_t>(each, 1));
}

}  // namespace axial::refine
