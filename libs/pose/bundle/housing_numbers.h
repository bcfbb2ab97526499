// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers of a camera behind a port, which can be measured, adjusted, or wrong: their names,
// their units, and the groups in which they belong together. housing_change.h lists the numbers.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pose/bundle/bundle.h"

namespace axial::pose {

enum class PortKind { none, flat, dome };  // none: no port, as in air

// The kind of `port`. No port: PortKind::none.
PortKind kind_of(const std::optional<refractive::Port<double>>& port);

// The kind of all ports of the bundle. Nothing if the bundle has several kinds, or no camera.
std::optional<PortKind> common_kind(const Bundle& bundle);

// The kind of a number. coordinate: of a dome's centre. point: a coordinate of the principal point.
enum class Quantity { angle, distance, coordinate, index, thickness, radius, focal, point };

// One number of a camera, for reports and messages.
struct HousingNumber {
  std::size_t number = 0;  // index in housing_change.h, if the number has one
  Quantity quantity = Quantity::distance;
  std::string name;           // in reports, for example "distance"
  std::string title;          // in sentences about the camera, for example "distance of the port"
  std::string unit;           // for example "mm"; a number without unit: ""
  double scale = 1;           // factor from the unit of housing_change.h to `unit`: 1000 for mm
  std::size_t camera = 0;     // index of the camera
  double now = 0, sigma = 0;  // present value and its standard deviation [unit]
  double before = 0, sigma_before = 0;  // the measured value; sigma_before 0: not measured
  double change = 0;                    // now - before

  // True if the photographs say more about the value than its measurement: `sigma` is less than
  // half of `sigma_before`, or the value was not measured. False if the measured value was kept.
  bool by_photographs() const {
    return !(sigma_before > 0) || (now != before && sigma < sigma_before / 2);
  }
};

// The numbers of a port with its values as `now` and `before`, by ascending HousingNumber::number.
std::vector<HousingNumber> port_numbers(const refractive::Port<double>& port);

// The standard deviations with which numbers were measured. 0: not stated. Distance and normal are
// those of a flat port, the centre is that of a dome, for each of its coordinates.
struct Sigmas {
  double normal_degrees = 0;                       // for each of its two tilts
  double distance = 0, centre = 0, thickness = 0;  // [m]
  double index = 0;                                // of the refractive index of the water
  double focal = 0;  // standard deviation of the focal length, divided by the focal length
};

// The standard deviations of numbers that were measured with a ruler, and of a lens and of water
// that were not calibrated for the dive: 3 degrees, 5 mm, 0.5 mm for the thickness, 0.004, 0.5 %.
Sigmas ruler_sigmas();

// Numbers that are measured and adjusted together, and that are wrong together.
struct NumberGroup {
  std::string_view word;          // in lists of numbers, for example "normal"
  std::string_view setting;       // the name of the setting of its standard deviation in messages
  std::string_view title;         // in sentences, if the group has several numbers
  double Sigmas::*sigma;          // the standard deviation of each number
  double scale;                   // factor from the unit of `sigma` to that of housing_change.h
  std::size_t first, count;       // of the numbers in housing_change.h
  bool of_flat, of_dome, of_air;  // the kinds of cameras that have these numbers

  bool applies(PortKind kind) const {
    return kind == PortKind::flat ? of_flat : kind == PortKind::dome ? of_dome : of_air;
  }
};

// All groups: normal, distance, centre, thickness, index, focal.
std::span<const NumberGroup> number_groups();

}  // namespace axial::pose
