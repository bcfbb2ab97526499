// SPDX-License-Identifier: GPL-3.0-or-later
// The corners, areas and directions of the faces of a mesh, in the frame of the mesh. Precondition
// of all functions: the face and its vertices exist.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>

#include "scene/mesh.h"

namespace axial::geometry {

inline std::array<Eigen::Vector3d, 3> corners_of(const Mesh& mesh, std::size_t face) {
  const auto& [a, b, c] = mesh.faces[face];
  return {mesh.vertices[a].cast<double>(), mesh.vertices[b].cast<double>(),
          mesh.vertices[c].cast<double>()};
}

// Twice the area of the face, times its unit normal.
inline Eigen::Vector3d area_vector(const Mesh& mesh, std::size_t face) {
  const auto [a, b, c] = corners_of(mesh, face);
  return (b - a).cross(c - a);
}

// The mean of the corners.
inline Eigen::Vector3d middle_of(const Mesh& mesh, std::size_t face) {
  const auto [a, b, c] = corners_of(mesh, face);
  return (a + b + c) / 3;
}

// The area of all faces [m^2]. Error for a mesh without area.
double area_of(const Mesh& mesh);

// The mean of the unit normals of the faces, weighted by area. Its length is 1 for a plane and 0
// for a closed mesh. Error for a mesh without area.
Eigen::Vector3d mean_normal(const Mesh& mesh);

}  // namespace axial::geometry
