// SPDX-License-Identifier: GPL-3.0-or-later
// Cameras of all kinds, and surfaces in front of them, for the tests of pinhole views and of
// resampling into them.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "support/analytic_scene.h"

namespace axial::cloud {

using test::AnalyticScene;

inline constexpr double kNear = 0.5, kFar = 1.6;

// A camera without a port, with 240 x 180 pixels and a horizontal field of view of 65 degrees.
inline CameraModel lens_in_air() {
  CameraModel model = test::dry_camera();
  return model.resized(240, 180);
}

inline CameraModel flat(double distance, const Eigen::Vector3d& normal) {
  CameraModel model = lens_in_air();
  refractive::FlatPort<double> port;
  port.normal = normal.normalized();
  port.distance = distance;
  port.thickness = 0.014;
  port.n_glass = 1.52;
  port.n_water = 1.333;
  model.port = port;
  return model;
}

inline CameraModel dome(const Eigen::Vector3d& centre) {
  CameraModel model = lens_in_air();
  refractive::DomePort<double> port;
  port.centre = centre;
  port.inner_radius = 0.05;
  port.thickness = 0.007;
  port.n_glass = 1.49;
  port.n_water = 1.333;
  model.port = port;
  return model;
}

inline CameraModel distorted(CameraModel model) {
  refractive::LensDistortion<double> distortion;
  distortion.above[1] = -0.12;
  distortion.above[2] = 0.02;
  model.distortion = distortion;
  return model;
}

inline CameraModel above_water(double height) {
  CameraModel model = flat(height, {0.02, 0.03, 1});
  auto& port = std::get<refractive::FlatPort<double>>(*model.port);
  port.thickness = 0;
  port.n_glass = port.n_water;
  return model;
}

struct NamedCamera {
  const char* name;
  CameraModel model;
};

inline std::vector<NamedCamera> cameras() {
  return {{"Flat", flat(0.02, {0, 0, 1})},
          {"FarFlat", flat(0.08, {0, 0, 1})},
          {"Tilted", flat(0.03, {0.1, -0.2, 1})},
          {"Dome", dome({0, 0, 0.002})},
          {"OffCentreDome", dome({0.004, -0.003, -0.006})},
          {"DistortedBehindPort", distorted(flat(0.03, {0.05, 0.05, 1}))},
          {"DistortedInAir", distorted(lens_in_air())},
          {"AboveWater", above_water(0.3)},
          {"InAir", lens_in_air()}};
}

inline AnalyticScene plane() {
  return {};
}

inline AnalyticScene sphere_before_plane() {
  AnalyticScene scene;
  scene.sphere_radius = 0.15;
  return scene;
}

inline Pose tilted_pose() {
  return test::circle_of_poses(5)[1];
}

// A fixture for tests of one camera of cameras().
class EachCamera : public testing::TestWithParam<NamedCamera> {
 protected:
  static CameraModel model() { return GetParam().model; }
};

}  // namespace axial::cloud
