// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/setup.h"

#include <cmath>
#include <numbers>

#include "base/error.h"

namespace axial::experiments {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// The z axis rotated by `degrees` about y, towards +x.
Vector3<double> turned_axis(double degrees) {
  return {std::sin(degrees * kDegree), 0, std::cos(degrees * kDegree)};
}

}  // namespace

PinholeLens<double> make_lens(const CameraSetup& setup, int width, int height, int fov_width) {
  const double f =
      0.5 * (fov_width > 0 ? fov_width : width) / std::tan(0.5 * setup.fov_degrees * kDegree);
  return {f, f, 0.5 * (width - 1), 0.5 * (height - 1)};
}

FlatPort<double> make_port(const CameraSetup& setup) {
  return {turned_axis(setup.tilt_degrees),
          setup.distance,
          setup.thickness,
          1,
          setup.n_glass,
          setup.n_water};
}

Vector3<double> source_centre(const StereoSetup& setup) {
  return setup.number == 1 ? Vector3<double>(1, 0, 0) : Vector3<double>(0.5, 0, -1);
}

Vector3<double> plane_point(const StereoSetup&) {
  return {0, 0, 4};
}

// The normal points towards the cameras. A positive angle turns the plane away from the second
// camera.
Vector3<double> plane_normal(const StereoSetup& setup) {
  return -turned_axis(-setup.plane_degrees);
}

Variation vary(const std::string& series, double value, int stereo_number) {
  Variation variation{series, value, {}};
  variation.setup.number = stereo_number;
  CameraSetup& camera = variation.setup.camera;
  if (series == "fov_degrees")
    camera.fov_degrees = value;
  else if (series == "distance_mm")
    camera.distance = 1e-3 * value;
  else if (series == "tilt_degrees")
    camera.tilt_degrees = value;
  else if (series == "plane_degrees")
    variation.setup.plane_degrees = value;
  else if (series == "n_glass")
    camera.n_glass = value;
  else if (series == "n_water")
    camera.n_water = value;
  else
    fail("'{}' is not a parameter of the simulations", series);
  return variation;
}

}  // namespace axial::experiments
