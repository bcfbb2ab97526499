// SPDX-License-Identifier: GPL-3.0-or-later
// Rough bodies on the terrain: boulders, caps, stalks and arches. Lengths are metres.
#pragma once

#include <Eigen/Core>

#include "simulate/triangle_mesh.h"

namespace axial::simulate {

// A rough ellipsoid. Its surface points are centre + turn * (radii o d) * (1 + relief(d)) for all
// unit vectors d, where o multiplies component by component.
struct Blob {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();    // world
  Eigen::Vector3d radii = Eigen::Vector3d::Ones();     // along the body's own axes, above 0
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  // rotation from the body's axes to the world
  double roughness = 0.2;  // height of the largest bumps, as a fraction of the radius
  std::uint32_t seed = 1;  // of the bumps

  // No point farther from the centre than this many times the largest radius is inside the body.
  static constexpr double kReach = 2.5;

  // The height of the bumps in a direction (unit vector along the body's own axes), as a fraction
  // of the radius; at least -0.7.
  double relief(const Eigen::Vector3d& unit_direction) const;
  // True if the point `p` [world, m] lies inside the body, at least about `margin` [m] below the
  // surface.
  bool contains(const Eigen::Vector3d& p, double margin) const;
};

// The mesh of a blob in the world frame, with about `cell` metres between vertices, and from 162 to
// 655,362 vertices.
TriangleMesh blob_mesh(const Blob& blob, double cell);

// Half a ring that stands on the ground: a rough tube around a half circle. The half circle lies in
// the vertical plane through `centre` and the unit horizontal direction `along` (cosine, sine).
// Both ends of the tube continue below the height of `centre`, and are open there.
struct Arch {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // world; on the ground
  Eigen::Vector2d along{1, 0};
  double span_radius = 0.5;  // radius of the half circle
  double rise = 1.0;         // the height of the arch divided by span_radius
  double tube_radius = 0.1;
  double roughness = 0.25;  // height of the largest bumps, as a fraction of tube_radius
  std::uint32_t seed = 1;   // of the bumps

  // True if the point `p` [world, m] lies inside the tube.
  bool contains(const Eigen::Vector3d& p) const;
};

// The mesh of an arch in the world frame, with about `cell` metres between vertices.
TriangleMesh arch_mesh(const Arch& arch, double cell);

}  // namespace axial::simulate
