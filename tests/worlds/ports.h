// SPDX-License-Identifier: GPL-3.0-or-later
// The usual ports and cameras of tests.
#pragma once

#include <Eigen/Core>

#include "geometry/posed_camera.h"
#include "refractive/flat_port.h"

namespace axial::test {

// A flat port of glass in front of the camera, in water. Lengths in metres.
inline refractive::FlatPort<double> flat_port(double distance = 0.03, double thickness = 0.01,
                                              const Eigen::Vector3d& normal = {0, 0, 1}) {
  return {normal.normalized(), distance, thickness, 1, 1.5, 1.333};
}

// A camera at `centre` that looks along z, with the principal point in the middle of its image, in
// air or behind flat_port().
inline geometry::PosedCamera camera_at(const Eigen::Vector3d& centre, int width, int height,
                                       double focal, bool wet = false) {
  geometry::PosedCamera posed;
  posed.camera.width = width;
  posed.camera.height = height;
  posed.camera.lens = {focal, focal, (width - 1) / 2.0, (height - 1) / 2.0};
  if (wet) posed.camera.port = flat_port();
  posed.pose.centre = centre;
  return posed;
}

// The same camera, looking down along -z, with y upwards in the image.
inline geometry::PosedCamera camera_above(const Eigen::Vector3d& centre, int width, int height,
                                          double focal, bool wet = false) {
  geometry::PosedCamera posed = camera_at(centre, width, height, focal, wet);
  posed.pose.rotation = Eigen::Vector3d(1, -1, -1).asDiagonal();
  return posed;
}

}  // namespace axial::test
