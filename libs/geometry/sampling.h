// SPDX-License-Identifier: GPL-3.0-or-later
// Random samples of a mesh or of points.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/mesh.h"

namespace axial::geometry {

// Returns `count` random points on the mesh, uniform by area. The faces, in their order, are
// divided into `count` parts of equal area, and each part gets one random point. The same seed
// gives the same points. `faces`, unless null, receives the index of the face of each sample. Error
// if the total area is 0 or not finite, or if a face refers to a vertex that does not exist.
std::vector<Eigen::Vector3f> sample_surface(const Mesh& mesh, std::size_t count, std::uint64_t seed,
                                            std::vector<std::uint32_t>* faces = nullptr);

// Returns `count` of the points, in their order. The points are divided into `count` runs of equal
// length, and one random point of each run is taken. If there are at most `count` points, all are
// returned. The same seed gives the same points.
std::vector<Eigen::Vector3f> subsample(std::span<const Eigen::Vector3f> points, std::size_t count,
                                       std::uint64_t seed);

}  // namespace axial::geometry
