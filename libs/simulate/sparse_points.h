// SPDX-License-Identifier: GPL-3.0-or-later
// True sparse points and their observations in images taken without a port.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "simulate/render.h"

namespace axial::simulate {

// The exact image of a point in one view.
struct Observation {
  std::size_t view = 0;   // index into the views of true_points()
  Eigen::Vector2d pixel;  // pixel centres at integers
};

struct SparsePoint {
  Eigen::Vector3d position;               // world [m]
  Eigen::Vector3f color;                  // linear R G B, 0 to 1
  std::vector<Observation> observations;  // by increasing view, at least two
};

// Places points on the surface that the views see: about `per_view` (at least 1) for each view. The
// points lie on the rays of a grid of pixels in the image of the view. Random numbers, which depend
// on `seed`, move the grid positions. A view observes a point if the point lies in its image and is
// not occluded. Only the 400 views nearest to the view for which a point was placed are tested.
// Points with fewer than two observations are dropped. The result is in the order of the views in
// which the points were placed. All views have the lens `lens` and no port. `shader` gives the
// points their colours.
std::vector<SparsePoint> true_points(const RayScene& scene, const Shader& shader, const Lens& lens,
                                     std::span<const View> views, int per_view, std::uint64_t seed);

}  // namespace axial::simulate
