// SPDX-License-Identifier: GPL-3.0-or-later
// Rough bodies the terrain is furnished with: boulders, caps and stalks, arches.
#pragma once

#include <Eigen/Core>

#include "simulate/triangle_mesh.h"

namespace axial::simulate {

// A rough ellipsoid: centre + turn * (radii o direction) * (1 + relief(direction)).
struct Blob {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d radii = Eigen::Vector3d::Ones();
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  double roughness = 0.2;  // of the relief's largest bumps, as a fraction of the radius
  std::uint32_t seed = 1;

  double relief(const Eigen::Vector3d& unit_direction) const;
  // True for points at least `margin` [m] below the surface.
  bool contains(const Eigen::Vector3d& p, double margin) const;
};

// About `cell` metres between vertices.
TriangleMesh blob_mesh(const Blob& blob, double cell);

// Half a ring standing on the ground: a rough tube around a half circle in the vertical plane
// through `centre` that is turned by (cosine, sine) = `along`.
struct Arch {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector2d along{1, 0};
  double span_radius = 0.5;  // of the half circle
  double rise = 1.0;         // its height over its radius
  double tube_radius = 0.1;
  double roughness = 0.25;
  std::uint32_t seed = 1;
};

TriangleMesh arch_mesh(const Arch& arch, double cell);

}  // namespace axial::simulate
