// SPDX-License-Identifier: GPL-3.0-or-later
// How the rays behind a port move when the numbers of the port change.
#pragma once

#include <ceres/jet.h>

#include <optional>
#include <variant>

#include "pose/bundle/housing_change.h"
#include "refractive/dome_port_camera.h"
#include "refractive/flat_port_camera.h"

namespace axial::pose {

// The rays of a port with the derivatives by the numbers 0 to 4 of its change. The object is built
// once for all rays of the port.
//
// Use: the image of a fixed point X is the direction whose ray passes through X. By the implicit
// function theorem, the derivative of the tangents of this direction with respect to the numbers is
// -d(tangents)/dX times the result of at(). Only the ray, which has a closed form, is
// differentiated, and not the iteration of the projection.
class RaysByChange {
 public:
  // The port is `measured` with `change` applied. Without a port, all derivatives are zero.
  RaysByChange(const std::optional<refractive::Port<double>>& measured,
               const HousingChange<double>& change);

  // Let X be the point at the distance `lambda` [m] from the origin of a ray in water, which lies
  // on the axis of the port (refractive::AxialRay), in the camera frame. The ray is the refracted
  // ray of the in-air direction (u, v, 1), with (u, v) = `tangents`. Returns the derivative of X
  // [m] with respect to the numbers (columns), at constant tangents and lambda.
  Eigen::Matrix<double, 3, kPortNumbers> at(const Eigen::Vector2d& tangents, double lambda) const;

 private:
  using Jet = ceres::Jet<double, kPortNumbers>;
  using Camera = std::variant<std::monostate, refractive::FlatPortCamera<Jet>,
                              refractive::DomePortCamera<Jet>>;

  static Camera camera_behind(const refractive::FlatPort<Jet>& port);
  static Camera camera_behind(const refractive::DomePort<Jet>& port);

  Camera camera_;
};

}  // namespace axial::pose
