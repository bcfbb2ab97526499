// SPDX-License-Identifier: GPL-3.0-or-later
// The steps of reconstruct() in axial/mesh.h. The method is that of Labatut, Pons and Keriven 2009
// (votes.h). In addition, the rays of cameras behind ports bend at the port.
#pragma once

#include <cstdint>

#include "axial/mesh.h"
#include "mesh/merge_points.h"

namespace axial::mesh {

// The approximate memory [bytes] that reconstruct() needs for `merged_points` points that
// merge_points() returns. The memory of the cloud, which is freed before, is not included.
std::uint64_t bytes_needed(std::size_t merged_points);

// For clouds that are reconstructed in tiles (tiled.h).
//
// Throws the Errors of reconstruct() for a point whose position, views or weights are wrong. The
// points of `cloud` have the numbers from `first` on in messages.
void check_points(const PointCloud& cloud, const Scene& scene, std::size_t first = 0);
// Makes the mesh of points that are merged already. `rays`: of the same scene. The result has no
// faces if there are fewer than four points, if no surface is found, or if cleaning leaves no face.
// Throws an Error if bytes_needed() exceeds the limit of Context::memory(), or if all points lie in
// a plane.
Mesh reconstruct_merged(MergedPoints points, const Scene& scene, const ViewRays& rays,
                        const ReconstructOptions& options, const Context& context = {});

}  // namespace axial::mesh
