// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/mesh.h"

namespace axial::evaluate {

// `count` points on the mesh, uniform by area: the surface is cut into `count` pieces of equal area
// (along the order of its faces) and each gets one point at random. The same for the same seed.
// Error if the mesh has no area or a coordinate or index is unusable. `faces`, unless null, becomes
// the face of each sample.
std::vector<Eigen::Vector3f> sample_surface(const Mesh& mesh, std::size_t count, std::uint64_t seed,
                                            std::vector<std::uint32_t>* faces = nullptr);

// At most `count` of the points, one at random out of each of `count` runs of equal length.
std::vector<Eigen::Vector3f> subsample(std::span<const Eigen::Vector3f> points, std::size_t count,
                                       std::uint64_t seed);

}  // namespace axial::evaluate
