// SPDX-License-Identifier: GPL-3.0-or-later
// True sparse points and their observations in images taken without a port.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "simulate/render.h"

namespace axial::simulate {

struct Observation {
  std::size_t view = 0;
  Eigen::Vector2d pixel;  // pixel centres at integers
};

struct SparsePoint {
  Eigen::Vector3d position;
  Eigen::Vector3f color;                  // linear R G B
  std::vector<Observation> observations;  // by increasing view, at least two
};

// Places points on the surface that the views see: about `per_view` for each view. The points lie
// on the rays of a grid of pixels in the image of the view. Random numbers, which depend on `seed`,
// move the grid positions. A view observes a point if the point lies in its image and is not
// occluded. Points with fewer than two observations are dropped.
std::vector<SparsePoint> true_points(const RayScene& scene, const Shader& shader, const Lens& lens,
                                     std::span<const View> views, int per_view, std::uint64_t seed);

}  // namespace axial::simulate
