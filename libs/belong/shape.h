// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes and clouds as one type, for checks that do not depend on the difference.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

#include "scene/mesh.h"
#include "scene/point_cloud.h"

namespace axial::belong {

// A mesh, or a cloud if `faces` is empty. Refers to the arrays of another object, which must
// outlive it. Its parts are the faces of the mesh or the points of the cloud.
struct Shape {
  std::span<const Eigen::Vector3f> vertices;                 // finite
  std::span<const std::array<std::uint32_t, 3>> faces = {};  // indices into `vertices`

  std::size_t parts() const { return faces.empty() ? vertices.size() : faces.size(); }
  // The mean of the corners of a face, or the point of a cloud. Precondition: the part exists.
  Eigen::Vector3d middle(std::size_t part) const;
};

// Precondition: check_mesh() accepts the mesh (scene/check_mesh.h).
Shape shape_of(const Mesh& mesh);
// Precondition: the positions are finite.
Shape shape_of(const PointCloud& cloud);

}  // namespace axial::belong
