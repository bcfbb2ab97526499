// SPDX-License-Identifier: GPL-3.0-or-later
// True sparse points and their observations in the in-air images.
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

// Places about `per_view` points on the surface that each view sees, at jittered grid positions
// that depend on `seed`. A point is observed by every view in whose image it lies without being
// occluded. Points with fewer than two observations are dropped.
std::vector<SparsePoint> true_points(const RayScene& scene, const Shader& shader, const Lens& lens,
                                     std::span<const View> views, int per_view, std::uint64_t seed);

}  // namespace axial::simulate
