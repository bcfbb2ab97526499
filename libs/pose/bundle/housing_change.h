// SPDX-License-Identifier: GPL-3.0-or-later
// The unknown numbers of a camera behind a port: the differences between the present numbers of
// lens and port and their measured values.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "pose/bundle/photograph_camera.h"

namespace axial::pose {

// The numbers of a change, by index. "Difference" means the present minus the measured value.
// - 0 to 2 of a flat port: the tilts of the normal [rad, for small tilts] towards two unit vectors
//   across it, the rows 0 and 1 of refractive::axis_from_camera(measured normal), in the camera
//   frame; and the difference of the distance [m].
// - 0 to 2 of a dome: the difference of the centre [m].
// - 3: the difference of the refractive index of the water.
// - 4: the difference of the thickness of the glass [m].
// - 5: the natural logarithm of the factor from the measured to the present focal lengths, for
//   both. Cameras in air have this number alone.
inline constexpr int kHousingNumbers = 6;
inline constexpr int kPortNumbers = 5;  // the numbers 0 to 4 belong to the port
inline constexpr int kIndexNumber = 3, kThicknessNumber = 4, kFocalNumber = 5;

// The numbers above, in the order of their indices. Zero: as measured.
template <class T>
using HousingChange = Eigen::Matrix<T, kHousingNumbers, 1>;

// Return the measured port or lens with `change` applied. Numbers that do not belong to it are
// ignored. Results are not checked. T is double or an automatic-differentiation scalar.
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

// The camera with `change` applied to lens and port. HousedCamera::field stays that of `measured`.
HousedCamera with_change(const HousedCamera& measured, const HousingChange<double>& change);

}  // namespace axial::pose
