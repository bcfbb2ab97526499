// SPDX-License-Identifier: GPL-3.0-or-later
// The unknown numbers of a camera behind a port: the differences between lens and port and their
// measured values.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "pose/photograph_camera.h"

namespace axial::pose {

// The numbers 0 to 2 of a flat port: tilts [rad] of the normal towards the two axes across it, and
// distance [m]. Of a dome: its centre [m]. Of both: refractive index of the water (3) and thickness
// of the glass [m] (4). Of all cameras, also in air: the logarithm of the factor of both focal
// lengths (5).
inline constexpr int kHousingNumbers = 6;
inline constexpr int kPortNumbers = 5;  // the first numbers belong to the port
inline constexpr int kIndexNumber = 3, kThicknessNumber = 4, kFocalNumber = 5;

template <class T>
using HousingChange = Eigen::Matrix<T, kHousingNumbers, 1>;

// The measured port or lens changed by `change`. T is double or an automatic-differentiation
// scalar.
template <class T>
refractive::FlatPort<T> with_change(const refractive::FlatPort<double>& measured,
                                    const HousingChange<T>& change) {
  refractive::FlatPort<T> port = measured.cast<T>();
  const Eigen::Matrix3d axis = refractive::axis_from_camera(measured.normal);
  port.normal +=
      axis.row(0).transpose().cast<T>() * change(0) + axis.row(1).transpose().cast<T>() * change(1);
  port.normal.normalize();
  port.distance += change(2);
  port.n_water += change(kIndexNumber);
  port.thickness += change(kThicknessNumber);
  return port;
}

template <class T>
refractive::DomePort<T> with_change(const refractive::DomePort<double>& measured,
                                    const HousingChange<T>& change) {
  refractive::DomePort<T> port = measured.cast<T>();
  port.centre += change.template head<3>();
  port.n_water += change(kIndexNumber);
  port.thickness += change(kThicknessNumber);
  return port;
}

template <class T>
refractive::PinholeLens<T> with_change(const refractive::PinholeLens<double>& measured,
                                       const HousingChange<T>& change) {
  using std::exp;
  refractive::PinholeLens<T> lens = measured.cast<T>();
  lens.fx *= exp(change(kFocalNumber));
  lens.fy *= exp(change(kFocalNumber));
  return lens;
}

// The camera with `change` applied to lens and port.
HousedCamera with_change(const HousedCamera& measured, const HousingChange<double>& change);

// The derivative by the numbers of the port of the point at `lambda` [m] on the ray in water of the
// in-air direction (u, v, 1), in the camera frame. `tangents`: (u, v). The image of a point is the
// direction whose ray meets the point. The derivative of the tangents by the numbers is therefore
// -d(tangents)/dX times this derivative (implicit function theorem). Only the ray, a closed form,
// is differentiated, and no iteration. Zero without a port.
Eigen::Matrix<double, 3, kPortNumbers> ray_by_change(
    const std::optional<refractive::Port<double>>& measured, const HousingChange<double>& change,
    const Eigen::Vector2d& tangents, double lambda);

}  // namespace axial::pose
