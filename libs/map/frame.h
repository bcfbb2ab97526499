// SPDX-License-Identifier: GPL-3.0-or-later
// The axes of a map and its pixel grid.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "axial/map.h"

namespace axial::map {

// The plane that is fitted to a mesh.
struct FittedPlane {
  Eigen::Vector3d point;   // the centroid of the surface [frame of the mesh]
  Eigen::Vector3d normal;  // unit; either of the two directions
};

// The plane that is fitted to the mesh by least squares of the distances of all points of its
// surface, weighted by area. Faces far away are left out, because they would tilt the plane: those
// that are more than five times farther from the median of the surface than half of its area is, if
// they have at most 2 % of the area and if the plane without them is another one. Error for a mesh
// whose area is 0.
FittedPlane fitted_plane(const Mesh& mesh);

// As grid_around(), the smallest grid that contains the box [map].
MapGrid grid_over(const Eigen::AlignedBox2d& box, double pixel, double most = kMostPixels);

// Throws an Error if a side of a map has more than `most` pixels. The message calls the width of a
// pixel the setting "ground_sample_distance".
void require_possible(double columns, double rows, double pixel, double most = kMostPixels);

}  // namespace axial::map
