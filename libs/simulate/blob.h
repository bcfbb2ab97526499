// SPDX-License-Identifier: GPL-3.0-or-later
// Rough bodies on the terrain: boulders, caps, stalks and arches. Lengths are metres.
#pragma once

#include <Eigen/Core>

#include "simulate/triangle_mesh.h"

namespace axial::simulate {

// A rough ellipsoid. Its surface points are centre + turn * (radii o d) * (1 + relief(d)) for all
// unit vectors d, where o multiplies component by component.
struct Blob {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d radii = Eigen::Vector3d::Ones();
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  double roughness = 0.2;  // height of the largest bumps, as a fraction of the radius
  std::uint32_t seed = 1;

  double relief(const Eigen::Vector3d& unit_direction) const;
  // True if the point `p` [m] lies inside the body, at least `margin` [m] below the surface.
  bool contains(const Eigen::Vector3d& p, double margin) const;
};

// The mesh of a blob, with about `cell` metres between vertices.
TriangleMesh blob_mesh(const Blob& blob, double cell);

// Half a ring that stands on the ground: a rough tube around a half circle. The half circle lies
// in the vertical plane through `centre` and the unit horizontal direction `along` (cosine,
// sine).
struct Arch {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector2d along{1, 0};
  double span_radius = 0.5;  // radius of the half circle
  double rise = 1.0;         // the height of the arch divided by span_radius
  double tube_radius = 0.1;
  double roughness = 0.25;
  std::uint32_t seed = 1;
};

// The mesh of an arch, with about `cell` metres between vertices.
TriangleMesh arch_mesh(const Arch& arch, double cell);

}  // namespace axial::simulate
