// SPDX-License-Identifier: GPL-3.0-or-later
#include "map/frame.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "scene/decompositions.h"

namespace axial::map {

MapFrame frame_with_up(const Eigen::Vector3d& up, const LocalFrame& mesh_frame) {
  const Eigen::Vector3d u = up.normalized();
  const Eigen::Vector3d right =
      std::abs(u.x()) < std::sqrt(0.5) ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d x = (right - right.dot(u) * u).normalized();
  MapFrame frame;
  frame.axes << x.transpose(), u.cross(x).transpose(), u.transpose();
  frame.origin = frame.axes * mesh_frame.origin;
  if (!frame.axes.isIdentity(0)) frame.origin.z() = 0;
  return frame;
}

Eigen::Vector3d fitted_up(const Mesh& mesh, std::span<const Eigen::Vector3d> centres) {
  // Moments of the surface. The second moment of a triangle of area A with the corners v_k and
  // their mean g is A / 12 (9 g g' + sum of v_k v_k').
  const Eigen::Vector3d near = mesh.vertices.front().cast<double>();  // against cancellation
  double area = 0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const auto& [a, b, c] : mesh.faces) {
    Eigen::Matrix3d corners;
    corners << mesh.vertices[a].cast<double>() - near, mesh.vertices[b].cast<double>() - near,
        mesh.vertices[c].cast<double>() - near;
    const Eigen::Vector3d mean = corners.rowwise().mean();
    const double of_face =
        0.5 * (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0)).norm();
    area += of_face;
    first += of_face * mean;
    second += of_face / 12 * (9 * mean * mean.transpose() + corners * corners.transpose());
  }
  if (!(area > 0)) fail("the mesh has no area");
  const Eigen::Vector3d centroid = first / area;
  const SymmetricEigen3 eigen(second / area - centroid * centroid.transpose());
  const Eigen::Vector3d normal = eigen.eigenvectors().col(0);
  Eigen::Vector3d to_cameras = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& centre : centres) to_cameras += centre - near - centroid;
  const double side = normal.dot(to_cameras);
  if (side == 0) fail("the camera centres do not show which side of the mesh is up");
  return side > 0 ? normal : Eigen::Vector3d(-normal);
}

MapGrid grid_around(const Mesh& mesh, const MapFrame& frame, double pixel, SettingNames name_of) {
  constexpr double kMost = 1'000'000;
  Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Array2d high = -low;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const Eigen::Array2d at = frame.to_map(vertex.cast<double>()).head<2>().array();
    low = low.min(at), high = high.max(at);
  }
  // In pixels from the origin of the map.
  constexpr double kTolerance = 1e-3;
  low = (low / pixel + kTolerance).floor();
  high = (high / pixel - kTolerance).ceil().max(low + 1);
  const Eigen::Array2d size = high - low;
  if (!(size.maxCoeff() <= kMost))
    fail("{} {:g}: the map would have {:.0f} x {:.0f} pixels, and {:.0f} per side is the most",
         name_of("ground_sample_distance"), pixel, size.x(), size.y(), kMost);
  return {low.x() * pixel, high.y() * pixel, pixel, static_cast<int>(size.x()),
          static_cast<int>(size.y())};
}

}  // namespace axial::map
