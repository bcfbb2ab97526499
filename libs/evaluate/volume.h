// SPDX-License-Identifier: GPL-3.0-or-later
// The volume between a mesh and the ground.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "scene/mesh.h"

namespace axial::evaluate {

// The points x with normal.dot(x) == offset; above it, normal.dot(x) is larger.
struct Plane {
  Eigen::Vector3d normal{0, 0, 1};  // unit
  double offset = 0;

  double height_of(const Eigen::Vector3d& x) const { return normal.dot(x) - offset; }
};

struct GroundOptions {
  int up_axis = 2;  // 0, 1, 2: the normal is at most 45 degrees from this axis or its opposite
  // Distance up to which a point lies on the ground. 0: 1/200 of the diagonal of the mesh's box.
  double threshold = 0;
  std::uint64_t seed = 1;
};

// The plane with the most area of the mesh within the threshold, found by RANSAC (M. Fischler and
// R. Bolles, 1981) over samples of the mesh, and then fitted to that area by least squares. `above`
// is a point on its upper side, such as a camera. Error if no plane has the wanted direction, or as
// for sample_surface.
Plane ground_plane(const Mesh& mesh, const Eigen::Vector3d& above, const GroundOptions& options);

// The volume of the part above the plane: the sum over all faces, clipped at the plane, of the area
// of their projections onto the plane, times the mean height. Areas of faces that look down count
// negative. This is the volume between the plane and a surface that looks up, and for a closed mesh
// the part of its volume above the plane.
double volume_above(const Mesh& mesh, const Plane& plane);

// The volume that a closed mesh encloses; negative if its faces look inwards. Of no meaning for a
// mesh with a border.
double enclosed_volume(const Mesh& mesh);

}  // namespace axial::evaluate
