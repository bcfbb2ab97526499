// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/memory.h"

#include <algorithm>

#include "base/error.h"
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

std::size_t views_to_keep(const Sizes& sizes, const Options& options) {
  const std::uint64_t most = std::max<std::uint64_t>(sizes.views, 2);
  if (options.max_bytes == 0) return most;
  const std::uint64_t least = bytes_needed(sizes, 2);
  if (least > options.max_bytes)
    fail("{}: refining a mesh of {} vertices needs {} MB more", options.name_of("max_memory"),
         sizes.vertices, (least - options.max_bytes) / 1'000'000 + 1);
  const std::uint64_t each = sizes.vertices * sizeof(VertexImage);
  return std::min(most, 2 + (options.max_bytes - least) / std::max<std::uint64_t>(each, 1));
}

}  // namespace axial::refine
