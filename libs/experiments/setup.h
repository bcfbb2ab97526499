// SPDX-License-Identifier: GPL-3.0-or-later
// The setups of the paper's simulations: a camera behind a flat port, and a stereo pair of two such
// cameras in front of a plane. The default values are the paper's, except the refractive indices,
// which the paper does not give. Camera axes: x right, y down, z forward.
#pragma once

#include <string>
#include <vector>

#include "refractive/flat_port_camera.h"

namespace axial::experiments {

using refractive::FlatPort;
using refractive::FlatPortCamera;
using refractive::PinholeLens;
using refractive::Vector2;
using refractive::Vector3;

// A camera behind a flat port.
struct CameraSetup {
  double fov_degrees = 80;   // field of view, horizontal, in air
  double distance = 0.02;    // d_a, camera centre to glass [m]
  double thickness = 0.014;  // of the glass [m]
  double tilt_degrees = 0;   // of the port's normal from the optical axis, towards +x
  double n_glass = 1.52;
  double n_water = 1.333;
};

// Returns the lens of an image of `width` x `height` pixels. The middle `fov_width` pixels of the
// width span the field of view. The other pixels are a border. If `fov_width` is 0, the whole width
// spans the field of view. The principal point is in the middle of the image. Both focal lengths
// are equal.
PinholeLens<double> make_lens(const CameraSetup& setup, int width, int height, int fov_width = 0);
// Returns the port of the setup, in the camera frame.
FlatPort<double> make_port(const CameraSetup& setup);

// Two cameras with parallel axes, and a plane through the point 4 m in front of the first camera.
struct StereoSetup {
  int number = 1;      // centre of the second camera; 1: (1, 0, 0) m; 2: (0.5, 0, -1) m
  CameraSetup camera;  // of both cameras
  // Rotation of the plane about y. 0: perpendicular to the optical axes. Positive: the plane turns
  // away from the second camera.
  double plane_degrees = 0;
};

// The centre of the second camera [m], a point of the plane [m], and the unit normal of the plane.
// All are in the frame of the first camera. The normal points towards the cameras.
Vector3<double> source_centre(const StereoSetup& setup);
Vector3<double> plane_point(const StereoSetup& setup);
Vector3<double> plane_normal(const StereoSetup& setup);

// One value of one varied parameter. All other parameters have their default values.
struct Variation {
  // The parameter: "fov_degrees", "distance_mm", "tilt_degrees", "n_glass", "n_water" or
  // "plane_degrees".
  std::string series;
  double value;  // in the unit in the name of the parameter
  StereoSetup setup;
};

// Returns the default setup with one parameter changed. `series` and `value`: as in Variation.
// `stereo_number`: StereoSetup::number. Error if `series` is none of the names in Variation.
Variation vary(const std::string& series, double value, int stereo_number = 1);

}  // namespace axial::experiments
