// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/mesh.h"

namespace axial::evaluate {

// Returns `count` points on the mesh, uniform by area. The surface is cut into `count` pieces of
// equal area, along the order of its faces, and each piece gets one random point. The same seed
// gives the same points. `faces`, unless null, receives the face of each sample. Error if the mesh
// has no area, or if a coordinate or an index is not valid.
std::vector<Eigen::Vector3f> sample_surface(const Mesh& mesh, std::size_t count, std::uint64_t seed,
                                            std::vector<std::uint32_t>* faces = nullptr);

// Returns at most `count` of the points: one random point out of each of `count` runs of equal
// length.
std::vector<Eigen::Vector3f> subsample(std::span<const Eigen::Vector3f> points, std::size_t count,
                                       std::uint64_t seed);

}  // namespace axial::evaluate
