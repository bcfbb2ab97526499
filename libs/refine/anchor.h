// SPDX-License-Identifier: GPL-3.0-or-later
// The anchor term of the system: weights that hold vertices near their first positions. The first
// position of a vertex is its position before the first step.
#pragma once

#include <span>
#include <vector>

#include "refine/topology.h"

namespace axial::refine {

// The anchor term: the sum over the vertices of weight * (offset after the step)^2. Both arrays
// have one entry per vertex.
struct Anchor {
  // The signed distance from the first position, along the vertex's normal, before the step [mesh
  // units].
  std::vector<float> offset;
  std::vector<double> weight;
};

struct AnchorOptions {
  // Information of the first position divided by the information of the photographs, for a first
  // position that the photographs do not contradict.
  double weight = 0.25;
  double factor = 1;  // image size of the step / full image size
};

// The signed distance of every vertex from its first position, along the vertex's normal in `shape`
// [mesh units]. `vertices`: the present positions. `first`: the first positions. Both have one
// entry per vertex.
std::vector<float> offsets(std::span<const Eigen::Vector3f> vertices,
                           std::span<const Eigen::Vector3f> first, const Shape& shape);

// The weight of every first position:
//
//     a = weight / factor^4 * (I + m / 10) / (1 + (d / (2 sigma))^2)
//
// I: `information` of the vertex, the sum of w g^2 (refine.h). m: the median of the positive I.
// d: `offset` + `displacement`, the distance [mesh units] from the first position to the position
// that the photographs alone would give the vertex. sigma: 3 / sqrt(I), the standard deviation of
// this position. weight, factor: fields of `options`. All spans have one entry per vertex.
//
// Reasons:
//   - The first position was matched in the same photographs. Its uncertainty depends on the same
//     texture and geometry, so that its information is proportional to I.
//   - A part of the first position comes from the surface around it. This part is m / 10.
//   - I is proportional to factor^4: factor^2 for the number of pixels, and factor^2 for the
//     squared gradients. The division gives the information at the full image size.
//   - If d is many sigma, the first position is wrong. Its weight decreases as in Cauchy's loss.
std::vector<double> anchor_weights(std::span<const double> information,
                                   std::span<const float> offset,
                                   std::span<const float> displacement,
                                   const AnchorOptions& options);

}  // namespace axial::refine
