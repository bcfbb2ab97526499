// SPDX-License-Identifier: GPL-3.0-or-later
// The volume between a mesh and the ground.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "scene/mesh.h"

namespace axial::geometry {

// The points x with normal.dot(x) == offset. Above the plane, normal.dot(x) is larger.
struct Plane {
  Eigen::Vector3d normal{0, 0, 1};  // unit
  double offset = 0;                // [m]

  // The signed distance of x from the plane [m]; positive above the plane.
  double height_of(const Eigen::Vector3d& x) const { return normal.dot(x) - offset; }
};

struct GroundOptions {
  // The axis that roughly points up or down: 0: x, 1: y, 2: z. The angle between the normal of the
  // plane and this axis or its opposite is at most 45 degrees.
  int up_axis = 2;
  // Points up to this distance from the plane lie on the ground [m]. 0: 1/200 of the diagonal of
  // the bounding box of the mesh.
  double threshold = 0;
  std::uint64_t seed = 1;  // of the random samples and planes
};

// Returns the plane, in the frame of the mesh, with the largest area of the mesh at distances up to
// `options.threshold`. The area is estimated with samples of the mesh. The search is RANSAC (M.
// Fischler and R. Bolles, 1981). A least-squares fit to the samples within the threshold then
// refines the plane. The normal points to the side of `above`, a point such as a camera [frame of
// the mesh]. Error if no plane has a normal in the wanted direction (GroundOptions::up_axis), or as
// for sample_surface() (sampling.h).
Plane ground_plane(const Mesh& mesh, const Eigen::Vector3d& above, const GroundOptions& options);

// Returns the volume [m^3] between the mesh and the plane, above the plane. Every face is clipped
// at the plane. Let A be the area of the clipped face, projected onto the plane, and h its mean
// height above the plane. A is negative if the normal of the face points down. The result is the
// sum of A * h over all faces. If all normals of the mesh point up, the result is the volume
// between plane and surface. If the mesh is closed and its normals point outwards, the result is
// the part of the enclosed volume above the plane. Precondition: the vertices of the faces exist.
double volume_above(const Mesh& mesh, const Plane& plane);

// Returns the volume [m^3] that a closed mesh encloses. The volume is negative if the normals of
// the faces point inwards. The result has no meaning for a mesh with a border. 0 for a mesh without
// faces. Precondition: the vertices of the faces exist.
double enclosed_volume(const Mesh& mesh);

}  // namespace axial::geometry
