// SPDX-License-Identifier: GPL-3.0-or-later
// How far the faces of a mesh are from the points of which the mesh was made.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/mesh.h"

namespace axial::mesh {

// The most points that say something about a mesh of this number of faces: four for each face.
std::size_t enough_points(std::size_t faces);

// Returns for each face the distance [m] from its middle, the mean of its corners, to the nearest
// point. The result does not depend on the number of threads. Preconditions: there is at least one
// point, and all coordinates are finite.
std::vector<float> distances_to_points(const Mesh& mesh, std::span<const Eigen::Vector3f> points);

// The memory [bytes] of distances_to_points() with its result, for enough_points() points, besides
// its arguments.
std::uint64_t bytes_of_distances(const Mesh& mesh);

}  // namespace axial::mesh
