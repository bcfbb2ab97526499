// SPDX-License-Identifier: GPL-3.0-or-later
// How much the first position of a vertex counts.
#pragma once

#include <span>
#include <vector>

#include "refine/topology.h"

namespace axial::refine {

struct Anchor {
  std::vector<float> offset;   // from the first position, along the vertex's normal [mesh units]
  std::vector<double> weight;  // of the square of the offset after the step
};

struct AnchorOptions {
  double weight = 0.25;
  double factor = 1;  // of the image size
};

// The distance of the vertices from their first positions, along their normals.
std::vector<float> offsets(std::span<const Eigen::Vector3f> vertices,
                           std::span<const Eigen::Vector3f> first, const Shape& shape);

// The weights of first positions that were matched in the same photographs. The information of the
// photographs on a vertex is I, the sum of w g^2. The first position has the same information up to
// the factor `weight`, because it is as uncertain as texture and geometry make it; a tenth of the
// median I is added, because some of the first position comes from the surface around it. At the
// full image size, I is larger than at a smaller size by about factor^-4: twice for the number of
// pixels, and twice for the gradients. Where the photographs alone would move the vertex (by
// `displacement`, after the offset) by many standard deviations of both measurements, the first
// position is wrong, and its weight decreases as by Cauchy's loss.
std::vector<double> anchor_weights(std::span<const double> information,
                                   std::span<const float> offset,
                                   std::span<const float> displacement,
                                   const AnchorOptions& options);

}  // namespace axial::refine
